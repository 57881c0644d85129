#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "roadbed/map/elements/lane.h"
#include "roadbed/map/elements/lane_types.h"

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
  std::span<const LaneMatch> of(std::size_t point) const {
    return std::span(all).subspan(ranges[point].from, ranges[point].to - ranges[point].from);
  }
};

/// What is looked for near a point.
struct LaneQuery {
  double radius_m = std::numeric_limits<double>::infinity();    ///< farthest lane
  std::size_t count = std::numeric_limits<std::size_t>::max();  ///< most lanes
  LaneTypes types = LaneTypes::all();
};

}  // namespace roadbed::map::elements
