#include "roadbed/tools/audit/road_audit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/commonroad/scenario.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/formats.h"
#include "roadbed/map/geojson/document.h"
#include "roadbed/tools/audit/route_file.h"
#include "roadbed/tools/files/json.h"
#include "roadbed/tools/simulation/common_road_obstacles.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline audit {
namespace {

using geometry::Polygon;
using geometry::Ring;
using Kind = planning::SurfaceRule::Kind;

constexpr std::string_view kArea = "area:", kRoute = "route:";

Ring turned(Ring ring, bool counter_clockwise) {
  if ((geometry::signed_area_m2(ring) > 0.0) != counter_clockwise) {
    std::ranges::reverse(ring);
  }
  return ring;
}

// A polygon as the file has it, in the drive's coordinates, whatever its crs member says.
Polygon polygon_of(const map::geojson::PolygonRecord& record, const std::string& file,
                   const std::string& feature) {
  const auto refuse = [&](std::size_t ring, const std::string& what) {
    throw map::InputError({.file = file,
                           .element = fmt::format("feature {}, ring {}", feature, ring),
                           .found = what,
                           .needed = "a polygon whose rings enclose a region",
                           .remedy = "correct the polygon"});
  };
  Polygon polygon;
  for (std::size_t i = 0; i < record.rings.size(); ++i) {
    if (record.rings[i].size() < 3) refuse(i, "fewer than three points");
    Ring ring = turned(record.rings[i], i == 0);
    if (i == 0) {
      polygon.outer = std::move(ring);
    } else {
      polygon.holes.push_back(std::move(ring));
    }
  }
  if (polygon.outer.empty()) refuse(0, "no ring");
  if (const auto fault = geometry::find_fault(polygon)) refuse(fault->ring, fault->what);
  return polygon;
}

std::vector<Polygon> read_area(const std::filesystem::path& file) {
  const std::string name = map::input_name(file);
  const map::geojson::Document document = map::geojson::parse(map::read_file(file), name);
  std::vector<Polygon> polygons;
  for (const map::geojson::FeatureRecord& feature : document.features) {
    for (const auto& record : feature.polygons) {
      polygons.push_back(polygon_of(record, name, feature.id));
    }
  }
  if (!polygons.empty()) return polygons;
  throw map::InputError({.file = name,
                         .found = "no polygon",
                         .needed = "a Polygon or MultiPolygon, in the drive's coordinates",
                         .remedy = "draw the area that the drive has to stay in"});
}

std::vector<map::LaneId> lanes_of_route(const std::filesystem::path& file,
                                        const map::RoadMap& road_map) {
  std::vector<map::LaneId> lanes;
  for (const RouteFileLeg& leg : read_route_file(file, road_map)) lanes.push_back(leg.lane);
  return lanes;
}

}  // namespace

std::string surface_words_fault(const std::string& text) {
  for (const std::string_view word : {"drivable", "surface", "lanes"}) {
    if (text == word) return {};
  }
  const bool has_file = (text.starts_with(kArea) && text.size() > kArea.size()) ||
                        (text.starts_with(kRoute) && text.size() > kRoute.size()) ||
                        text.ends_with(".json");
  if (has_file) return {};
  return "is none of drivable, surface, lanes, route:F.json and area:F.geojson";
}

SurfaceWords surface_words(const std::string& text) {
  if (text == "drivable") return {Kind::drivable};
  if (text == "surface") return {Kind::surface};
  if (text == "lanes") return {Kind::lanes};
  if (text.starts_with(kArea)) return {Kind::area, text.substr(kArea.size())};
  return {Kind::route, text.starts_with(kRoute) ? text.substr(kRoute.size()) : text};
}

planning::SurfaceRule surface_rule(const std::string& text, const map::RoadMap* road_map) {
  const SurfaceWords words = surface_words(text);
  planning::SurfaceRule rule;
  rule.kind = words.kind;
  rule.road_map = road_map;
  if (words.kind == Kind::area) rule.area_in_source = read_area(words.file);
  if (words.kind == Kind::route) rule.route = lanes_of_route(words.file, *road_map);
  return rule;
}

std::shared_ptr<const planning::RoadSurface> made_surface(const planning::SurfaceRule& rule) {
  if (rule.kind != Kind::area && rule.kind != Kind::route) return nullptr;
  constexpr double any_reach_m = 0.0;
  return std::make_shared<const planning::RoadSurface>(
      planning::road_surface(planning::surface_polygons(rule, {}, any_reach_m), rule.seam_m));
}

std::vector<planning::LightCycle> recorded_lights(const std::filesystem::path& file,
                                                  long start_step) {
  if (file.empty() || map::is_stream(file)) return {};
  if (is_common_road(file)) {
    return light_cycles(
        map::commonroad::parse_scenario(map::read_file(file), map::input_name(file)), start_step);
  }
  const std::string start = map::read_file_start(file, 4096);
  const std::size_t sign = start.find_first_not_of(" \t\r\n");
  if (sign == std::string::npos || start[sign] != '{' || map::format_of(start)) return {};
  return read_scenario(file).lights;
}

planning::Verdict RoadAudit::verdict() const {
  using planning::Verdict;
  std::vector<Verdict> verdicts{surface.verdict};
  for (const planning::RuleReport& rule : rules) {
    if (counts(rule.rule)) verdicts.push_back(rule.verdict);
  }
  for (const Verdict grave : {Verdict::conflict, Verdict::unknown, Verdict::undecided}) {
    if (std::ranges::count(verdicts, grave) > 0) return grave;
  }
  return Verdict::clear;
}

bool RoadAudit::counts(planning::TrafficRule rule) const {
  return std::ranges::count(counted, rule) > 0;
}

RoadAudit audit_road(const geometry::Trajectory& drive, std::span<const geometry::BodyPart> parts,
                     const RoadQuestion& question, bool certifies) {
  double reach_m = 0.0;
  for (const geometry::BodyPart& part : parts) reach_m = std::max(reach_m, part.reach_m());
  const auto made =
      question.made
          ? question.made
          : question.kept->of(planning::surface_polygons(question.surface, drive, reach_m),
                              question.surface.seam_m);
  const planning::RoadSurface& surface = *made;
  RoadAudit audit;
  audit.on = question.on;
  audit.margin_m = question.margin_m;
  audit.seam_m = question.surface.seam_m;
  audit.counted = question.counted;
  audit.surface =
      planning::audit_surface(surface, drive, parts, question.margin_m, question.surface.road_map);
  if (certifies) {
    audit.certificates =
        planning::certify_surface(surface, drive, parts, question.margin_m, audit.surface);
  }
  if (question.surface.road_map != nullptr) {
    audit.rules =
        planning::audit_rules({question.surface.road_map, question.lights}, drive, parts.front());
  }
  audit.made = made;
  return audit;
}

}  // namespace roadbed::tools::audit
