#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "roadbed/geometry/motion/trajectory.h"

namespace roadbed::tools::inline files {

/// Reads a drive: a header line with column names, then a row per state, at increasing times.
///
/// `t_s,x_m,y_m,heading_rad` must be there; `speed_mps,acceleration_mps2,steering_rad,
/// curvature_per_m` are 0 where the column is missing. Order is free; other columns are ignored.
/// Poses are those of the rear axle's centre in source coordinates.
/// @throws InputError naming line and column; also where rows cannot be a drive, see
///         `implausible_row`.
geometry::Trajectory read_trajectory_csv(const std::filesystem::path& file);

/// The same from bytes; `name` stands for the file in messages.
geometry::Trajectory parse_trajectory_csv(std::string_view bytes, const std::string& name);

/// All eight columns, in the order above; reading it gives the same numbers, bit for bit.
std::string write_trajectory_csv(const geometry::Trajectory& drive);

}  // namespace roadbed::tools
