#include "roadbed/planning/lateral/candidate_batch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace roadbed::planning::inline lateral {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// What rounding may add to a bound: a fraction of all of it, and of a quartic's largest part.
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

CandidateBatch::CandidateBatch(const std::vector<Station>& stations, const QuinticFamily& family,
                               const BatchConfig& config, std::span<KernelPoint> points)
    : config_(config), points_(points) {
  const std::vector<BatchSample> batch = batch_samples(stations, family);
  for (std::size_t i = 0; i < batch.size(); ++i) points[i] = kernel_point(batch[i], config);
  closed_form_ = closed_form_cost(batch, config);
  unfolded_ = end_offsets_unfolded(batch);
  least_duration_ = least_duration(batch, points_);
  bound_curvature();
  set_on_road(end_offsets_on_road(batch));
}

// dσ/ds ≥ 1 − κ d.
CandidateBatch::LeastDuration CandidateBatch::least_duration(const std::vector<BatchSample>& batch,
                                                             std::span<const KernelPoint> points) {
  LeastDuration least;
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const double curvature = batch[i].station.line.curvature_per_m;
    least.at_zero_s += points[i].time_weight * (1.0 - curvature * batch[i].at_zero[0]);
    least.per_unit_s -= points[i].time_weight * curvature * batch[i].per_unit[0];
  }
  return least;
}

double CandidateBatch::time_cost(double duration_s) const {
  const double per_duration =
      std::max(config_.frame.start_speed_mps, kSlowestCounted_mps) / config_.frame.max_l_m;
  return of(config_.weights, CostTerm::time) * squared(duration_s * per_duration);
}

Rejection CandidateBatch::first_verdict(std::size_t offset) const {
  const double end_d_m = config_.end_d_m[offset];
  if (!on_road_.holds(end_d_m)) return Rejection::off_road;
  return unfolded_.holds(end_d_m) ? Rejection::none : Rejection::beyond_curvature;
}

void CandidateBatch::bound_curvature() {
  const std::vector<double>& end_d_m = config_.end_d_m;
  bounds_.resize((end_d_m.size() + kSimdWidth - 1) / kSimdWidth);
  std::vector<double> from_d_m(blocks()), to_d_m(blocks());
  for (std::size_t block = 0; block < blocks(); ++block) {
    from_d_m[block] = end_d_m[first_offset(block)];
    to_d_m[block] = end_d_m[first_offset(block) + offsets_in(block) - 1];
  }
  curvature_.assign(blocks(), Quartic{});
  add_curvature_bounds(points_, from_d_m, to_d_m, curvature_);
}

void CandidateBatch::set_on_road(const OffsetInterval& on_road) {
  on_road_ = on_road;
  std::ranges::fill(bounds_, kInfinity);
  for (std::size_t offset = 0; offset < config_.end_d_m.size(); ++offset) {
    const double e = config_.end_d_m[offset];
    if (first_verdict(offset) != Rejection::none) continue;
    const std::size_t block = offset / kSimdWidth;
    const double cost = closed_form_.at(e) + time_cost(least_duration_.at(e)) +
                        std::max(0.0, rounded_down(curvature_[block], e));
    bounds_[block] = std::min(bounds_[block], cost * (1.0 - kRounding));
  }
}

void CandidateBatch::evaluate(std::size_t block, std::span<double> cost,
                              std::span<Rejection> rejection) const {
  std::array<double, kSimdWidth> sums{}, duration_s{}, curvature{}, acceleration{}, steering{};
  const std::span<const double> end_d_m(config_.end_d_m.data() + first_offset(block),
                                        offsets_in(block));
  run_kernel(points_, end_d_m, {sums, duration_s, curvature, acceleration, steering});
  const DrivingLimits& limits = config_.limits;
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

BatchCosts evaluate_batch(const std::vector<Station>& stations, const QuinticFamily& family,
                          const BatchConfig& config) {
  std::vector<KernelPoint> points(stations.size());
  const CandidateBatch batch(stations, family, config, points);
  BatchCosts result{std::vector<double>(config.end_d_m.size()),
                    std::vector<Rejection>(config.end_d_m.size())};
  for (std::size_t block = 0; block < batch.blocks(); ++block) {
    batch.evaluate(
        block, std::span(result.cost).subspan(batch.first_offset(block), batch.offsets_in(block)),
        std::span(result.rejection).subspan(batch.first_offset(block), batch.offsets_in(block)));
  }
  for (std::size_t offset = 0; offset < config.end_d_m.size(); ++offset) {
    const Rejection first = batch.first_verdict(offset);
    if (first != Rejection::none) result.rejection[offset] = first;
  }
  return result;
}

}  // namespace roadbed::planning::lateral
