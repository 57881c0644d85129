#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "roadbed/map/validation/validate.h"

namespace roadbed::map::validation {
namespace {

bool says_speed(const Lane& lane) {
  return std::ranges::any_of(lane.speed_limits,
                             [](const SpeedLimit& limit) { return limit.limit_mps.has_value(); });
}

bool lacks_speed(const Lane& lane) { return is_drivable(lane.type) && !says_speed(lane); }

bool has_speed(const Lane& lane) { return is_drivable(lane.type) && says_speed(lane); }

void missing_of_roads(const RoadMap& road_map, Report& report) {
  for (const Road& road : road_map.roads()) {
    const auto count = std::count_if(road.lanes.begin(), road.lanes.end(),
                                     [&](LaneId id) { return lacks_speed(road_map.lane(id)); });
    if (count == 0) continue;
    report.add("road " + road.source_id, road.reference_in_map.at(0.0),
               fmt::format("{} of its drivable lanes have no speed limit; add one", count));
  }
}

void missing_of_lanes_without_road(const RoadMap& road_map, Report& report) {
  const Lane* first = nullptr;
  std::size_t lacking = 0, drivable = 0;
  for (const Lane& lane : road_map.lanes()) {
    if (lane.road || !is_drivable(lane.type)) continue;
    ++drivable;
    if (!lacks_speed(lane)) continue;
    if (lacking++ == 0) first = &lane;
  }
  if (first == nullptr) return;
  report.add(
      "lane " + first->name, first->pose_at(0.0).position(),
      fmt::format("has no speed limit, as {} of {} drivable lanes; add one", lacking, drivable));
}

/// One finding for a map that says no speed at all, else one per road, and one for all lanes that
/// belong to none.
void missing_speeds(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  const auto& lanes = road_map.lanes();
  if (std::any_of(lanes.begin(), lanes.end(), has_speed)) {
    missing_of_roads(road_map, report);
    missing_of_lanes_without_road(road_map, report);
  } else if (std::any_of(lanes.begin(), lanes.end(), lacks_speed)) {
    report.add("map", std::nullopt, "no drivable lane has a speed limit; add them");
  }
}

/// Limits of lanes without a road; those of roads are looked at in their source, with their unit.
void absurd_speeds(const RoadMap& road_map, const ValidateOptions& options, Report& report) {
  for (const Lane& lane : road_map.lanes()) {
    if (lane.road || !is_drivable(lane.type)) continue;
    for (const SpeedLimit& limit : lane.speed_limits) {
      if (!limit.limit_mps || std::isinf(*limit.limit_mps)) continue;
      if (*limit.limit_mps > 0.0 && *limit.limit_mps <= options.max_speed_mps) continue;
      report.add(
          "lane " + lane.name, lane.pose_at(limit.from_s_m).position(),
          fmt::format("its speed limit is {:.1f} m/s ({:.0f} km/h); correct the value or its "
                      "unit",
                      *limit.limit_mps, 3.6 * *limit.limit_mps));
    }
  }
}

void lanes_for_nobody(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  for (const Lane& lane : road_map.lanes()) {
    if (!is_drivable(lane.type) || !lane.participants.empty()) continue;
    report.add("lane " + lane.name, lane.pose_at(0.0).position(),
               "nobody may use it; correct its access or participants");
  }
}

const char* place_for_crs(const std::string& format) {
  if (format.starts_with("OpenDRIVE")) return "add a <geoReference> to its header";
  if (format.starts_with("CommonRoad")) return "add a <geoTransformation> to its location";
  return "say it with import --crs";
}

void missing_crs(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  const auto& remarks = road_map.import_diagnostics();
  const auto says_why = [](const ImportDiagnostic& d) { return d.rule == "import.crs-unknown"; };
  if (!road_map.crs().empty() || std::any_of(remarks.begin(), remarks.end(), says_why)) return;
  report.add("map", std::nullopt,
             fmt::format("does not say its coordinate reference system; {}",
                         place_for_crs(road_map.format())));
}

/// Whether a text can be a PROJ string, an authority's code, WKT or PROJJSON.
bool looks_like_crs(const std::string& text) {
  static constexpr std::string_view kSigns[] = {
      "+proj=", "+init=", "EPSG:", "epsg:", "CRS[", "CS[", "urn:ogc", "\"type\""};
  return std::any_of(std::begin(kSigns), std::end(kSigns),
                     [&](std::string_view sign) { return text.find(sign) != std::string::npos; });
}

void broken_crs(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  if (road_map.crs().empty() || looks_like_crs(road_map.crs())) return;
  report.add("map", std::nullopt,
             fmt::format("its coordinate reference system \"{}\" is no PROJ string, EPSG code or "
                         "WKT; correct it",
                         road_map.crs().substr(0, 60)));
}

constexpr std::array<MapRule, 5> kAttributeRules = {{
    {{"speed.missing",
      {},
      Severity::info,
      "drivable lanes have no speed limit; once per road, or once per map without any or roads"},
     missing_speeds},
    {{"speed.absurd",
      {},
      Severity::warning,
      "a lane's speed limit is not positive, or above --max-speed"},
     absurd_speeds},
    {{"lane.no-participants", {}, Severity::warning, "nobody may use a drivable lane"},
     lanes_for_nobody},
    {{"crs.missing", {}, Severity::info, "the map does not say its coordinate reference system"},
     missing_crs},
    {{"crs.broken",
      {},
      Severity::warning,
      "the map's coordinate reference system is no PROJ string, code or WKT"},
     broken_crs},
}};

}  // namespace

std::span<const MapRule> attribute_rules() { return kAttributeRules; }

}  // namespace roadbed::map::validation
