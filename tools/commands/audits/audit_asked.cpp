#include "roadbed/tools/commands/audits/audit_asked.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "roadbed/tools/audit/audit_clock.h"
#include "roadbed/tools/audit/audit_subjects.h"
#include "roadbed/tools/audit/audited_drive.h"
#include "roadbed/tools/commands/occupancy/cloud_inputs.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline commands::inline audits {
namespace {

using planning::AuditQuestion;
using planning::UnknownPolicy;

std::vector<planning::TrafficRule> rules_of(const std::string& words) {
  std::vector<planning::TrafficRule> rules;
  for (const planning::TrafficRule rule : planning::kTrafficRules) {
    const auto name = "," + std::string(planning::to_string(rule)) + ",";
    if (words == "all" || ("," + words + ",").find(name) != std::string::npos) {
      rules.push_back(rule);
    }
  }
  return rules;
}

std::string rules_fault(const std::string& words) {
  if (words == "all") return {};
  const auto count = 1 + std::ranges::count(words, ',');
  const auto known = static_cast<std::ptrdiff_t>(rules_of(words).size());
  return count == known ? "" : "is not all, nor of markings, direction, speed and lights";
}

bool is_same_body(const geometry::VehicleShape& a, const geometry::VehicleShape& b) {
  return a.length_m == b.length_m && a.width_m == b.width_m &&
         a.rear_overhang_m == b.rear_overhang_m && a.height_m == b.height_m;
}

}  // namespace

void AuditAsked::declare_occupancy(Arguments& arguments) {
  arguments
      .add("--occupancy", occupancy_,
           "Octree of obstacles (.bt .ot), or a folder of tiles, of which a drive reads those "
           "that it meets; or a cloud or a log of clouds, made one in memory as occupancy build "
           "does, in cells of 0.1 m")
      .reads()
      .ending(kCloudInputEndings);
}

std::vector<Argument> AuditAsked::declare(Arguments& arguments) {
  arguments.heading("Question");
  arguments
      .add("--vehicle", vehicle_,
           std::string("Vehicle: ") + kVehicleSyntax +
               "; default: the one that a CommonRoad solution names, else commonroad:2")
      .reads()
      .ending(".json .yaml");
  arguments
      .add("--map", map_, "Map of the roads: what --on is about; checks that frames agree; drawn")
      .reads()
      .ending(kMapEndings);
  arguments
      .add("--obstacles", obstacles_,
           "Dynamic obstacles beside the occupancy: a scenario (.json, CommonRoad .xml), or boxes "
           "over time (.csv: t_s,id,x_m,y_m,heading_rad,length_m,width_m, poses of the "
           "centre; an id of one row stands for ever, one of several is there from its "
           "first to its last), in the drive's time and coordinates. Second 0 of a CommonRoad "
           "file, also of lights, is its planning problem's initial step, as simulate writes "
           "drives, else step 0; beside a CommonRoad solution, which has absolute steps, step 0")
      .reads(files_named_by_scenario)
      .ending(".json .xml .csv");
  declare_question(arguments);
  const Argument rules = declare_road(arguments);
  filter_.declare(arguments);
  return {rules};
}

void AuditAsked::declare_question(Arguments& arguments) {
  clearance_argument_ =
      arguments
          .add("--clearance", options_.clearance_m, "Less distance than this is a conflict [m]")
          .within(0.0, 100.0)
          .with_default();
  inflate_argument_ =
      arguments.add("--inflate", options_.inflate_m, "Margin added around the vehicle [m]")
          .within(0.0, 100.0)
          .with_default();
  unknown_argument_ = arguments.choice(
      "--unknown", options_.unknown,
      {{"free", UnknownPolicy::free},
       {"occupied", UnknownPolicy::occupied},
       {"report", UnknownPolicy::report}},
      "How unknown space counts, which was not measured: free, occupied, or report: no obstacle, "
      "but a "
      "drive over it is not clear. Where nothing was measured within 10 m of the body at its "
      "heights, a drive is not clear either way");
  least_measured_argument_ = arguments
                                 .add("--least-measured", options_.least_measured,
                                      "Fraction of the space that the vehicle takes that has to "
                                      "be measured, else no drive is clear, whatever --unknown "
                                      "says")
                                 .within(0.0, 1.0)
                                 .with_default();
  arguments
      .add("--ground", ground_,
           "What heights are above: Z of level ground in the occupancy's frame [m]; map: the "
           "road's surface of --map, which the band follows; measured: the surface that was "
           "measured along the drive, to a cell, with nothing below it, on all sides and "
           "without a step, refused elsewhere; heights are widened by a cell. A drive that "
           "is all upon an obstacle takes its top for ground. Default: map with --map, else "
           "0")
      .checked(ground_rule_fault);
  from_height_argument_ =
      arguments
          .add("--from-height", from_height_m_,
               "The vehicle's underside above the ground [m]; its top is the vehicle's height")
          .within(-100.0, 100.0)
          .with_default();
}

Argument AuditAsked::declare_road(Arguments& arguments) {
  arguments.heading("Road");
  arguments
      .add("--on", on_,
           "What the whole body has to stay on, between the rows too: drivable (drivable lanes "
           "and road areas of --map), surface (with shoulders, stops, parking, bus and taxi "
           "lanes), lanes (those that the drive is along in their direction, and those beside "
           "them), route:F.json (lanes that route --json printed), or area:F.geojson (polygons "
           "in the drive's coordinates). Needs no --occupancy")
      .checked(surface_words_fault)
      .may_read([](const std::string& words) {
        return surface_words_fault(words).empty() ? surface_words(words).file
                                                  : std::filesystem::path();
      });
  margin_argument_ =
      arguments.add("--margin", margin_m_, "Least distance from the body to the edge of --on [m]")
          .within(0.0, 0.5 * planning::kSurfaceHorizon_m)
          .with_default();
  seam_argument_ =
      arguments
          .add("--seam", seam_m_,
               "Points of the map this near to each other are one for --on: gaps of maps that do "
               "not meet exactly are no holes [m]. Slits that are narrower are closed, and round "
               "holes up to 2.5 times as wide")
          .within(0.0, 0.1)
          .with_default();
  return arguments
      .add("--rules", rules_,
           "Traffic rules that count in the verdict, with commas: markings (solid ones are not "
           "crossed), direction, speed, lights (none is passed at red, as far as a CommonRoad "
           "map or the scenario of --obstacles says what they show), or all. With --on and "
           "--map each has a verdict of its own either way")
      .checked(rules_fault);
}

std::string AuditAsked::fault() const {
  if (ground_ == "map" && map_.empty()) return "--ground map needs --map";
  if (on_.empty() && (margin_argument_->given() || !rules_.empty())) {
    return "--margin and --rules need --on";
  }
  const bool is_area = !on_.empty() && on_.starts_with("area:");
  if (!on_.empty() && !is_area && map_.empty()) return "--on " + on_ + " needs --map";
  if (!rules_.empty() && map_.empty()) return "--rules needs --map";
  return occupancy_.empty() ? about_occupancy() : "";
}

// Of a road audit nothing of that counts, and who gives it takes it to.
std::string AuditAsked::about_occupancy() const {
  if (!ground_.empty()) return "--ground needs --occupancy";
  if (!filter_.words().empty()) return filter_.words() + " needs --occupancy";
  for (const auto& [name, argument] : {std::pair{"--clearance", &clearance_argument_},
                                       {"--unknown", &unknown_argument_},
                                       {"--least-measured", &least_measured_argument_},
                                       {"--from-height", &from_height_argument_}}) {
    if ((*argument)->given()) return std::string(name) + " needs --occupancy";
  }
  const auto rules = rules_of(rules_);
  const bool has_lights = std::ranges::count(rules, planning::TrafficRule::lights) > 0;
  if (!obstacles_.empty() && !has_lights) {
    return "--obstacles needs --occupancy, or --rules lights for those of a scenario";
  }
  return {};
}

void AuditAsked::take_map_of_log(const std::filesystem::path& map_file) {
  if (map_.empty()) map_ = map_file;
  take_road();
}

void AuditAsked::take_road() {
  if (on_.empty()) on_ = "drivable";
}

void AuditAsked::take_drive(const std::filesystem::path& file) {
  start_step_ = second_0_step(file, std::array{obstacles_, map_});
  if (!file.empty() && is_solution(file)) drives_vehicle_ = vehicle_of_solution(file);
}

std::string AuditAsked::vehicle_note(const Vehicle& vehicle) const {
  if (drives_vehicle_.empty() || vehicle_.empty()) return {};
  const geometry::VehicleShape own = read_vehicle_shape(drives_vehicle_);
  const bool has_more = !vehicle.circles.empty() || !vehicle.more.empty();
  if (!has_more && is_same_body(own, vehicle.shape)) return {};
  return fmt::format(
      "note: the solution is of {}, {:.3f} m by {:.3f} m; audited is --vehicle {}, {:.3f} m by "
      "{:.3f} m{}, its rear axle where that one's is\n",
      drives_vehicle_.string(), own.length_m, own.width_m, vehicle_.string(),
      vehicle.shape.length_m, vehicle.shape.width_m, has_more ? " and more parts" : "");
}

bool AuditAsked::shifts_obstacles() const {
  return !obstacles_.empty() && is_common_road(obstacles_) &&
         second_0_step({}, std::array{obstacles_}) != start_step_;
}

Vehicle AuditAsked::read_vehicle() const {
  return vehicle_file().empty() ? Vehicle{} : tools::read_vehicle(vehicle_file());
}

AuditQuestion AuditAsked::question(const Vehicle& vehicle, const map::RoadMap* road_map,
                                   bool certifies, const Inputs& inputs) const {
  AuditQuestion question{.parts = vehicle.parts(from_height_m_),
                         .ground = ground_rule(ground_, road_map),
                         .options = options_,
                         .certifies = certifies};
  if (!obstacles_.empty()) {
    question.moving_in_source = read_moving_obstacles(obstacles_, inputs, start_step_);
  }
  return question;
}

RoadQuestion AuditAsked::road_question(const map::RoadMap* road_map) const {
  RoadQuestion road{.on = on_, .surface = surface_rule(on_, road_map), .margin_m = margin_m_};
  road.surface.seam_m = seam_m_;
  road.made = made_surface(road.surface);
  road.counted = rules_of(rules_);
  for (const auto& file : {map_, obstacles_}) {
    const std::vector<planning::LightCycle> lights = recorded_lights(file, start_step_);
    road.lights.insert(road.lights.end(), lights.begin(), lights.end());
  }
  return road;
}

CertificateDemands AuditAsked::demands(const std::filesystem::path& trajectory) const {
  const auto if_given = [](const std::optional<Argument>& argument, auto value) {
    return argument->given() ? std::optional(value) : std::nullopt;
  };
  return {.occupancy = occupancy_,
          .trajectory = trajectory,
          .vehicle = vehicle_,
          .map = map_,
          .obstacles = obstacles_,
          .ground = ground_,
          .on = on_,
          .clearance_m = if_given(clearance_argument_, options_.clearance_m),
          .inflate_m = if_given(inflate_argument_, options_.inflate_m),
          .underside_m = if_given(from_height_argument_, from_height_m_),
          .least_measured = if_given(least_measured_argument_, options_.least_measured),
          .margin_m = if_given(margin_argument_, margin_m_),
          .seam_m = if_given(seam_argument_, seam_m_),
          .unknown = if_given(unknown_argument_, options_.unknown)};
}

std::string AuditAsked::against() const {
  std::string words;
  if (!occupancy_.empty()) words = "--occupancy " + occupancy_.string();
  if (const std::string filter = filter_.words(); !filter.empty()) words += " " + filter;
  if (!on_.empty()) words += (words.empty() ? "--on " : " --on ") + on_;
  if (occupancy_.empty() && !map_.empty()) words += " --map " + map_.string();
  return words;
}

std::string AuditAsked::suite() const {
  if (!occupancy_.empty()) return occupancy_.string();
  return map_.empty() ? on_ : map_.string();
}

}  // namespace roadbed::tools::commands::audits
