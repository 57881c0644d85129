#pragma once

#include <Eigen/Core>

namespace roadbed::planning::inline reference {

/// Support points that a reference line may have: 75 km at steps of 0.5 m, 240 MB while it is made.
inline constexpr double kMostSupportPoints = 150'000.0;

/// The reference line at one station. Derivatives are with respect to arc length.
struct ReferencePoint {
  double s_m = 0.0;
  Eigen::Vector2d in_map{0, 0};
  double heading_rad = 0.0;          ///< continuous along the line, not wrapped
  double curvature_per_m = 0.0;      ///< κ, positive to the left
  double curvature_d1_per_m2 = 0.0;  ///< κ′
  double curvature_d2_per_m3 = 0.0;  ///< κ″
  double curvature_d3_per_m4 = 0.0;  ///< κ‴
  double curvature_d4_per_m5 = 0.0;  ///< κ⁗, continuous as all before
};

/// Room beside the line and what the map says there: the own lane, its neighbours in the same
/// direction across markings that may be crossed, and the lane of the other direction where its
/// marking may be crossed too, as for passing a parked car.
struct Corridor {
  double left_m = 0.0;   ///< distance to the left edge of the drivable road, ≥ 0
  double right_m = 0.0;  ///< distance to the right edge, ≥ 0
  double speed_limit_mps = 0.0;
};

}  // namespace roadbed::planning::reference
