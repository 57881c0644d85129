#pragma once

#include <vector>

#include "roadbed/map/validation/validate.h"

// One function per rule, one source file per theme. Each returns its findings in order of lanes.

namespace roadbed::map::rules {

using Findings = std::vector<Finding>;

// continuity.cpp: where one lane leads to the next
Findings gaps(const RoadMap& road_map, const ValidateOptions& options);
Findings kinks(const RoadMap& road_map, const ValidateOptions& options);

// borders.cpp: the shape of one lane
Findings negative_widths(const RoadMap& road_map, const ValidateOptions& options);
Findings zero_widths(const RoadMap& road_map, const ValidateOptions& options);
Findings folds(const RoadMap& road_map, const ValidateOptions& options);
Findings self_intersections(const RoadMap& road_map, const ValidateOptions& options);

// links.cpp: how lanes are linked
Findings one_sided_links(const RoadMap& road_map, const ValidateOptions& options);
Findings zero_width_links(const RoadMap& road_map, const ValidateOptions& options);
Findings dead_ends(const RoadMap& road_map, const ValidateOptions& options);
Findings separate_parts(const RoadMap& road_map, const ValidateOptions& options);

// attributes.cpp: what lanes and roads say of themselves
Findings missing_speeds(const RoadMap& road_map, const ValidateOptions& options);

// imports.cpp: what the reader of the file has seen
Findings import_remarks(const RoadMap& road_map, const ValidateOptions& options);

}  // namespace roadbed::map::rules
