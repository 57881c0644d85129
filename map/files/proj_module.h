#pragma once

// Private to map/files/projection.cpp: the plain C interface between the program and the module
// that links PROJ.

#include <cstddef>

extern "C" {

/// Turns `count` pairs of easting and northing in `crs` into longitude and latitude in degrees
/// (WGS 84), in place, or back. What PROJ needs for the system that was asked for last is kept for
/// the thread. Returns 0; or 1, and says why in `message`.
using RoadbedProjLonLat = int(const char* crs, int to_lon_lat, double* xy, std::size_t count,
                              char* message, std::size_t message_size);
RoadbedProjLonLat roadbed_proj_lon_lat;

/// Writes the horizontal part of `crs` as well-known text (WKT 1). Returns 0; or 1, and says why.
using RoadbedProjWkt = int(const char* crs, char* wkt, std::size_t wkt_size, char* message,
                           std::size_t message_size);
RoadbedProjWkt roadbed_proj_wkt;
}
