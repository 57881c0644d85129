#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/polygon.h"
#include "roadbed/map/validation/rules.h"

namespace roadbed::map::rules {
namespace {

using Eigen::Vector2d;

constexpr double kTolerance = 2e-3;  // [m] borders are sampled to within 1 mm each
constexpr double kFold = 0.01;       // [m] less is a step at a joint of geometry records

Severity by_use(const Lane& lane, Severity if_drivable) {
  return is_drivable(lane.type) ? if_drivable : Severity::info;
}

/// Direction of travel over a metre: where geometry records step back at their joints, as many
/// files have them do by up to some centimetres, a single segment may point anywhere.
Vector2d direction_at(const Lane& lane, double s_m) {
  constexpr double kReach = 0.5;  // [m]
  const Vector2d along = lane.centre.in_map.at(s_m + kReach) - lane.centre.in_map.at(s_m - kReach);
  return along.norm() > 0.0 ? Vector2d(along.normalized()) : Vector2d(0.0, 0.0);
}

/// Distance from the right border to the left one across the lane, negative if they are swapped.
double signed_width_m(const Lane& lane, double s_m) {
  const Vector2d across = Lane::point_at(lane.left, s_m) - Lane::point_at(lane.right, s_m);
  const Vector2d direction = direction_at(lane, s_m);
  return across.dot(Vector2d(-direction.y(), direction.x()));
}

/// Stations of all vertices of both borders.
std::vector<double> border_stations_m(const Lane& lane) {
  std::vector<double> stations_m = lane.left.station_m;
  stations_m.insert(stations_m.end(), lane.right.station_m.begin(), lane.right.station_m.end());
  return stations_m;
}

struct Fold {
  Vector2d in_map;
  double length_m = 0.0;
};

/// The part of a border that runs against the lane's direction.
Fold fold_of(const Lane& lane, const LaneLine& border) {
  Fold fold;
  const auto& points = border.in_map.points();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double middle_m = 0.5 * (border.station_m[i - 1] + border.station_m[i]);
    const double forward_m = (points[i] - points[i - 1]).dot(direction_at(lane, middle_m));
    if (forward_m >= 0.0) continue;
    if (fold.length_m == 0.0) fold.in_map = points[i];
    fold.length_m -= forward_m;
  }
  return fold;
}

Fold longer_fold(const Lane& lane) {
  const Fold left = fold_of(lane, lane.left), right = fold_of(lane, lane.right);
  return left.length_m >= right.length_m ? left : right;
}

geometry::Ring outline(const Lane& lane) {
  geometry::Ring ring = lane.right.in_map.points();
  const auto& left = lane.left.in_map.points();
  ring.insert(ring.end(), left.rbegin(), left.rend());
  return ring;
}

/// Whether the outline encloses more than one region, or a hole, that a human could see.
bool winds_over_itself(const Lane& lane) {
  constexpr double kVisible = 0.01;  // [m²]
  int visible = 0;
  for (const geometry::Polygon& piece : geometry::make_simple(outline(lane))) {
    if (geometry::area_m2(piece) > kVisible) ++visible;
    if (!piece.holes.empty()) return true;
  }
  return visible > 1;
}

}  // namespace

Findings negative_widths(const RoadMap& road_map, const ValidateOptions&) {
  Findings findings;
  for (const Lane& lane : road_map.lanes()) {
    double least_m = -kTolerance, at_m = -1.0;
    for (const double s_m : border_stations_m(lane)) {
      const double width_m = signed_width_m(lane, s_m);
      if (width_m < least_m) least_m = width_m, at_m = s_m;
    }
    if (at_m < 0.0) continue;
    findings.push_back(
        {.rule = "geometry.negative-width",
         .asam_rule = "asam.net:xodr:1.4.0:road.lane.width.lane_width_validity",
         .severity = by_use(lane, Severity::error),
         .element = "lane " + lane.name,
         .in_map = lane.pose_at(at_m).position(),
         .message = fmt::format("its borders are swapped at station {:.2f} m, width {:.3f} m; "
                                "correct the width records",
                                at_m, least_m)});
  }
  return findings;
}

Findings zero_widths(const RoadMap& road_map, const ValidateOptions&) {
  Findings findings;
  for (const Lane& lane : road_map.lanes()) {
    const auto stations_m = border_stations_m(lane);
    const bool has_width = std::any_of(stations_m.begin(), stations_m.end(),
                                       [&](double s_m) { return lane.width_m(s_m) > kTolerance; });
    if (has_width || !is_drivable(lane.type)) continue;
    findings.push_back({.rule = "geometry.zero-width",
                        .asam_rule = {},
                        .severity = Severity::warning,
                        .element = "lane " + lane.name,
                        .in_map = lane.pose_at(0.0).position(),
                        .message = "has no width anywhere; give it one, or remove it"});
  }
  return findings;
}

Findings folds(const RoadMap& road_map, const ValidateOptions&) {
  Findings findings;
  for (const Lane& lane : road_map.lanes()) {
    const Fold fold = longer_fold(lane);
    if (fold.length_m <= kFold) continue;
    findings.push_back({.rule = "geometry.fold",
                        .asam_rule = {},
                        .severity = by_use(lane, Severity::warning),
                        .element = "lane " + lane.name,
                        .in_map = fold.in_map,
                        .message = fmt::format(
                            "a border runs backwards over {:.3f} m: the bend is too tight for its "
                            "distance from the reference line, or geometry records step back; "
                            "widen the bend or mend the records",
                            fold.length_m)});
  }
  return findings;
}

Findings self_intersections(const RoadMap& road_map, const ValidateOptions&) {
  Findings findings;
  for (const Lane& lane : road_map.lanes()) {
    if (geometry::is_simple(outline(lane)) || longer_fold(lane).length_m > kFold) continue;
    if (!winds_over_itself(lane)) continue;
    findings.push_back({.rule = "geometry.self-intersection",
                        .asam_rule = {},
                        .severity = by_use(lane, Severity::warning),
                        .element = "lane " + lane.name,
                        .in_map = lane.pose_at(0.5 * lane.length_m()).position(),
                        .message = "crosses itself; split its road where it does"});
  }
  return findings;
}

}  // namespace roadbed::map::rules
