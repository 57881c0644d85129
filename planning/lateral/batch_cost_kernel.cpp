#include "roadbed/planning/lateral/batch_cost_kernel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "roadbed/geometry/primitives/instruction_sets.h"

namespace roadbed::planning::inline lateral {
namespace {

// The sums of a block stay in registers, and what its candidates share at a station is loaded once.
constexpr std::size_t kBlock = kSimdWidth;

struct Block {
  double cost[kBlock] = {}, duration_s[kBlock] = {};
  double curvature_squared[kBlock] = {}, acceleration_squared[kBlock] = {};
  double steering_excess[kBlock] = {};
};

inline double larger(double a, double b) { return a > b ? a : b; }

// Free of branches, so that it becomes vector code.
ROADBED_CLONES void sum_block(const KernelPoint* points, std::size_t count,
                              const double* __restrict end_d_m, Block& __restrict result) {
  Block sum;
  for (std::size_t station = 0; station < count; ++station) {
    const KernelPoint& p = points[station];
    for (std::size_t i = 0; i < kBlock; ++i) {
      const double e = end_d_m[i];
      const double g0 = p.g[0][0] + e * (p.g[0][1] + e * p.g[0][2]);
      const double g1 = p.g[1][0] + e * (p.g[1][1] + e * p.g[1][2]);
      const double g2 = p.g[2][0] + e * (p.g[2][1] + e * p.g[2][2]);
      const double g3 = p.g[3][0] + e * (p.g[3][1] + e * p.g[3][2]);
      const double q0 = p.q[0][0] + e * (p.q[0][1] + e * p.q[0][2]);
      const double q1 = p.q[1][0] + e * (p.q[1][1] + e * p.q[1][2]);
      const double q2 = p.q[2][0] + e * (p.q[2][1] + e * p.q[2][2]);
      const double q3 = p.q[3][0] + e * (p.q[3][1] + e * p.q[3][2]);
      const double r = 1.0 / g0;
      const double stretch = std::sqrt(g0);
      const double inverse = stretch * r;  // 1 / stretch
      const double r1 = g1 * r, r2 = g2 * r, r3 = g3 * r;
      const double a = q0 * r1;
      // As geometry::offset_curve.
      const double k = q0 * r * inverse;
      const double k1 = (q1 - 1.5 * a) * r * r;
      const double k2 = (q2 - r1 * (3.5 * q1 - 4.5 * a) - 1.5 * q0 * r2) * (r * r * inverse);
      const double k3 = (q3 - 1.5 * q0 * r3 - r2 * (5.0 * q1 - 14.25 * a) -
                         r1 * (6.0 * q2 - r1 * (16.75 * q1 - 20.25 * a))) *
                        (r * r * r);
      const double kk = k * k;
      const double jerk = p.jerk_per_k * k + p.jerk_per_d1 * k1;
      sum.cost[i] += p.curvature_weight * kk + p.curvature_d1_weight * k1 * k1 +
                     p.curvature_d2_weight * k2 * k2 + p.curvature_d3_weight * k3 * k3 +
                     jerk * jerk;
      sum.duration_s[i] += p.time_weight * stretch;
      sum.curvature_squared[i] = larger(kk, sum.curvature_squared[i]);
      sum.acceleration_squared[i] = larger(p.fourth_power * kk, sum.acceleration_squared[i]);
      const double turn = p.steering_per_k1 * k1;
      const double most = p.steering_rate + p.steering_rate_per_kk * kk;
      sum.steering_excess[i] = larger(turn * turn - most * most, sum.steering_excess[i]);
    }
  }
  result = sum;
}

// Bounds of kBounds blocks at once; c[j] holds the coefficient of d_e^j of each.
constexpr std::size_t kBounds = 16;
struct Bounds {
  double from[kBounds] = {}, to[kBounds] = {};
  double c[5][kBounds] = {};
};

ROADBED_CLONES void sum_bounds(const KernelPoint* points, std::size_t count,
                               Bounds& __restrict bounds) {
  for (std::size_t station = 0; station < count; ++station) {
    const KernelPoint& p = points[station];
    const double a = p.q[0][0], b = p.q[0][1], c = p.q[0][2], w = p.curvature_weight;
    const double square[5] = {w * a * a, 2.0 * w * a * b, w * (b * b + 2.0 * a * c),
                              2.0 * w * b * c, w * c * c};
    for (std::size_t i = 0; i < kBounds; ++i) {
      const double e = bounds.from[i], f = bounds.to[i];
      // g = |p′|² is convex in d_e: the greatest is at an end.
      const double g = larger(p.g[0][0] + e * (p.g[0][1] + e * p.g[0][2]),
                              p.g[0][0] + f * (p.g[0][1] + f * p.g[0][2]));
      const double inverse_cube = 1.0 / (g * g * g);
      for (std::size_t j = 0; j < 5; ++j) bounds.c[j][i] += inverse_cube * square[j];
    }
  }
}

}  // namespace

void run_kernel(std::span<const KernelPoint> points, std::span<const double> end_d_m,
                const KernelSums& sums) {
  for (std::size_t first = 0; first < end_d_m.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, end_d_m.size() - first);
    double block_end_d_m[kBlock] = {};
    std::copy_n(end_d_m.data() + first, count, block_end_d_m);
    Block block;
    sum_block(points.data(), points.size(), block_end_d_m, block);
    std::copy_n(block.cost, count, sums.cost.data() + first);
    std::copy_n(block.duration_s, count, sums.duration_s.data() + first);
    std::copy_n(block.curvature_squared, count, sums.curvature_squared.data() + first);
    std::copy_n(block.acceleration_squared, count, sums.acceleration_squared.data() + first);
    std::copy_n(block.steering_excess, count, sums.steering_excess.data() + first);
  }
}

void add_curvature_bounds(std::span<const KernelPoint> points, std::span<const double> from_d_m,
                          std::span<const double> to_d_m, std::span<Quartic> bounds) {
  for (std::size_t first = 0; first < bounds.size(); first += kBounds) {
    const std::size_t blocks = std::min(kBounds, bounds.size() - first);
    Bounds sums;
    std::copy_n(from_d_m.data() + first, blocks, sums.from);
    std::copy_n(to_d_m.data() + first, blocks, sums.to);
    sum_bounds(points.data(), points.size(), sums);
    for (std::size_t i = 0; i < blocks; ++i) {
      for (std::size_t j = 0; j < 5; ++j) bounds[first + i][j] += sums.c[j][i];
    }
  }
}

}  // namespace roadbed::planning::lateral
