#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/elements/lane.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/map/model/road_map.h"

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
BuiltLanes build_lanes(const XmlDocument& xml, const Eigen::Vector2d& origin_in_source,
                       std::vector<ImportDiagnostic>& remarks);

/// What a `lineMarking` child of a bound says; none if nothing.
std::optional<BorderMark> read_marking(pugi::xml_node bound);

}  // namespace roadbed::map::commonroad
