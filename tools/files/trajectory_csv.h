#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/motion/vehicle_shape.h"

namespace roadbed::tools::inline files {

/// Reads a drive: a header line with column names, then a row per state, at increasing times.
///
/// `t_s,x_m,y_m,heading_rad` must be there; without `speed_mps` speeds follow from the poses, and
/// `acceleration_mps2,steering_rad,curvature_per_m` are 0 where the column is missing. Order is
/// free; other columns are ignored. Poses are those of the rear axle's centre in source
/// coordinates.
/// @throws InputError naming line and column; also where rows cannot be a drive, see
///         `implausible_row`.
geometry::Trajectory read_trajectory_csv(const std::filesystem::path& file);

/// The same from bytes; `name` stands for the file in messages.
geometry::Trajectory parse_trajectory_csv(std::string_view bytes, const std::string& name);

/// All eight columns, in the order above; reading it gives the same numbers, bit for bit.
std::string write_trajectory_csv(const geometry::Trajectory& drive);

/// Of row `i`, along the body, over the steps before and behind it; 0 where there is only one row.
double speed_of_way_mps(const std::vector<geometry::TrajectoryPoint>& rows, std::size_t i);

/// What cannot be a drive of a vehicle, in rows as a file has them.
struct ImplausibleRow {
  std::size_t row;  ///< from 0
  std::string column, found, needed, remedy;
};

/// A step between rows that no vehicle makes (over 150 m/s, or turning faster than 5 rad/s, beside
/// what noise of 1 m and 0.5 rad does), headings that fit the path driven as degrees and not as
/// radians, or rows so far apart that they make a way of over 20 km and 100 m for each of them.
/// None: the rows may be a drive. O(rows).
/// @param rows  before their headings are unwrapped.
std::optional<ImplausibleRow> implausible_row(const std::vector<geometry::TrajectoryPoint>& rows);

/// Its first part alone, where headings are in radians for sure.
std::optional<ImplausibleRow> impossible_step(const std::vector<geometry::TrajectoryPoint>& rows);

/// Where a drive turns tighter than a vehicle's steering lets it; empty where it does not. Told
/// over a metre of path, so that noise of positions is no bend.
std::string curvature_note(const geometry::Trajectory& drive, const geometry::VehicleShape& shape);

}  // namespace roadbed::tools::files
