#pragma once

#include <array>
#include <vector>

#include "roadbed/geometry/curves/piecewise_cubic.h"
#include "roadbed/map/opendrive/lateral_shape.h"

namespace roadbed::map::opendrive {

/// How far the road's surface stands above its reference line: <crossSectionSurface> of
/// <lateralProfile> (ASAM OpenDRIVE 1.8, section 10.5.5). Up to two strips on each side:
///
///      outer 2 │ inner 1 │ inner -1 │ outer -2
///      ────────┴─────────┼──────────┴─────────▶ −t
///           width of 1   t_offset
class SurfaceStrips {
 public:
  /// A strip's height is a cubic of the distance dt from its inner edge, which counts negative on
  /// the right; its factors of 1, dt, dt², dt³ are functions of s.
  struct Strip {
    std::array<geometry::PiecewiseCubic, 4> factors;
    geometry::PiecewiseCubic width;  ///< of an inner strip with an outer one
    bool is_there = false;
    bool is_relative = false;  ///< an outer strip that stands on the inner one's outer edge
  };

  struct Side {
    Strip inner, outer;
  };

  SurfaceStrips() = default;
  SurfaceStrips(geometry::PiecewiseCubic t_offset, Side left, Side right);

  bool empty() const { return !left_.inner.is_there && !right_.inner.is_there; }

  /// Where any of its records begins, in order.
  const std::vector<double>& stations_m() const { return stations_m_; }

  /// At s, by the records that hold at `inside_s_m`. On the line between the sides the one of
  /// `sign` counts.
  double height_m(double s_m, double t_m, double inside_s_m, int sign) const;

  /// As LateralShape::bounds, between two stations with no record beginning between them.
  LateralShape::Bounds bounds(double from_s_m, double to_s_m, double t_m,
                              const geometry::CubicValue& t_bounds, int sign) const;

 private:
  geometry::PiecewiseCubic t_offset_;
  Side left_, right_;
  std::vector<double> stations_m_;
};

}  // namespace roadbed::map::opendrive
