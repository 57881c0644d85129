#include "roadbed/tools/audit/certificate_file_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "roadbed/map/occupancy/ground/drive_ground.h"
#include "roadbed/planning/audit/check/certificate_check.h"

namespace roadbed::tools::inline audit {
namespace {

using planning::GroundRule;

using geometry::BodyPart;
using map::GroundPlace;
using planning::AuditCertificate;

constexpr double kSame_m = 1e-9;

bool is_same(double a, double b) { return std::abs(a - b) <= kSame_m; }

std::string part_fault(const CertificateFile& file, const AuditCertificate& claimed,
                       const BodyPart& part) {
  const BodyPart& of = claimed.part;
  if (of.name != part.name) {
    return fmt::format("it is about a part \"{}\" where the vehicle has \"{}\"", of.name,
                       part.name);
  }
  if (!is_same(of.rear_m, part.rear_m) || !is_same(of.front_m, part.front_m) ||
      !is_same(of.right_m, part.right_m) || !is_same(of.left_m, part.left_m) ||
      !is_same(of.radius_m, part.radius_m)) {
    return fmt::format("{}: it is not as long, wide or placed as the vehicle's", part.name);
  }
  const double above_m = file.ground.under.surface ? 0.0 : file.ground.under.level_m;
  const double margin_m = file.ground.under.margin_m;
  if (!is_same(claimed.band.from_m, above_m + part.from_height_m - margin_m) ||
      !is_same(claimed.band.to_m, above_m + part.to_height_m + margin_m)) {
    return fmt::format(
        "{}: heights {:.9g} m to {:.9g} m are not those of the vehicle, {:.9g} m to "
        "{:.9g} m above the ground",
        part.name, claimed.band.from_m, claimed.band.to_m, part.from_height_m, part.to_height_m);
  }
  return {};
}

map::BodyReach reach_of(const CertificateFile& file) {
  map::BodyReach reach;
  for (const AuditCertificate& part : file.parts) {
    const double grown_m = part.part.radius_m + part.inflate_m;
    reach.rear_m = std::min(reach.rear_m, part.part.rear_m - grown_m);
    reach.front_m = std::max(reach.front_m, part.part.front_m + grown_m);
  }
  return reach;
}

// A level stands for planes a metre apart, from the drive's start to its end.
std::vector<GroundPlace> level_places(const geometry::Trajectory& drive, double level_m,
                                      const map::BodyReach& body, bool is_below_body) {
  constexpr double apart_m = 1.0;
  std::vector<GroundPlace> places;
  const auto& samples = drive.points();
  const auto take = [&](const geometry::TrajectoryPoint& state) {
    const Eigen::Vector2d axle = state.pose().position();
    const Eigen::Vector2d ahead(std::cos(state.heading_rad), std::sin(state.heading_rad));
    places.push_back({axle, level_m, {0.0, 0.0}});
    if (!is_below_body) return;
    for (double x_m = body.rear_m; x_m < body.front_m + apart_m; x_m += apart_m) {
      places.push_back({axle + std::min(x_m, body.front_m) * ahead, level_m, {0.0, 0.0}});
    }
  };
  take(samples.front());
  Eigen::Vector2d last = samples.front().pose().position();
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double way_m = (samples[i].pose().position() - samples[i - 1].pose().position()).norm();
    const double steps = std::ceil(way_m / apart_m);
    for (double step = 1.0; step <= steps; ++step) {
      const auto state = geometry::interpolate(samples[i - 1], samples[i], step / steps);
      const bool is_end = i + 1 == samples.size() && step == steps;
      if (!is_end && (state.pose().position() - last).norm() < apart_m) continue;
      take(state);
      last = state.pose().position();
    }
  }
  if ((samples.back().pose().position() - last).norm() > 0.0) take(samples.back());
  return places;
}

}  // namespace

std::vector<std::string> part_faults(const CertificateFile& file, const Vehicle& vehicle) {
  const std::vector<BodyPart> parts = vehicle.parts(file.underside_m);
  if (parts.size() != file.parts.size()) {
    return {fmt::format("it is about {} parts, and the vehicle has {}", file.parts.size(),
                        parts.size())};
  }
  std::vector<std::string> faults;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::string fault = part_fault(file, file.parts[i], parts[i]);
    if (!fault.empty()) faults.push_back(std::move(fault));
  }
  return faults;
}

std::vector<std::string> ground_faults_of(const CertificateFile& file,
                                          const geometry::Trajectory& drive,
                                          const map::RoadMap* road_map,
                                          const std::vector<map::OccupancyCell>& cells,
                                          double cell_m) {
  const planning::GroundUnder& under = file.ground.under;
  const bool is_measured = file.ground.kind == GroundRule::Kind::measured;
  const double margin_m = is_measured ? map::measured_ground_margin_m(cell_m) : 0.0;
  if (!is_same(under.margin_m, margin_m)) {
    return {fmt::format("the ground's margin is {:.9g} m, not {:.9g} m", margin_m, under.margin_m)};
  }
  if (file.ground.kind == GroundRule::Kind::level) {
    if (!under.surface) return {};
    return {"the ground is said to be level, and has places"};
  }
  const map::BodyReach body = reach_of(file);
  if (under.surface) {
    double reach_m = 0.0;
    for (const AuditCertificate& part : file.parts) {
      reach_m = std::max(reach_m, part.part.reach_m() + std::sqrt(2.0) * part.inflate_m);
    }
    std::vector<std::string> faults = map::ground_faults(*under.surface, drive, reach_m);
    if (!faults.empty()) return faults;
  }
  const std::vector<GroundPlace> places =
      under.surface ? under.surface->places()
                    : level_places(drive, under.level_m, body, is_measured);
  std::string fault;
  if (is_measured) {
    fault = planning::measured_ground_fault(places, cells, cell_m, drive, body);
  } else if (road_map == nullptr) {
    fault = "the ground is said to be that of a map, and none is named";
  } else {
    fault = planning::map_ground_fault(places, *road_map, drive);
  }
  if (fault.empty()) return {};
  return {fault};
}

}  // namespace roadbed::tools::audit
