#pragma once

#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "roadbed/map/formats/open_drive_budget.h"
#include "roadbed/map/formats/open_drive_document.h"
#include "roadbed/map/road_map.h"

namespace roadbed::map::open_drive {

/// A lane of the file: index of its road, index of its section, id.
using LaneKey = std::tuple<std::size_t, std::size_t, int>;

struct BuiltLanes {
  std::vector<Lane> lanes;
  std::map<LaneKey, LaneId> ids;
  std::vector<bool> forward;  ///< per lane: it drives towards growing s
};

/// All lanes of all roads, sampled; lanes of no length are left out and remarked.
/// @throws RoadFault as sample_side does.
BuiltLanes build_lanes(const Document& document, const std::vector<geometry::PlanView>& plan_views,
                       const std::map<std::string, JunctionId>& junctions, double max_error_m,
                       PointBudget& budget, std::vector<ImportRemark>& remarks);

/// Whether the marking between a lane and the next one outwards (or, for lane 0, the marking in
/// the middle) may be crossed, by travel towards growing or falling lane ids.
struct Crossing {
  bool to_larger_id = false, to_smaller_id = false;
};
Crossing crossing(const std::vector<RoadMark>& marks, int lane_id, double section_length_m);

}  // namespace roadbed::map::open_drive
