#include "roadbed/map/derived/lane_relations.h"

#include <algorithm>

namespace roadbed::map::inline derived {
namespace {

std::vector<LaneId> sorted(std::vector<LaneId> lanes) {
  std::sort(lanes.begin(), lanes.end());
  lanes.erase(std::unique(lanes.begin(), lanes.end()), lanes.end());
  return lanes;
}

/// Goes from lane to lane across the borders of one side; `side` names the member of the links.
std::optional<LaneId> first_against(const LaneGraph& graph, LaneId lane,
                                    std::optional<Neighbour> LaneLinks::*side) {
  for (std::size_t steps = 0; steps < graph.size(); ++steps) {  // neighbours may form a circle
    const std::optional<Neighbour>& beside = graph.of(lane).*side;
    if (!beside) return std::nullopt;
    if (!beside->same_direction) return beside->lane;
    lane = beside->lane;
  }
  return std::nullopt;
}

}  // namespace

std::optional<LaneId> opposite_lane(const LaneGraph& graph, LaneId lane) {
  const std::optional<LaneId> left = first_against(graph, lane, &LaneLinks::left);
  return left ? left : first_against(graph, lane, &LaneLinks::right);
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

}  // namespace roadbed::map::derived
