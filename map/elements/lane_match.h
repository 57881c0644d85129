#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/elements/lane.h"

namespace roadbed::map::inline elements {

/// A lane near a point. `distance_m` is 0 inside the lane's polygon.
struct LaneMatch {
  LanePlace place;
  double distance_m = 0.0;
  double heading_rad = 0.0;  ///< of the lane there
};

/// Lanes near each of many points.
struct LaneMatches {
  struct Range {
    std::size_t from = 0, to = 0;
  };
  std::vector<LaneMatch> all;
  std::vector<Range> ranges;  ///< in `all`, one per point
  std::size_t size() const { return ranges.size(); }
  /// The lanes of one point, the nearest first.
  std::span<const LaneMatch> of(std::size_t point) const {
    return std::span(all).subspan(ranges[point].from, ranges[point].to - ranges[point].from);
  }
};

/// A set of lane types, as those that a question is about.
class LaneTypes {
 public:
  static LaneTypes all() {
    return those([](LaneType) { return true; });
  }
  static LaneTypes drivable() { return those(is_drivable); }
  static LaneTypes surface() { return those(is_surface); }

  bool has(LaneType type) const { return has(static_cast<std::uint32_t>(type)); }        ///< one
  bool has(std::uint32_t type) const { return type < 32 && (bits_ >> type & 1U) != 0; }  ///< one

 private:
  template <typename Wants>
  static LaneTypes those(const Wants& wants) {
    LaneTypes made;
    for (std::uint32_t type = 0; type <= static_cast<std::uint32_t>(LaneType::other); ++type) {
      if (wants(static_cast<LaneType>(type))) made.bits_ |= 1U << type;
    }
    return made;
  }

  std::uint32_t bits_ = 0;
};

/// What is looked for near a point.
struct LaneQuery {
  double radius_m = std::numeric_limits<double>::infinity();    ///< farthest lane
  std::size_t count = std::numeric_limits<std::size_t>::max();  ///< most lanes
  LaneTypes types = LaneTypes::all();
  geometry::WorkBudget* budget = nullptr;  ///< a step of it is each piece of a lane looked at
};

}  // namespace roadbed::map::elements
