#pragma once

#include <array>
#include <optional>

#include "roadbed/geometry/curves/quintic.h"

namespace roadbed::geometry::inline curves {

/// Curvature κ of a reference line and its first four derivatives with respect to its own arc
/// length s: κ, κ′, κ″, κ‴, κ⁗.
using CurvatureDerivatives = std::array<double, 5>;

/// A curve beside a reference line, p(s) = r(s) + d(s) n(s), at one station: everything with
/// respect to the arc length of the *curve*, σ. (The reference line's is s.)
struct OffsetCurve {
  double stretch = 1.0;              ///< dσ/ds > 0
  double along = 1.0;                ///< cos of the angle from the line's direction to the curve's
  double across = 0.0;               ///< sin of that angle
  double curvature_per_m = 0.0;      ///< k
  double curvature_d1_per_m2 = 0.0;  ///< dk/dσ
  double curvature_d2_per_m3 = 0.0;  ///< d²k/dσ²
  double curvature_d3_per_m4 = 0.0;  ///< d³k/dσ³
};

/// The parts of a curve beside a line that its curvature and its derivatives are made of, see
/// README.md, section "Frenet frame": g = |p′|², q = p′ × p″ and their derivatives with
/// respect to s. Where d is linear in a parameter, all eight are quadratic in it.
struct SpeedAndTurn {
  std::array<double, 4> g;
  std::array<double, 4> q;
};

/// 1 − κ d and d′, the components of p′ along and across the line, with derivatives with respect
/// to s up to the fourth.
struct FrameVelocity {
  std::array<double, 5> along;   ///< A = 1 − κ d, A′, …, A⁗
  std::array<double, 5> across;  ///< B = d′, B′, …, B⁗
};

FrameVelocity frame_velocity(const CurvatureDerivatives& line, const Quintic::Derivatives& d);

/// g and q as the bilinear form that they are in a frame velocity: with u = v the quantities
/// themselves; the part of them that is mixed in two velocities with u ≠ v is what
/// mixed(u, v) + mixed(v, u) gives.
SpeedAndTurn mixed(const CurvatureDerivatives& line, const FrameVelocity& u,
                   const FrameVelocity& v);

/// Exact direction, curvature and derivatives of curvature of the curve; no trigonometry.
/// Accuracy falls as 1/(1 − κ d): about 1e-9 relative at 0.05.
/// @param line   κ … κ⁗ of the reference line; the third derivative needs κ⁗.
/// @param d      d, d′, …, d⁗′ with respect to s, as Quintic::at() gives them.
/// @param least  none is returned where 1 − κ d ≤ least: there the curve is folded or about to be.
std::optional<OffsetCurve> offset_curve(const CurvatureDerivatives& line,
                                        const Quintic::Derivatives& d, double least);

}  // namespace roadbed::geometry::curves
