#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "roadbed/map/elements/lane_graph.h"
#include "roadbed/map/model/load_options.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/opendrive/budget.h"
#include "roadbed/map/opendrive/document.h"
#include "roadbed/map/opendrive/stretch.h"

namespace roadbed::map::opendrive {

/// A lane of the file: index of its road, index of its section, id.
using LaneKey = std::tuple<std::size_t, std::size_t, int>;

struct BuiltLanes {
  std::vector<Lane> lanes;
  std::map<LaneKey, LaneId> ids;
  std::vector<bool> forward;  ///< per lane: it drives towards growing s

  /// Road stations of the vertices of all lanes on one side of a section, and per lane which side
  /// that is.
  std::vector<std::vector<double>> side_stations_m;
  std::vector<std::uint32_t> side_of_lane;

  /// Station on the lane, in driving direction, where the road has that station; clamped to the
  /// lane. O(log vertices).
  double station_m(LaneId lane, double road_s_m) const;
};

/// Stretches along the road as the lane's driver meets them: in that order, by lane station.
template <typename Value>
std::vector<Stretch<Value>> in_driving_order(const BuiltLanes& built, LaneId lane,
                                             std::vector<Stretch<Value>> along_road) {
  const bool forward = built.forward[lane.index];
  if (!forward) std::reverse(along_road.begin(), along_road.end());
  for (Stretch<Value>& stretch : along_road) {
    const double low_m = built.station_m(lane, stretch.from_s_m);
    const double high_m = built.station_m(lane, stretch.to_s_m);
    stretch.from_s_m = forward ? low_m : high_m;
    stretch.to_s_m = forward ? high_m : low_m;
  }
  return along_road;
}

/// All lanes of all roads, sampled; lanes of no length are left out and remarked. The same for any
/// number of threads.
/// @throws RoadFault as sample_side does.
BuiltLanes build_lanes(const Document& document, const std::vector<geometry::PlanView>& plan_views,
                       const std::map<std::string, JunctionId>& junctions,
                       const LoadOptions& options, PointBudget& budget,
                       std::vector<ImportDiagnostic>& remarks);

/// How the lanes connect: along roads, across road ends, through junctions, and side by side.
/// Links that name what is not there are remarked and left out.
std::vector<LaneLinks> link_lanes(const Document& document, const BuiltLanes& built,
                                  std::vector<ImportDiagnostic>& remarks);

}  // namespace roadbed::map::opendrive
