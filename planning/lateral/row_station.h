#pragma once

#include <limits>
#include <vector>

#include "roadbed/planning/lateral/candidates.h"
#include "roadbed/planning/lateral/row_kernel.h"

namespace roadbed::planning::inline lateral {

/// What all rows of a cycle are evaluated with.
struct RowQuestion {
  const std::vector<double>& end_d_m;  ///< of the lanes, ascending
  CostTerms weights;
  CostFrame frame;  ///< end_l_m is that of the row
  DrivingLimits limits;
};

/// A row at one station: d and its derivatives are at_zero + d_e · per_unit.
struct RowStation {
  const Station& station;
  geometry::Quintic::Derivatives at_zero, per_unit;
  double share;  ///< of the trapezoidal mean
};

std::vector<RowStation> row_stations(const std::vector<Station>& stations,
                                     const QuinticFamily& family);

/// The station as the kernel needs it.
KernelPoint kernel_point(const RowStation& at, const RowQuestion& question);

/// A sum over a row's stations that is c[0] + e (c[1] + e c[2]) with e = d_e.
struct RowQuadratic {
  double c[3] = {0.0, 0.0, 0.0};
  void add_square(double weight, double at_zero, double per_unit) {
    c[0] += weight * at_zero * at_zero;
    c[1] += 2.0 * weight * at_zero * per_unit;
    c[2] += weight * per_unit * per_unit;
  }
  double at(double e) const { return c[0] + e * (c[1] + e * c[2]); }
};

/// Those terms that are quadratic in d_e: length, offset, consistency, and the longitudinal ones.
RowQuadratic closed_form_cost(const std::vector<RowStation>& row, const RowQuestion& question);

/// Values of d_e for which every station keeps a limit on d.
struct LaneInterval {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();

  /// A limit on d = at_zero + d_e · per_unit.
  void keep(double least_d, double most_d, double at_zero, double per_unit);
  bool holds(double end_d_m) const { return end_d_m >= from && end_d_m <= to; }
};

LaneInterval lanes_on_road(const std::vector<RowStation>& row);

/// The same from the course, for `count` stations, without what else there is at them.
LaneInterval lanes_on_road(const Course& course, const QuinticFamily& family, int count);

/// 1 − κ d > kLeastUnfolded.
LaneInterval lanes_unfolded(const std::vector<RowStation>& row);

}  // namespace roadbed::planning::lateral
