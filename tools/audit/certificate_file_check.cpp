#include "roadbed/tools/audit/certificate_file_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/occupancy/ground/drive_ground.h"
#include "roadbed/map/occupancy/ground/ground.h"
#include "roadbed/map/occupancy/octree/tiled_occupancy.h"
#include "roadbed/planning/audit/check/certificate_check.h"
#include "roadbed/tools/audit/audit_subjects.h"
#include "roadbed/tools/audit/audited_drive.h"
#include "roadbed/tools/audit/certificate_json.h"
#include "roadbed/tools/files/json.h"
#include "roadbed/tools/files/trajectory_csv.h"
#include "roadbed/tools/files/vehicle_file.h"

namespace roadbed::tools::inline audit {
namespace {

using planning::GroundRule;

namespace fs = std::filesystem;
/// A file that a certificate is about, as it was found.
struct CheckedFile {
  std::string role;
  CertifiedFile file;
};

/// Looks at one certificate.
class CertificateCheck {
 public:
  CertificateCheck(const fs::path& name, const CertificateDemands& demands, const Inputs& inputs)
      : name_(name), demands_(demands), inputs_(inputs), file_(read_certificate_json(name)) {}

  bool run() {
    compare_files();
    compare_demands();
    if (!faults_.empty()) return false;
    drive_ = read_trajectory_csv(path_of(file_.trajectory, demands_.trajectory));
    check_claims();
    return faults_.empty();
  }

  void print(std::ostream& out) const;
  Json json() const;

 private:
  using Line = std::function<void(const std::string& head, const std::string& text)>;
  void print_surface(const Line& line) const;
  void print_clearance(const Line& line) const;

  static fs::path path_of(const CertifiedFile& named, const fs::path& demanded) {
    return demanded.empty() ? fs::path(named.name) : demanded;
  }

  // What cannot be read proves nothing: no claim may rest on it.
  void compare(const std::string& role, const std::optional<CertifiedFile>& named,
               const fs::path& demanded) {
    if (!named) {
      if (!demanded.empty()) {
        faults_.push_back(
            fmt::format("it is about no {}, and {} is required", role, demanded.string()));
      }
      return;
    }
    try {
      const CertifiedFile found = certified(role, path_of(*named, demanded));
      files_.push_back({role, found});
      if (found.sha256 == named->sha256) return;
      faults_.push_back(fmt::format("{} {} has the hash {}, the certificate is about one with {}",
                                    role, found.name, found.sha256, named->sha256));
    } catch (const map::InputError& error) {
      faults_.push_back(fmt::format("{} cannot be looked at: {}", role, error.what()));
    }
  }

  CertifiedFile certified(const std::string& role, const fs::path& path) {
    if (role != "obstacles") return certified_file(path);
    moving_ = read_moving_obstacles(path, inputs_);
    return certified_obstacles(path, moving_);
  }

  void compare_files() {
    compare("occupancy", file_.occupancy, demands_.occupancy);
    compare("trajectory", file_.trajectory, demands_.trajectory);
    compare("vehicle", file_.vehicle, demands_.vehicle);
    compare("map", file_.roads, demands_.map);
    compare("obstacles", file_.obstacles, demands_.obstacles);
  }

  void demand(const std::string& what, std::optional<double> demanded, double proven,
              const std::string& unit = " m") {
    constexpr double rounding = 1e-12;
    if (!demanded || std::abs(*demanded - proven) <= rounding) return;
    faults_.push_back(
        fmt::format("it is about {} {:.9g}{}, not {:.9g}{}", what, proven, unit, *demanded, unit));
  }

  /// What options ask of something that the certificate is not about.
  void about_no(std::string_view what,
                std::initializer_list<std::pair<std::string_view, bool>> options) {
    for (const auto& [name, is_given] : options) {
      if (is_given)
        faults_.push_back(fmt::format("it is about no {}, and {} is given", what, name));
    }
  }

  void compare_demands() {
    demand("an underside at", demands_.underside_m, file_.underside_m);
    compare_surface();
    if (file_.parts.empty()) {
      about_no("occupied space", {{"--clearance", demands_.clearance_m.has_value()},
                                  {"--least-measured", demands_.least_measured.has_value()},
                                  {"--unknown", demands_.unknown.has_value()},
                                  {"--ground", !demands_.ground.empty()}});
      return;
    }
    const planning::AuditCertificate& question = file_.parts.front();
    demand("a clearance of", demands_.clearance_m, question.clearance_m);
    demand("a margin around the vehicle of", demands_.inflate_m, question.inflate_m);
    demand("a measured share of at least", demands_.least_measured, file_.least_measured, "");
    if (demands_.unknown && *demands_.unknown != question.unknown_policy) {
      faults_.push_back(fmt::format("unknown space counts as {}, not {}",
                                    planning::to_string(question.unknown_policy),
                                    planning::to_string(*demands_.unknown)));
    }
    if (!demands_.ground.empty() && ground_text() != demands_.ground) compare_ground();
  }

  void compare_surface() {
    if (!file_.surface) {
      about_no("surface", {{"--on", !demands_.on.empty()},
                           {"--margin", demands_.margin_m.has_value()},
                           {"--seam", demands_.seam_m.has_value()}});
      return;
    }
    const CertifiedSurface& surface = *file_.surface;
    if (!demands_.on.empty() && demands_.on != surface.on) {
      faults_.push_back(fmt::format("it is about staying on {}, not {}", surface.on, demands_.on));
    }
    demand("a distance from the edge of", demands_.margin_m, surface.margin_m);
    demand("closed seams of", demands_.seam_m, surface.seam_m);
    demand("a margin around the vehicle of", demands_.inflate_m, surface.inflate_m);
    if (surface.file) compare("surface", surface.file, {});
  }

  void compare_ground() {
    const GroundRule asked = ground_rule(demands_.ground, nullptr);
    const bool is_map = demands_.ground == "map";
    const GroundRule::Kind kind = is_map ? GroundRule::Kind::map : asked.kind;
    const bool is_same = kind == file_.ground.kind && (kind != GroundRule::Kind::level ||
                                                       asked.level_m == file_.ground.under.level_m);
    if (is_same) return;
    faults_.push_back(fmt::format("heights are above {}, not {}", ground_text(), demands_.ground));
  }

  std::string ground_text() const {
    if (file_.ground.kind == GroundRule::Kind::map) return "map";
    if (file_.ground.kind == GroundRule::Kind::measured) return "measured";
    return fmt::format("{:.9g}", file_.ground.under.level_m);
  }

  // Of a tiled occupancy only the tiles within reach of the claims.
  std::vector<map::OccupancyCell> cells_of(const map::OccupancySource& occupancy) const {
    const auto* tiles = dynamic_cast<const map::TiledOccupancy*>(&occupancy);
    if (tiles == nullptr) return occupancy.cells();
    double far_m = 0.0;
    for (const planning::AuditCertificate& part : file_.parts) {
      far_m = std::max(far_m, planning::checked_distance_m(part, drive_));
    }
    constexpr double any_height_m = 1e6;
    const Eigen::Vector3d margin(far_m, far_m, any_height_m);
    std::vector<map::Box3> boxes;
    for (const geometry::TrajectoryPoint& sample : drive_.points()) {
      const Eigen::Vector3d at(sample.x_m, sample.y_m, 0.0);
      boxes.push_back({at - margin, at + margin});
    }
    return tiles->cells_of_tiles(boxes);
  }

  void check_claims() {
    std::shared_ptr<const map::RoadMap> road_map;
    const bool is_on_map = file_.surface || file_.ground.kind == GroundRule::Kind::map;
    if (is_on_map && file_.roads) {
      road_map = inputs_.road_map(path_of(*file_.roads, demands_.map));
    }
    const Vehicle vehicle =
        file_.vehicle ? read_vehicle(path_of(*file_.vehicle, demands_.vehicle)) : Vehicle{};
    if (file_.occupancy) check_clearance(vehicle, road_map.get());
    if (!file_.surface) return;
    const auto faults =
        surface_faults(*file_.surface, vehicle.parts(file_.underside_m), road_map.get(), drive_);
    faults_.insert(faults_.end(), faults.begin(), faults.end());
  }

  void check_clearance(const Vehicle& vehicle, const map::RoadMap* road_map) {
    const auto occupancy = inputs_.occupancy(path_of(*file_.occupancy, demands_.occupancy));
    faults_ = part_faults(file_, vehicle);
    if (!faults_.empty()) return;
    try {
      const std::vector<map::OccupancyCell> cells = cells_of(*occupancy);
      faults_ = ground_faults_of(file_, drive_, road_map, cells, occupancy->resolution_m());
      for (const planning::AuditCertificate& part : file_.parts) {
        for (const std::string& fault :
             planning::check_certificate(part, cells, occupancy->resolution_m(), drive_, moving_)) {
          faults_.push_back(file_.parts.size() == 1 ? fault : part.part.name + ": " + fault);
        }
      }
    } catch (const std::length_error& too_long) {
      throw map::InputError(
          {.file = name_.string(), .found = too_long.what(), .remedy = "audit the drive in parts"});
    }
  }

  std::string question() const;
  bool is_whole() const {
    return std::ranges::all_of(file_.parts, [](const planning::AuditCertificate& part) {
      return part.certified_clearance_m > 0.0;
    });
  }

  fs::path name_;
  const CertificateDemands& demands_;
  const Inputs& inputs_;
  CertificateFile file_;
  geometry::Trajectory drive_;
  std::vector<planning::ObstacleInSource> moving_;
  std::vector<CheckedFile> files_;
  std::vector<std::string> faults_;
};

std::string part_text(const planning::AuditCertificate& audit) {
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

// What the verdict is about: a certificate of another question proves nothing of one's own.
std::string CertificateCheck::question() const {
  std::string text;
  if (file_.surface) {
    text = fmt::format("on {}, {} m from its edge, seams of {} m closed, the vehicle grown by {} m",
                       file_.surface->on, file_.surface->margin_m, file_.surface->seam_m,
                       file_.surface->inflate_m);
    if (file_.parts.empty()) return text;
    text += "; ";
  }
  const planning::AuditCertificate& audit = file_.parts.front();
  for (const planning::AuditCertificate& part : file_.parts) text += part_text(part) + "; ";
  if (const map::Ground* ground = audit.band.ground; ground != nullptr && !drive_.empty()) {
    const auto [low_m, high_m] = map::heights_at_samples_m(*ground, drive_);
    text += fmt::format("above ground at z {:.2f} m to {:.2f} m at the drive's samples ({}); ",
                        low_m, high_m, ground_text());
  }
  return text +
         fmt::format("grown by {} m; clearance {} m; unknown space counts as {}; {}",
                     audit.inflate_m, audit.clearance_m, planning::to_string(audit.unknown_policy),
                     file_.obstacles ? "dynamic obstacles are those of " + file_.obstacles->name
                                     : "no dynamic obstacles");
}

void CertificateCheck::print(std::ostream& out) const {
  const Line line = [&](const std::string& head, const std::string& text) {
    out << fmt::format("{:<17}{}\n", head, text);
  };
  line("certificate", faults_.empty() ? "holds" : "does not hold");
  line("verdict", fmt::format("{}, as written by {}", to_string(file_.verdict()), file_.program));
  line("question", question());
  for (const CheckedFile& checked : files_) {
    line(checked.role, fmt::format("{}, SHA-256 {}", checked.file.name, checked.file.sha256));
  }
  if (!file_.vehicle) line("vehicle", "none named: CommonRoad's vehicle 2");
  if (file_.surface) print_surface(line);
  if (!file_.parts.empty()) print_clearance(line);
  for (const std::string& fault : faults_) line("fault", fault);
}

void CertificateCheck::print_surface(const Line& line) const {
  std::size_t spans = 0;
  for (const planning::SurfaceCertificate& part : file_.surface->parts) {
    spans += part.from_edge.size();
  }
  line("on the surface", fmt::format("{} proven spans from its edge", spans));
  if (file_.surface->certified_margin_m() > 0.0) {
    line("certified", fmt::format("{:.3f} m from its edge", file_.surface->certified_margin_m()));
  }
}

void CertificateCheck::print_clearance(const Line& line) const {
  line("measured", fmt::format("{:.1f} % of the space that the vehicle takes, {:g} % required",
                               100.0 * file_.measured_fraction(), 100.0 * file_.least_measured));
  std::size_t from_occupied = 0, from_unknown = 0, from_moving = 0;
  for (const planning::AuditCertificate& part : file_.parts) {
    from_occupied += part.from_occupied.size();
    from_unknown += part.from_unknown.size();
    from_moving += part.from_moving.size();
  }
  line("proven spans",
       fmt::format("{} from occupied space, {} from unknown space, {} from dynamic obstacles",
                   from_occupied, from_unknown, from_moving));
  if (is_whole()) line("certified", fmt::format("{:.3f} m", file_.certified_clearance_m()));
}

Json CertificateCheck::json() const {
  Json files = Json::array();
  for (const CheckedFile& checked : files_) {
    files.push_back(
        {{"role", checked.role}, {"file", checked.file.name}, {"sha256", checked.file.sha256}});
  }
  Json json{{"roadbed_certificate_check", 1},
            {"holds", faults_.empty()},
            {"question", question()},
            {"verdict", to_string(file_.verdict())}};
  if (file_.surface) json["certified_margin_m"] = file_.surface->certified_margin_m();
  if (!file_.parts.empty()) {
    json["certified_clearance_m"] = file_.certified_clearance_m();
    json["measured_share"] = file_.measured_fraction();
    json["least_measured"] = file_.least_measured;
  }
  json["files"] = std::move(files);
  json["faults"] = faults_;
  return json;
}

}  // namespace

bool check_certificate_file(const fs::path& certificate, const CertificateDemands& demands,
                            bool json, const Inputs& inputs, std::ostream& out) {
  CertificateCheck check(certificate, demands, inputs);
  const bool holds = check.run();
  if (json) {
    out << map::json_text(check.json(), 2) << '\n';
  } else {
    check.print(out);
  }
  return holds;
}

}  // namespace roadbed::tools::audit
