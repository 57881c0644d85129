#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/elements/attributes.h"
#include "roadbed/map/elements/id.h"

namespace roadbed::map::inline elements {

/// A sign or light.
struct Signal {
  std::string source_id;
  std::string name;
  std::optional<RoadId> road;             ///< none in Lanelet2 and CommonRoad
  double road_s_m = 0.0, road_t_m = 0.0;  ///< 0 without a road
  Eigen::Vector2d in_map{0, 0};
  double z_m = 0.0;
  std::optional<double> heading_rad;  ///< in which it faces, if known
  std::string country, type, subtype;
  std::optional<double> value;
  std::string unit;
  std::string text;
  bool dynamic = false;          ///< changes, as a light does
  std::vector<LaneId> lanes;     ///< that it speaks to
  std::vector<double> lane_s_m;  ///< its station on each of them; empty: unknown
  Attributes attributes;
};

/// Signals that are switched together: OpenDRIVE's controller.
struct Controller {
  std::string source_id, name;
  std::vector<std::string> signals;  ///< source ids
  Attributes attributes;
};

/// Where vehicles of some lanes stop.
struct StopLine {
  std::string source_id;
  std::vector<Eigen::Vector3d> in_map;  ///< two points or more, x y z [m]
  std::vector<LaneId> lanes;
  std::vector<std::string> signals;  ///< source ids of those that say when to stop
};

/// What a regulation refers to: a lane, or a line or point by its coordinates.
struct RegulationMember {
  std::string role;       ///< as in Lanelet2: "refers", "ref_line", "yield", "right_of_way", …
  std::string source_id;  ///< of the element
  std::optional<LaneId> lane;
  std::vector<Eigen::Vector3d> in_map;  ///< points of a line, one of a point; empty for a lane
  Attributes attributes;                ///< the element's own
};

/// A traffic rule that holds on some lanes, whatever kind it is: Lanelet2's regulatory element,
/// CommonRoad's intersection. Kinds that nobody here knows are kept like all others.
struct Regulation {
  std::string source_id;
  std::string type;  ///< "traffic_light", "right_of_way", "speed_limit", "intersection", …
  std::vector<LaneId> lanes;  ///< on which it holds
  std::vector<RegulationMember> members;
  Attributes attributes;
};

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

}  // namespace roadbed::map::elements
