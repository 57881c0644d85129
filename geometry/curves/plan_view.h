#pragma once

#include <array>
#include <optional>
#include <variant>
#include <vector>

#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::geometry::inline curves {

// The curves of OpenDRIVE's plan view, each in its own frame: it starts at the origin along x.

struct LineCurve {};

struct ArcCurve {
  double curvature_per_m;
};

/// Clothoid: curvature is linear in s.
struct SpiralCurve {
  double start_curvature_per_m, end_curvature_per_m;
};

/// v(u) = a + b·u + c·u² + d·u³, u along x; s is the arc length.
struct Poly3Curve {
  double a, b, c, d;
};

/// u(p), v(p) cubic; p is proportional to s and reaches `p_end` at the curve's end.
struct ParamPoly3Curve {
  std::array<double, 4> u, v;
  double p_end;
};

/// Length of the curve from parameter 0 to its end [m], by quadrature.
double arc_length_m(const ParamPoly3Curve& curve);

using PlanCurve = std::variant<LineCurve, ArcCurve, SpiralCurve, Poly3Curve, ParamPoly3Curve>;

/// A curve with its place: `start` is the pose at road station `s_m`.
struct PlanPiece {
  double s_m = 0.0;
  double length_m = 0.0;
  Pose2 start;
  PlanCurve curve;
};

/// The reference line at one station.
struct PlanPoint {
  Pose2 pose;
  double curvature_per_m = 0.0;
};

/// Proven upper bounds over a stretch, derivatives by the road's s:
/// of |position″|, |heading′|, |heading″|, and of position″ across the curve.
struct PlanBounds {
  double second_derivative_per_m = 0.0;
  double heading_d1_per_m = 0.0;
  double heading_d2_per_m2 = 0.0;
  double across_per_m = 0.0;  ///< of position″ · normal
  double slowest = 1.0;       ///< lower bound of |position′|: 1 where s is the arc length

  /// Where s is the arc length: the signed curvature's range.
  struct Range {
    double low_per_m = 0.0, high_per_m = 0.0;
  };
  std::optional<Range> curvature;
};

/// One piece at a station of the road.
PlanPoint plan_point(const PlanPiece& piece, double s_m);

/// Bounds over a stretch of one piece, between stations of the road.
PlanBounds plan_bounds(const PlanPiece& piece, double from_s_m, double to_s_m);

/// A road's reference line in plan view: pieces one after another.
class PlanView {
 public:
  /// @throws std::invalid_argument if there is no piece, a value is not finite, a length is not
  ///         positive or the pieces are not in order of s.
  explicit PlanView(std::vector<PlanPiece> pieces);

  const std::vector<PlanPiece>& pieces() const { return pieces_; }
  double end_s_m() const { return pieces_.back().s_m + pieces_.back().length_m; }

  /// The reference line at s; past an end the nearest piece goes on. Error below 1e-10 m for
  /// curves of up to 10 km.
  PlanPoint at(double s_m) const { return at(s_m, s_m); }

  /// The piece that holds at `piece_s_m`, evaluated at s: the limit from one side where two meet.
  PlanPoint at(double s_m, double piece_s_m) const;

  /// Bounds over a stretch that lies inside one piece (the one of its middle).
  PlanBounds bounds(double from_s_m, double to_s_m) const;

  /// The piece that holds at a station. O(log N).
  const PlanPiece& piece_at(double s_m) const;

 private:
  std::vector<PlanPiece> pieces_;
};

}  // namespace roadbed::geometry::curves
