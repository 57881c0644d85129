#include "roadbed/tools/commands/audits/audit_scene.h"

#include <fmt/ostream.h>

#include <algorithm>
#include <iostream>
#include <utility>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/occupancy/octree/tiled_occupancy.h"
#include "roadbed/planning/rules/rule_audit.h"
#include "roadbed/tools/cli/build_id.h"
#include "roadbed/tools/commands/audits/audit_frames.h"
#include "roadbed/tools/report/surroundings.h"

namespace roadbed::tools::inline commands::inline audits {
namespace {

// The vehicle's rectangle, grown by the margin on every side.
geometry::VehicleShape inflated(geometry::VehicleShape grown, double margin_m) {
  grown.length_m += 2.0 * margin_m;
  grown.width_m += 2.0 * margin_m;
  grown.rear_overhang_m += margin_m;
  return grown;
}

ReportSource source(const char* role, const CertifiedFile& file) {
  return {.role = role, .name = file.name, .sha256 = file.sha256};
}

ReportCheck rule_check(const planning::RuleReport& rule, bool counts) {
  const bool is_broken = rule.verdict == planning::Verdict::conflict;
  return {.name = fmt::format("rule: {}", planning::to_string(rule.rule)),
          .value = static_cast<double>(rule.violations.size()),
          .unit = "times broken",
          .bound = counts ? "≤ 0" : "",
          .passed = rule.verdict == planning::Verdict::clear,
          .at_s = is_broken ? std::optional(rule.violations.front().from_s) : std::nullopt,
          .bound_from = counts ? "--rules" : rule.reason};
}

// Excursions from the surface are among the conflicts of the report.
void add_road(const RoadAudit& road, AuditSurroundings& page) {
  for (const planning::RuleReport& rule : road.rules) {
    const bool counts = road.counts(rule.rule);
    page.checks.push_back(rule_check(rule, counts));
    for (const planning::Violation& one : rule.violations) {
      page.events.push_back(
          {one.from_s, counts ? EventLevel::fault : EventLevel::warning,
           fmt::format("{}, lane {}: {}", planning::to_string(rule.rule), one.lane, one.text)});
    }
  }
}

}  // namespace

std::string AuditScene::crs() const {
  if (occupancy) return occupancy->crs();
  return road_map == nullptr ? std::string() : road_map->crs();
}

AuditDemand AuditScene::demand() const {
  return {.occupancy = occupancy.get(), .question = question, .road = road ? &*road : nullptr};
}

AuditScene audit_scene(const AuditAsked& asked, bool certifies, const CommonOptions& common) {
  AuditScene scene{.asked = asked, .inputs = common.inputs};
  const Vehicle vehicle = asked.read_vehicle();
  scene.shape = vehicle.shape;
  scene.vehicle_note = asked.vehicle_note(vehicle);
  if (!asked.map_file().empty()) scene.road_map = common.inputs->road_map(asked.map_file());
  scene.question = asked.question(vehicle, scene.road_map.get(), certifies, *common.inputs);
  if (asked.about_road()) scene.road = asked.road_question(scene.road_map.get());
  return scene;
}

void add_occupancy(AuditScene& scene, const Streams& streams, const CommonOptions& common) {
  if (scene.asked.occupancy_file().empty()) return;
  const FilterArguments& filter = scene.asked.filter();
  scene.occupancy = filter.words().empty()
                        ? common.inputs->occupancy(scene.asked.occupancy_file())
                        : common.inputs->filtered_occupancy(scene.asked.occupancy_file(),
                                                            filter.filter(), filter.words());
  if (const auto removed = scene.occupancy->seen_through(); removed && !common.quiet) {
    fmt::print(streams.err,
               "note: {} was built with --remove-seen-through {}: {} cells with points count as "
               "free\n",
               scene.asked.occupancy_file().string(), removed->clouds, removed->cells);
  }
  if (scene.road_map == nullptr) return;
  check_overlap(road_bounds(*scene.road_map), measured_bounds(*scene.occupancy),
                scene.asked.occupancy_file().string());
  const std::string &of_map = scene.road_map->crs(), &of_occupancy = scene.occupancy->crs();
  if (!common.quiet && !of_map.empty() && !of_occupancy.empty() && of_map != of_occupancy) {
    fmt::print(streams.err, "note: the map's CRS is \"{}\", the occupancy's \"{}\"\n", of_map,
               of_occupancy);
  }
}

map::Box2 drawn(const AuditedDrive& audited, const AuditScene& scene) {
  const Eigen::Vector2d margin_m = Eigen::Vector2d::Constant(60.0);
  const map::Box2 around =
      planning::audited_region(audited.drive, scene.question.parts, scene.asked.options()).around;
  return {around.min_in_source - margin_m, around.max_in_source + margin_m};
}

CertifiedFile hashed_once(const AuditScene& scene, const std::filesystem::path& file) {
  return *scene.inputs->of<CertifiedFile>("hashed input", {file}, [&] {
    return std::make_shared<const CertifiedFile>(hashed_input(file));
  });
}

AuditSurroundings surroundings_of(const AuditedDrive& audited, const AuditScene& scene) {
  const map::Box2 around = drawn(audited, scene);
  const Eigen::AlignedBox2d box(around.min_in_source, around.max_in_source);
  AuditSurroundings page{.name = audited.name,
                         .body = inflated(scene.shape, scene.asked.options().inflate_m),
                         .parts = scene.question.inflated_parts(),
                         .clearance_m = scene.asked.options().clearance_m,
                         .occupied = {},
                         .road_map = {},
                         .moving = scene.question.moving_in_source,
                         .checks = {},
                         .events = {},
                         .command = scene.command,
                         .version = name_and_version(),
                         .crs = scene.crs(),
                         .sources = {}};
  if (scene.occupancy) {
    page.occupied =
        occupied_in(*scene.occupancy, scene.question.heights(audited.audit.ground), box);
    const std::filesystem::path& file = scene.asked.occupancy_file();
    const bool is_bag = map::is_folder(file) && !map::is_tiled_occupancy(file);
    if (!file.empty() && !is_bag) {
      page.sources.push_back(source("occupancy", hashed_once(scene, file)));
    }
  } else {
    page.clearance_m = scene.asked.margin_m();
    page.is_of_surface = true;
  }
  if (scene.road_map != nullptr) {
    page.road_map = map_around(*scene.road_map, box);
    page.sources.push_back(source("map", hashed_once(scene, scene.asked.map_file())));
  }
  if (audited.road) add_road(*audited.road, page);
  if (!scene.drive_file.empty() && !map::is_folder(scene.drive_file)) {
    page.sources.push_back(source("trajectory", hashed_input(scene.drive_file)));
  }
  return page;
}

DriveSpace space_of(const AuditedDrive& audited, const AuditScene& scene) {
  DriveSpace space;
  space.parts = scene.question.parts;
  space.occupancy = scene.occupancy.get();
  space.ground = &audited.audit.ground;
  if (scene.occupancy || scene.road) space.audit = audited.whole();
  return space;
}

}  // namespace roadbed::tools::commands::audits
