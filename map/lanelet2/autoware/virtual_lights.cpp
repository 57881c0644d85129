#include "roadbed/map/lanelet2/autoware/virtual_lights.h"

#include <algorithm>
#include <functional>
#include <map>
#include <queue>
#include <utility>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/geometry/primitives/polyline.h"

namespace roadbed::map::lanelet2::autoware {
namespace {

/// One outer border of lanelets that follow each other.
geometry::Polyline border_of(const std::vector<const Lanelet*>& way, Side side) {
  Line2 points;
  for (const Lanelet* lanelet : way) {
    const auto& border = side == Side::left ? lanelet->surface->left : lanelet->surface->right;
    for (const Eigen::Vector3d& point : border) points.emplace_back(point.head<2>());
  }
  return geometry::Polyline(std::move(points));
}

}  // namespace

bool coordinates_intersection(const VectorMap& map, const Relation& light) {
  return std::ranges::any_of(map.lines(light, "refers"), [](const Way* way) {
    return way->type == "intersection_coordination";
  });
}

const Lanelet* lanelet_under(const VectorMap& map, const Way& line) {
  const Line2 plan = plan_of(map, line);
  if (plan.size() < 2) return nullptr;
  constexpr double kSameLevel_m = 1.0;
  const double z_m = map.document().nodes[line.nodes.front()].in_map.z();
  const Lanelet* best = nullptr;
  double most = 0.0;
  for (const Lanelet* lanelet : map.near(geometry::box_around(plan))) {
    if (!is_for_vehicles(*lanelet) || z_m < lanelet->surface->least_z_m - kSameLevel_m ||
        z_m > lanelet->surface->greatest_z_m + kSameLevel_m) {
      continue;
    }
    const double share = share_inside(map, plan, lanelet->surface->ring);
    if (share > most) best = lanelet, most = share;
  }
  return best;
}

const Way* end_line_on(const VectorMap& map, const Relation& light, const Lanelet& lanelet) {
  const Way* best = nullptr;
  double most = 0.0;
  for (const Way* line : map.lines(light, "end_line")) {
    if (map.budget().is_spent()) return nullptr;
    const double share = share_inside(map, plan_of(map, *line), lanelet.surface->ring);
    if (share > most) best = line, most = share;
  }
  return best;
}

std::vector<const Lanelet*> shortest_way(const VectorMap& map, const Lanelet& from,
                                         const Lanelet& to) {
  constexpr std::size_t kMost = 1000;
  using Reached = std::pair<double, std::pair<const Lanelet*, const Lanelet*>>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> ahead;
  std::map<const Lanelet*, const Lanelet*> before;
  ahead.push({0.0, {&from, nullptr}});
  while (!ahead.empty() && before.size() < kMost && !before.contains(&to)) {
    const auto [distance_m, step] = ahead.top();
    ahead.pop();
    const auto [at, behind] = step;
    if (!before.emplace(at, behind).second) continue;
    if (!map.budget().spend(at->surface->ring.size())) return {};
    for (const Lanelet* next : map.following(*at)) {
      if (!is_for_vehicles(*next) || before.contains(next)) continue;
      ahead.push({distance_m + way_length_m(*next->surface), {next, at}});
    }
  }
  std::vector<const Lanelet*> way;
  if (!before.contains(&to)) return way;
  for (const Lanelet* at = &to; at != nullptr; at = before.at(at)) way.push_back(at);
  std::ranges::reverse(way);
  return way;
}

CrossingStations stations_of(const VectorMap& map, const Way& line,
                             const std::vector<const Lanelet*>& way) {
  const geometry::Polyline left = border_of(way, Side::left), right = border_of(way, Side::right);
  const Line2 plan = plan_of(map, line);
  const auto one = left.project(plan.front()), other = left.project(plan.back());
  const bool begins_left = one.d_m > other.d_m;
  return {begins_left ? one.s_m : other.s_m,
          right.project(begins_left ? plan.back() : plan.front()).s_m};
}

bool is_before(const CrossingStations& one, const CrossingStations& other) {
  return one.left_m < other.left_m && one.right_m < other.right_m;
}

}  // namespace roadbed::map::lanelet2::autoware
