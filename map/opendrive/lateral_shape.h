#pragma once

#include <vector>

#include "roadbed/geometry/curves/piecewise_cubic.h"

namespace roadbed::map::opendrive {

/// How far the road's surface stands above the plane of its superelevation: <shape> of
/// <lateralProfile> (ASAM OpenDRIVE 1.8, section 10.5.4). Profiles over t at some stations,
/// linear in s between them, constant before the first and after the last.
class LateralShape {
 public:
  /// One profile. Its cubics count from their `t`.
  struct Profile {
    double s_m = 0.0;
    geometry::PiecewiseCubic over_t;
  };

  LateralShape() = default;
  explicit LateralShape(std::vector<Profile> profiles) : profiles_(std::move(profiles)) {}

  bool empty() const { return profiles_.empty(); }
  const std::vector<Profile>& profiles() const { return profiles_; }

  double height_m(double s_m, double t_m) const;

  /// Bounds of |h|, |dh/ds| and |d²h/ds²| along a border, and of the sum of the kinks in dh/ds
  /// where it crosses from one cubic to the next.
  struct Bounds {
    geometry::CubicValue height;
    double kinks = 0.0;
  };

  /// Along a border between two stations with no profile between them.
  /// @param t_m  where the border is in the middle of the stretch.
  /// @param t_bounds  of its |t′| and |t″|; the value is not used.
  Bounds bounds(double from_s_m, double to_s_m, double t_m,
                const geometry::CubicValue& t_bounds) const;

 private:
  std::size_t profile_at(double s_m) const;
  std::vector<Profile> profiles_;
};

}  // namespace roadbed::map::opendrive
