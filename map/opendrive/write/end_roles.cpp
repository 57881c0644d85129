#include "roadbed/map/opendrive/write/end_roles.h"

#include <algorithm>
#include <set>

#include "roadbed/map/opendrive/write/road_lines.h"

namespace roadbed::map::opendrive {
namespace {

using EndPair = std::pair<std::uint32_t, std::uint32_t>;

class RoleFinder {
 public:
  RoleFinder(const RoadMap& road_map, const RoadPlan& plan) : plan_(plan) {
    found_.roles.assign(2 * plan.roads.size(), EndRole::free);
    found_.partner.resize(2 * plan.roads.size());
    found_.is_apart.resize(plan.roads.size());
    found_.groups = joined_ends(road_map, plan);
    for (const Lane& lane : road_map.lanes()) {
      const auto from = exit_end(plan, lane.id);
      if (!from) continue;
      for (const LaneId next : road_map.graph().of(lane.id).successors) {
        if (const auto to = entry_end(plan, next)) add(*from, *to, {lane.id, next});
      }
    }
  }

  EndRoles find() {
    for (const auto& [group, pairs] : pairs_) set_roles(pairs);
    return std::move(found_);
  }

 private:
  void add(std::uint32_t from, std::uint32_t to, const std::pair<LaneId, LaneId>& lanes) {
    if (from == to) {
      ++found_.lost_links;
      return;
    }
    found_.joints[{from, to}].push_back(lanes);
    pairs_[found_.groups[from]].insert({from, to});
  }

  void set_roles(const std::set<EndPair>& pairs) {
    std::set<std::uint32_t> ends;
    for (const auto& [from, to] : pairs) ends.insert({from, to});
    if (ends.size() == 2) {
      const std::uint32_t a = *ends.begin(), b = *ends.rbegin();
      found_.roles[a] = found_.roles[b] = EndRole::plain;
      found_.partner[a] = b;
      found_.partner[b] = a;
      return;
    }
    const auto hub = std::find_if(ends.begin(), ends.end(), [&](std::uint32_t end) {
      return std::all_of(pairs.begin(), pairs.end(), [&](const EndPair& pair) {
        return pair.first == end || pair.second == end;
      });
    });
    if (hub == ends.end()) {
      set_mesh(pairs, ends);
      return;
    }
    for (const std::uint32_t end : ends) {
      found_.roles[end] = end == *hub ? EndRole::hub : EndRole::spoke;
      if (end != *hub) keep_apart(end);
    }
  }

  void set_mesh(const std::set<EndPair>& pairs, const std::set<std::uint32_t>& ends) {
    for (const auto& [from, to] : pairs) {
      found_.roles[from] = EndRole::mesh_exit;
      found_.roles[to] = EndRole::mesh_entry;
    }
    for (const std::uint32_t end : ends) keep_apart(end);
  }

  void keep_apart(std::uint32_t end) {
    if (plan_.roads[end / 2].has_both_ways()) found_.is_apart[end / 2] = true;
  }

  const RoadPlan& plan_;
  EndRoles found_;
  std::map<std::uint32_t, std::set<EndPair>> pairs_;
};

}  // namespace

EndRoles find_end_roles(const RoadMap& road_map, const RoadPlan& plan) {
  return RoleFinder(road_map, plan).find();
}

}  // namespace roadbed::map::opendrive
