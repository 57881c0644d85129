#pragma once

#include <string>

namespace roadbed::map::inline elements {

/// What is painted or built along a border. Of double lines the left one, seen in the driving
/// direction of the lane whose border it is, comes first.
enum class MarkType {
  none,
  solid,
  broken,
  solid_solid,
  solid_broken,
  broken_solid,
  broken_broken,
  botts_dots,
  curb,
  grass,
  edge,  ///< a physical end of the road: guard rail, wall, fence
  other,
};

/// A marking along a lane's border, from a station of the lane to the next marking's.
struct BorderMark {
  double from_s_m = 0.0;
  MarkType type = MarkType::none;
  std::string color;     ///< the source's word, empty if it has none: "white", "yellow"
  double width_m = 0.0;  ///< 0 if unknown

  bool operator==(const BorderMark&) const = default;
};

}  // namespace roadbed::map::elements
