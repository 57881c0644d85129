#pragma once

#include <cstddef>
#include <vector>

#include "roadbed/map/opendrive/document.h"

namespace roadbed::map::opendrive {

/// One side of one lane section: its lanes from the middle of the road outwards.
struct SectionSide {
  double from_s_m = 0.0, to_s_m = 0.0;
  int sign = 1;  ///< of the lanes' ids: +1 left, −1 right
  std::vector<const LaneRecord*> lanes;
};

/// The lanes of a section's side, and how far that side reaches: to the next section that says
/// something of it.
SectionSide section_side(const RoadRecord& road, std::size_t section, int sign);

/// Index of the next section that says something of that side, or the number of sections.
std::size_t next_section(const RoadRecord& road, std::size_t section, int sign);

}  // namespace roadbed::map::opendrive
