#pragma once

#include <optional>
#include <vector>

#include "roadbed/map/elements/lane.h"
#include "roadbed/map/elements/lane_graph.h"
#include "roadbed/map/lanelet2/document.h"
#include "roadbed/map/model/road_map.h"

// The steps from a document to a map, in this order. What they leave out they remark in it.

namespace roadbed::map::lanelet2 {

/// A lane's border: which way of the file it is, and whether the lane runs against it.
struct Border {
  std::uint32_t way = 0;
  bool reversed = false;
  auto operator<=>(const Border&) const = default;
};

struct BuiltLanes {
  std::vector<Lane> lanes;
  std::vector<Border> left, right;       ///< one per lane
  std::vector<std::uint32_t> relations;  ///< one per lane: its place in Document::relations
  std::vector<std::optional<LaneId>> lane_of_relation;  ///< one per relation
};

struct LinkedLanes {
  std::vector<LaneLinks> links;  ///< one per lane
  std::vector<ImportDiagnostic> remarks;
};

/// All lanelets as lanes; one without two usable borders is left out and remarked.
/// @param threads  that may be used.
/// @throws InputError if the borders have more points than a file of this size can mean, or if no
/// lanelet is left.
BuiltLanes build_lanes(Document& document, int threads = 1);

/// First and last node of a border in driving direction.
std::uint32_t first_node(const Document& document, const Border& border);
std::uint32_t last_node(const Document& document, const Border& border);

/// Lane links as Lanelet2's routing graph has them, for all road users: a lane follows another if
/// it begins with the two nodes that the other one ends with and somebody may use both; lanes are
/// neighbours if they share a border way. Of several neighbours on one side, that of the same
/// direction and the same users comes first, then the one that comes first in the file. Where more
/// than 64 lanes meet, the rest is left out and remarked. Looks neither at speed limits nor at
/// which ways are used, so that these may be found meanwhile.
LinkedLanes link_lanes(const Document& document, const BuiltLanes& built);

/// Regulatory elements of every kind, with what they refer to; those nobody here knows are kept
/// like all others. Adds the signs, lights and stop lines that they name, and the limits of
/// speed_limit elements to their lanes.
void add_regulations(Document& document, BuiltLanes& built, RoadMapParts& parts);

/// Multipolygons as areas: their rings put together from ways that share end nodes. One whose rings
/// do not close is left out and remarked.
void add_areas(Document& document, RoadMapParts& parts);

/// Closed lines (`area=yes`) as objects with an outline: parking lots, intersection areas.
void add_objects(Document& document, RoadMapParts& parts);

}  // namespace roadbed::map::lanelet2
