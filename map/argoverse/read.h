#pragma once

#include <string>
#include <string_view>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::argoverse {

/// Whether bytes begin a map of Argoverse 2: a JSON object whose first key is one of its lists.
bool is_argoverse(std::string_view bytes);

/// An Argoverse 2 map (`log_map_archive_*.json`) [Wilson 2021, "Argoverse 2: Next Generation
/// Datasets for Self-Driving Perception and Forecasting", NeurIPS Datasets and Benchmarks]: lane
/// segments, pedestrian crossings and drivable areas in city coordinates [m].
///
/// Successors are the graph, as in the `av2` package; a predecessor that is not answered by one is
/// remarked. Where the name of the file says the city (`…____PIT_city_57819.json`), the CRS is the
/// city's UTM zone and its offset; where there is a ground height raster in the same folder, points
/// without a height get theirs from it.
/// @param name  the file as the user named it.
/// @throws InputError if the file is no such map or a value of it is unusable.
RoadMapParts read(const std::string& bytes, const std::string& name);

}  // namespace roadbed::map::argoverse
