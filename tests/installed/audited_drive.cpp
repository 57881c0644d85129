// Is a drive clear of what was measured? An audit with a certificate, and its check by brute force.
//
//     audited_drive town.xodr town.bt 1/3/1 6 1/3/1 60 drive.csv
#include <roadbed/map/load_map.h>
#include <roadbed/map/occupancy/octree/tiled_occupancy.h>
#include <roadbed/planning/audit/audit_drive.h>
#include <roadbed/planning/audit/check/certificate_check.h>
#include <roadbed/planning/reference/reference_line.h>
#include <roadbed/planning/route/router.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>
#include <vector>

using namespace roadbed;

namespace {

/// Along the line at 8 m/s, in the coordinates of the file.
geometry::Trajectory drive_along(const map::RoadMap& map, const planning::ReferenceLine& line) {
  std::vector<geometry::TrajectoryPoint> points;
  for (double s_m = 0.0; s_m <= line.goal_s_m(); s_m += 0.5) {
    const planning::ReferencePoint at = line.at(s_m);
    const Eigen::Vector2d in_source = map.to_source(at.in_map);
    points.push_back({.t_s = s_m / 8.0,
                      .x_m = in_source.x(),
                      .y_m = in_source.y(),
                      .heading_rad = at.heading_rad,
                      .speed_mps = 8.0,
                      .curvature_per_m = at.curvature_per_m});
  }
  return geometry::Trajectory(points);
}

void write(const geometry::Trajectory& drive, const char* name) {
  std::FILE* file = std::fopen(name, "w");
  if (file == nullptr) return;
  std::fputs("t_s,x_m,y_m,heading_rad\n", file);
  for (const geometry::TrajectoryPoint& point : drive.points()) {
    std::fprintf(file, "%.17g,%.17g,%.17g,%.17g\n", point.t_s, point.x_m, point.y_m,
                 point.heading_rad);
  }
  std::fclose(file);
}

}  // namespace

int main(int count, char** arguments) try {
  if (count < 8) return 2;
  const map::RoadMap map = map::load_map(arguments[1]);
  const std::unique_ptr<map::OccupancySource> occupancy = map::open_occupancy(arguments[2]);
  const planning::RouteAnswer answer =
      planning::find_route(map, {map.find_lane(arguments[3]).value(), std::atof(arguments[4])},
                           {map.find_lane(arguments[5]).value(), std::atof(arguments[6])});
  if (!answer.route) return 1;
  const geometry::Trajectory drive =
      drive_along(map, planning::ReferenceLine::along(map, *answer.route));
  write(drive, arguments[7]);

  const planning::AuditQuestion question{.parts = {geometry::body_of(geometry::VehicleShape{})},
                                         .options = {.unknown = planning::UnknownPolicy::free},
                                         .certifies = true};
  const planning::DriveAudit audit = planning::audit_drive(*occupancy, drive, question);
  std::printf("%s, least clearance %.9f m\n",
              std::string(planning::to_string(audit.report.verdict)).c_str(),
              audit.report.least_clearance_m);

  std::vector<std::string> faults;
  for (const planning::AuditCertificate& certificate : audit.certificates) {
    for (const std::string& fault : planning::check_certificate(certificate, occupancy->cells(),
                                                                occupancy->resolution_m(), drive)) {
      faults.push_back(fault);
    }
    std::printf("certificate: at least %.9f m, %zu spans\n", certificate.certified_clearance_m,
                certificate.from_occupied.size());
  }
  for (const std::string& fault : faults) std::printf("does not hold: %s\n", fault.c_str());
  return faults.empty() && !audit.certificates.empty() ? 0 : 1;
} catch (const std::exception& fault) {
  std::fprintf(stderr, "%s\n", fault.what());
  return 1;
}
