#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/geometry/polygons/ring.h"
#include "roadbed/map/elements/lane_curvature.h"
#include "roadbed/map/validation/lane_folds.h"
#include "roadbed/map/validation/validate.h"

namespace roadbed::map::validation {
namespace {

using Eigen::Vector2d;

Severity by_use(const Lane& lane, Severity if_drivable) {
  return is_drivable(lane.type) ? if_drivable : Severity::info;
}

geometry::Ring outline(const Lane& lane) {
  geometry::Ring ring = lane.right.in_map.points();
  const auto& left = lane.left.in_map.points();
  ring.insert(ring.end(), left.rbegin(), left.rend());
  return ring;
}

/// Whether the outline encloses more than one region, or a hole, that a human could see, or folds
/// too often to tell.
bool winds_over_itself(const Lane& lane) {
  constexpr double kVisible = 0.01;  // [m²]
  int visible = 0;
  const geometry::Ring ring = outline(lane);
  const auto pieces = geometry::make_simple(ring);
  if (pieces.empty()) return !geometry::has_few_crossings(ring);
  for (const geometry::Polygon& piece : pieces) {
    if (geometry::area_m2(piece) > kVisible) ++visible;
    if (!piece.holes.empty()) return true;
  }
  return visible > 1;
}

void negative_widths(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  for (const Lane& lane : road_map.lanes()) {
    const auto swapped = most_swapped(lane);
    if (!swapped) continue;
    report
        .add("lane " + lane.name, lane.pose_at(swapped->s_m).position(),
             fmt::format("its borders are swapped at station {:.2f} m, width {:.3f} m; correct the "
                         "width records, or widen the bend if the lane lies beyond its centre",
                         swapped->s_m, swapped->width_m))
        .severity = by_use(lane, Severity::error);
  }
}

double greatest_width_m(const Lane& lane) {
  double greatest_m = 0.0;
  for (const double s_m : border_stations_m(lane)) {
    greatest_m = std::max(greatest_m, lane.width_m(s_m));
  }
  return greatest_m;
}

void zero_widths(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  for (const Lane& lane : road_map.lanes()) {
    if (!is_drivable(lane.type) || greatest_width_m(lane) > kWidthTolerance) continue;
    report.add("lane " + lane.name, lane.pose_at(0.0).position(),
               "has no width anywhere; give it one, or remove it");
  }
}

/// Distance from a place on one border to the nearest of the other.
double across_m(const Lane& lane, double s_m) {
  const auto distance_m = [s_m](const LaneLine& from, const LaneLine& to) {
    return std::abs(to.in_map.project(Lane::point_at(from, s_m)).d_m);
  };
  return std::min(distance_m(lane.left, lane.right), distance_m(lane.right, lane.left));
}

/// The greatest width where it is more than a limit. Places of one station may lie far apart along
/// the lane where its borders are drawn by few points; how wide it is there, the nearest place of
/// the other border says. That is asked at the widest stations only, as it takes the whole border.
double greatest_width_m(const Lane& lane, double limit_m) {
  constexpr std::size_t kMost = 64;
  std::vector<std::pair<double, double>> wide;  // width, station
  for (const double s_m : border_stations_m(lane)) {
    if (const double width_m = lane.width_m(s_m); width_m > limit_m)
      wide.emplace_back(width_m, s_m);
  }
  std::ranges::sort(wide, std::greater());
  if (wide.size() > kMost) wide.resize(kMost);
  double greatest_m = 0.0;
  for (const auto& [width_m, s_m] : wide) greatest_m = std::max(greatest_m, across_m(lane, s_m));
  return greatest_m;
}

void absurd_widths(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  constexpr double kWidest = 30.0;  // [m]
  for (const Lane& lane : road_map.lanes()) {
    if (!is_drivable(lane.type)) continue;
    const double width_m = greatest_width_m(lane, kWidest);
    if (width_m <= kWidest) continue;
    report.add("lane " + lane.name, lane.pose_at(0.5 * lane.length_m()).position(),
               fmt::format("is {:.1f} m wide; check the unit of its width, or whether its borders "
                           "belong together",
                           width_m));
  }
}

void folds(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  const char* why = road_map.format().starts_with("OpenDRIVE")
                        ? "the bend is too tight for its distance from the reference line, or "
                          "geometry records step back; widen the bend or mend the records"
                        : "the bend is tighter than the lane is wide, or points are out of order; "
                          "widen the bend or move the points";
  for (const Lane& lane : road_map.lanes()) {
    const Fold fold = longer_fold(lane);
    if (fold.length_m <= kFold) continue;
    report
        .add("lane " + lane.name, fold.in_map,
             fmt::format("a border runs backwards over {:.3f} m: {}", fold.length_m, why))
        .severity = by_use(lane, Severity::warning);
  }
}

void self_intersections(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  for (const Lane& lane : road_map.lanes()) {
    if (geometry::is_simple(outline(lane)) || longer_fold(lane).length_m > kFold) continue;
    if (!winds_over_itself(lane)) continue;
    report
        .add("lane " + lane.name, lane.pose_at(0.5 * lane.length_m()).position(),
             "crosses itself; split its road where it does")
        .severity = by_use(lane, Severity::warning);
  }
}

void short_lanes(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  constexpr double kShortest = 0.05;  // [m]
  for (const Lane& lane : road_map.lanes()) {
    if (!is_drivable(lane.type) || lane.length_m() >= kShortest) continue;
    report.add("lane " + lane.name, lane.pose_at(0.0).position(),
               fmt::format("is {:.4f} m long; join it with the next one", lane.length_m()));
  }
}

struct Bend {
  double s_m = 0.0, curvature_per_m = 0.0;
};

/// The tightest bend at a vertex, beyond which the line is straight.
Bend tightest_bend(const Lane& lane, double chord_m) {
  Bend tightest;
  const auto& stations_m = lane.centre.in_map.stations_m();
  for (std::size_t i = 1; i + 1 < stations_m.size(); ++i) {
    const double s_m = stations_m[i];
    const double curvature = std::abs(curvature_about_per_m(lane, s_m, chord_m));
    if (curvature > tightest.curvature_per_m) tightest = {s_m, curvature};
  }
  return tightest;
}

void tight_bends(const RoadMap& road_map, const ValidateOptions& options, Report& report) {
  for (const Lane& lane : road_map.lanes()) {
    if (!is_drivable(lane.type)) continue;
    const Bend bend = tightest_bend(lane, 1.0);
    if (bend.curvature_per_m <= options.max_curvature_per_m) continue;
    report.add("lane " + lane.name, lane.pose_at(bend.s_m).position(),
               fmt::format("bends with a radius of {:.2f} m at station {:.2f} m, tighter than a "
                           "car can; widen the bend",
                           1.0 / bend.curvature_per_m, bend.s_m));
  }
}

void fast_bends(const RoadMap& road_map, const ValidateOptions& options, Report& report) {
  for (const Lane& lane : road_map.lanes()) {
    const auto limit_mps = lane.least_speed_limit_mps();
    if (!is_drivable(lane.type) || lane.junction || !limit_mps) continue;
    const Bend bend = tightest_bend(lane, 5.0);
    const double acceleration = *limit_mps * *limit_mps * bend.curvature_per_m;
    if (acceleration <= options.max_lateral_acceleration_mps2) continue;
    report.add("lane " + lane.name, lane.pose_at(bend.s_m).position(),
               fmt::format("allows {:.0f} km/h in a bend of {:.1f} m radius, {:.1f} m/s² sideways; "
                           "lower the limit or widen the bend",
                           3.6 * *limit_mps, 1.0 / bend.curvature_per_m, acceleration));
  }
}

void elevation_spikes(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  constexpr double kSpike = 1.0;  // [m]
  for (const Lane& lane : road_map.lanes()) {
    const auto& z_m = lane.centre.z_m;
    const auto& s_m = lane.centre.station_m;
    for (std::size_t i = 1; i < z_m.size(); ++i) {
      const double rise_m = z_m[i] - z_m[i - 1];
      if (std::abs(rise_m) <= kSpike || std::abs(rise_m) <= s_m[i] - s_m[i - 1]) continue;
      report.add("lane " + lane.name, lane.centre.in_map.points()[i],
                 fmt::format("climbs {:.2f} m over {:.2f} m; correct the elevation", rise_m,
                             s_m[i] - s_m[i - 1]));
      break;
    }
  }
}

constexpr std::array<MapRule, 9> kBorderRules = {{
    {{"geometry.negative-width", "asam.net:xodr:1.4.0:road.lane.width.lane_width_validity",
      Severity::error, "a lane's borders are swapped by more than 2 mm, twice the sampling"},
     negative_widths},
    {{"geometry.zero-width", {}, Severity::warning, "a drivable lane has no width anywhere"},
     zero_widths},
    {{"geometry.absurd-width", {}, Severity::warning, "a drivable lane is wider than 30 m"},
     absurd_widths},
    {{"geometry.fold", {}, Severity::warning, "a border runs backwards by more than 1 cm"}, folds},
    {{"geometry.self-intersection", "asam.net:xodr:1.4.0:road.no_overlap_self", Severity::warning,
      "a lane without folds crosses itself"},
     self_intersections},
    {{"geometry.short-lane", {}, Severity::info, "a drivable lane is shorter than 5 cm"},
     short_lanes},
    {{"geometry.tight-bend",
      {},
      Severity::warning,
      "a drivable lane's centreline is more curved than --max-curvature"},
     tight_bends},
    {{"speed.bend",
      {},
      Severity::info,
      "at its speed limit a bend needs more than --max-lateral-acceleration"},
     fast_bends},
    {{"geometry.elevation-spike",
      {},
      Severity::warning,
      "a lane climbs by more than 1 m at more than 100 %"},
     elevation_spikes},
}};

}  // namespace

std::span<const MapRule> border_rules() { return kBorderRules; }

}  // namespace roadbed::map::validation
