#pragma once

#include <string>
#include <vector>

#include "roadbed/geometry/curves/fit_curve.h"
#include "roadbed/geometry/curves/smooth_curve.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/reference/reference_point.h"

namespace roadbed::planning::inline reference {

struct ReferenceLineOptions;

/// What a reference line is made of. The line's station 0 is `start_m` of the curve.
struct ReferenceLineData {
  geometry::SmoothCurve curve;
  double start_m = 0.0;
  double goal_s_m = 0.0;
  double largest_move_m = 0.0;
  double corridor_step_m = 1.0;
  std::vector<std::string> notes;
  std::vector<Corridor> corridor;  ///< at stations 0, step, 2 · step, …; not empty
};

/// How a reference line is fitted.
geometry::FitOptions fit_options(const ReferenceLineOptions& options);

/// Room beside a point of a line that lies in or near a lane.
///
/// To each side the road reaches over the own lane and the drivable ones beyond, as long as the
/// marking between may be crossed, and ends past the first lane of the other direction. Distances
/// are along the line's normal to the outermost border.
/// @param fraction     of the lane's length at the point, about, in driving direction.
/// @param reversed  the lane is driven against its direction.
Corridor room_beside(const map::RoadMap& road_map, map::LaneId lane, double fraction,
                     const geometry::CurvePoint& point, double default_speed_mps,
                     bool reversed = false);

/// The same of the lane alone, whoever may cross its markings.
Corridor room_in_lane(const map::RoadMap& road_map, map::LaneId lane, double fraction,
                      const geometry::CurvePoint& point, bool reversed = false);

}  // namespace roadbed::planning::reference
