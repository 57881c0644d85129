#include "roadbed/map/derived/conflicts.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/derived/lane_piece.h"

namespace roadbed::map::inline derived {
namespace {

/// What is stacked as a whole: a road, or a lane of no road (numbered after all roads).
std::size_t group_of(const RoadMap& road_map, LaneId id) {
  const Lane& lane = road_map.lane(id);
  return lane.road ? lane.road->index : road_map.roads().size() + id.index;
}

using Stacked = std::set<std::pair<std::size_t, std::size_t>>;  ///< lower and upper group

/// Pieces stand for their boxes here: it is enough for a picture, and bridges are long. Where more
/// than most_steps() of them meet, those that are met then are stacked no more.
Stacked stacked_groups(const RoadMap& road_map, double headroom_m) {
  const std::vector<LanePiece> pieces = drivable_pieces(road_map);
  std::vector<geometry::Box> boxes;
  boxes.reserve(pieces.size());
  for (const LanePiece& piece : pieces) boxes.push_back(piece.box());
  const geometry::BoxTree tree(boxes);
  Stacked stacked;
  geometry::WorkBudget steps(geometry::most_steps(pieces.size()));
  for (std::size_t i = 0; i < pieces.size() && !steps.is_spent(); ++i) {
    tree.visit(boxes[i], [&](std::size_t below) {
      if (!steps.spend(1) || pieces[i].z_m - pieces[below].z_m <= headroom_m) return;
      stacked.emplace(group_of(road_map, pieces[below].lane), group_of(road_map, pieces[i].lane));
    });
  }
  return stacked;
}

}  // namespace

std::vector<int> levels_of_lanes(const RoadMap& road_map, double headroom_m) {
  constexpr int kMostLevels = 8;  // roads that wind around each other have no end
  const Stacked stacked = stacked_groups(road_map, headroom_m);
  std::vector<int> level(road_map.roads().size() + road_map.lanes().size(), 0);
  for (int pass = 0; pass < kMostLevels; ++pass) {
    for (const auto& [lower, upper] : stacked) {
      level[upper] = std::min(std::max(level[upper], level[lower] + 1), kMostLevels);
    }
  }
  std::vector<int> of_lanes;
  for (const Lane& lane : road_map.lanes()) of_lanes.push_back(level[group_of(road_map, lane.id)]);
  return of_lanes;
}

}  // namespace roadbed::map::derived
