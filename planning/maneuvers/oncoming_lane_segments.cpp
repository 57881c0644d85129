#include "roadbed/planning/maneuvers/overtaking.h"

#include <algorithm>
#include <limits>

namespace roadbed::planning::inline maneuvers {
namespace {

using map::Lane;
using map::Neighbour;

constexpr double kEdgeStep_m = 5.0;
constexpr double kJoined_m = 5.0;  // stretches so near to each other are one
constexpr double kUnknownLimit_mps = 100.0 / 3.6;

/// Least distance from the line to a border of the lane, between two stations of the lane.
double least_distance_m(const Lane& lane, const map::LaneLine& border,
                        const map::StationRange& range, const ReferenceLine& line) {
  double least = std::numeric_limits<double>::infinity();
  for (double s_m = range.from_s_m; s_m < range.to_s_m + kEdgeStep_m; s_m += kEdgeStep_m) {
    const double at_m = std::min(s_m, range.to_s_m);
    least = std::min(least, std::abs(line.project(Lane::point_at(border, at_m)).d_m));
  }
  return std::min(least, lane.width_m(range.from_s_m));
}

OncomingLaneSegment stretch_of(const map::RoadMap& road_map, const Lane& lane,
                               const map::StationRange& range, double side, map::LaneId other,
                               const ReferenceLine& line) {
  const auto station = [&](double s_m) { return line.project(lane.pose_at(s_m).position()).s_m; };
  const auto limit = road_map.lane(other).least_speed_limit_mps();
  return {.from_s_m = station(range.from_s_m),
          .to_s_m = station(range.to_s_m),
          .side = side,
          .own_edge_m = least_distance_m(lane, side > 0.0 ? lane.left : lane.right, range, line),
          .limit_mps = limit && *limit > 0.0 ? *limit : kUnknownLimit_mps};
}

/// The part of a range that a leg drives.
std::optional<map::StationRange> driven(const RouteLeg& leg, map::StationRange range) {
  range.from_s_m = std::max(range.from_s_m, leg.from_s_m);
  range.to_s_m = std::min(range.to_s_m, leg.to_s_m);
  if (range.to_s_m <= range.from_s_m) return std::nullopt;
  return range;
}

void join(const OncomingLaneSegment& next, std::vector<OncomingLaneSegment>& stretches) {
  if (stretches.empty() || next.from_s_m - stretches.back().to_s_m > kJoined_m ||
      next.side != stretches.back().side) {
    stretches.push_back(next);
    return;
  }
  OncomingLaneSegment& last = stretches.back();
  last.to_s_m = std::max(last.to_s_m, next.to_s_m);
  last.own_edge_m = std::min(last.own_edge_m, next.own_edge_m);
  last.limit_mps = std::max(last.limit_mps, next.limit_mps);
}

}  // namespace

std::vector<OncomingLaneSegment> oncoming_lane_segments(const map::RoadMap& road_map,
                                                        const Route& route,
                                                        const ReferenceLine& line) {
  std::vector<OncomingLaneSegment> stretches;
  for (const RouteLeg& leg : route.legs) {
    if (leg.reversed) continue;
    const map::LaneLinks& links = road_map.graph().of(leg.lane);
    for (const auto& [neighbour, side] : {std::pair{&links.left, 1.0}, {&links.right, -1.0}}) {
      if (!*neighbour || (*neighbour)->same_direction) continue;
      if (!map::is_drivable(road_map.lane((*neighbour)->lane).type)) continue;
      for (const map::StationRange& window : (*neighbour)->change_windows) {
        if (const auto range = driven(leg, window)) {
          join(
              stretch_of(road_map, road_map.lane(leg.lane), *range, side, (*neighbour)->lane, line),
              stretches);
        }
      }
    }
  }
  return stretches;
}

}  // namespace roadbed::planning::maneuvers
