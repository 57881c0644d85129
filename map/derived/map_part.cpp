#include "roadbed/map/derived/map_part.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "roadbed/map/index/road_map_index.h"

namespace roadbed::map::inline derived {
namespace {

/// What is kept of one kind, in the order in which it is first asked for, and its numbers.
template <typename Number>
class Kept {
 public:
  Number keep(Number of_whole) {
    const auto [at, is_new] =
        numbers_.try_emplace(of_whole.index, Number{static_cast<std::uint32_t>(of_whole_.size())});
    if (is_new) of_whole_.push_back(of_whole);
    return at->second;
  }

  std::optional<Number> keep(const std::optional<Number>& of_whole) {
    return of_whole ? std::optional(keep(*of_whole)) : std::nullopt;
  }

  std::optional<Number> find(const std::optional<Number>& of_whole) const {
    const auto at = of_whole ? numbers_.find(of_whole->index) : numbers_.end();
    return at == numbers_.end() ? std::nullopt : std::optional(at->second);
  }

  std::vector<Number> find(const std::vector<Number>& of_whole) const {
    std::vector<Number> found;
    for (const Number id : of_whole) {
      if (const auto number = find(std::optional(id))) found.push_back(*number);
    }
    return found;
  }

  const std::vector<Number>& of_whole() const { return of_whole_; }

 private:
  std::unordered_map<std::uint32_t, Number> numbers_;
  std::vector<Number> of_whole_;
};

class Part {
 public:
  Part(const RoadMap& whole, const Eigen::AlignedBox2d& box_in_map)
      : whole_(whole), box_(box_in_map) {
    static_cast<MapHead&>(parts_) = whole.content();
  }

  RoadMap made() && {
    add_lanes();
    add_roads();
    add_furniture();
    add_regulations();
    return RoadMap(std::move(parts_));
  }

 private:
  void add_lanes() {
    if (box_.isEmpty()) return;
    for (const LaneId id : whole_.index().lanes.in_box(box_.min(), box_.max(), LaneTypes::all())) {
      lanes_.keep(id);
    }
    for (const LaneId id : lanes_.of_whole()) {
      Lane lane = whole_.lane(id);
      lane.id = *lanes_.find(std::optional(id));
      lane.road = roads_.keep(lane.road);
      lane.junction = junctions_.keep(lane.junction);
      parts_.lanes.push_back(std::move(lane));
      parts_.links.push_back(links_of(id));
    }
  }

  LaneLinks links_of(LaneId id) const {
    const LaneLinks& links = whole_.graph().of(id);
    const auto neighbour = [&](const std::optional<Neighbour>& to) -> std::optional<Neighbour> {
      const auto lane = to ? lanes_.find(std::optional(to->lane)) : std::nullopt;
      if (!lane) return std::nullopt;
      return Neighbour{*lane, to->same_direction, to->change_windows};
    };
    return {lanes_.find(links.successors), lanes_.find(links.predecessors), neighbour(links.left),
            neighbour(links.right)};
  }

  void add_roads() {
    for (const RoadId id : roads_.of_whole()) {
      Road road = whole_.road(id);
      road.id = *roads_.find(std::optional(id));
      road.junction = junctions_.keep(road.junction);
      road.lanes = lanes_.find(road.lanes);
      parts_.roads.push_back(std::move(road));
    }
    for (const JunctionId id : junctions_.of_whole()) {
      Junction junction = whole_.junction(id);
      junction.id = *junctions_.find(std::optional(id));
      junction.connecting_roads = roads_.find(junction.connecting_roads);
      parts_.junctions.push_back(std::move(junction));
    }
  }

  bool is_near(const auto& points_in_map) const {
    Eigen::AlignedBox2d box;
    for (const auto& point : points_in_map) box.extend(Eigen::Vector2d(point.template head<2>()));
    return box_.intersects(box);
  }

  void add_furniture() {
    for (Signal signal : whole_.signals()) {
      if (!box_.contains(signal.in_map)) continue;
      signal.road = roads_.find(signal.road);
      std::vector<double> stations_m;
      for (std::size_t i = 0; i < signal.lane_s_m.size() && i < signal.lanes.size(); ++i) {
        if (lanes_.find(std::optional(signal.lanes[i]))) stations_m.push_back(signal.lane_s_m[i]);
      }
      signal.lane_s_m = std::move(stations_m);
      signal.lanes = lanes_.find(signal.lanes);
      parts_.signals.push_back(std::move(signal));
    }
    for (const Controller& controller : whole_.controllers()) {
      const auto is_kept = [&](const std::string& id) {
        return std::ranges::find(parts_.signals, id, &Signal::source_id) != parts_.signals.end();
      };
      if (std::ranges::any_of(controller.signals, is_kept))
        parts_.controllers.push_back(controller);
    }
    for (StopLine line : whole_.stop_lines()) {
      if (!is_near(line.in_map)) continue;
      line.lanes = lanes_.find(line.lanes);
      parts_.stop_lines.push_back(std::move(line));
    }
    for (MapObject object : whole_.objects()) {
      if (!box_.contains(object.in_map) && !is_near(object.outline_in_map)) continue;
      object.road = roads_.find(object.road);
      parts_.objects.push_back(std::move(object));
    }
    for (const Area& area : whole_.areas()) {
      const auto near = [&](const geometry::Polygon& polygon) { return is_near(polygon.outer); };
      if (std::ranges::any_of(area.in_map, near)) parts_.areas.push_back(area);
    }
  }

  void add_regulations() {
    for (Regulation regulation : whole_.regulations()) {
      regulation.lanes = lanes_.find(regulation.lanes);
      if (regulation.lanes.empty()) continue;
      std::erase_if(regulation.members, [&](const RegulationMember& member) {
        return member.lane && !lanes_.find(member.lane);
      });
      for (RegulationMember& member : regulation.members) member.lane = lanes_.find(member.lane);
      parts_.regulations.push_back(std::move(regulation));
    }
  }

  const RoadMap& whole_;
  const Eigen::AlignedBox2d box_;
  RoadMapParts parts_;
  Kept<LaneId> lanes_;
  Kept<RoadId> roads_;
  Kept<JunctionId> junctions_;
};

}  // namespace

RoadMap map_part(const RoadMap& whole, const Eigen::AlignedBox2d& box_in_map) {
  return Part(whole, box_in_map).made();
}

}  // namespace roadbed::map::derived
