#include "roadbed/planning/maneuvers/merge_places.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadbed/planning/maneuvers/lane_course.h"

namespace roadbed::planning::inline maneuvers {
namespace {

using map::LaneId;

constexpr double kLaneBack_m = 250.0, kLaneOn_m = 100.0;  // along the next lane
constexpr double kInTheWay_m = 2.0;  // from the next lane's middle, side to side with its traffic
constexpr double kOutOfWay_m = 2.6;  // and nobody's concern
constexpr double kInNextLane_m = 0.5;
constexpr double kPlaceStep_m = 0.5, kMostChange_m = 80.0;
constexpr double kLongestWindow_m = 1000.0;
constexpr double kLastChange_m = 30.0;     // where the lane ends, it is slow
constexpr double kWorthChoosing_m = 40.0;  // between the first and the last place

/// The lane of a leg, what leads to it, and what the route goes on with.
geometry::Polyline lane_merged_into(const map::RoadMap& road_map, const Route& route,
                                    std::size_t leg) {
  const double from_s_m = route.legs[leg].from_s_m;
  std::vector<LaneId> lanes =
      with_lanes_before(road_map, route.legs[leg].lane, kLaneBack_m - from_s_m);
  double on_m = road_map.lane(route.legs[leg].lane).length_m() - from_s_m;
  for (std::size_t i = leg; i + 1 < route.legs.size() && on_m < kLaneOn_m; ++i) {
    if (route.legs[i].exit != LegExit::successor) break;
    lanes.push_back(route.legs[i + 1].lane);
    on_m += road_map.lane(lanes.back()).length_m();
  }
  return middle_of(road_map, lanes);
}

bool changes_lane(const RouteLeg& leg) {
  return leg.exit == LegExit::change_left || leg.exit == LegExit::change_right;
}

/// First station of a line from one on, up or down, where the next lane is as near as asked for.
template <typename IsThere>
std::optional<double> first_beside(const MergePlace& place, const ReferenceLine& line,
                                   double from_s_m, double step_m, double most_m,
                                   const IsThere& is_there) {
  for (double way_m = 0.0; way_m < most_m; way_m += std::abs(step_m)) {
    const double s_m = from_s_m + std::copysign(way_m, step_m);
    if (is_there(std::abs(place.lane.project(line.at(s_m).in_map).d_m))) return s_m;
  }
  return std::nullopt;
}

/// Around the middle of the change.
void set_stations(const ReferenceLine& line, double middle_s_m, MergePlace& place) {
  const auto first = [&](double step_m, const auto& is_there) {
    return first_beside(place, line, middle_s_m, step_m, kMostChange_m, is_there)
        .value_or(middle_s_m + std::copysign(kMostChange_m, step_m));
  };
  place.hold_s_m = first(-kPlaceStep_m, [](double d_m) { return d_m >= kOutOfWay_m; });
  place.enter_s_m = first(-kPlaceStep_m, [](double d_m) { return d_m >= kInTheWay_m; });
  place.out_s_m = first(kPlaceStep_m, [](double d_m) { return d_m <= kInNextLane_m; });
  place.enter_m = place.lane.project(line.at(place.enter_s_m).in_map).s_m;
}

std::optional<MergePlace> place_behind(const map::RoadMap& road_map, const Route& route,
                                       std::size_t leg, const ReferenceLine& line) {
  const RouteLeg& left = route.legs[leg];
  if (left.reversed || leg + 1 >= route.legs.size()) return std::nullopt;
  const map::Lane& lane = road_map.lane(left.lane);
  const auto station_m = [&](double lane_s_m) {
    return line.project(lane.pose_at(lane_s_m).position()).s_m;
  };
  MergePlace place{.leg = leg, .lane = lane_merged_into(road_map, route, leg + 1)};
  const double middle_s_m = station_m(left.to_s_m);
  place.from_s_m = left.change_window
                       ? station_m(std::clamp(left.change_window->from_s_m, 0.0, lane.length_m()))
                       : middle_s_m;
  set_stations(line, middle_s_m, place);
  return place;
}

/// The change's stations on a line on which it is made elsewhere; none: it is not found.
std::optional<MergePlace> place_on(const ReferenceLine& line, MergePlace place, double step_m) {
  const double between_m = 0.5 * (kInTheWay_m + kInNextLane_m);
  const auto middle_s_m =
      first_beside(place, line, place.out_s_m, step_m, kLongestWindow_m,
                   [&](double d_m) { return step_m > 0.0 ? d_m <= between_m : d_m >= between_m; });
  if (!middle_s_m) return std::nullopt;
  set_stations(line, *middle_s_m, place);
  return place;
}

}  // namespace

std::vector<MergePlace> merge_places(const map::RoadMap& road_map, const Route& route,
                                     const ReferenceLine& line) {
  std::vector<MergePlace> places;
  for (std::size_t i = 0; i < route.legs.size(); ++i) {
    if (!changes_lane(route.legs[i])) continue;
    if (auto place = place_behind(road_map, route, i, line)) places.push_back(*std::move(place));
  }
  return places;
}

std::optional<MergeLines> merge_lines(const map::RoadMap& road_map, const Route& route,
                                      const MergePlace& place, ReferenceLineOptions options) {
  using At = PlacedChange::At;
  const auto& window = route.legs[place.leg].change_window;
  // Both places are inside of it, by more than a step.
  const double least_m = kWorthChoosing_m + kPlaceStep_m;
  if (!window || window->to_s_m - window->from_s_m < least_m) return std::nullopt;
  options.placed_change = {place.leg, At::window_start, options.lane_change_length_m};
  ReferenceLine next_lane = ReferenceLine::along(road_map, route, options);
  options.placed_change = {place.leg, At::window_end, kLastChange_m};
  ReferenceLine own_lane = ReferenceLine::along(road_map, route, options);
  const auto first = place_on(next_lane, place, -kPlaceStep_m);
  const auto last = place_on(own_lane, place, kPlaceStep_m);
  if (!first || !last) return std::nullopt;
  const auto lane_m = [&](const ReferenceLine& line, double s_m) {
    return place.lane.project(line.at(s_m).in_map).s_m;
  };
  MergeLines lines{.next_lane = std::move(next_lane), .own_lane = std::move(own_lane)};
  lines.first_m = first->enter_m;
  lines.hold_m = lane_m(lines.own_lane, last->hold_s_m);
  lines.last_m = lane_m(lines.own_lane, last->out_s_m);
  lines.out_s_m = last->out_s_m;
  if (lines.last_m - lines.first_m < kWorthChoosing_m) return std::nullopt;
  return lines;
}

}  // namespace roadbed::planning::maneuvers
