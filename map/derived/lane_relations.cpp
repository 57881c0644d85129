#include "roadbed/map/derived/lane_relations.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/map/derived/conflicts.h"

namespace roadbed::map::inline derived {
namespace {

std::vector<LaneId> sorted(std::vector<LaneId> lanes) {
  std::sort(lanes.begin(), lanes.end());
  lanes.erase(std::unique(lanes.begin(), lanes.end()), lanes.end());
  return lanes;
}

/// Goes from lane to lane across the borders of one side, each only once; `side` names the member
/// of the links.
class FirstAgainst {
 public:
  FirstAgainst(const LaneGraph& graph, std::optional<Neighbour> LaneLinks::*side)
      : graph_(graph), side_(side), found_(graph.size()), is_met_(graph.size(), false) {}

  std::vector<std::optional<LaneId>> of_all() {
    for (std::uint32_t i = 0; i < graph_.size(); ++i) {
      if (!is_met_[i]) look_from(LaneId{i});
    }
    return std::move(found_);
  }

 private:
  void look_from(LaneId lane) {
    std::vector<std::size_t> passed;
    std::optional<LaneId> against;
    while (true) {
      is_met_[lane.index] = true;
      passed.push_back(lane.index);
      const std::optional<Neighbour>& beside = graph_.of(lane).*side_;
      if (!beside) break;
      if (!beside->same_direction) {
        against = beside->lane;
        break;
      }
      lane = beside->lane;
      if (is_met_[lane.index]) {  // neighbours may form a circle: then nothing was found yet
        against = found_[lane.index];
        break;
      }
    }
    for (const std::size_t i : passed) found_[i] = against;
  }

  const LaneGraph& graph_;
  std::optional<Neighbour> LaneLinks::*side_;
  std::vector<std::optional<LaneId>> found_;
  std::vector<bool> is_met_;
};

}  // namespace

std::vector<std::optional<LaneId>> opposite_lanes(const LaneGraph& graph) {
  std::vector<std::optional<LaneId>> left = FirstAgainst(graph, &LaneLinks::left).of_all();
  const std::vector<std::optional<LaneId>> right = FirstAgainst(graph, &LaneLinks::right).of_all();
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!left[i]) left[i] = right[i];
  }
  return left;
}

std::vector<Merge> merges(const LaneGraph& graph) {
  std::vector<Merge> found;
  for (std::uint32_t i = 0; i < graph.size(); ++i) {
    Merge merge{LaneId{i}, sorted(graph.of(LaneId{i}).predecessors)};
    if (merge.from.size() > 1) found.push_back(std::move(merge));
  }
  return found;
}

std::vector<LaneId> merging_lanes(const LaneGraph& graph, LaneId lane) {
  std::vector<LaneId> others;
  for (const LaneId successor : graph.of(lane).successors) {
    for (const LaneId other : graph.of(successor).predecessors) {
      if (other != lane) others.push_back(other);
    }
  }
  return sorted(std::move(others));
}

bool begin_oppositely(const RoadMap& road_map, LaneId a, LaneId b) {
  constexpr double opposite_rad = 2.4;
  const auto heading_rad = [&](LaneId of) { return road_map.lane(of).pose_at(0.0).heading_rad; };
  return std::abs(geometry::wrap_angle(heading_rad(a) - heading_rad(b))) > opposite_rad;
}

bool crosses_oncoming(const RoadMap& road_map, LaneId lane) {
  return std::ranges::any_of(find_conflicts_of(road_map, lane), [&](const Conflict& conflict) {
    return conflict.kind == ConflictKind::crossing &&
           begin_oppositely(road_map, lane, conflict.partner_of(lane));
  });
}

bool drives_on_the_left(const RoadMap& road_map) {
  std::ptrdiff_t by_side = 0, by_oncoming = 0;
  for (const Lane& lane : road_map.lanes()) {
    if (!is_drivable(lane.type)) continue;
    const double along_road_m = lane.origin.road_to_s_m - lane.origin.road_from_s_m;
    if (lane.road && lane.one_way && along_road_m != 0.0) {
      const bool on_left = !lane.origin.source_id.starts_with('-');
      by_side += on_left == (along_road_m > 0.0) ? 1 : -1;
    }
    const LaneLinks& links = road_map.graph().of(lane.id);
    const auto meets = [&](const std::optional<Neighbour>& beside) {
      return beside && !beside->same_direction && is_drivable(road_map.lane(beside->lane).type);
    };
    by_oncoming += (meets(links.right) ? 1 : 0) - (meets(links.left) ? 1 : 0);
  }
  return by_side != 0 ? by_side > 0 : by_oncoming > 0;
}

}  // namespace roadbed::map::derived
