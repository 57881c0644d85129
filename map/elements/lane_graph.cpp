#include "roadbed/map/elements/lane_graph.h"

#include <fmt/format.h>

#include <stdexcept>

namespace roadbed::map::inline elements {

LaneGraph::LaneGraph(std::vector<LaneLinks> links) : links_(std::move(links)) { check(); }

void LaneGraph::check() const {
  const auto check = [this](LaneId id) {
    if (id.index >= links_.size()) {
      throw std::invalid_argument(
          fmt::format("LaneGraph: a link names lane {} of {}", id.index, links_.size()));
    }
  };
  for (const LaneLinks& of_lane : links_) {
    for (const LaneId id : of_lane.successors) check(id);
    for (const LaneId id : of_lane.predecessors) check(id);
    if (of_lane.left) check(of_lane.left->lane);
    if (of_lane.right) check(of_lane.right->lane);
  }
}

}  // namespace roadbed::map::elements
