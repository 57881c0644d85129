#pragma once

// Private to map/occupancy: the plain C interface between the program and the module that links
// PCL, so that neither sees the other's types.

#include <cstddef>
#include <cstdint>

extern "C" {

/// Filters `count` points, x y z each, in place. Returns how many are left.
/// @param nearest  unless null, gets the number of the point that each of them was nearest to.
using RoadbedPclFilter = std::size_t(float* xyz, std::uint32_t* nearest, std::size_t count,
                                     float voxel_m, int neighbours, double deviations);
RoadbedPclFilter roadbed_pcl_filter;
}
