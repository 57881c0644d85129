#include "roadbed/planning/lateral/sure_edges.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roadbed::planning::inline lateral {
namespace {

constexpr double kMargin_m = 0.02;  // what sampling and the line's turning may add
constexpr double kMostSlope = 0.5, kLeastCosine = 0.87, kMostSine = 0.48;  // of θ: B/A ≤ 0.5
constexpr double kLeastAlong = 0.3;                                        // of A

// A bound that is linear in d_e.
void keep_at_most(double limit, double at_zero, double per_unit, OffsetInterval& interval) {
  constexpr double kFixed = 1e-12;
  const double room = limit - at_zero;
  if (per_unit > kFixed) {
    interval.to = std::min(interval.to, room / per_unit);
  } else if (per_unit < -kFixed) {
    interval.from = std::max(interval.from, room / per_unit);
  } else if (!(room >= 0.0)) {
    interval.from = std::numeric_limits<double>::infinity();
  }
}

// Where the line may be beside its tangent, under a corner.
OffsetRange line_beside(const RoadBorder::Room& room, double from_x_m, double to_x_m) {
  const double squares[] = {0.5 * from_x_m * from_x_m, 0.5 * to_x_m * to_x_m};
  const auto [least, most] = std::minmax(squares[0], squares[1]);
  const double low = room.least_curvature_per_m, high = room.most_curvature_per_m;
  return {low * (low < 0.0 ? most : least), high * (high > 0.0 ? most : least)};
}

}  // namespace

OffsetInterval surely_inside(const CandidateEvaluator& evaluator, const Station& station,
                             const LinearPoint& at, const OffsetRange& asked) {
  const geometry::VehicleShape& vehicle = evaluator.vehicle();
  const double half_width_m = 0.5 * vehicle.width_m, reach_m = vehicle.reach_m();
  const double along = std::min(at.along[0] + asked.min_d_m * at.along[1],
                                at.along[0] + asked.max_d_m * at.along[1]);
  OffsetInterval inside;
  if (along < kLeastAlong) return {.from = std::numeric_limits<double>::infinity()};
  const RoadBorder::Room room =
      evaluator.border().least_room(station.line.s_m - reach_m, station.line.s_m + reach_m);
  const double margin_m = evaluator.margins().border_margin_m + kMargin_m + half_width_m;
  for (const double side : {1.0, -1.0}) {
    const double slope[2] = {side * at.across[0] / along, side * at.across[1] / along};
    keep_at_most(kMostSlope, slope[0], slope[1], inside);
    for (const double x_m : {vehicle.front_m(), -vehicle.rear_overhang_m}) {
      const double turned_m = kMostSine * half_width_m, short_x_m = kLeastCosine * x_m;
      const OffsetRange line = line_beside(room, std::min(x_m, short_x_m) - turned_m,
                                           std::max(x_m, short_x_m) + turned_m);
      const double limit_m = side > 0.0 ? room.left_m + line.min_d_m : room.right_m - line.max_d_m;
      const double d[2] = {side * at.d_m[0], side * at.d_m[1]};
      keep_at_most(limit_m - margin_m, d[0], d[1], inside);
      keep_at_most(limit_m - margin_m, d[0] + x_m * slope[0], d[1] + x_m * slope[1], inside);
    }
  }
  return inside;
}

}  // namespace roadbed::planning::lateral
