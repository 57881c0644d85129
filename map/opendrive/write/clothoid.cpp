#include "roadbed/map/opendrive/write/clothoid.h"

#include <cmath>

#include "roadbed/geometry/curves/quadrature.h"
#include "roadbed/geometry/primitives/angle.h"

namespace roadbed::map::opendrive {
namespace {

constexpr double kSteepest_rad = 70.0 * geometry::kRadiansPerDegree;

// Over τ in [0, 1], of the heading h(τ) = A τ² + (δ − A) τ + φ₀ against the chord: the integrals of
// cos h, sin h, and (τ² − τ) cos h, the derivative of the second one by A.
struct Integrals {
  double cosine = 0.0, sine = 0.0, sine_by_a = 0.0;
};

Integrals integrate(double a, double delta, double phi0) {
  const auto integrand = [&](double tau) {
    const double heading_rad = phi0 + tau * (delta - a + a * tau);
    const double cosine = std::cos(heading_rad);
    return Eigen::Array3d(cosine, std::sin(heading_rad), (tau * tau - tau) * cosine);
  };
  const bool is_gentle = std::abs(delta - a) + 2.0 * std::abs(a) < 1.0;
  const Eigen::Array3d sums = is_gentle ? geometry::integrate(integrand, 0.0, 1.0)
                                        : Eigen::Array3d(geometry::integrate(integrand, 0.0, 0.5) +
                                                         geometry::integrate(integrand, 0.5, 1.0));
  return {sums[0], sums[1], sums[2]};
}

geometry::PlanCurve curve_of(double k0, double k1, double length_m) {
  constexpr double straight = 1e-11;
  if (std::abs(k0) * length_m < straight && std::abs(k1) * length_m < straight) {
    return geometry::LineCurve{};
  }
  if (std::abs(k1 - k0) * length_m < straight) return geometry::ArcCurve{0.5 * (k0 + k1)};
  return geometry::SpiralCurve{k0, k1};
}

}  // namespace

std::optional<geometry::PlanPiece> clothoid_between(const geometry::Pose2& from,
                                                    const geometry::Pose2& to, double s_m) {
  const Eigen::Vector2d chord = to.position() - from.position();
  const double chord_m = chord.norm();
  if (!(chord_m > 1e-9)) return {};
  const double along_rad = std::atan2(chord.y(), chord.x());
  const double phi0 = geometry::wrap_angle(from.heading_rad - along_rad);
  const double phi1 = geometry::wrap_angle(to.heading_rad - along_rad);
  if (std::abs(phi0) > kSteepest_rad || std::abs(phi1) > kSteepest_rad) return {};
  const double delta = phi1 - phi0;
  double a = 3.0 * (phi0 + phi1);
  Integrals sums = integrate(a, delta, phi0);
  for (int step = 0; step < 20 && std::abs(sums.sine) > 1e-15; ++step) {
    if (std::abs(sums.sine_by_a) < 1e-6) return {};
    a -= sums.sine / sums.sine_by_a;
    sums = integrate(a, delta, phi0);
  }
  if (!(std::abs(sums.sine) < 1e-12) || !(sums.cosine > 0.1)) return {};
  const double length_m = chord_m / sums.cosine;
  return geometry::PlanPiece{s_m, length_m, from,
                             curve_of((delta - a) / length_m, (delta + a) / length_m, length_m)};
}

}  // namespace roadbed::map::opendrive
