#include "roadbed/planning/row_kernel.h"

#include <cmath>
#include <cstddef>

// One compiled copy per instruction set, chosen when the program starts. Clang has no such
// levels yet, and runs the portable copy.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define ROADBED_CLONES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define ROADBED_CLONES
#endif

namespace roadbed::planning {
namespace {

// Points of one station in all lanes. Free of branches, so that it becomes vector code.
ROADBED_CLONES void add_station(const KernelPoint& p, std::size_t lanes,
                                const double* __restrict end_d_m, double* __restrict cost,
                                double* __restrict duration_s, double* __restrict worst_curvature,
                                double* __restrict worst_acceleration) {
  for (std::size_t i = 0; i < lanes; ++i) {
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
    cost[i] += p.curvature_weight * kk + p.curvature_d1_weight * k1 * k1 +
               p.curvature_d2_weight * k2 * k2 + p.curvature_d3_weight * k3 * k3 + jerk * jerk;
    duration_s[i] += p.time_weight * stretch;
    const double acceleration = p.fourth_power * kk;
    worst_curvature[i] = kk > worst_curvature[i] ? kk : worst_curvature[i];
    worst_acceleration[i] =
        acceleration > worst_acceleration[i] ? acceleration : worst_acceleration[i];
  }
}

}  // namespace

void run_kernel(std::span<const KernelPoint> points, std::span<const double> end_d_m,
                const KernelSums& sums) {
  for (const KernelPoint& point : points) {
    add_station(point, end_d_m.size(), end_d_m.data(), sums.cost.data(), sums.duration_s.data(),
                sums.curvature_squared.data(), sums.acceleration_squared.data());
  }
}

}  // namespace roadbed::planning
