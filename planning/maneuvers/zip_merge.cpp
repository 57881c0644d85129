#include "roadbed/planning/maneuvers/zip_merge.h"

#include <algorithm>
#include <array>

namespace roadbed::planning::inline maneuvers {
namespace {

constexpr int kPatience = 80;  // steps
constexpr double kStandsStill_mps = 0.3;

bool goes_on(const map::RoadMap& road_map, map::LaneId lane) {
  return std::ranges::any_of(road_map.graph().of(lane).successors, [&](map::LaneId next) {
    return map::is_drivable(road_map.lane(next).type);
  });
}

/// Without braking harder than it may: from its speed to that of who waits, behind that one.
bool can_let_in(const ZipBody& driver, const ZipBody& waits) {
  const double gap_m = driver.to_end_m - waits.to_end_m - waits.length_m;
  const double closing2 = driver.speed_mps * driver.speed_mps - waits.speed_mps * waits.speed_mps;
  return closing2 <= 2.0 * ZipMerge::kMostBraking_mps2 * gap_m;
}

}  // namespace

bool ends_beside(const map::RoadMap& road_map, map::LaneId lane, map::LaneId other) {
  if (!map::is_drivable(road_map.lane(lane).type) || goes_on(road_map, lane)) return false;
  const map::LaneLinks& links = road_map.graph().of(lane);
  return goes_on(road_map, other) &&
         std::ranges::any_of(
             std::array{links.left, links.right}, [&](const std::optional<map::Neighbour>& next) {
               return next && next->lane == other && next->same_direction && next->change_allowed();
             });
}

std::vector<geometry::Pose2> lane_ends(const map::RoadMap& road_map) {
  std::vector<geometry::Pose2> ends;
  for (std::uint32_t i = 0; i < road_map.lanes().size(); ++i) {
    const map::LaneLinks& links = road_map.graph().of(map::LaneId{i});
    const bool may_leave = std::ranges::any_of(
        std::array{links.left, links.right}, [&](const std::optional<map::Neighbour>& next) {
          return next && ends_beside(road_map, map::LaneId{i}, next->lane);
        });
    if (!may_leave) continue;
    const map::Lane& lane = road_map.lane(map::LaneId{i});
    ends.push_back(lane.pose_at(lane.length_m()));
  }
  return ends;
}

bool ZipMerge::is_let_in(std::size_t end, const std::string& body) const {
  return std::ranges::any_of(turns_, [&](const auto& turn) {
    return turn.first.first == end && turn.second.let_in == body && !turn.second.is_over;
  });
}

void ZipMerge::go_on(Turn& turn, const ZipBody& driver, const ZipBody& waits) const {
  if (turn.let_in != waits.id) return;
  const bool both_stand = driver.speed_mps < kStandsStill_mps && waits.speed_mps < kStandsStill_mps;
  turn.stands_for += both_stand ? 1 : 0;
  const bool is_past = driver.to_end_m < waits.to_end_m + waits.length_m;
  turn.is_over = turn.is_over || is_past || turn.stands_for > kPatience;
}

void ZipMerge::update(std::size_t end, const std::vector<ZipBody>& drivers,
                      const std::vector<ZipBody>& waiting) {
  std::erase_if(turns_, [&](const auto& turn) {
    const auto& [at_end, driver] = turn.first;
    return at_end == end && std::ranges::find(drivers, driver, &ZipBody::id) == drivers.end();
  });
  for (const ZipBody& waits : waiting) {
    for (const ZipBody& driver : drivers) {
      const auto turn = turns_.find({end, driver.id});
      if (turn != turns_.end()) {
        go_on(turn->second, driver, waits);
      } else if (!is_let_in(end, waits.id) && driver.to_end_m > waits.to_end_m &&
                 can_let_in(driver, waits)) {
        turns_[{end, driver.id}] = {.let_in = waits.id};
      }
    }
  }
}

std::optional<std::string> ZipMerge::let_in(std::size_t end, const std::string& driver) const {
  const auto turn = turns_.find({end, driver});
  if (turn == turns_.end() || turn->second.is_over) return std::nullopt;
  return turn->second.let_in;
}

}  // namespace roadbed::planning::maneuvers
