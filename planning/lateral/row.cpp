#include "roadbed/planning/lateral/row.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace roadbed::planning::inline lateral {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// What rounding may add to a bound: a share of all of it, and of a quartic's largest part.
constexpr double kRounding = 1e-9, kQuarticRounding = 1e-13;

double squared(double value) { return value * value; }

// A quartic, less what rounding may have added. Its even coefficients are sums of squares but for
// parts that those of degree 0 and 4 outweigh, so that they bound every part of the sums.
double rounded_down(const Quartic& c, double e) {
  const double ee = e * e;
  const double parts = 2.0 * c[0] + ee * (std::abs(c[2]) + 2.0 * ee * c[4]);
  return c[0] + e * (c[1] + e * (c[2] + e * (c[3] + e * c[4]))) - 3.0 * kQuarticRounding * parts;
}

}  // namespace

Row::Row(const std::vector<Station>& stations, const QuinticFamily& family,
         const RowQuestion& question, std::span<KernelPoint> points)
    : question_(question), points_(points) {
  const std::vector<RowStation> row = row_stations(stations, family);
  for (std::size_t i = 0; i < row.size(); ++i) points[i] = kernel_point(row[i], question);
  closed_form_ = closed_form_cost(row, question);
  unfolded_ = lanes_unfolded(row);
  least_duration_ = least_duration(row, points_);
  bound_curvature();
  set_on_road(lanes_on_road(row));
}

// dσ/ds ≥ 1 − κ d.
Row::LeastDuration Row::least_duration(const std::vector<RowStation>& row,
                                       std::span<const KernelPoint> points) {
  LeastDuration least;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const double curvature = row[i].station.line.curvature_per_m;
    least.at_zero_s += points[i].time_weight * (1.0 - curvature * row[i].at_zero[0]);
    least.per_unit_s -= points[i].time_weight * curvature * row[i].per_unit[0];
  }
  return least;
}

double Row::time_cost(double duration_s) const {
  const double per_duration =
      std::max(question_.frame.start_speed_mps, kSlowestCounted_mps) / question_.frame.max_l_m;
  return of(question_.weights, CostTerm::time) * squared(duration_s * per_duration);
}

Rejection Row::first_verdict(std::size_t lane) const {
  const double end_d_m = question_.end_d_m[lane];
  if (!on_road_.holds(end_d_m)) return Rejection::off_road;
  return unfolded_.holds(end_d_m) ? Rejection::none : Rejection::beyond_curvature;
}

void Row::bound_curvature() {
  const std::vector<double>& end_d_m = question_.end_d_m;
  bounds_.resize((end_d_m.size() + kLanesPerBlock - 1) / kLanesPerBlock);
  std::vector<double> from_d_m(blocks()), to_d_m(blocks());
  for (std::size_t block = 0; block < blocks(); ++block) {
    from_d_m[block] = end_d_m[first_lane(block)];
    to_d_m[block] = end_d_m[first_lane(block) + lanes_in(block) - 1];
  }
  curvature_.assign(blocks(), Quartic{});
  add_curvature_bounds(points_, from_d_m, to_d_m, curvature_);
}

void Row::set_on_road(const LaneInterval& on_road) {
  on_road_ = on_road;
  std::ranges::fill(bounds_, kInfinity);
  for (std::size_t lane = 0; lane < question_.end_d_m.size(); ++lane) {
    const double e = question_.end_d_m[lane];
    if (first_verdict(lane) != Rejection::none) continue;
    const std::size_t block = lane / kLanesPerBlock;
    const double cost = closed_form_.at(e) + time_cost(least_duration_.at(e)) +
                        std::max(0.0, rounded_down(curvature_[block], e));
    bounds_[block] = std::min(bounds_[block], cost * (1.0 - kRounding));
  }
}

void Row::evaluate(std::size_t block, std::span<double> cost,
                   std::span<Rejection> rejection) const {
  std::array<double, kLanesPerBlock> sums{}, duration_s{}, curvature{}, acceleration{}, steering{};
  const std::span<const double> end_d_m(question_.end_d_m.data() + first_lane(block),
                                        lanes_in(block));
  run_kernel(points_, end_d_m, {sums, duration_s, curvature, acceleration, steering});
  const DrivingLimits& limits = question_.limits;
  for (std::size_t i = 0; i < end_d_m.size(); ++i) {
    cost[i] = sums[i] + closed_form_.at(end_d_m[i]) + time_cost(duration_s[i]);
    rejection[i] = Rejection::none;
    if (!unfolded_.holds(end_d_m[i]) || !(curvature[i] <= squared(limits.max_curvature_per_m))) {
      rejection[i] = Rejection::beyond_curvature;
    } else if (!(acceleration[i] <= squared(limits.max_lateral_acceleration_mps2))) {
      rejection[i] = Rejection::lateral_acceleration;
    } else if (!(steering[i] <= kLimitSlack * squared(limits.max_steering_rate_radps))) {
      rejection[i] = Rejection::steering_rate;
    }
  }
}

RowResult evaluate_row(const std::vector<Station>& stations, const QuinticFamily& family,
                       const RowQuestion& question) {
  std::vector<KernelPoint> points(stations.size());
  const Row row(stations, family, question, points);
  RowResult result{std::vector<double>(question.end_d_m.size()),
                   std::vector<Rejection>(question.end_d_m.size())};
  for (std::size_t block = 0; block < row.blocks(); ++block) {
    row.evaluate(block, std::span(result.cost).subspan(row.first_lane(block), row.lanes_in(block)),
                 std::span(result.rejection).subspan(row.first_lane(block), row.lanes_in(block)));
  }
  for (std::size_t lane = 0; lane < question.end_d_m.size(); ++lane) {
    const Rejection first = row.first_verdict(lane);
    if (first != Rejection::none) result.rejection[lane] = first;
  }
  return result;
}

}  // namespace roadbed::planning::lateral
