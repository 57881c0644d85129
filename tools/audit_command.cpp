#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/occupancy/clearance_field.h"
#include "roadbed/map/occupancy/occupancy_map.h"
#include "roadbed/planning/audit.h"
#include "roadbed/planning/audit_certificate.h"
#include "roadbed/tools/command.h"
#include "roadbed/tools/report/audit_svg.h"
#include "roadbed/tools/support/audit_json.h"
#include "roadbed/tools/support/certificate_check.h"
#include "roadbed/tools/support/certificate_json.h"
#include "roadbed/tools/support/output_file.h"
#include "roadbed/tools/support/trajectory_csv.h"
#include "roadbed/tools/support/vehicle_json.h"

namespace roadbed::tools {
namespace {

using planning::AuditOptions;
using planning::AuditReport;
using planning::UnknownPolicy;

bool overlap(const map::Box2& a, const map::Box2& b) {
  return (a.min_in_source.array() <= b.max_in_source.array()).all() &&
         (b.min_in_source.array() <= a.max_in_source.array()).all();
}

void extend(std::optional<map::Box2>& box, const Eigen::Vector2d& least,
            const Eigen::Vector2d& most) {
  if (!box) box = map::Box2{least, most};
  box->min_in_source = box->min_in_source.cwiseMin(least);
  box->max_in_source = box->max_in_source.cwiseMax(most);
}

std::optional<map::Box2> bounds_of(const std::vector<map::OccupancyCell>& cells) {
  std::optional<map::Box2> box;
  for (const map::OccupancyCell& cell : cells) {
    const Eigen::Array2d centre = cell.centre_in_source.head<2>();
    extend(box, centre - 0.5 * cell.size_m, centre + 0.5 * cell.size_m);
  }
  return box;
}

std::string text_of(const map::Box2& box) {
  return fmt::format("x {:.1f} to {:.1f}, y {:.1f} to {:.1f}", box.min_in_source.x(),
                     box.max_in_source.x(), box.min_in_source.y(), box.max_in_source.y());
}

std::vector<geometry::Ring> drivable_lanes(const map::RoadMap& road_map) {
  std::vector<geometry::Ring> rings;
  for (const map::Lane& lane : road_map.lanes()) {
    if (!is_drivable(lane.type)) continue;
    geometry::Ring ring;
    for (const Eigen::Vector2d& point : lane.polygon) ring.push_back(road_map.to_source(point));
    rings.push_back(std::move(ring));
  }
  return rings;
}

class AuditCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description(
        "Prove that a drive keeps clear of occupied space, or show where it does not");
    arguments.add("--occupancy", occupancy_, "Octree of obstacles (.bt .ot)");
    arguments.add("--trajectory", trajectory_,
                  "Drive to audit (.csv), poses of the rear axle, linear between rows; every point "
                  "of the body is covered");
    const Argument vehicle =
        arguments.add("--vehicle", vehicle_, "Vehicle (.json); default: CommonRoad's vehicle 2");
    const Argument map = arguments.add(
        "--map", map_, "Map of the roads: checks that the frames agree, and is drawn");
    arguments.add("--clearance", options_.clearance_m, "Less distance than this is a conflict [m]")
        .within(0.0, 100.0)
        .with_default();
    arguments.add("--inflate", options_.inflate_m, "Margin added around the vehicle [m]")
        .within(0.0, 100.0)
        .with_default();
    arguments.choice("--unknown", options_.unknown,
                     {{"free", UnknownPolicy::free},
                      {"occupied", UnknownPolicy::occupied},
                      {"report", UnknownPolicy::report}},
                     "What space counts as that was not measured: free, occupied, or report: no "
                     "obstacle, but a drive over it is not clear");
    arguments.add("--ground", ground_m_, "Height of the ground in the occupancy's frame [m]")
        .with_default();
    arguments
        .add("--from-height", from_height_m_,
             "The vehicle's underside above the ground [m]; its top is the vehicle's height")
        .with_default();
    arguments.flag("--json", json_, "Print one JSON document");
    const Argument svg = arguments.add("--svg", svg_, "Draw the audit as a picture (.svg)");
    const Argument certificate = arguments.add(
        "--certificate", certificate_,
        "Write the proof (.json): spans of time, what holds in them, witnesses, hashes of "
        "the inputs");
    arguments
        .add("--check", check_,
             "Verify a certificate by brute force instead; its inputs are the files that it names, "
             "or --occupancy and --trajectory")
        .excludes(certificate)
        .excludes(svg)
        .excludes(vehicle)
        .excludes(map);
    arguments.flag("--force", force_, "Replace outputs that exist");
    arguments.require([this] { return missing(); });
    arguments.example(
        "  roadbed audit --occupancy street.bt --trajectory drive/trajectory.csv "
        "--certificate proof.json\n"
        "  roadbed audit --check proof.json");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    if (!check_.empty()) {
      const bool holds =
          check_certificate_file(check_, occupancy_, trajectory_, json_, streams.out);
      return holds ? Exit::ok : Exit::failed;
    }
    for (const auto& output : {svg_, certificate_}) {
      if (!output.empty()) check_writable(output, force_);
    }
    const geometry::Trajectory drive = read_trajectory_csv(trajectory_);
    const geometry::VehicleShape vehicle =
        vehicle_.empty() ? geometry::VehicleShape{} : read_vehicle_json(vehicle_);
    const map::OccupancyMap occupancy = map::OccupancyMap::load(occupancy_);
    const map::FieldRegion region = planning::audited_region(drive, vehicle, options_);
    const auto lanes = check_frames(streams.err, common.quiet, occupancy, region.around);
    const map::HeightBand band = height_band(vehicle);
    const map::ClearanceField field(occupancy, band, region);
    const AuditReport report = planning::audit(field, drive, vehicle, options_);

    if (!svg_.empty()) {
      write_output(svg_, audit_svg({drive, planning::inflated(vehicle, options_.inflate_m), report,
                                    occupied_boxes(occupancy, band), lanes}));
    }
    if (!certificate_.empty()) {
      const auto certificate = planning::certify(field, band, drive, vehicle, options_, report);
      write_output(certificate_, write_certificate_json({.program = "roadbed " ROADBED_VERSION,
                                                         .occupancy = certified_file(occupancy_),
                                                         .trajectory = certified_file(trajectory_),
                                                         .certificate = certificate}));
    }
    print(streams.out, report);
    return report.verdict == planning::Verdict::clear ? Exit::ok : Exit::failed;
  }

 private:
  std::string missing() const {
    if (!check_.empty()) return {};
    if (occupancy_.empty()) return "--occupancy";
    return trajectory_.empty() ? "--trajectory" : "";
  }

  map::HeightBand height_band(const geometry::VehicleShape& vehicle) const {
    if (from_height_m_ < vehicle.height_m) {
      return {ground_m_ + from_height_m_, ground_m_ + vehicle.height_m};
    }
    throw map::InputError({.file = vehicle_.empty() ? "vehicle" : vehicle_.string(),
                           .place = {},
                           .element = "height_m",
                           .found = fmt::format("is {} m", vehicle.height_m),
                           .needed = fmt::format("more than --from-height, {} m", from_height_m_),
                           .remedy = "lower --from-height"});
  }

  // Says what lies apart from what; an occupancy apart from the map cannot be meant.
  std::vector<geometry::Ring> check_frames(std::ostream& err, bool quiet,
                                           const map::OccupancyMap& occupancy,
                                           const map::Box2& drive) const {
    const auto measured = bounds_of(occupancy.cells());
    if (!quiet && (!measured || !overlap(*measured, drive))) {
      fmt::print(err, "note: the drive ({}) lies outside the measured space ({})\n", text_of(drive),
                 measured ? text_of(*measured) : "none");
    }
    if (map_.empty()) return {};
    const map::RoadMap road_map = map::load_map(map_);
    std::optional<map::Box2> roads;
    std::vector<geometry::Ring> lanes = drivable_lanes(road_map);
    for (const geometry::Ring& lane : lanes) {
      for (const Eigen::Vector2d& point : lane) extend(roads, point, point);
    }
    if (roads && measured) check_overlap(*roads, *measured);
    if (!quiet && !road_map.crs().empty() && !occupancy.crs().empty() &&
        road_map.crs() != occupancy.crs()) {
      fmt::print(err, "note: the map's CRS is \"{}\", the occupancy's \"{}\"\n", road_map.crs(),
                 occupancy.crs());
    }
    return lanes;
  }

  void check_overlap(const map::Box2& roads, const map::Box2& measured) const {
    if (overlap(roads, measured)) return;
    throw map::InputError({.file = occupancy_.string(),
                           .place = {},
                           .element = {},
                           .found = fmt::format("covers {}", text_of(measured)),
                           .needed = fmt::format("the map's {}", text_of(roads)),
                           .remedy = "bring map and occupancy into one frame"});
  }

  static std::vector<map::Box2> occupied_boxes(const map::OccupancyMap& occupancy,
                                               const map::HeightBand& band) {
    std::vector<map::Box2> boxes;
    for (const map::OccupancyCell& cell : occupancy.cells()) {
      const double half_m = 0.5 * cell.size_m, z_m = cell.centre_in_source.z();
      if (cell.state != map::CellState::occupied) continue;
      if (z_m + half_m <= band.from_m || z_m - half_m >= band.to_m) continue;
      const Eigen::Array2d centre = cell.centre_in_source.head<2>();
      boxes.push_back({centre - half_m, centre + half_m});
    }
    return boxes;
  }

  void print(std::ostream& out, const AuditReport& report) const {
    if (json_) {
      out << audit_json(report).dump(2) << '\n';
    } else {
      out << audit_text(report);
    }
  }

  std::filesystem::path occupancy_, trajectory_, vehicle_, map_, svg_, certificate_, check_;
  AuditOptions options_;
  double ground_m_ = 0.0, from_height_m_ = map::HeightBand{}.from_m;
  bool json_ = false, force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_audit_command() { return std::make_unique<AuditCommand>(); }

}  // namespace roadbed::tools
