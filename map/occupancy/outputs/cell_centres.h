#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "roadbed/map/occupancy/octree/occupancy_source.h"

namespace roadbed::map::inline occupancy::inline outputs {

/// The middle of every occupied cell of the finest size, in source coordinates; larger leaves are
/// as many cells as they hold. In the octree's order.
/// @param name  of the octree's file, for messages.
/// @throws InputError if there are more than a hundred million.
std::vector<Eigen::Vector3d> occupied_centres(const OccupancySource& occupancy,
                                              const std::string& name);

/// Whether floats hold coordinates as well as a cell needs: all within 4,096 m of 0.
bool fit_in_floats(const std::vector<Eigen::Vector3d>& points);

/// Points as binary PCD 0.7: floats where these do, else doubles, which PCL's own reader takes for
/// zeros.
/// @param normals  of each point, as normal_x normal_y normal_z; empty: none are written.
std::string points_as_pcd(const std::vector<Eigen::Vector3d>& points,
                          const std::vector<Eigen::Vector3f>& normals = {});

/// The same as binary PLY 1.0, little-endian; normals are nx ny nz.
std::string points_as_ply(const std::vector<Eigen::Vector3d>& points,
                          const std::vector<Eigen::Vector3f>& normals = {});

}  // namespace roadbed::map::occupancy::outputs
