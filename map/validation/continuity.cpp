#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "roadbed/geometry/angle.h"
#include "roadbed/map/validation/rules.h"

namespace roadbed::map::rules {
namespace {

using Eigen::Vector2d;
using Points = std::vector<Vector2d>;

// A step that no smoothing hides: more than this is an error, less a warning.
constexpr double kBrokenGap = 0.5;   // [m]
constexpr double kBrokenKink = 0.5;  // [rad]

double heading_rad(const Vector2d& from, const Vector2d& to) {
  return std::atan2(to.y() - from.y(), to.x() - from.x());
}

/// Direction at the end of a sampled curve: a chord has the curve's direction at its middle, so
/// half a chord's turn is added, as the last two chords turn. Points are from the end inwards.
double end_heading_rad(const Vector2d& end, const Vector2d& before, const Vector2d* third) {
  const double last_rad = heading_rad(before, end);
  if (third == nullptr) return last_rad;
  const double last_m = (end - before).norm(), other_m = (before - *third).norm();
  const double turn_rad = geometry::wrap_angle(last_rad - heading_rad(*third, before));
  return last_rad + turn_rad * last_m / (last_m + other_m);
}

/// Without points that are nearer than a millimetre to the one before.
Points apart(const Points& points) {
  Points kept;
  for (const Vector2d& point : points) {
    if (kept.empty() || (point - kept.back()).norm() > 1e-3) kept.push_back(point);
  }
  return kept;
}

std::optional<double> final_heading_rad(const Lane& lane) {
  const Points points = apart(lane.centre.in_map.points());
  const std::size_t n = points.size();
  if (n < 2) return std::nullopt;
  return end_heading_rad(points[n - 1], points[n - 2], n > 2 ? &points[n - 3] : nullptr);
}

std::optional<double> first_heading_rad(const Lane& lane) {
  const Points points = apart(lane.centre.in_map.points());
  if (points.size() < 2) return std::nullopt;
  const double backwards_rad =
      end_heading_rad(points[0], points[1], points.size() > 2 ? &points[2] : nullptr);
  return backwards_rad + std::numbers::pi;
}

double border_gap_m(const LaneLine& from, const LaneLine& to) {
  return (to.in_map.points().front() - from.in_map.points().back()).norm();
}

bool holds(const std::vector<LaneId>& lanes, const std::optional<Neighbour>& neighbour) {
  return neighbour && neighbour->same_direction &&
         std::find(lanes.begin(), lanes.end(), neighbour->lane) != lanes.end();
}

/// A lane that splits into two meets each of them with one border only, two that merge likewise.
struct Seam {
  double left_m = 0.0, right_m = 0.0;
};

Seam seam_between(const LaneGraph& graph, const Lane& from, const Lane& to) {
  const LaneLinks &before = graph.of(from.id), &after = graph.of(to.id);
  Seam seam;
  if (!holds(before.successors, after.left) && !holds(after.predecessors, before.left)) {
    seam.left_m = border_gap_m(from.left, to.left);
  }
  if (!holds(before.successors, after.right) && !holds(after.predecessors, before.right)) {
    seam.right_m = border_gap_m(from.right, to.right);
  }
  return seam;
}

/// Calls `check(from, to)` for every link between drivable lanes.
template <typename Check>
void for_each_drivable_link(const RoadMap& road_map, const Check& check) {
  for (const Lane& from : road_map.lanes()) {
    for (const LaneId to : road_map.graph().of(from.id).successors) {
      if (is_drivable(from.type) && is_drivable(road_map.lane(to).type)) {
        check(from, road_map.lane(to));
      }
    }
  }
}

}  // namespace

Findings gaps(const RoadMap& road_map, const ValidateOptions& options) {
  Findings findings;
  for_each_drivable_link(road_map, [&](const Lane& from, const Lane& to) {
    const auto [left_m, right_m] = seam_between(road_map.graph(), from, to);
    const double gap_m = std::max(left_m, right_m);
    if (gap_m <= options.max_gap_m) return;
    findings.push_back(
        {.rule = "geometry.gap",
         .asam_rule = "asam.net:xodr:1.7.0:lane_smoothness.contact_point_no_horizontal_gaps",
         .severity = gap_m > kBrokenGap ? Severity::error : Severity::warning,
         .element = "lane " + from.name,
         .in_map = from.centre.in_map.points().back(),
         .message = fmt::format("its end is off the start of lane {}, left border by {:.3f} m, "
                                "right border by {:.3f} m; move one of them, or correct a width",
                                to.name, left_m, right_m)});
  });
  return findings;
}

Findings kinks(const RoadMap& road_map, const ValidateOptions& options) {
  Findings findings;
  for_each_drivable_link(road_map, [&](const Lane& from, const Lane& to) {
    const auto end_rad = final_heading_rad(from), start_rad = first_heading_rad(to);
    if (!end_rad || !start_rad) return;
    const double kink_rad = geometry::wrap_angle(*start_rad - *end_rad);
    if (std::abs(kink_rad) <= options.max_kink_rad) return;
    findings.push_back(
        {.rule = "geometry.kink",
         .asam_rule = {},
         .severity = std::abs(kink_rad) > kBrokenKink ? Severity::error : Severity::warning,
         .element = "lane " + from.name,
         .in_map = from.centre.in_map.points().back(),
         .message = fmt::format("lane {} goes on turned by {:.3f} rad; correct the heading of one "
                                "of them, or a width's slope",
                                to.name, kink_rad)});
  });
  return findings;
}

}  // namespace roadbed::map::rules
