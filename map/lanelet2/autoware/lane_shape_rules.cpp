#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_set>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/lanelet2/autoware/border_sharing.h"
#include "roadbed/map/lanelet2/autoware/rules.h"
#include "roadbed/map/lanelet2/autoware/shapes.h"

namespace roadbed::map::lanelet2::autoware {
namespace {

using Eigen::Vector2d;
using validation::Report;
using validation::ValidateOptions;

void shared_points(const VectorMap& map, const ValidateOptions&, Report& report) {
  const Document& document = map.document();
  for (const Lanelet& lanelet : map.lanelets()) {
    if (!lanelet.surface) continue;
    const auto left = document.ways[lanelet.surface->left_border.way].nodes;
    const auto right = document.ways[lanelet.surface->right_border.way].nodes;
    const std::unordered_set<std::uint32_t> on_left(left.begin(), left.end());
    const auto shared =
        std::ranges::find_if(right, [&](std::uint32_t node) { return on_left.contains(node); });
    if (shared == right.end()) continue;
    add_issue(report, map, 1, lanelet,
              fmt::format("its left and right border share node {}; give each nodes of its own",
                          document.nodes[*shared].id));
  }
}

/// The line that a lanelet names as its centreline; null if it names none.
const Way* own_centreline(const VectorMap& map, const Lanelet& lanelet) {
  const auto lines = map.lines(lanelet.relation(), "centerline");
  return lines.size() == 1 && lines.front()->nodes.size() >= 2 ? lines.front() : nullptr;
}

constexpr double kPlanar_m = 0.01, kHeight_m = 0.1;  // Autoware's tolerances

void check_end(const VectorMap& map, Report& report, const Way& centreline, std::uint32_t node,
               const Eigen::Vector3d& left, const Eigen::Vector3d& right) {
  const Node& end = map.document().nodes[node];
  const double apart_m = distance_m(end.in_map.head<2>(), {left.head<2>(), right.head<2>()});
  if (apart_m <= kPlanar_m) return;
  add_issue(report, map, 1, centreline,
            fmt::format("is a centreline whose end, node {}, lies {:.2f} m off the end of its "
                        "lanelet; move it there",
                        end.id, apart_m))
      .in_map = map.place(end);
}

/// Height of a border where it is nearest to a point, and how near that is.
std::pair<double, double> height_beside(const Vector2d& point,
                                        const std::vector<Eigen::Vector3d>& border) {
  double z_m = border.front().z(), least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < border.size(); ++i) {
    const Eigen::Vector3d along = border[i] - border[i - 1];
    const double length2 = along.head<2>().squaredNorm();
    const Vector2d from_start = point - border[i - 1].head<2>();
    const double share =
        length2 > 0.0 ? std::clamp(from_start.dot(along.head<2>()) / length2, 0.0, 1.0) : 0.0;
    const double apart_m = (from_start - share * along.head<2>()).norm();
    if (apart_m >= least_m) continue;
    least_m = apart_m;
    z_m = border[i - 1].z() + share * along.z();
  }
  return {z_m, least_m};
}

/// Height of the surface at a point: between the borders beside it.
double height_m(const Surface& surface, const Vector2d& point) {
  const auto [left_m, to_left_m] = height_beside(point, surface.left);
  const auto [right_m, to_right_m] = height_beside(point, surface.right);
  const double width_m = to_left_m + to_right_m;
  return width_m > 0.0 ? (left_m * to_right_m + right_m * to_left_m) / width_m : left_m;
}

void check_points(const VectorMap& map, Report& report, const Way& centreline,
                  const Surface& surface) {
  if (!map.budget().spend(2 * centreline.nodes.size() * surface.ring.size())) return;
  const Line2 edge = closed(surface.ring);
  std::vector<std::int64_t> outside, off_ground;
  for (const std::uint32_t place : centreline.nodes) {
    const Node& node = map.document().nodes[place];
    const Vector2d point = node.in_map.head<2>();
    const bool is_end = place == centreline.nodes.front() || place == centreline.nodes.back();
    if (!is_end && !geometry::contains(surface.ring, point) &&
        distance_m(point, edge) > kPlanar_m) {
      outside.push_back(node.id);
    }
    if (std::abs(node.in_map.z() - height_m(surface, point)) > kHeight_m) {
      off_ground.push_back(node.id);
    }
  }
  if (!outside.empty()) {
    add_issue(
        report, map, 2, centreline,
        fmt::format("is a centreline whose nodes {} lie outside its lanelet; move them inside",
                    ids_text(outside)));
  }
  if (!off_ground.empty()) {
    add_issue(report, map, 3, centreline,
              fmt::format("is a centreline whose nodes {} lie more than {} m above or below its "
                          "lanelet; correct their ele",
                          ids_text(off_ground), kHeight_m));
  }
}

void centrelines(const VectorMap& map, const ValidateOptions&, Report& report) {
  for (const Lanelet& lanelet : map.lanelets()) {
    const Way* line = own_centreline(map, lanelet);
    if (line == nullptr || !lanelet.surface) continue;
    const Surface& surface = *lanelet.surface;
    check_end(map, report, *line, line->nodes.front(), surface.left.front(), surface.right.front());
    check_end(map, report, *line, line->nodes.back(), surface.left.back(), surface.right.back());
    check_points(map, report, *line, surface);
  }
}

/// How far a walkway goes on beyond its overlap with a road, on the shorter side [m].
double extension_m(const VectorMap& map, const Surface& walkway, const Surface& road) {
  const Line2 start{walkway.left.front().head<2>(), walkway.right.front().head<2>()};
  const Line2 end{walkway.left.back().head<2>(), walkway.right.back().head<2>()};
  double least_m = std::numeric_limits<double>::infinity();
  const auto take = [&](const Vector2d& from, const Vector2d& to) {
    for (const Line2& edge : {start, end}) {
      for (const Vector2d& point : {from, to}) least_m = std::min(least_m, distance_m(point, edge));
      for (const Vector2d& point : edge) {
        least_m = std::min(least_m, distance_m(point, {from, to}));
      }
    }
  };
  for (const auto& [from, to] : parts_inside(map, closed(walkway.ring), road.ring)) take(from, to);
  for (const auto& [from, to] : parts_inside(map, closed(road.ring), walkway.ring)) take(from, to);
  return least_m;
}

void walkways(const VectorMap& map, const ValidateOptions&, Report& report) {
  constexpr double kLeast_m2 = 1e-4, kLeast_m = 3.0;
  for (const Lanelet& lanelet : map.lanelets()) {
    if (lanelet.subtype() != "walkway" || !lanelet.surface) continue;
    bool meets_road = false;
    for (const Lanelet* road : map.near(lanelet.surface->box)) {
      if (road->subtype() != "road" && road->subtype() != "private") continue;
      if (on_other_level(*lanelet.surface, *road->surface)) continue;
      if (overlap_m2(map, lanelet.surface->ring, road->surface->ring) < kLeast_m2) continue;
      meets_road = true;
      const double beyond_m = extension_m(map, *lanelet.surface, *road->surface);
      if (beyond_m >= kLeast_m) continue;
      add_issue(report, map, 2, lanelet,
                fmt::format("is a walkway that ends {:.2f} m beyond road {}; extend it to {:.0f} m",
                            beyond_m, road->id(), kLeast_m));
    }
    if (meets_road || map.budget().is_spent()) continue;
    add_issue(report, map, 1, lanelet,
              "is a walkway that crosses no road, for which Autoware does not need it; remove it, "
              "or draw it across the road");
  }
}

constexpr std::array<Rule, 4> kLaneShapeRules = {{
    {{"autoware.lane.border-sharing",
      {},
      validation::Severity::error,
      "lanelets lie beside each other without sharing a border",
      "Lane.BorderSharing"},
     border_sharing},
    {{"autoware.lane.shared-points",
      {},
      validation::Severity::error,
      "the left and right border of a lanelet share nodes",
      "Lane.LaneletGeometry"},
     shared_points},
    {{"autoware.lane.centreline",
      {},
      validation::Severity::error,
      "a lanelet's own centreline does not lie on it from end to end",
      "Lane.CenterlineGeometry"},
     centrelines},
    {{"autoware.lane.walkway",
      {},
      validation::Severity::error,
      "a walkway crosses no road, or does not go on beyond it",
      "Lane.WalkwayIntersection"},
     walkways},
}};

}  // namespace

std::span<const Rule> lane_shape_rules() { return kLaneShapeRules; }

}  // namespace roadbed::map::lanelet2::autoware
