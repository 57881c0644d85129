#pragma once

// Private to map/occupancy: more of the plain C interface between the program and the module that
// links PCL (clouds/pcl_filter.h). Points are x y z each.

#include <cstddef>
#include <cstdint>

extern "C" {

/// What its progressive morphological filter is told, in metres; slope is rise over run.
struct RoadbedPclGroundOptions {
  float cell, slope, least_height, most_height, widest;
};

/// The plane z = plane[0] x + plane[1] y + plane[2] that most points lie within `near` of, of those
/// no steeper than `slope`; whether there is one.
using RoadbedPclPlane = bool(const float* xyz, std::size_t count, float slope, float near,
                             float* plane);
RoadbedPclPlane roadbed_pcl_plane;

/// Sets `is_ground` of each point to 1 or 0.
using RoadbedPclGround = void(const float* xyz, std::size_t count,
                              const RoadbedPclGroundOptions* options, std::uint8_t* is_ground);
RoadbedPclGround roadbed_pcl_ground;

/// Sets `cluster` of each point to the number of its Euclidean cluster, counted as they first come,
/// or to -1 where that has fewer than `least` points. Points are in one cluster where steps from
/// point to point, none longer than the tolerance, lead from one to the other. O(n log n).
using RoadbedPclClusters = void(const float* xyz, std::size_t count, double tolerance,
                                std::size_t least, std::int32_t* cluster);
RoadbedPclClusters roadbed_pcl_clusters;

/// Sets the unit normal of each point, x y z, of the plane through its `neighbours` nearest ones,
/// turned towards `viewpoint`; all NaN where there is no plane.
using RoadbedPclNormals = void(const float* xyz, std::size_t count, int neighbours,
                               const float* viewpoint, float* normals);
RoadbedPclNormals roadbed_pcl_normals;
}
