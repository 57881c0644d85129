#pragma once

#include <Eigen/Core>
#include <string>

namespace roadbed::map::inline edit::inline merging {

/// What a file's coordinates mean.
struct CoordinateSystem {
  std::string crs;                        ///< empty: unknown
  Eigen::Vector3d offset{0.0, 0.0, 0.0};  ///< of OpenDRIVE's header: x, y, and the turn [rad]
};

/// @throws InputError if the second map's coordinates are not those of the first.
void require_same_system(const CoordinateSystem& first, const std::string& first_name,
                         const CoordinateSystem& second, const std::string& second_name);

}  // namespace roadbed::map::edit::merging
