#include "roadbed/map/lanelet2/autoware/light_facing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "roadbed/map/lanelet2/autoware/shapes.h"

namespace roadbed::map::lanelet2::autoware {
namespace {

using Eigen::Vector2d;

/// From the left to the right border, at that end of the lanelet which is nearer to the stop line.
Vector2d edge_beside(const Surface& surface, const Line2& stop_line) {
  const auto apart_m = [&](const Vector2d& left, const Vector2d& right) {
    const Vector2d &one = stop_line.front(), &other = stop_line.back();
    return std::min((left - one).norm() + (right - other).norm(),
                    (left - other).norm() + (right - one).norm());
  };
  const Vector2d start_left = surface.left.front().head<2>();
  const Vector2d start_right = surface.right.front().head<2>();
  const Vector2d end_left = surface.left.back().head<2>();
  const Vector2d end_right = surface.right.back().head<2>();
  return apart_m(start_left, start_right) <= apart_m(end_left, end_right)
             ? Vector2d(start_right - start_left)
             : Vector2d(end_right - end_left);
}

double cosine(const Vector2d& a, const Vector2d& b) {
  const double lengths = a.norm() * b.norm();
  return lengths > 0.0 ? a.dot(b) / lengths : 1.0;
}

/// Those ends of all lanelets that name an element and have a surface.
std::vector<Vector2d> edges_of(const VectorMap& map, const Relation& regulation) {
  std::vector<Vector2d> edges;
  const auto lines = map.lines(regulation, "ref_line");
  if (lines.empty() || lines.front()->nodes.size() < 2) return edges;
  const Line2 stop_line = plan_of(map, *lines.front());
  for (const Lanelet* user : map.users(regulation)) {
    if (user->surface) edges.push_back(edge_beside(*user->surface, stop_line));
  }
  return edges;
}

struct Facing {
  bool rightly = false, wrongly = false;
};

}  // namespace

void light_facing(const VectorMap& map, const validation::ValidateOptions&,
                  validation::Report& report) {
  std::map<const Way*, Facing> facing;
  for (const Relation* regulation : map.regulations()) {
    if (regulation->subtype != "traffic_light") continue;
    const std::vector<Vector2d> edges = edges_of(map, *regulation);
    if (edges.empty()) continue;
    const bool diverge = std::ranges::any_of(
        edges, [&](const Vector2d& edge) { return cosine(edges.front(), edge) < std::sqrt(0.5); });
    for (const Way* light : map.lines(*regulation, "refers")) {
      if (light->type != "traffic_light" || light->subtype != "red_yellow_green") continue;
      if (light->nodes.size() < 2) continue;
      if (diverge) {
        add_issue(report, map, 1, *light,
                  fmt::format("lanelets that name traffic light {} turn by more than 45° from each "
                              "other; look whether all of them have to look at it",
                              regulation->id))
            .severity = validation::Severity::info;
      }
      const Line2 line = plan_of(map, *light);
      const bool right = cosine(edges.front(), line.back() - line.front()) > 0.0;
      (right ? facing[light].rightly : facing[light].wrongly) = true;
    }
  }
  for (const Way& way : map.document().ways) {
    const auto found = facing.find(&way);
    if (found == facing.end() || !found->second.wrongly) continue;
    if (!found->second.rightly) {
      add_issue(report, map, 2, way,
                "is a traffic light that faces away from the lanelets that name it; reverse it, so "
                "that it runs from left to right as drivers see it");
    } else {
      add_issue(report, map, 3, way,
                "is a traffic light that faces some of the lanelets that name it and turns away "
                "from others; look which of them have to look at it")
          .severity = validation::Severity::warning;
    }
  }
}

}  // namespace roadbed::map::lanelet2::autoware
