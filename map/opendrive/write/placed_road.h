#pragma once

#include <array>
#include <vector>

#include "roadbed/geometry/curves/plan_view.h"
#include "roadbed/map/opendrive/write/beside_line.h"
#include "roadbed/map/opendrive/write/end_lines.h"
#include "roadbed/map/opendrive/write/road_plan.h"

namespace roadbed::map::opendrive {

/// A road's reference line, and its borders beside it.
struct PlacedRoad {
  std::vector<geometry::PlanPiece> plan_view;
  std::vector<double> section_from_m;            ///< where each section begins, and the last ends
  std::vector<std::vector<BesideLine>> borders;  ///< by section, from left to right
  /// Between which stations the map has each of them.
  std::vector<std::vector<StationRange>> reach;
  std::array<bool, 2> is_rim{};  ///< whether some border may end before the road does, at its ends
  BesideFaults faults;
  double fault_m = 0.0;  ///< how far it is from being sound, 0 if it is (README)

  /// The reference line's first or last pose.
  geometry::Pose2 end_pose(bool last) const;
  /// Where a border meets the line across the road's first or last end.
  Eigen::Vector2d end_point(bool last, std::size_t border) const;
};

/// Of a road of the map its own reference line and cross-sections. Else the first sound one of
/// reference lines along the border, then along the middle, both ever
/// smoother; else the one with the least faults.
/// @param border  of the first section, which the reference line follows; of a road of the map it
///                follows that road's own.
/// @param most_m  faults that make it useless: is the fault then, and nothing else is told.
PlacedRoad place_road(const RoadMap& road_map, const PlannedRoad& road, std::size_t border,
                      const std::array<EndLine, 2>& ends, double most_m = 1e300);

}  // namespace roadbed::map::opendrive
