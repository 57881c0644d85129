#include "roadbed/geometry/curves/frenet.h"

#include <cmath>

namespace roadbed::geometry::inline curves {

FrameVelocity frame_velocity(const CurvatureDerivatives& line, const Quintic::Derivatives& d) {
  const auto& [k, k1, k2, k3, k4] = line;
  return {
      .along = {1.0 - k * d[0], -(k1 * d[0] + k * d[1]), -(k2 * d[0] + 2.0 * k1 * d[1] + k * d[2]),
                -(k3 * d[0] + 3.0 * k2 * d[1] + 3.0 * k1 * d[2] + k * d[3]),
                -(k4 * d[0] + 4.0 * k3 * d[1] + 6.0 * k2 * d[2] + 4.0 * k1 * d[3] + k * d[4])},
      .across = {d[1], d[2], d[3], d[4], d[5]}};
}

SpeedAndTurn mixed(const CurvatureDerivatives& line, const FrameVelocity& u,
                   const FrameVelocity& v) {
  const auto& A = u.along;
  const auto& B = u.across;
  const auto& C = v.along;
  const auto& D = v.across;
  // p′ = z e^{iψ} with z = A + iB and ψ′ = κ, so p″ = (z′ + iκz) e^{iψ}: g = |z|² and
  // q = Im(z̄ z′) + κ g. The Wronskian w = Im(z̄ z′) loses terms at each derivative.
  const double g = A[0] * C[0] + B[0] * D[0];
  const double g1 = 2.0 * (A[0] * C[1] + B[0] * D[1]);
  const double g2 = 2.0 * (A[1] * C[1] + A[0] * C[2] + B[1] * D[1] + B[0] * D[2]);
  const double g3 = 2.0 * (3.0 * (A[1] * C[2] + B[1] * D[2]) + A[0] * C[3] + B[0] * D[3]);
  const double w = A[0] * D[1] - B[0] * C[1];
  const double w1 = A[0] * D[2] - B[0] * C[2];
  const double w2 = A[0] * D[3] - B[0] * C[3] + A[1] * D[2] - B[1] * C[2];
  const double w3 = A[0] * D[4] - B[0] * C[4] + 2.0 * (A[1] * D[3] - B[1] * C[3]);
  return {.g = {g, g1, g2, g3},
          .q = {w + line[0] * g, w1 + line[1] * g + line[0] * g1,
                w2 + line[2] * g + 2.0 * line[1] * g1 + line[0] * g2,
                w3 + line[3] * g + 3.0 * line[2] * g1 + 3.0 * line[1] * g2 + line[0] * g3}};
}

std::optional<OffsetCurve> offset_curve(const CurvatureDerivatives& line,
                                        const Quintic::Derivatives& d, double least) {
  const FrameVelocity velocity = frame_velocity(line, d);
  if (!(velocity.along[0] > least)) return std::nullopt;  // also catches NaN
  const auto [g, q] = mixed(line, velocity, velocity);
  const double r1 = g[1] / g[0], r2 = g[2] / g[0], r3 = g[3] / g[0];
  const double stretch = std::sqrt(g[0]);
  const double inverse = 1.0 / stretch, inverse3 = inverse * inverse * inverse;
  const double a = q[0] * r1;
  // k = q g^(−3/2), and d/dσ = (1/stretch) d/ds three times.
  return OffsetCurve{
      .stretch = stretch,
      .along = velocity.along[0] * inverse,
      .across = velocity.across[0] * inverse,
      .curvature_per_m = q[0] * inverse3,
      .curvature_d1_per_m2 = (q[1] - 1.5 * a) * inverse3 * inverse,
      .curvature_d2_per_m3 =
          (q[2] - r1 * (3.5 * q[1] - 4.5 * a) - 1.5 * q[0] * r2) * inverse3 * inverse * inverse,
      .curvature_d3_per_m4 = (q[3] - 1.5 * q[0] * r3 - r2 * (5.0 * q[1] - 14.25 * a) -
                              r1 * (6.0 * q[2] - r1 * (16.75 * q[1] - 20.25 * a))) *
                             inverse3 * inverse3};
}

}  // namespace roadbed::geometry::curves
