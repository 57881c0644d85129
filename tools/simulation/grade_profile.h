#pragma once

#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/route/route.h"

namespace roadbed::tools::inline simulation {

/// How steep a route is, from the heights of its lanes' centres; level where there are none.
class GradeProfile {
 public:
  GradeProfile(const map::RoadMap& road_map, const planning::Route& route,
               const planning::ReferenceLine& line);

  /// Grade over the 10 m around a station of the line, positive uphill.
  double grade_rad(double s_m) const;

 private:
  double height_m(double s_m) const;

  struct Height {
    double s_m, z_m;
  };
  std::vector<Height> heights_;  ///< stations increase
};

}  // namespace roadbed::tools
