#include "roadbed/planning/route/guidance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace roadbed::planning::inline route {
namespace {

std::string words(Turn turn) {
  switch (turn) {
    case Turn::left:
      return "turn left";
    case Turn::right:
      return "turn right";
    case Turn::u_turn:
      return "make a U-turn";
    default:
      return "";
  }
}

// Name of the road that is reached behind a turn: the first one outside the junction.
std::string onto(const map::RoadMap& road_map, const Route& route, std::size_t leg) {
  for (std::size_t i = leg; i < route.legs.size(); ++i) {
    const map::Lane& lane = road_map.lane(route.legs[i].lane);
    if (!lane.road || lane.junction) continue;
    const std::string& name = road_map.road(*lane.road).name;
    return name.empty() ? "" : " onto " + name;
  }
  return "";
}

std::string change_words(const RouteLeg& leg) {
  const char* side = leg.exit == LegExit::change_left ? "left" : "right";
  const double room_m =
      leg.change_window ? std::abs(leg.change_window->to_s_m - leg.change_window->from_s_m) : 0.0;
  return fmt::format("change one lane to the {} within {:.0f} m", side, room_m);
}

// From where the leg begins to a station of its lane.
double driven_m(const RouteLeg& leg, double s_m) {
  return leg.reversed ? leg.from_s_m - s_m : s_m - leg.from_s_m;
}

void name_distances(std::vector<Instruction>& instructions) {
  std::stable_sort(instructions.begin(), instructions.end(),
                   [](const auto& a, const auto& b) { return a.at_m < b.at_m; });
  double before_m = 0.0;
  for (Instruction& instruction : instructions) {
    instruction.text =
        fmt::format("in {:.0f} m, {}", instruction.at_m - before_m, instruction.text);
    before_m = instruction.at_m;
  }
}

}  // namespace

std::vector<Instruction> instructions_for(const map::RoadMap& road_map, const Route& route) {
  std::vector<Instruction> made;
  double at_m = 0.0;
  std::size_t stop = 0;
  for (std::size_t i = 0; i < route.legs.size(); ++i) {
    const RouteLeg& leg = route.legs[i];
    const std::string turn = words(leg.turn);
    if (!turn.empty() && i > 0) made.push_back({at_m, i, turn + onto(road_map, route, i)});
    if (leg.change_window) {
      // A change may begin beside a leg before.
      const double to_window_m = driven_m(leg, leg.change_window->from_s_m);
      made.push_back({std::max(0.0, at_m + to_window_m), i, change_words(leg)});
    }
    for (; stop < route.stops.size() && route.stops[stop].leg == i; ++stop) {
      const double to_stop_m = std::clamp(driven_m(leg, route.stops[stop].s_m), 0.0, leg.length_m);
      made.push_back({at_m + to_stop_m, i, fmt::format("pass via point {}", stop + 1)});
    }
    at_m += leg.length_m;
  }
  made.push_back({at_m, route.legs.size() - 1, "arrive at the goal"});
  name_distances(made);
  return made;
}

}  // namespace roadbed::planning::route
