#pragma once

#include <span>
#include <vector>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline derived {

/// A lane between two of its cross-sections, which go straight from border to border.
struct LanePiece {
  LaneId lane;
  StationRange range;
  Eigen::Vector2d left_from, left_to, right_from, right_to;
  double z_m;  ///< of the centreline halfway

  geometry::Box box() const;
};

/// All drivable lanes piece by piece, cut where either border has a vertex; by lane, then station.
std::vector<LanePiece> drivable_pieces(const RoadMap& road_map);

/// The same of the drivable ones among some lanes, in their order.
std::vector<LanePiece> drivable_pieces(const RoadMap& road_map, std::span<const LaneId> lanes);

}  // namespace roadbed::map::derived
