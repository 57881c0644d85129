#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/map/edit/edited.h"

namespace roadbed::map::inline edit::inline transforming {

/// A motion of a map: turned about the origin of its coordinates, then shifted.
///
/// (1) x′ = R(turn) x + shift
struct RigidMotion {
  double turn_rad = 0.0;
  Eigen::Vector3d shift_m{0.0, 0.0, 0.0};

  Eigen::Vector2d operator()(const Eigen::Vector2d& point) const;
};

/// A turn about a place, which stays.
RigidMotion turn_about(const Eigen::Vector2d& place, double turn_rad);

/// Where a point is, and where it has to be.
struct PointPair {
  Eigen::Vector2d from{0, 0}, to{0, 0};
};

/// The motion that takes points nearest to where they have to be.
struct Alignment {
  RigidMotion motion;
  double rms_m = 0.0, worst_m = 0.0;  ///< what stays between them
};

/// Least squares over all pairs: the turn is that of Σ (x − x̄)ᵀ(y − ȳ) and its cross product, the
/// shift takes one mean to the other [Umeyama 1991, doi:10.1109/34.88573, without a scale].
/// @throws std::invalid_argument if there are fewer than two pairs, or all points are at one place.
Alignment align(std::span<const PointPair> pairs);

struct TransformOptions {
  RigidMotion motion;              ///< done first
  std::optional<std::string> to;   ///< the system that coordinates are brought to, by PROJ
  std::optional<std::string> crs;  ///< what the system is called, in place of what the file says
};

/// A map at another place, or in another coordinate system, as a file of its own format; what of it
/// roadbed does not use stays. Ids and links stay.
/// @throws InputError if the file is unusable, of a format that cannot be moved, or its system is
///         unknown and `to` asks for another, or one of them is not of metres in a plane.
Edited transform(std::string bytes, const std::string& name, const TransformOptions& options);

/// Refuses places that no map may have, as a file with them could not be read again.
/// @param points  in the new coordinates [m].
/// @throws InputError
void require_places(std::span<const Eigen::Vector2d> points, const std::string& name);

/// Refuses a place that is not what is needed.
[[noreturn]] void refuse_place(const Eigen::Vector2d& point, const std::string& needed,
                               const std::string& name);

// Of one format.
//
// OpenDRIVE: each geometry is put to its place, in another system turned and scaled so that it ends
// where the next one begins: stations, lengths and curvatures with it, widths by one scale for the
// map. How far that is off where the system puts its middle is said. Heights stay, but for the
// shift.
Edited transform_open_drive(std::string bytes, const std::string& name,
                            const TransformOptions& options);

// Lanelet2: a motion moves nodes, by latitude and longitude and by `local_x` and `local_y`. Another
// system changes `local_x` and `local_y` only, and is named in the root.
Edited transform_lanelet2(std::string bytes, const std::string& name,
                          const TransformOptions& options);

// CommonRoad: all that has a place, lanelets, signs, obstacles with their trajectories, planning
// problems, and their orientations, which another system turns as in the middle of the map.
// Lengths, widths and speeds stay.
Edited transform_common_road(std::string bytes, const std::string& name,
                             const TransformOptions& options);

}  // namespace roadbed::map::edit::transforming
