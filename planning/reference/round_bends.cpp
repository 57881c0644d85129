#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "roadbed/planning/reference/bend_rounding.h"
#include "roadbed/planning/reference/bezier_places.h"
#include "roadbed/planning/reference/line_driving.h"
#include "roadbed/planning/reference/reference_line_data.h"
#include "roadbed/planning/reference/route_curve.h"

namespace roadbed::planning::inline reference {
namespace {

using Eigen::Vector2d;

constexpr double kOffSurface_m = 0.05;  // still is on the road
const std::vector<double> kInCorridor_m = {-0.1, 0.0, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0};
constexpr double kRoomStep_m = 0.5;
constexpr double kNear_m = 25.0;  // of a bend: as far as its body and its legs reach
// Out of the corridor is so much worse than out of the lane, and off the road than both.
constexpr double kOffCorridor_m = 3.0, kOffRoad_m = 6.0;
constexpr double kMostOffCorridor_m = 0.6, kMostOffRoad_m = 0.3;
constexpr double kOneBend_m = 12.0;  // between bends to the same side that are rounded as one
constexpr double kDrawStep_m = 0.25;
// The curves that have been chosen are kept to when all is fitted again.
constexpr double kKeepTo_m = 0.05, kFineKnots_m = 0.5, kFineScale_m = 1.0;
constexpr double kWidenBy_m = 0.3, kMostWide_m = 1.2;
constexpr double kLostFit = 1.5;        // a curve farther off than so many tolerances is no fit
constexpr double kBesideBend_m = 12.0;  // that is drawn wider with a bend, before and behind it

// How far places are out of the lanes of the path, beside its curve.
class RoomBeside {
 public:
  RoomBeside(const map::RoadMap& road_map, const RoutePath& path, const RouteCurve& route)
      : road_map_(road_map), curve_(route.curve) {
    const std::vector<std::size_t> beside = points_beside(path, curve_, 0.0, kRoomStep_m);
    for (std::size_t i = 0; i < beside.size(); ++i) {
      const RoutePathPoint& at = path.points[beside[i]];
      const geometry::CurvePoint point = curve_.at(kRoomStep_m * static_cast<double>(i));
      lane_.push_back(room_in_lane(road_map, at.lane, at.fraction, point, at.reversed));
      corridor_.push_back(room_beside(road_map, at.lane, at.fraction, point, 0.0, at.reversed));
    }
  }

  double outside_m(const Vector2d& in_map, double near_s_m) const {
    const geometry::LinePosition place = curve_.project(in_map, near_s_m);
    const double out_of_corridor_m = beyond_m(corridor_, place);
    if (out_of_corridor_m < kOffSurface_m) return std::min(beyond_m(lane_, place), kOffCorridor_m);
    const bool is_held =
        out_of_corridor_m < kMostOffCorridor_m && road_map_.on_surface(in_map, kOffSurface_m);
    return out_of_corridor_m + (is_held ? kOffCorridor_m : kOffRoad_m);
  }

 private:
  static double beyond_m(const std::vector<Corridor>& room, const geometry::LinePosition& place) {
    const auto last = static_cast<double>(room.size() - 1);
    const double index = std::clamp(place.s_m / kRoomStep_m, 0.0, last);
    const auto before = static_cast<std::size_t>(index);
    const Corridor &a = room[before], &b = room[std::min(before + 1, room.size() - 1)];
    const double part = index - static_cast<double>(before);
    return std::max(place.d_m - std::lerp(a.left_m, b.left_m, part),
                    -place.d_m - std::lerp(a.right_m, b.right_m, part));
  }

  const map::RoadMap& road_map_;
  const geometry::SmoothCurve& curve_;
  std::vector<Corridor> lane_, corridor_;
};

LineDriving driving_along(const RouteCurve& route, const geometry::VehicleShape& vehicle,
                          const std::function<bool(const Vector2d&)>& on_road) {
  const LineView line(
      [&](double s_m) {
        const geometry::CurvePoint point = route.curve.at(route.start_m + s_m);
        return ReferencePoint{.s_m = s_m,
                              .in_map = point.position,
                              .heading_rad = point.heading_rad,
                              .curvature_per_m = point.curvature_per_m[0],
                              .curvature_d1_per_m2 = point.curvature_per_m[1]};
      },
      [](double) { return Corridor{}; });
  return driving_along(line, route.goal_s_m, vehicle, on_road);
}

// How far the body is outside where it follows the curve as it is.
double outside_as_it_is_m(const RouteCurve& route, double from_m, double to_m,
                          const geometry::VehicleShape& vehicle, const RoomBeside& room) {
  const std::vector<Vector2d> body = body_outline(vehicle);
  double outside_m = -1e9;
  for (double s_m = from_m; s_m <= to_m; s_m += kDrawStep_m) {
    const geometry::CurvePoint at = route.curve.at(s_m);
    const geometry::Pose2 pose{at.position.x(), at.position.y(), at.heading_rad};
    for (const Vector2d& place : body) {
      outside_m = std::max(outside_m, room.outside_m(pose * place, s_m + place.x()));
    }
  }
  return outside_m;
}

// Bends to the same side, one soon after the other, as one.
std::vector<LineFault> joined(const std::vector<LineFault>& faults, const RouteCurve& route) {
  const auto is_left = [&](double s_m) {
    return route.curve.at(route.start_m + s_m).curvature_per_m[0] > 0.0;
  };
  std::vector<LineFault> all;
  for (const LineFault& fault : faults) {
    const bool goes_on = !all.empty() && fault.from_s_m - all.back().to_s_m < kOneBend_m &&
                         is_left(fault.from_s_m) == is_left(all.back().to_s_m);
    if (goes_on)
      all.back().to_s_m = fault.to_s_m;
    else
      all.push_back(fault);
  }
  return all;
}

// In the corridor, and beyond it; off the road no farther than the body is already.
std::vector<double> steps_up_to(double as_it_is_m) {
  std::vector<double> steps_m = kInCorridor_m;
  for (const double more_m : {0.1, 0.2, 0.3, kMostOffCorridor_m}) {
    steps_m.push_back(kOffCorridor_m + more_m);
  }
  for (const double more_m : {0.1, 0.2, kMostOffRoad_m}) {
    if (kOffRoad_m + more_m <= as_it_is_m) steps_m.push_back(kOffRoad_m + more_m);
  }
  return steps_m;
}

struct Rounding {
  std::vector<RoundedBend> bends;
  std::vector<std::string> reasons;  // one for each that has none
};

// Two bends behind each other share what lies between them.
Rounding rounding_of(const std::vector<LineFault>& faults, const RouteCurve& route,
                     const geometry::VehicleShape& vehicle, const RoomBeside& room,
                     bool in_corridor) {
  Rounding rounding;
  for (std::size_t i = 0; i < faults.size(); ++i) {
    const double from_m = route.start_m + faults[i].from_s_m;
    const double to_m = route.start_m + faults[i].to_s_m;
    const double least_m =
        i == 0 ? 0.0 : from_m - 0.5 * (faults[i].from_s_m - faults[i - 1].to_s_m);
    const double most_m = i + 1 == faults.size()
                              ? route.curve.length_m()
                              : to_m + 0.5 * (faults[i + 1].from_s_m - faults[i].to_s_m);
    const auto outside_m = [&](const Vector2d& in_map, double near_s_m) {
      return room.outside_m(in_map, near_s_m);
    };
    const double as_it_is_m = outside_as_it_is_m(route, std::max(least_m, from_m - kNear_m),
                                                 std::min(most_m, to_m + kNear_m), vehicle, room);
    BendChoice choice = round_bend({route.curve, from_m, to_m, least_m, most_m, outside_m,
                                    in_corridor ? kInCorridor_m : steps_up_to(as_it_is_m)},
                                   vehicle);
    if (choice.bend) rounding.bends.push_back(*std::move(choice.bend));
    if (choice.reason.empty()) continue;
    rounding.reasons.push_back(
        fmt::format("the bend at {:.1f} m is not rounded: {}", faults[i].from_s_m, choice.reason));
  }
  return rounding;
}

geometry::Polyline with_bends(const geometry::SmoothCurve& curve,
                              const std::vector<RoundedBend>& bends) {
  std::vector<Vector2d> points;
  const auto keep = [&](double from_m, double to_m) {
    const int count = std::max(1, static_cast<int>(std::ceil((to_m - from_m) / kDrawStep_m)));
    for (int i = 0; i <= count; ++i) {
      points.push_back(curve.at(std::lerp(from_m, to_m, 1.0 * i / count)).position);
    }
  };
  double kept_m = 0.0;
  for (const RoundedBend& bend : bends) {
    keep(kept_m, bend.from_s_m);
    const int count = static_cast<int>(std::ceil(2.0 * bend.curve.length_m() / kDrawStep_m));
    for (int i = 1; i < count; ++i) points.push_back(bend.curve.at(1.0 * i / count));
    kept_m = bend.to_s_m;
  }
  keep(kept_m, curve.length_m());
  return geometry::Polyline(std::move(points));
}

double largest_move_m(const RoutePath& path, const geometry::SmoothCurve& curve) {
  double most_m = 0.0, s_m = 0.0;
  for (const RoutePathPoint& point : path.points) {
    const geometry::LinePosition at = curve.project(point.in_map, s_m);
    most_m = std::max(most_m, std::abs(at.d_m));
    s_m = std::max(s_m, at.s_m);
  }
  return most_m;
}

// Fitted to points that are as smooth as they have to be.
RouteCurve redrawn(const RoutePath& path, const geometry::Polyline& through,
                   geometry::FitOptions options) {
  options.tolerance_m = std::min(options.tolerance_m, kKeepTo_m);
  options.knot_distance_m = std::min(options.knot_distance_m, kFineKnots_m);
  options.scale_m = std::min(options.scale_m, kFineScale_m);
  RouteCurve route = draw_curve(path, through, options);
  route.largest_move_m = largest_move_m(path, route.curve);
  return route;
}

// By the length of the path, with what lies before and behind them.
std::vector<geometry::WiderStretch> wider_stretches(const std::vector<LineFault>& bends,
                                                    const RouteCurve& route, double path_m) {
  const double path_per_line = path_m / route.curve.length_m();
  std::vector<geometry::WiderStretch> stretches;
  for (const LineFault& bend : bends) {
    stretches.push_back({path_per_line * (route.start_m + bend.from_s_m) - kBesideBend_m,
                         path_per_line * (route.start_m + bend.to_s_m) + kBesideBend_m, 0.0});
  }
  return stretches;
}

struct BendRounder {
  const map::RoadMap& road_map;
  const RoutePath& path;
  const geometry::VehicleShape& vehicle;
  const geometry::FitOptions& options;

  LineDriving driving(const RouteCurve& route) const {
    return driving_along(route, vehicle, [&](const Vector2d& place) {
      return road_map.on_surface(place, kOffSurface_m);
    });
  }

  std::vector<LineFault> bends(const RouteCurve& route) const {
    return joined(driving_along(route, vehicle, {}).bends, route);
  }

  std::optional<RouteCurve> all_in_corridor(const RouteCurve& route) const {
    const RoomBeside room(road_map, path, route);
    const Rounding rounding = rounding_of(bends(route), route, vehicle, room, true);
    if (!rounding.reasons.empty()) return std::nullopt;
    RouteCurve rounded = redrawn(path, with_bends(route.curve, rounding.bends), options);
    return bends(rounded).empty() ? std::optional(std::move(rounded)) : std::nullopt;
  }

  // The line may swing out before and behind a bend, by more and more, as long as the body leaves
  // the road on no longer a stretch for it.
  void widen(RouteCurve& route) const {
    const LineDriving first = driving(route);
    const geometry::Polyline centreline = centreline_of(path);
    geometry::FitOptions fit = options;
    fit.wider = wider_stretches(first.bends, route, centreline.length_m());
    double bends_m = length_of(first.bends);
    for (double wide_m = options.tolerance_m + kWidenBy_m;
         bends_m > 0.0 && wide_m < kMostWide_m + 1e-9; wide_m += kWidenBy_m) {
      for (geometry::WiderStretch& stretch : fit.wider) stretch.tolerance_m = wide_m;
      RouteCurve wider = draw_curve(path, centreline, fit);
      if (wider.largest_move_m > kLostFit * wide_m) continue;
      const LineDriving on_wider = driving(wider);
      if (length_of(on_wider.leaves) > length_of(first.leaves)) break;
      if (length_of(on_wider.bends) >= bends_m) continue;
      bends_m = length_of(on_wider.bends);
      route = std::move(wider);
    }
  }

  // Returns why some are not rounded.
  std::vector<std::string> round_what_is_left(RouteCurve& route) const {
    const std::vector<LineFault> left = bends(route);
    if (left.empty()) return {};
    const RoomBeside room(road_map, path, route);
    Rounding rounding = rounding_of(left, route, vehicle, room, false);
    if (rounding.bends.empty()) return std::move(rounding.reasons);
    RouteCurve rounded = redrawn(path, with_bends(route.curve, rounding.bends), options);
    if (length_of(bends(rounded)) < length_of(left)) route = std::move(rounded);
    return std::move(rounding.reasons);
  }
};

}  // namespace

BendsRounded round_bends(const map::RoadMap& road_map, const RoutePath& path,
                         const geometry::VehicleShape& vehicle, const geometry::FitOptions& options,
                         RouteCurve& route) {
  const BendRounder rounder{road_map, path, vehicle, options};
  if (rounder.bends(route).empty()) return {};
  BendsRounded result{.any = true, .notes = {}};
  if (auto rounded = rounder.all_in_corridor(route)) {
    route = *std::move(rounded);
  } else {
    rounder.widen(route);
    result.notes = rounder.round_what_is_left(route);
  }
  std::ranges::copy(notes_on(driving_along(route, vehicle, {}).bends),
                    std::back_inserter(result.notes));
  return result;
}

}  // namespace roadbed::planning::reference
