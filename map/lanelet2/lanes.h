#pragma once

#include <vector>

#include "roadbed/map/elements/lane.h"
#include "roadbed/map/lanelet2/document.h"

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

/// All lanelets as lanes; one without two usable borders is left out and remarked.
/// @throws InputError if the borders have more points than a file of this size can mean, or if no
/// lanelet is left.
BuiltLanes build_lanes(Document& document);

/// First and last node of a border in driving direction.
std::uint32_t first_node(const Document& document, const Border& border);
std::uint32_t last_node(const Document& document, const Border& border);

}  // namespace roadbed::map::lanelet2
