#include "roadbed/map/lanelet2/write/write.h"

#include <fmt/format.h>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/lanelet2/frame.h"
#include "roadbed/map/lanelet2/write/lanelet_map.h"

namespace roadbed::map::lanelet2 {
namespace {

TransverseMercator grid_of(const std::string& crs) {
  if (const auto grid = transverse_mercator_of(crs)) return *grid;
  throw InputError(
      {.file = "Lanelet2",
       .found = crs.empty()
                    ? "the map's CRS is unknown"
                    : fmt::format("the map's CRS \"{}\" is no transverse Mercator one", crs),
       .needed = "latitude and longitude of its nodes",
       .remedy = "give --anchor LAT,LON: where its coordinates 0,0 are"});
}

std::string text_of(const RoadMap& road_map, const OsmMap& osm, const Lanelet2Options& options,
                    const TransverseMercator& grid) {
  const CrsOffset& offset = options.offset_in_crs;
  const geometry::Pose2 crs_from_source{offset.x_m, offset.y_m, offset.heading_rad};
  OsmFrame frame{.z_offset_m = offset.z_m, .crs = {}};
  if (offset == CrsOffset{}) frame.crs = options.crs;
  return osm_text(osm, frame, [&](std::size_t i) {
    const Eigen::Vector2d local = road_map.to_source(osm.nodes[i].in_map.head<2>());
    return OsmPlace{grid.inverse(crs_from_source * local), local};
  });
}

std::vector<std::pair<std::string, std::size_t>> lost_of(const RoadMap& road_map,
                                                         const LaneletMap& made) {
  std::vector<std::pair<std::string, std::size_t>> lost;
  if (made.left_out > 0) lost.emplace_back("lanes that nobody may use", made.left_out);
  const std::size_t limits = flattened_limits(road_map, made);
  if (limits > 0) lost.emplace_back(kFlattenedLimits, limits);
  if (is_from_lanelet2(road_map)) return lost;
  for (const auto& [what, count] : {std::pair{"junctions", road_map.junctions().size()},
                                    {"controllers", road_map.controllers().size()},
                                    {"regulations", road_map.regulations().size()}}) {
    if (count > 0) lost.emplace_back(what, count);
  }
  return lost;
}

}  // namespace

Lanelet2File write_lanelet2(const RoadMap& road_map, const Lanelet2Options& options) {
  const TransverseMercator grid = grid_of(options.crs);
  const LaneletMap made = lanelet_map(road_map);
  return {text_of(road_map, made.osm, options, grid), notes_of(made), lost_of(road_map, made)};
}

Lanelet2File write_lanelet2(const RoadMap& road_map) {
  return write_lanelet2(road_map, {road_map.crs(), road_map.offset_in_crs()});
}

}  // namespace roadbed::map::lanelet2
