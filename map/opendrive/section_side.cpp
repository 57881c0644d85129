#include "roadbed/map/opendrive/section_side.h"

#include <iterator>

namespace roadbed::map::opendrive {

std::size_t next_section(const RoadRecord& road, std::size_t section, int sign) {
  return sign > 0 ? road.sections[section].next_left : road.sections[section].next_right;
}

SectionSide section_side(const RoadRecord& road, std::size_t section, int sign) {
  const std::size_t next = next_section(road, section, sign);
  SectionSide side{road.sections[section].s_m,
                   next < road.sections.size() ? road.sections[next].s_m : road.length_m,
                   sign,
                   {}};
  const auto& lanes = road.sections[section].lanes;
  if (sign > 0) {
    for (auto it = lanes.upper_bound(0); it != lanes.end(); ++it) side.lanes.push_back(&it->second);
  } else {
    for (auto it = std::make_reverse_iterator(lanes.lower_bound(0)); it != lanes.rend(); ++it) {
      side.lanes.push_back(&it->second);
    }
  }
  return side;
}

}  // namespace roadbed::map::opendrive
