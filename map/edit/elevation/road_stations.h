#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/opendrive/document.h"

namespace roadbed::map::inline edit::inline elevation {

/// A straight line across a road: height over t.
struct CrossLine {
  std::optional<double> height_m;  ///< at the reference line
  std::optional<double> slope;     ///< rise towards the left, per metre
};

/// A station of a road of OpenDRIVE, and places across its carriageway.
struct RoadStation {
  double s_m = 0.0;
  geometry::Pose2 reference_in_source;
  double right_t_m = 0.0, left_t_m = 0.0;  ///< outermost borders that are driven between

  static constexpr std::size_t kPlaces = 5;
  double t_m(std::size_t place) const;
  Eigen::Vector2d place_in_source(double t_m) const;

  /// Least squares through heights at the places; the slope where three are known or more, over
  /// half the width.
  CrossLine line_through(const std::array<std::optional<double>, kPlaces>& heights_m) const;
};

/// Stations so far apart, and both ends. Sidewalks, kerbs, medians and lanes of no type are no
/// carriageway; a road that has nothing else is one all over.
/// @param road  as `opendrive::mend` leaves it.
std::vector<RoadStation> stations_of(const opendrive::RoadRecord& road,
                                     const Eigen::Vector2d& origin_in_source, double apart_m);

}  // namespace roadbed::map::edit::elevation
