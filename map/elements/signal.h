#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

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

}  // namespace roadbed::map::elements
