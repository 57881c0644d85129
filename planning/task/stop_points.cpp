#include "roadbed/planning/task/stop_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/map/derived/conflicts.h"
#include "roadbed/map/derived/lane_relations.h"
#include "roadbed/map/derived/rule_index.h"
#include "roadbed/planning/task/give_way_rules.h"
#include "roadbed/planning/task/lane_join.h"

namespace roadbed::planning::inline task {
namespace {

using map::LaneId;
using map::RulePlace;

constexpr double kTurns_rad = 0.8;  // by less a lane goes straight on
constexpr double kBeforeConflict_m = 0.5;
constexpr double kSameWaitingPlace_m = 0.5;

std::vector<LaneId> lanes_of(const Route& route) {
  std::vector<LaneId> lanes;
  for (const RouteLeg& leg : route.legs) lanes.push_back(leg.lane);
  return lanes;
}

class Finder {
 public:
  Finder(const map::RoadMap& road_map, const Route& route, const ReferenceLine& line,
         std::span<const LightCycle> lights)
      : road_map_(road_map),
        route_(route),
        line_(line),
        lights_(lights),
        rules_(road_map, lanes_of(route)) {}

  std::vector<StopPoint> all() {
    for (leg_ = 0; leg_ < route_.legs.size(); ++leg_) {
      if (!leg().reversed) look_at_leg();
    }
    std::ranges::stable_sort(places_, {}, &StopPoint::s_m);
    return std::move(places_);
  }

 private:
  const RouteLeg& leg() const { return route_.legs[leg_]; }

  void look_at_leg() {
    const std::array<LaneId, 1> lane{leg().lane};
    const double length_m = leg().to_s_m - leg().from_s_m;
    for (const RulePlace& rule : rules_.ahead(lane, leg().from_s_m, length_m)) {
      if (rule.kind == map::RuleKind::stop_line) look_at_stop_line(rule);
      if (rule.kind == map::RuleKind::signal) {
        look_at_signal(road_map_.signals()[rule.index], rule.s_m);
      }
    }
    const std::optional<LaneJoin> join = join_to_give_way_at(road_map_, leg().lane);
    look_at_regulations(join);
    if (join) look_at_join(*join);
    const bool turns = leg().turn == Turn::left || leg().turn == Turn::right;
    if (turns && road_map_.lane(leg().lane).junction) look_at_turn();
  }

  /// A stop line stands for its signals, wherever those are.
  void look_at_stop_line(const RulePlace& rule) {
    for (const std::string& id : road_map_.stop_lines()[rule.index].signals) {
      for (const map::Signal& signal : road_map_.signals()) {
        if (signal.source_id == id) look_at_signal(signal, rule.s_m);
      }
    }
  }

  void look_at_signal(const map::Signal& signal, double s_m) {
    if (!seen_.insert(signal.source_id).second) return;
    if (const std::optional<std::size_t> light = light_of(signal)) {
      add(StopKind::light, s_m, "light " + signal.source_id, light);
    } else if (is_stop_sign(signal)) {
      add(StopKind::stop_sign, s_m, "stop sign " + signal.source_id);
    } else if (is_give_way_sign(signal)) {
      add(StopKind::give_way, s_m, "give way sign " + signal.source_id);
    }
  }

  std::optional<std::size_t> light_of(const map::Signal& signal) const {
    for (std::size_t i = 0; i < lights_.size(); ++i) {
      if (std::ranges::count(lights_[i].signals, signal.source_id) > 0) return i;
    }
    return std::nullopt;
  }

  void look_at_regulations(const std::optional<LaneJoin>& join) {
    for (const std::size_t index : rules_.at(leg().lane, leg().from_s_m).regulations) {
      const map::Regulation& regulation = road_map_.regulations()[index];
      if (!has_priority_role(regulation, "yield", leg().lane)) continue;
      add(StopKind::give_way, line_of(regulation, join), "rule " + regulation.source_id);
    }
  }

  /// A sign or regulation that asks to give way there has been seen already.
  void look_at_join(const LaneJoin& join) {
    const double s_m = station(leg().lane, join.from_s_m);
    const bool is_known = std::ranges::any_of(places_, [&](const StopPoint& place) {
      const bool gives_way = place.kind == StopKind::give_way || place.kind == StopKind::stop_sign;
      return gives_way && place.s_m < s_m && s_m < place.clear_s_m;
    });
    if (is_known) return;
    add(StopKind::give_way, std::max(0.0, join.from_s_m - kBeforeConflict_m),
        "join with lane " + road_map_.lane(join.other).name);
    places_.back().clear_s_m = station(leg().lane, leg().to_s_m);
  }

  /// Station of the regulation's stop line on the leg's lane; without one, of the place where it
  /// joins the other, or of the lane's end.
  double line_of(const map::Regulation& regulation, const std::optional<LaneJoin>& join) const {
    const geometry::Polyline& centre = road_map_.lane(leg().lane).centre.in_map;
    for (const map::RegulationMember& member : regulation.members) {
      if (member.role == "ref_line" && !member.in_map.empty()) {
        return centre.project(member.in_map.front().head<2>()).s_m;
      }
    }
    return join ? std::max(0.0, join->from_s_m - kBeforeConflict_m) : centre.length_m();
  }

  void look_at_turn() {
    const LaneId turn = leg().lane;
    std::optional<map::StationRange> crossed;
    for (const map::Conflict& conflict : map::find_conflicts_of(road_map_, turn)) {
      if (conflict.kind != map::ConflictKind::crossing) continue;
      const LaneId other = conflict.partner_of(turn);
      if (!map::begin_oppositely(road_map_, turn, other) || gives_way(other, turn)) continue;
      const map::StationRange& range = conflict.on(turn);
      if (!crossed || range.from_s_m < crossed->from_s_m) crossed = range;
    }
    if (!crossed) return;
    add(StopKind::turn, crossed->from_s_m - kBeforeConflict_m,
        leg().turn == Turn::left ? "left turn" : "right turn");
  }

  /// Of two that turn to opposite sides, into the same road, the one with the wider turn
  /// gives way.
  bool gives_way(LaneId lane, LaneId other) const {
    return turned_rad(lane) * turned_rad(other) < 0.0 && std::abs(turned_rad(lane)) > kTurns_rad &&
           road_map_.lane(lane).length_m() > road_map_.lane(other).length_m();
  }

  double turned_rad(LaneId id) const {
    const map::Lane& lane = road_map_.lane(id);
    return geometry::wrap_angle(lane.pose_at(lane.length_m()).heading_rad -
                                lane.pose_at(0.0).heading_rad);
  }

  double station(LaneId lane, double s_m) const {
    return line_.project(road_map_.lane(lane).pose_at(s_m).position()).s_m;
  }

  /// End of the junction that comes next.
  double clear_s_m() const {
    std::size_t i = leg_;
    if (!road_map_.lane(leg().lane).junction && i + 1 < route_.legs.size()) ++i;
    while (i + 1 < route_.legs.size() && road_map_.lane(route_.legs[i + 1].lane).junction) ++i;
    return station(route_.legs[i].lane, route_.legs[i].to_s_m);
  }

  /// Lights at one line are places of their own: each of them can be red.
  void add(StopKind kind, double lane_s_m, std::string name,
           std::optional<std::size_t> light = {}) {
    const double s_m = station(leg().lane, lane_s_m);
    const bool known = std::ranges::any_of(places_, [&](const StopPoint& place) {
      return place.kind == kind && place.light == light &&
             std::abs(place.s_m - s_m) < kSameWaitingPlace_m;
    });
    if (known) return;
    places_.push_back({.kind = kind,
                       .s_m = s_m,
                       .clear_s_m = clear_s_m(),
                       .name = std::move(name),
                       .light = light});
  }

  const map::RoadMap& road_map_;
  const Route& route_;
  const ReferenceLine& line_;
  std::span<const LightCycle> lights_;
  map::RuleIndex rules_;
  std::size_t leg_ = 0;
  std::set<std::string, std::less<>> seen_;  ///< signals
  std::vector<StopPoint> places_;
};

}  // namespace

LightColour colour_at(const LightCycle& light, double t_s) {
  double cycle_s = 0.0;
  for (const LightPhase& phase : light.phases) cycle_s += phase.duration_s;
  double in_cycle_s = std::fmod(t_s - light.offset_s, cycle_s);
  if (in_cycle_s < 0.0) in_cycle_s += cycle_s;
  for (const LightPhase& phase : light.phases) {
    if (in_cycle_s < phase.duration_s) return phase.colour;
    in_cycle_s -= phase.duration_s;
  }
  return light.phases.back().colour;
}

std::vector<StopPoint> stop_points(const map::RoadMap& road_map, const Route& route,
                                   const ReferenceLine& line, std::span<const LightCycle> lights) {
  return Finder(road_map, route, line, lights).all();
}

}  // namespace roadbed::planning::task
