#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadbed/geometry/curves/plan_view.h"
#include "roadbed/map/opendrive/budget.h"
#include "roadbed/map/opendrive/lane_borders.h"

namespace roadbed::map::opendrive {

/// A border along a side: its points, and their heights.
struct BorderLine {
  std::vector<Eigen::Vector2d> points;
  std::vector<double> z_m;
};

/// All borders of a side, at the same stations: border 0 is the lane offset, border i the outer one
/// of lane i. Of a lane with <height> records its own borders stand higher than the road's.
struct SideLines {
  std::vector<double> s_m;
  std::vector<BorderLine> borders;
  std::vector<std::vector<LaneHeight>> raised;  ///< by station and lane, or empty: none is
};

/// Borders along a whole side, at stations dense enough that a straight line between neighbouring
/// points is nowhere more than `max_error_m` from the border (proven in plan view from bounds of
/// its second derivative). Where records do not meet, a station occurs twice.
///
/// A border at offset t, with the lateral shape's height h(s, t) there, lies at
/// reference(s) + (t·cos(superelevation) − h·sin(superelevation))·normal(s); its height is
/// elevation + t·sin(superelevation) + h·cos(superelevation) − |t|·tan(crossfall). A lane with
/// level="true" goes on flat from its inner border.
/// @param road_index  of the road, for faults.
/// @throws RoadFault if a border goes where no road can be, or the budget is spent.
SideLines sample_side(const RoadRecord& road, std::size_t road_index,
                      const geometry::PlanView& plan_view, const SectionSide& side,
                      double max_error_m, PointBudget& budget);

}  // namespace roadbed::map::opendrive
