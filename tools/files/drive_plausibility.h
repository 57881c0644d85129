#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/motion/vehicle_shape.h"

namespace roadbed::tools::inline files {

/// What cannot be a drive of a vehicle, in rows as a file has them.
struct ImplausibleRow {
  std::size_t row;  ///< from 0
  std::string column, found, needed, remedy;
};

/// A step between rows that no vehicle makes (over 150 m/s, or turning faster than 5 rad/s, beside
/// what noise of 1 m and 0.5 rad does), or headings that fit the way driven as degrees and not as
/// radians. None: the rows may be a drive. O(rows).
/// @param rows  before their headings are unwrapped.
std::optional<ImplausibleRow> implausible_row(const std::vector<geometry::TrajectoryPoint>& rows);

/// Where a drive turns tighter than a vehicle's steering lets it; empty where it does not. Told
/// over a metre of way, so that noise of positions is no bend.
std::string curvature_note(const geometry::Trajectory& drive, const geometry::VehicleShape& shape);

}  // namespace roadbed::tools
