#pragma once

#include <vector>

#include "roadbed/map/road_map.h"
#include "roadbed/map/validation/finding.h"

namespace roadbed::map {

struct ValidateOptions {
  double max_gap_m = 0.01;     ///< between the ends of linked lanes
  double max_kink_rad = 0.05;  ///< between the headings of linked centrelines
};

/// Every fault found, in order of rule and element. Never throws over a faulty map.
std::vector<Finding> validate(const RoadMap& road_map, const ValidateOptions& options = {});

}  // namespace roadbed::map
