#include "roadbed/tools/support/certificate_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "roadbed/map/input_error.h"
#include "roadbed/map/occupancy/ground.h"
#include "roadbed/map/occupancy/tiled_occupancy.h"
#include "roadbed/planning/audit_certificate_check.h"
#include "roadbed/planning/ground_claims.h"
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

// Of a tiled occupancy only the tiles within reach of the claims.
std::vector<map::OccupancyCell> cells_for(const map::OccupancySource& occupancy,
                                          const CertificateFile& file,
                                          const geometry::Trajectory& drive) {
  const auto* tiles = dynamic_cast<const map::TiledOccupancy*>(&occupancy);
  if (tiles == nullptr) return occupancy.cells();
  double far_m = 0.0;
  for (const planning::AuditCertificate& part : file.parts) {
    far_m = std::max(far_m, planning::checked_distance_m(part, drive));
  }
  constexpr double any_height_m = 1e6;
  const Eigen::Vector3d margin(far_m, far_m, any_height_m);
  std::vector<map::Box3> boxes;
  for (const geometry::TrajectoryPoint& row : drive.points()) {
    const Eigen::Vector3d at(row.x_m, row.y_m, 0.0);
    boxes.push_back({at - margin, at + margin});
  }
  return tiles->cells_of_tiles(boxes);
}

// A vehicle or map that is still there must be the one that was taken.
void compare_if_there(const std::optional<CertifiedFile>& claimed,
                      std::vector<std::string>& faults) {
  std::error_code unreadable;
  if (!claimed || !fs::exists(claimed->name, unreadable)) return;
  compare(*claimed, certified_file(claimed->name), faults);
}

std::vector<std::string> faults_of_ground(const CertificateFile& file,
                                          const geometry::Trajectory& drive) {
  if (!file.ground) return {};
  double reach_m = 0.0;
  for (const planning::AuditCertificate& part : file.parts) {
    reach_m = std::max(reach_m, part.part.reach_m() + std::sqrt(2.0) * part.inflate_m);
  }
  return planning::ground_faults(*file.ground, drive, reach_m);
}

std::vector<std::string> faults_of(const CertificateFile& file, const fs::path& occupancy_file,
                                   const fs::path& trajectory_file, const fs::path& obstacles_file,
                                   const fs::path& name, const Inputs& inputs) {
  std::vector<std::string> faults;
  compare(file.occupancy, certified_file(occupancy_file), faults);
  compare(file.trajectory, certified_file(trajectory_file), faults);
  std::vector<planning::MovingObstacle> moving;
  if (file.obstacles) {
    const fs::path from = obstacles_file.empty() ? fs::path(file.obstacles->name) : obstacles_file;
    moving = read_moving_obstacles(from, inputs);
    compare(*file.obstacles, certified_obstacles(from, moving), faults);
  } else if (!obstacles_file.empty()) {
    faults.push_back(fmt::format("the certificate is not about what moves in {}, nor anywhere else",
                                 obstacles_file.string()));
  }
  compare_if_there(file.vehicle, faults);
  compare_if_there(file.roads, faults);
  if (!faults.empty()) return faults;
  const geometry::Trajectory drive = read_trajectory_csv(trajectory_file);
  faults = faults_of_ground(file, drive);
  const auto occupancy = inputs.occupancy(occupancy_file);
  try {
    const std::vector<map::OccupancyCell> cells = cells_for(*occupancy, file, drive);
    for (const planning::AuditCertificate& part : file.parts) {
      for (const std::string& fault :
           planning::check_certificate(part, cells, occupancy->resolution_m(), drive, moving)) {
        faults.push_back(file.parts.size() == 1 ? fault : part.part.name + ": " + fault);
      }
    }
    return faults;
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
std::string text_of(const planning::AuditCertificate& audit) {
  const geometry::BodyPart& part = audit.part;
  const std::string heights =
      fmt::format("heights {:.9g} m to {:.9g} m", audit.band.from_m, audit.band.to_m);
  if (part.is_circle()) {
    return fmt::format("{} of radius {:.9g} m at ({:.9g} m, {:.9g} m), {}", part.name,
                       part.radius_m, part.front_m, part.left_m, heights);
  }
  const std::string aside =
      part.left_m + part.right_m == 0.0
          ? ""
          : fmt::format(", its middle {:.9g} m to the left", part.middle_in_vehicle().y());
  return fmt::format("{} {:.9g} m by {:.9g} m, {:.9g} m of it behind the rear axle{}, {}",
                     part.name, part.length_m(), part.width_m(), -part.rear_m, aside, heights);
}

std::string question_of(const CertificateFile& file, const fs::path& trajectory_file) {
  const planning::AuditCertificate& audit = file.parts.front();
  std::string text;
  for (const planning::AuditCertificate& part : file.parts) text += text_of(part) + "; ";
  if (const map::Ground* ground = audit.band.ground) {
    const auto [low_m, high_m] =
        planning::heights_at_rows_m(*ground, read_trajectory_csv(trajectory_file));
    text += fmt::format(
        "above ground at z {:.2f} m to {:.2f} m at the drive's rows, as the certificate has it; ",
        low_m, high_m);
  }
  return text + fmt::format("grown by {} m; clearance {} m; unknown space counts as {}; {}",
                            audit.inflate_m, audit.clearance_m,
                            planning::name(audit.unknown_policy),
                            file.obstacles ? "what moves is that of " + file.obstacles->name
                                           : "nothing moves");
}

void print(std::ostream& out, const CertificateFile& file, const std::string& question,
           const std::vector<std::string>& faults) {
  out << fmt::format("{:<17}{}\n", "certificate", faults.empty() ? "holds" : "does not hold");
  out << fmt::format("{:<17}{}, as written by {}\n", "verdict", name(file.verdict()), file.program);
  out << fmt::format("{:<17}{}\n", "question", question);
  std::size_t from_occupied = 0, from_unknown = 0, from_moving = 0;
  bool is_whole = true;
  for (const planning::AuditCertificate& part : file.parts) {
    from_occupied += part.from_occupied.size();
    from_unknown += part.from_unknown.size();
    from_moving += part.from_moving.size();
    is_whole = is_whole && part.conflicts.empty() && part.undecided.empty();
  }
  out << fmt::format("{:<17}{} from occupied space, {} from unknown space, {} from what moves\n",
                     "proven spans", from_occupied, from_unknown, from_moving);
  if (is_whole) {
    out << fmt::format("{:<17}{:.3f} m\n", "certified", file.certified_clearance_m());
  }
  for (const std::string& fault : faults) out << fmt::format("{:<17}{}\n", "fault", fault);
}

}  // namespace

bool check_certificate_file(const fs::path& certificate, const fs::path& occupancy,
                            const fs::path& trajectory, const fs::path& obstacles, bool json,
                            const Inputs& inputs, std::ostream& out) {
  const CertificateFile file = read_certificate_json(certificate);
  const fs::path drive = trajectory.empty() ? fs::path(file.trajectory.name) : trajectory;
  const std::vector<std::string> faults =
      faults_of(file, occupancy.empty() ? fs::path(file.occupancy.name) : occupancy, drive,
                obstacles, certificate, inputs);
  const std::string question = question_of(file, drive);
  if (json) {
    out << nlohmann::ordered_json{{"holds", faults.empty()},
                                  {"question", question},
                                  {"verdict", name(file.verdict())},
                                  {"certified_clearance_m", file.certified_clearance_m()},
                                  {"faults", faults}}
               .dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
        << '\n';
  } else {
    print(out, file, question, faults);
  }
  return faults.empty();
}

}  // namespace roadbed::tools
