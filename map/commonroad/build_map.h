#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/commonroad/document.h"
#include "roadbed/map/elements/lane.h"
#include "roadbed/map/elements/lane_graph.h"
#include "roadbed/map/model/road_map.h"

// The steps from a document to a map. What they leave out or mend they remark.

namespace roadbed::map::commonroad {

/// The lanes of a file, and the element that each was made of.
struct BuiltLanes {
  std::vector<Lane> lanes;
  std::vector<pugi::xml_node> elements;  ///< one per lane
  std::map<std::string, LaneId, std::less<>> ids;

  std::optional<LaneId> find(std::string_view source_id) const;
};

/// All lanelets as lanes, without their links. Lanelets that enclose no strip (a border of one
/// point, no length, an id that another one has) are remarked and left out.
/// @throws InputError if a coordinate is unusable.
BuiltLanes build_lanes(const Document& document, const Eigen::Vector2d& origin_in_source,
                       std::vector<ImportDiagnostic>& remarks);

/// How the lanes connect: `successor`, `predecessor`, `adjacentLeft`, `adjacentRight`.
///
/// A link of lanes that do not touch, or of which only one of the two speaks, is remarked; the
/// first is left out, the second holds for both. Lanes may be changed where the line marking can be
/// crossed, without one between lanes of the same direction, and only where the two borders run
/// within 1 m of each other.
std::vector<LaneLinks> link_lanes(const Document& document, const BuiltLanes& built,
                                  std::vector<ImportDiagnostic>& remarks);

/// Signs, lights, stop lines and intersections, added to the parts; speed limits are set on the
/// lanes that refer to such a sign (of several the least), lanes inside an intersection get its
/// junction. References to what is not there are remarked.
/// @param country  "DEU", or empty.
void add_rules(const Document& document, const std::string& country, BuiltLanes& built,
               RoadMapParts& parts);

}  // namespace roadbed::map::commonroad
