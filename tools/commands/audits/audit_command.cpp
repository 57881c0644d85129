#include <fmt/format.h>
#include <fmt/ostream.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/files/json_text.h"
#include "roadbed/tools/audit/argoverse_log.h"
#include "roadbed/tools/audit/audit_all.h"
#include "roadbed/tools/audit/audit_subjects.h"
#include "roadbed/tools/audit/certificate_file_check.h"
#include "roadbed/tools/cli/freed_memory.h"
#include "roadbed/tools/cli/progress_bar.h"
#include "roadbed/tools/commands/audits/audit_asked.h"
#include "roadbed/tools/commands/audits/audit_frames.h"
#include "roadbed/tools/commands/audits/audit_output.h"
#include "roadbed/tools/commands/audits/audit_outputs.h"
#include "roadbed/tools/commands/audits/commands.h"
#include "roadbed/tools/files/json.h"
#include "roadbed/tools/files/obstacles_csv.h"
#include "roadbed/tools/files/trajectory_csv.h"

namespace roadbed::tools::inline commands::inline audits {
namespace {

class AuditCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description(
        "Prove that drives keep clear of occupied space and on the road, or show where they do "
        "not");
    asked_.declare_occupancy(arguments);
    std::vector<Argument> not_with_check = subjects_.declare(arguments);
    for (const Argument& other : asked_.declare(arguments)) not_with_check.push_back(other);
    declare_outputs(arguments, not_with_check);
    arguments.require([this] { return missing(); });
    arguments.says_no_if("a drive is not clear, or the certificate does not hold");
    arguments.example(
        "  roadbed audit --occupancy street.bt --trajectory drive/trajectory.csv "
        "--certificate proof.json\n"
        "  roadbed audit --check proof.json --vehicle car.json --clearance 0.3\n"
        "  roadbed audit --occupancy street.bt --trajectory drives --threads 4 --junit audit.xml\n"
        "  roadbed audit --occupancy street.bt --trajectory poses.txt --pose-frame rear-axle "
        "--save-drive poses.csv\n"
        "  roadbed audit --log data/argoverse_log --boxes annotated --unknown free --svg log.svg\n"
        "  roadbed audit --log data/argoverse_log --boxes annotated --unknown free --certificate "
        "log.json --save-drive log.csv --save-occupancy log.bt --save-obstacles log_boxes.csv\n"
        "  roadbed audit --occupancy scan_1.pcd --height 0.3,3 --trajectory drive/trajectory.csv\n"
        "  roadbed audit --occupancy street.bt --map town.xodr --lane lane:1/0/-1 --offset 0.3\n"
        "  roadbed audit --map town.xodr --on drivable --margin 0.1 --trajectory "
        "drive/trajectory.csv\n"
        "  roadbed audit --occupancy street.bt --map town.xodr --trajectory drive/trajectory.csv "
        "--mcap audit.mcap");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    if (!check_.empty()) {
      const bool holds = check_certificate_file(check_, asked_.demands(subjects_.file()), json_,
                                                *common.inputs, streams.out);
      return holds ? Exit::ok : Exit::no;
    }
    outputs_.check(asked_, subjects_);
    const LogScene of_log = subjects_.log().empty() ? LogScene() : take_log(common);
    asked_.take_drive(subjects_.file());
    outputs_.check_clock(asked_);
    AuditScene scene = audit_scene(asked_, outputs_.certifies(), common);
    if (of_log.occupancy == nullptr && asked_.leaves_obstacles() && !common.quiet) {
      fmt::print(streams.err,
                 "note: the obstacles of {} count with --occupancy only; its lights do\n",
                 asked_.obstacles_file().string());
    }
    scene.command = "roadbed audit " + asked_.against();
    if (asked_.obstacles_file().empty()) scene.question.moving_in_source = of_log.obstacles;
    if (outputs_.saves_obstacles()) as_saved(scene.question.moving_in_source);
    scene.occupancy = of_log.occupancy;
    if (!subjects_.is_swept()) scene.drive_file = subjects_.file();
    const std::vector<AuditSubject> subjects = subjects_.list(scene.road_map.get(), scene.shape);
    add_occupancy(scene, streams, common);
    return subjects_.is_folder() ? run_folder(subjects, scene, streams, common)
                                 : run_one(subjects.front(), scene, streams, common);
  }

 private:
  void declare_outputs(Arguments& arguments, const std::vector<Argument>& not_with_check) {
    arguments.heading("Outputs");
    arguments.flag("-j,--json", json_, "Print one JSON document");
    const std::vector<Argument> outputs = outputs_.declare(arguments);
    Argument check =
        arguments
            .add("--check", check_,
                 "Verify a certificate by brute force instead, from the files that it names. The "
                 "question's options, --occupancy and --trajectory say what it has to be about; "
                 "files may have moved, if they are the same")
            .reads(files_named_by_certificate)
            .ending(".json");
    for (const Argument& other : outputs) check.excludes(other);
    for (const Argument& other : not_with_check) check.excludes(other);
    outputs_.declare_force(arguments);
  }

  std::string missing() const {
    if (!check_.empty()) return check_fault();
    const bool has_log = !subjects_.log().empty();
    if (std::string fault = certificate_fault(); !fault.empty()) return fault;
    if (std::string fault = asked_.fault(); !has_log && !fault.empty()) return fault;
    if (!has_log && !asked_.asks()) return "--occupancy or --on is required";
    const bool has_map = !asked_.map_file().empty();
    if (std::string fault = subjects_.fault(has_map); !fault.empty()) return fault;
    return {};
  }

  std::string check_fault() const {
    if (subjects_.has_any_place()) {
      return "--from, --to and --via are not for --check: a certificate is about the drive of a "
             "file";
    }
    const std::string filter = asked_.filter().words();
    return filter.empty() ? "" : filter + " is not for --check: a certificate is about an octree";
  }

  // It is about files, which who checks it reads by themselves.
  std::string certificate_fault() const {
    if (!outputs_.certifies()) return {};
    if (asked_.has_rules()) {
      return "--certificate excludes --rules: no certificate holds what they found; ask for them "
             "by themselves";
    }
    const bool has_log = !subjects_.log().empty();
    const bool has_octree = !has_log || !asked_.occupancy_file().empty();
    std::string needed;
    const auto need = [&](const char* option, bool is_needed) {
      if (is_needed) needed += (needed.empty() ? "" : ", ") + std::string(option);
    };
    need("--save-drive", (has_log || subjects_.is_swept()) && !outputs_.saves_drive());
    need("--save-occupancy",
         (!has_octree || !asked_.filter().words().empty()) && !outputs_.saves_occupancy());
    need("--save-obstacles",
         has_log && asked_.obstacles_file().empty() && !outputs_.saves_obstacles());
    return needed.empty() ? "" : "--certificate needs " + needed + " here, as it is about files";
  }

  // Lengths are rounded in the file.
  static void as_saved(std::vector<planning::ObstacleInSource>& obstacles) {
    if (obstacles.empty()) return;
    obstacles = parse_obstacles_csv(write_obstacles_csv(obstacles), "obstacles.csv");
  }

  // What is not given is the log's.
  LogScene take_log(const CommonOptions& common) {
    const ArgoverseLog log = argoverse_log(subjects_.log());
    asked_.take_map_of_log(log.map);
    if (!asked_.occupancy_file().empty() && !asked_.obstacles_file().empty()) return {};
    return scene_of_log(log, subjects_.log_boxes(), common.threads);
  }

  Exit run_folder(const std::vector<AuditSubject>& subjects, const AuditScene& scene,
                  const Streams& streams, const CommonOptions& common) const {
    outputs_.check_for_folder();
    keep_freed_memory();  // each drive takes and frees surroundings of its own
    ProgressBar progress(subjects.size(), !common.quiet && isatty(STDERR_FILENO) == 1);
    const std::vector<AuditedDrive> audits =
        audit_all(scene.demand(), subjects, common.threads, [&] { progress.done_one(); });
    for (const AuditedDrive& audited : audits) {
      if (!common.quiet && audited.fault.empty()) print_notes(audited, scene, streams.err);
    }
    outputs_.write_all(audits, scene);
    if (json_) {
      streams.out << text_of_json(versioned("audits", with_removal(audits_json(audits), scene)));
    } else {
      streams.out << audits_table(audits);
    }
    return std::ranges::all_of(audits, &AuditedDrive::is_clear) ? Exit::ok : Exit::no;
  }

  // Of its file, and of what the vehicle could not drive; audited all the same.
  static void print_notes(const AuditedDrive& audited, const AuditScene& scene, std::ostream& err) {
    err << notes_text(audited.name, audited.notes);
    const std::string note = curvature_note(audited.drive, scene.shape);
    if (!note.empty()) fmt::print(err, "note: {}: {}\n", audited.name, note);
  }

  Exit run_one(const AuditSubject& subject, const AuditScene& scene, const Streams& streams,
               const CommonOptions& common) const {
    AuditedDrive audited{.name = subject.name, .vehicle_of_drive = asked_.vehicle_of_drive()};
    audited.take(subject.read());
    if (!common.quiet) {
      streams.err << scene.vehicle_note;
      print_notes(audited, scene, streams.err);
    }
    audit_one(scene.demand(), audited, [&](const planning::GroundUnder& ground) {
      if (common.quiet) return;
      streams.err << ground_note(ground, scene.question, scene.occupancy->resolution_m());
    });
    outputs_.write_one(audited, scene);
    if (json_) {
      streams.out << text_of_json(versioned("audit", with_removal(audit_json(audited), scene)));
    } else {
      streams.out << audit_text(audited);
    }
    return audited.is_clear() ? Exit::ok : Exit::no;
  }

  static nlohmann::ordered_json with_removal(nlohmann::ordered_json json, const AuditScene& scene) {
    const auto removed = scene.occupancy ? scene.occupancy->seen_through() : std::nullopt;
    if (removed) {
      json["occupancy_seen_through"] = {{"clouds", removed->clouds},
                                        {"removed_cells", removed->cells}};
    }
    return json;
  }

  // File names may hold bytes that are no UTF-8.
  static std::string text_of_json(const nlohmann::ordered_json& json) {
    return map::json_text(json, 2) + "\n";
  }

  AuditAsked asked_;
  AuditSubjects subjects_;
  AuditOutputs outputs_;
  std::filesystem::path check_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_audit_command() { return std::make_unique<AuditCommand>(); }

}  // namespace roadbed::tools::commands::audits
