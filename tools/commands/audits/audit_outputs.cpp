#include "roadbed/tools/commands/audits/audit_outputs.h"

#include <algorithm>
#include <optional>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/tools/cli/build_id.h"
#include "roadbed/tools/commands/audits/audit_frames.h"
#include "roadbed/tools/commands/audits/audit_output.h"
#include "roadbed/tools/files/drive_file.h"
#include "roadbed/tools/files/obstacles_csv.h"
#include "roadbed/tools/files/trajectory_csv.h"
#include "roadbed/tools/report/audit_pages.h"
#include "roadbed/tools/report/audit_pictures.h"
#include "roadbed/tools/report/drive_mcap.h"
#include "roadbed/tools/report/report.h"
#include "roadbed/tools/report/surroundings.h"

namespace roadbed::tools::inline commands::inline audits {
namespace {

// Lanes that a picture of a drive can show: it is wider or higher than the drive's box by less
// than three times the box's longer side.
std::vector<geometry::Ring> drawn_lanes(const AuditedDrive& audited, const AuditScene& scene) {
  if (scene.road_map == nullptr) return {};
  const map::Box2 box = drawn(audited, scene);
  const double side_m = (box.max_in_source - box.min_in_source).maxCoeff();
  const Eigen::Vector2d margin_m = Eigen::Vector2d::Constant(3.0 * side_m);
  return drivable_rings(*scene.road_map,
                        {box.min_in_source - margin_m, box.max_in_source + margin_m});
}

std::vector<map::Box2> boxes_in(const map::Box2& around, const AuditedDrive& audited,
                                const AuditScene& scene) {
  if (!scene.occupancy) return {};
  return occupied_boxes(*scene.occupancy, scene.question.heights(audited.audit.ground), around);
}

// The surface that the drive has to stay on; else lanes.
std::vector<geometry::Ring> drawn_ground(const AuditedDrive& audited, const AuditScene& scene) {
  if (!audited.road) return drawn_lanes(audited, scene);
  std::vector<geometry::Ring> rings;
  for (const geometry::Polygon& polygon : audited.road->made->polygons_in_source) {
    rings.push_back(polygon.outer);
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  }
  return rings;
}

ReportInput page_of(const AuditedDrive& audited, const AuditScene& scene) {
  return report_of_audit(audited.drive, audited.whole(), surroundings_of(audited, scene));
}

// Who checks a certificate hashes its files again.
void refuse_certificate_of_streams(const AuditAsked& asked, const AuditSubjects& subjects) {
  for (const auto& file : {asked.occupancy_file(), subjects.file(), asked.vehicle_file(),
                           asked.map_file(), asked.obstacles_file()}) {
    if (map::is_stream(file)) certified_file(file);  // says why not
  }
}

// That of a surface has no word for what is unknown.
void refuse_certificate_of_gaps(const AuditedDrive& audited) {
  if (audited.between_poses.empty()) return;
  const planning::Stretch& gap = audited.between_poses.front();
  throw map::InputError(
      {.file = audited.name,
       .found = fmt::format("its log says no pose from {:.3f} s to {:.3f} s", gap.from_s, gap.to_s),
       .needed = "all of the drive for a certificate of --on alone",
       .remedy = "leave out --certificate"});
}

// Who checks it gets the drive as it was audited, and needs no options to read it.
void refuse_certificate_of_logs(const AuditSubjects& subjects) {
  if (subjects.is_swept() || subjects.is_folder() || is_drive_table(subjects.file())) return;
  throw map::InputError({.file = map::input_name(subjects.file()),
                         .found = "is no .csv of a drive, which certificates are about",
                         .needed = "--save-drive beside --certificate",
                         .remedy = "give it"});
}

}  // namespace

std::vector<Argument> AuditOutputs::declare(Arguments& arguments) {
  const Argument svg =
      arguments.add("--svg", svg_, "Draw the audit of one drive as a picture (.svg)")
          .writes(".svg");
  const Argument page =
      arguments
          .add("--report", report_,
               "Write a page that plays the audit of one drive, or lists those of a folder, with "
               "close-ups (.html)")
          .writes(".html");
  const Argument log =
      arguments
          .add("--mcap", mcap_,
               "Write a log that plays the audit of one drive in Foxglove, Lichtblick and Rerun "
               "(.mcap): poses, lanes, obstacles, occupied space, stretches by verdict")
          .writes(".mcap");
  const Argument certificate =
      arguments
          .add("--certificate", certificate_,
               "Write the proof of one drive (.json): spans of time, what holds in them, "
               "witnesses, hashes of the inputs")
          .writes(".json");
  const Argument junit =
      arguments.add("--junit", junit_, "Write a test case per drive (.xml)").writes(".xml");
  const Argument geojson =
      arguments
          .add("--geojson", geojson_,
               "Write stretches, conflicts and witnesses (.geojson), in the occupancy's "
               "coordinates")
          .writes(".geojson");
  const Argument saved = arguments
                             .add("--save-drive", saved_drive_,
                                  "Write the drive that was audited, poses of the rear axle (.csv)")
                             .writes(".csv");
  const Argument occupancy =
      arguments
          .add("--save-occupancy", saved_occupancy_,
               "Write the occupancy that was audited, of clouds or of --log, as an octree (.bt)")
          .writes(".bt");
  const Argument obstacles =
      arguments
          .add("--save-obstacles", saved_obstacles_,
               "Write the dynamic obstacles that were audited, as --obstacles reads them (.csv); a "
               "header only where there are none")
          .writes(".csv");
  return {svg, page, log, certificate, junit, geojson, saved, occupancy, obstacles};
}

void AuditOutputs::declare_force(Arguments& arguments) {
  arguments.flag("-f,--force", force_, "Replace outputs that exist");
}

void AuditOutputs::check(const AuditAsked& asked, const AuditSubjects& subjects) const {
  for (const auto& output : {svg_, report_, mcap_, certificate_, junit_, geojson_, saved_drive_,
                             saved_occupancy_, saved_obstacles_}) {
    if (!output.empty()) map::check_writable(output, force_);
  }
  if (!certifies()) return;
  refuse_certificate_of_streams(asked, subjects);
  if (!saves_drive()) refuse_certificate_of_logs(subjects);
}

// Who checks it reads them in the time of their own planning problem.
void AuditOutputs::check_clock(const AuditAsked& asked) const {
  if (!certifies() || saves_obstacles() || !asked.shifts_obstacles()) return;
  throw map::InputError({.file = map::input_name(asked.obstacles_file()),
                         .found = "begins at another time step than second 0 of the drive",
                         .needed = "--save-obstacles beside --certificate",
                         .remedy = "give it"});
}

void AuditOutputs::check_for_folder() const {
  if (svg_.empty() && mcap_.empty() && certificate_.empty() && !saves_drive() &&
      !saves_occupancy() && !saves_obstacles()) {
    return;
  }
  throw map::InputError({.file = "--svg, --mcap, --certificate or --save-…",
                         .found = "is about one drive, and --trajectory is a folder",
                         .remedy = "give one file"});
}

void AuditOutputs::write_one(const AuditedDrive& audited, const AuditScene& scene) const {
  if (certifies() && !audited.has_occupancy) refuse_certificate_of_gaps(audited);
  map::OutputFiles files(force_);
  const Saved saved = add_saved(audited, scene, files);
  if (!svg_.empty()) files.add(svg_, picture(audited, scene));
  if (!report_.empty()) files.add(report_, drive_report_html(page_of(audited, scene)));
  if (!mcap_.empty()) {
    files.add(mcap_, drive_mcap(page_of(audited, scene), space_of(audited, scene)));
  }
  if (certifies()) files.add(certificate_, certificate(audited, scene, saved));
  add_lists({audited}, scene, files);
  files.commit();
}

void AuditOutputs::write_all(const std::vector<AuditedDrive>& audits,
                             const AuditScene& scene) const {
  map::OutputFiles files(force_);
  if (!report_.empty()) files.add(report_, index(audits, scene));
  add_lists(audits, scene, files);
  files.commit();
}

AuditOutputs::Saved AuditOutputs::add_saved(const AuditedDrive& audited, const AuditScene& scene,
                                            map::OutputFiles& files) const {
  Saved saved;
  const auto add = [&](const std::filesystem::path& file, const std::string& bytes) {
    files.add(file, bytes);
    return certifies() ? certified_bytes(file, bytes) : CertifiedFile{};
  };
  if (saves_drive()) saved.drive = add(saved_drive_, write_trajectory_csv(audited.drive));
  if (saves_occupancy()) {
    const auto* octree = dynamic_cast<const map::OccupancyMap*>(scene.occupancy.get());
    if (octree == nullptr) {
      throw map::InputError({.file = map::input_name(scene.asked.occupancy_file()),
                             .found = "is a folder of tiles, or none is given",
                             .needed = "one octree for --save-occupancy",
                             .remedy = "leave that out"});
    }
    saved.occupancy = add(saved_occupancy_, octree->to_bt());
  }
  if (saves_obstacles()) {
    files.add(saved_obstacles_, write_obstacles_csv(scene.question.moving_in_source));
  }
  return saved;
}

std::string AuditOutputs::picture(const AuditedDrive& audited, const AuditScene& scene) const {
  const planning::AuditReport whole = audited.whole();
  return audit_svg({audited.drive, scene.question.inflated_parts(), whole,
                    boxes_in(drawn(audited, scene), audited, scene), drawn_ground(audited, scene),
                    scene.question.moving_in_source, !scene.occupancy});
}

std::string AuditOutputs::index(const std::vector<AuditedDrive>& audits,
                                const AuditScene& scene) const {
  const std::vector<geometry::BodyPart> parts = scene.question.inflated_parts();
  std::vector<IndexedAudit> index;
  for (const AuditedDrive& audited : audits) {
    index.push_back(indexed(audited));
    if (!audited.fault.empty()) continue;
    const auto occupied = [&](const map::Box2& shown) { return boxes_in(shown, audited, scene); };
    const std::vector<geometry::Ring> lanes = drawn_ground(audited, scene);
    index.back().pictures = close_ups(
        audited.whole(), {audited.drive, parts, occupied, lanes, scene.question.moving_in_source});
  }
  return audit_index_html(index, scene.asked.suite(), name_and_version());
}

std::string AuditOutputs::certificate(const AuditedDrive& audited, const AuditScene& scene,
                                      const Saved& saved) const {
  const AuditAsked& asked = scene.asked;
  CertificateFile file{.program = name_and_version(),
                       .trajectory = saved.drive ? *saved.drive : certified_file(scene.drive_file),
                       .underside_m = asked.from_height_m(),
                       .ground = {scene.question.ground.kind, audited.audit.ground},
                       .least_measured = asked.options().least_measured,
                       .parts = audited.audit.certificates};
  if (saved.occupancy) {
    file.occupancy = saved.occupancy;
  } else if (scene.occupancy) {
    file.occupancy = hashed_once(scene, asked.occupancy_file());
  }
  const auto& obstacles = saves_obstacles() ? saved_obstacles_ : asked.obstacles_file();
  const bool has_obstacles = !obstacles.empty() && !scene.question.moving_in_source.empty();
  if (has_obstacles && scene.occupancy) {
    file.obstacles = certified_obstacles(obstacles, scene.question.moving_in_source);
  }
  if (!asked.vehicle_file().empty()) file.vehicle = certified_file(asked.vehicle_file());
  if (!asked.map_file().empty()) file.roads = hashed_once(scene, asked.map_file());
  if (audited.road) file.surface = certified_surface(*audited.road, asked.options().inflate_m);
  return write_certificate_json(file);
}

void AuditOutputs::add_lists(const std::vector<AuditedDrive>& audits, const AuditScene& scene,
                             map::OutputFiles& files) const {
  if (!junit_.empty()) files.add(junit_, audits_junit(audits, scene.asked.suite()));
  if (!geojson_.empty()) {
    files.add(geojson_, audits_geojson(audits, scene.question, scene.crs()));
  }
}

}  // namespace roadbed::tools::commands::audits
