#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/elements/attributes.h"
#include "roadbed/map/elements/id.h"
#include "roadbed/map/elements/participants.h"

namespace roadbed::map::inline elements {

/// A thing on or beside the road: crosswalk, parking space, building, pole.
struct MapObject {
  std::string source_id, name;
  std::string type;  ///< the source's word: "crosswalk", "parkingSpace", …
  std::optional<RoadId> road;
  double road_s_m = 0.0, road_t_m = 0.0;  ///< 0 without a road
  Eigen::Vector2d in_map{0, 0};
  geometry::Ring outline_in_map;  ///< counter-clockwise; empty for a point
  double z_m = 0.0, height_m = 0.0;
  Attributes attributes;
};

/// An area without a direction of travel: Lanelet2's area, a road surface of a GeoJSON file.
struct Area {
  std::string source_id;
  std::string type;      ///< the source's word: "parking", "walkway", …
  bool is_road = false;  ///< vehicles may be there
  std::vector<geometry::Polygon> in_map;
  Participants participants;
  Attributes attributes;
};

}  // namespace roadbed::map::elements
