#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace roadbed::planning::inline lateral {

/// What all candidates of one length share at one station, ready for the kernel. With e = d_e the
/// speed g = |p′|², the turn q = p′ × p″ and their derivatives are exact quadratics
/// c[0] + e (c[1] + e c[2]) (README.md, section "One batch at a time").
struct KernelPoint {
  double g[4][3];
  double q[4][3];
  double curvature_weight;  ///< of k²: its own and that of lateral acceleration
  double curvature_d1_weight, curvature_d2_weight, curvature_d3_weight;
  double jerk_per_k, jerk_per_d1;  ///< the square of their sum with k and dk/dσ is a cost
  double time_weight;              ///< duration per stretch [s]
  double fourth_power;             ///< v⁴: (lateral acceleration)² per k²
  double steering_per_k1;          ///< L v
  double steering_rate, steering_rate_per_kk;  ///< r and r L², see KernelSums
};

/// Sums of the candidates of a batch, added to by run_kernel(). All spans have the same length.
struct KernelSums {
  std::span<double> cost;
  std::span<double> duration_s;
  std::span<double> curvature_squared;     ///< running maximum of k²
  std::span<double> acceleration_squared;  ///< running maximum of v⁴ k²
  /// Running maximum of (L v dk/dσ)² − r² (1 + L² k²)², or 0: positive where the steering rate,
  /// of tan δ = L k, is over its limit r.
  std::span<double> steering_excess;
};

/// Candidates that go through all stations together, one in each SIMD lane.
inline constexpr std::size_t kSimdWidth = 8;

/// A polynomial of degree four in d_e, c[0] first.
using Quartic = std::array<double, 5>;

/// Lower bounds of what k² costs: with G the greatest g of a block of candidates, k² = q²/g³ ≥
/// q²/G³, and q² is a quartic in d_e. One bound per block, each over the d_e in [from, to].
/// @param bounds  added to.
void add_curvature_bounds(std::span<const KernelPoint> points, std::span<const double> from_d_m,
                          std::span<const double> to_d_m, std::span<Quartic> bounds);

/// Runs over all points of all candidates of a batch; one square root and one division per point,
/// and vector lanes over d_e. For a candidate with g = 0 somewhere the sums are not finite or
/// meaningless. Rounding depends on the instruction set: those with fused multiply-adds use them.
void run_kernel(std::span<const KernelPoint> points, std::span<const double> end_d_m,
                const KernelSums& sums);

}  // namespace roadbed::planning::lateral
