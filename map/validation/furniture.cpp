#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

#include "roadbed/map/index/road_map_index.h"
#include "roadbed/map/validation/validate.h"

namespace roadbed::map::validation {
namespace {

/// Whether a lane is within a distance; near ones are looked for first, as most things have one.
bool near_a_lane(const RoadMap& road_map, const Eigen::Vector2d& in_map, double distance_m) {
  for (const double fraction : {0.1, 0.3, 1.0}) {
    const LaneQuery nearest{.radius_m = fraction * distance_m, .count = 1};
    if (!road_map.index().lanes.near(in_map, nearest).empty()) return true;
  }
  return false;
}

void signals_off_road(const RoadMap& road_map, const ValidateOptions& options, Report& report) {
  for (const Signal& signal : road_map.signals()) {
    if (near_a_lane(road_map, signal.in_map, options.max_signal_distance_m)) continue;
    // Scenarios are cut from larger maps, and keep the signs of what is left.
    const bool is_of_a_cut = road_map.format().starts_with("CommonRoad") && !signal.lanes.empty();
    Finding& finding = report.add(
        "signal " + signal.source_id, signal.in_map,
        fmt::format("is more than {:.0f} m from any lane{}; correct its place",
                    options.max_signal_distance_m,
                    is_of_a_cut ? ", though lanes name it: if the map was not cut there" : ""));
    if (is_of_a_cut) finding.severity = Severity::info;
  }
}

/// A light for those on foot, of OpenDRIVE's catalogue of signals.
bool is_for_walkers(const Signal& signal) { return signal.type == "1000002"; }

void lights_without_lane(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  for (const Signal& signal : road_map.signals()) {
    if (!signal.dynamic || !signal.lanes.empty() || is_for_walkers(signal)) continue;
    report.add("signal " + signal.source_id, signal.in_map,
               "changes, but speaks to no lane; say for which lanes it holds");
  }
}

Eigen::Vector2d middle(const StopLine& line) {
  return 0.5 * (line.in_map.front() + line.in_map.back()).head<2>();
}

double distance_m(const RoadMap& road_map, const StopLine& line) {
  double least_m = 1e300;
  for (const LaneId lane : line.lanes) {
    const auto place = road_map.lane(lane).centre.in_map.project(middle(line));
    least_m = std::min(least_m, std::abs(place.d_m));
  }
  return least_m;
}

void stop_lines_beside(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  constexpr double kBeside = 10.0;  // [m]; one line may stop several lanes
  for (const StopLine& line : road_map.stop_lines()) {
    if (line.lanes.empty() || line.in_map.size() < 2) continue;
    const double off_m = distance_m(road_map, line);
    if (off_m <= kBeside) continue;
    report.add(
        "stop line " + line.source_id, middle(line),
        fmt::format("is {:.1f} m from the lanes that it stops; correct its place or lanes", off_m));
  }
}

/// The lines, by their source ids, that regulations with lanes name: a detection area's stops
/// traffic now and then.
std::set<std::string> lines_of_regulations(const RoadMap& road_map) {
  std::set<std::string> lines;
  for (const Regulation& regulation : road_map.regulations()) {
    if (regulation.lanes.empty()) continue;
    for (const RegulationMember& member : regulation.members) {
      if (member.in_map.size() > 1) lines.insert(member.source_id);
    }
  }
  return lines;
}

void stop_lines_without_lane(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  const std::set<std::string> named = lines_of_regulations(road_map);
  for (const StopLine& line : road_map.stop_lines()) {
    if (!line.lanes.empty() || line.in_map.empty() || named.contains(line.source_id)) continue;
    report.add("stop line " + line.source_id, middle(line),
               "stops no lane; say which, or remove it");
  }
}

void objects_off_road(const RoadMap& road_map, const ValidateOptions& options, Report& report) {
  for (const MapObject& object : road_map.objects()) {
    if (near_a_lane(road_map, object.in_map, options.max_object_distance_m)) continue;
    report.add("object " + object.source_id, object.in_map,
               fmt::format("is more than {:.0f} m from any lane; correct its place",
                           options.max_object_distance_m));
  }
}

/// Of Lanelet2 the rules about the text look at it, which know areas, too.
void regulations_without_lane(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  if (road_map.format().starts_with("Lanelet2")) return;
  for (const Regulation& regulation : road_map.regulations()) {
    const auto names_lane = [](const RegulationMember& member) { return member.lane.has_value(); };
    if (!regulation.lanes.empty() ||
        std::any_of(regulation.members.begin(), regulation.members.end(), names_lane)) {
      continue;
    }
    report.add(
        "regulation " + regulation.source_id, std::nullopt,
        fmt::format("of type {} holds on no lane; name it in one, or remove it", regulation.type));
  }
}

constexpr std::array<MapRule, 6> kFurnitureRules = {{
    {{"signal.off-road",
      {},
      Severity::warning,
      "a signal is farther than --max-signal-distance from any lane"},
     signals_off_road},
    {{"signal.no-lane", {}, Severity::info, "a light speaks to no lane"}, lights_without_lane},
    {{"stop-line.beside",
      {},
      Severity::warning,
      "a stop line is more than 10 m from the lanes that it stops"},
     stop_lines_beside},
    {{"stop-line.no-lane", {}, Severity::info, "a stop line stops no lane"},
     stop_lines_without_lane},
    {{"object.off-road",
      {},
      Severity::info,
      "an object is farther than --max-object-distance from any lane"},
     objects_off_road},
    {{"regulation.no-lane", {}, Severity::info, "a regulation holds on no lane"},
     regulations_without_lane},
}};

}  // namespace

std::span<const MapRule> furniture_rules() { return kFurnitureRules; }

}  // namespace roadbed::map::validation
