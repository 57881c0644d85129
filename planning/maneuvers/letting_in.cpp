#include "roadbed/planning/maneuvers/letting_in.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "roadbed/planning/maneuvers/lane_course.h"

namespace roadbed::planning::inline maneuvers {
namespace {

constexpr double kInItsLane_m = 1.2;  // of its middle
constexpr double kOutside_m = 2.0;    // of the middle of the lane that ends, or more
constexpr double kBacks_mps = 0.5;    // less is standing
const std::string kVehicle;           // no obstacle has an empty id

bool drives_to_its_end(const RouteLeg& leg) {
  return !leg.reversed && (leg.exit == LegExit::successor || leg.exit == LegExit::goal);
}

}  // namespace

LettingIn::LettingIn(const geometry::VehicleShape& vehicle, const DrivingTask& task)
    : vehicle_(vehicle), task_(task) {
  for (const RouteLeg& leg : task.route.legs) {
    if (!drives_to_its_end(leg)) continue;
    const map::LaneLinks& links = task.road_map.graph().of(leg.lane);
    for (const std::optional<map::Neighbour>& next : std::array{links.left, links.right}) {
      if (!next || !ends_beside(task.road_map, next->lane, leg.lane)) continue;
      geometry::Polyline lane = middle_of(
          task.road_map, with_lanes_before(task.road_map, next->lane, ZipMerge::kSeenFrom_m));
      const double s_m = task.line.project(lane.points().back()).s_m;
      ends_.push_back({s_m, std::move(lane)});
    }
  }
}

LettingIn::Decision LettingIn::look(const ViewOnLine& view) {
  if (std::abs(view.at.d_m) > kInItsLane_m) return {};
  const Eigen::Vector2d here = task_.line.at(view.at.s_m).in_map;
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    const End& end = ends_[i];
    const double to_end_m = end.s_m - view.at.s_m - vehicle_.front_m();
    if (to_end_m < 0.0 || to_end_m > ZipMerge::kSeenFrom_m) continue;
    if (std::abs(end.lane.project(here).d_m) < kOutside_m) continue;  // it is in that lane itself
    const std::vector<ZipBody> others = waiting(end, view);
    zip_.update(i, drivers(end, view, to_end_m), others);
    const auto let_in = zip_.let_in(i, kVehicle);
    if (!let_in) continue;
    const auto other = std::ranges::find(others, *let_in, &ZipBody::id);
    if (other == others.end()) continue;
    const auto obstacle = std::ranges::find(view.traffic.obstacles, *let_in, &Obstacle::id);
    const auto index = static_cast<std::size_t>(obstacle - view.traffic.obstacles.begin());
    return {.behind = Lead{.obstacle = index,
                           .gap_m = to_end_m - other->to_end_m - other->length_m,
                           .speed_mps = other->speed_mps},
            .reason = fmt::format("lets {} {} in, whose lane ends in {:.0f} m", obstacle->kind,
                                  obstacle->id, std::max(0.0, other->to_end_m))};
  }
  return {};
}

/// Those in the vehicle's lane, itself among them, the foremost first.
std::vector<ZipBody> LettingIn::drivers(const End& end, const ViewOnLine& view,
                                        double to_end_m) const {
  std::vector<ZipBody> all{{kVehicle, to_end_m, vehicle_.length_m, view.speed_mps}};
  for (const MoverOnLine& mover : movers_on_line(task_.line, view.traffic, view.t_s)) {
    const double left_m = end.s_m - mover.front_m();
    const bool is_near = left_m > 0.0 && left_m < ZipMerge::kSeenFrom_m;
    if (!is_near || std::abs(mover.d_m) > kInItsLane_m || mover.speed_mps < -kBacks_mps) continue;
    all.push_back({view.traffic.obstacles[mover.obstacle].id, left_m, 2.0 * mover.half_length_m,
                   mover.speed_mps});
  }
  std::ranges::stable_sort(all, {}, &ZipBody::to_end_m);
  return all;
}

/// Those in the lane that ends, the foremost first.
std::vector<ZipBody> LettingIn::waiting(const End& end, const ViewOnLine& view) const {
  std::vector<ZipBody> all;
  for (const MoverOnLane& mover : movers_on_lane(end.lane, view.traffic, view.t_s, kInItsLane_m)) {
    const Obstacle& other = view.traffic.obstacles[mover.obstacle];
    const double left_m = end.lane.length_m() - mover.s_m - mover.half_length_m;
    if (other.is_static() || left_m > ZipMerge::kInTurn_m || mover.speed_mps < -kBacks_mps)
      continue;
    all.push_back({other.id, left_m, other.length_m, mover.speed_mps});
  }
  std::ranges::stable_sort(all, {}, &ZipBody::to_end_m);
  return all;
}

}  // namespace roadbed::planning::maneuvers
