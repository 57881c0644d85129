#pragma once

#include <limits>
#include <vector>

#include "roadbed/planning/lateral/batch_cost_kernel.h"
#include "roadbed/planning/lateral/candidates.h"

namespace roadbed::planning::inline lateral {

/// What all batches of a cycle are evaluated with.
struct BatchConfig {
  const std::vector<double>& end_d_m;  ///< of the offsets, ascending
  CostTerms weights;
  CostFrame frame;  ///< end_l_m is that of the batch
  DrivingLimits limits;
};

/// A batch at one station: d and its derivatives are at_zero + d_e · per_unit.
struct BatchSample {
  const Station& station;
  geometry::Quintic::Derivatives at_zero, per_unit;
  double mean_weight;  ///< of the trapezoidal mean
};

std::vector<BatchSample> batch_samples(const std::vector<Station>& stations,
                                       const QuinticFamily& family);

/// The station as the kernel needs it.
KernelPoint kernel_point(const BatchSample& at, const BatchConfig& config);

/// A sum over a batch's stations that is c[0] + e (c[1] + e c[2]) with e = d_e.
struct EndOffsetQuadratic {
  double c[3] = {0.0, 0.0, 0.0};
  void add_square(double weight, double at_zero, double per_unit) {
    c[0] += weight * at_zero * at_zero;
    c[1] += 2.0 * weight * at_zero * per_unit;
    c[2] += weight * per_unit * per_unit;
  }
  double at(double e) const { return c[0] + e * (c[1] + e * c[2]); }
};

/// Those terms that are quadratic in d_e: length, offset, consistency, and the longitudinal ones.
EndOffsetQuadratic closed_form_cost(const std::vector<BatchSample>& batch,
                                    const BatchConfig& config);

/// Values of d_e for which every station keeps a limit on d.
struct OffsetInterval {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();

  /// A limit on d = at_zero + d_e · per_unit.
  void keep(double least_d, double most_d, double at_zero, double per_unit);
  bool holds(double end_d_m) const { return end_d_m >= from && end_d_m <= to; }
};

OffsetInterval end_offsets_on_road(const std::vector<BatchSample>& batch);

/// The same from the context, for `count` stations, without what else there is at them.
OffsetInterval end_offsets_on_road(const CycleContext& context, const QuinticFamily& family,
                                   int count);

/// 1 − κ d > kLeastUnfolded.
OffsetInterval end_offsets_unfolded(const std::vector<BatchSample>& batch);

}  // namespace roadbed::planning::lateral
