#pragma once

#include <vector>

#include "roadbed/map/sumo/net.h"

namespace roadbed::map::sumo {

using Points = std::vector<Eigen::Vector3d>;  ///< [m], in the map's coordinates

/// Which line of a lane, as its driver sees it.
enum class LineOf { left, centre, right };

/// A lane's line in the direction in which it is driven, from one share of its length to another.
Points line_of(const RoadMap& road_map, DirectedLane way, LineOf line, double from_share = 0.0,
               double to_share = 1.0);

/// The centrelines of a net's lanes.
class LaneLines {
 public:
  LaneLines(const RoadMap& road_map, const Net& net);

  const Points& of(std::uint32_t edge, std::uint32_t lane) const { return lines_[edge][lane]; }

  /// From a lane's end over the lanes inside the junction to the next one's begin.
  Points of(const NetConnection& connection) const;

 private:
  const RoadMap& road_map_;
  const Net& net_;
  std::vector<std::vector<Points>> lines_;
};

}  // namespace roadbed::map::sumo
