#include "roadbed/tools/support/certificate_check.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "roadbed/map/input_error.h"
#include "roadbed/map/occupancy/occupancy_map.h"
#include "roadbed/planning/audit_certificate_check.h"
#include "roadbed/tools/support/certificate_json.h"
#include "roadbed/tools/support/moving_obstacles.h"
#include "roadbed/tools/support/trajectory_csv.h"

namespace roadbed::tools {
namespace {

namespace fs = std::filesystem;

// A file that is not the one of the certificate proves nothing of it.
void compare(const CertifiedFile& claimed, const CertifiedFile& found,
             std::vector<std::string>& faults) {
  if (found.xxhash == claimed.xxhash) return;
  faults.push_back(fmt::format("{} has the hash {}, the certificate is about one with {}",
                               found.name, found.xxhash, claimed.xxhash));
}

std::vector<std::string> faults_of(const CertificateFile& file, const fs::path& occupancy_file,
                                   const fs::path& trajectory_file, const fs::path& obstacles_file,
                                   const fs::path& name) {
  std::vector<std::string> faults;
  compare(file.occupancy, certified_file(occupancy_file), faults);
  compare(file.trajectory, certified_file(trajectory_file), faults);
  std::vector<planning::MovingObstacle> moving;
  if (file.obstacles) {
    const fs::path from = obstacles_file.empty() ? fs::path(file.obstacles->name) : obstacles_file;
    moving = read_moving_obstacles(from);
    compare(*file.obstacles, certified_obstacles(from, moving), faults);
  } else if (!obstacles_file.empty()) {
    faults.push_back(fmt::format("the certificate is not about what moves in {}, nor anywhere else",
                                 obstacles_file.string()));
  }
  if (!faults.empty()) return faults;
  const geometry::Trajectory drive = read_trajectory_csv(trajectory_file);
  const map::OccupancyMap occupancy = map::OccupancyMap::load(occupancy_file);
  try {
    return planning::check_certificate(file.certificate, occupancy.cells(),
                                       occupancy.resolution_m(), drive, moving);
  } catch (const std::length_error& too_long) {
    throw map::InputError({.file = name.string(),
                           .place = {},
                           .element = {},
                           .found = too_long.what(),
                           .needed = {},
                           .remedy = "audit the drive in parts"});
  }
}

// What the verdict is about: a certificate of another question proves nothing of one's own.
std::string question_of(const CertificateFile& file) {
  const planning::AuditCertificate& audit = file.certificate;
  return fmt::format(
      "body {} m by {} m, {} m of it behind the rear axle, grown by {} m; heights {} m to {} m; "
      "clearance {} m; unknown space counts as {}; {}",
      audit.vehicle.length_m, audit.vehicle.width_m, audit.vehicle.rear_overhang_m, audit.inflate_m,
      audit.band.from_m, audit.band.to_m, audit.clearance_m, planning::name(audit.unknown_policy),
      file.obstacles ? "what moves is that of " + file.obstacles->name : "nothing moves");
}

void print(std::ostream& out, const CertificateFile& file, const std::vector<std::string>& faults) {
  const planning::AuditCertificate& audit = file.certificate;
  out << fmt::format("{:<17}{}\n", "certificate", faults.empty() ? "holds" : "does not hold");
  out << fmt::format("{:<17}{}, as written by {}\n", "verdict", name(audit.verdict), file.program);
  out << fmt::format("{:<17}{}\n", "question", question_of(file));
  out << fmt::format("{:<17}{} from occupied space, {} from unknown space, {} from what moves\n",
                     "proven spans", audit.from_occupied.size(), audit.from_unknown.size(),
                     audit.from_moving.size());
  if (audit.conflicts.empty() && audit.undecided.empty()) {
    out << fmt::format("{:<17}{:.3f} m\n", "certified", audit.certified_clearance_m);
  }
  for (const std::string& fault : faults) out << fmt::format("{:<17}{}\n", "fault", fault);
}

}  // namespace

bool check_certificate_file(const fs::path& certificate, const fs::path& occupancy,
                            const fs::path& trajectory, const fs::path& obstacles, bool json,
                            std::ostream& out) {
  const CertificateFile file = read_certificate_json(certificate);
  const std::vector<std::string> faults = faults_of(
      file, occupancy.empty() ? fs::path(file.occupancy.name) : occupancy,
      trajectory.empty() ? fs::path(file.trajectory.name) : trajectory, obstacles, certificate);
  if (json) {
    out << nlohmann::ordered_json{{"holds", faults.empty()},
                                  {"question", question_of(file)},
                                  {"verdict", name(file.certificate.verdict)},
                                  {"certified_clearance_m", file.certificate.certified_clearance_m},
                                  {"faults", faults}}
               .dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
        << '\n';
  } else {
    print(out, file, faults);
  }
  return faults.empty();
}

}  // namespace roadbed::tools
