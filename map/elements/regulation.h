#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/elements/attributes.h"
#include "roadbed/map/elements/id.h"

namespace roadbed::map::inline elements {

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

}  // namespace roadbed::map::elements
