#include <filesystem>
#include <optional>
#include <string>

#include "roadbed/map/files/visible_text.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/tools/cli/drive_arguments.h"
#include "roadbed/tools/commands/audits/audit_output.h"
#include "roadbed/tools/commands/audits/audit_scene.h"
#include "roadbed/tools/commands/drives/commands.h"
#include "roadbed/tools/report/drive_mcap.h"

namespace roadbed::tools::inline commands::inline drives {
namespace {

class ReportDriveCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Write a page that plays a recorded drive, with its audit");
    arguments
        .add("DRIVE", drive_,
             "Recorded drive: a log (rosbag2, MCAP), .csv, CommonRoad solution, poses of "
             "Argoverse 2, TUM or KITTI")
        .required()
        .reads()
        .ending(".db3 .mcap .csv .xml .feather .txt");
    arguments.add("-o,--output", output_, "Page (.html)").required().writes(".html");
    arguments
        .add("--mcap", mcap_,
             "Write a log, too, that plays the drive in Foxglove, Lichtblick and Rerun (.mcap): "
             "poses, lanes, obstacles, occupied space, stretches by verdict")
        .writes(".mcap");
    of_drive_.declare(arguments);
    arguments.heading("Audit");
    asked_.declare_occupancy(arguments);
    asked_.declare(arguments);
    arguments.flag("-f,--force", force_, "Replace the output if it exists");
    arguments.require([this] {
      if (!asked_.map_file().empty()) asked_.take_road();
      return asked_.fault();
    });
    arguments.says_no_if("the drive is not clear of what it was audited against");
    arguments.example(
        "  roadbed report drive drive/trajectory.csv --map town.xodr -o drive.html\n"
        "  roadbed report drive drive/trajectory.csv --map town.xodr --occupancy street.bt "
        "--unknown free -o audited.html");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    map::check_writable(output_, force_);
    if (!mcap_.empty()) map::check_writable(mcap_, force_);
    asked_.take_drive(drive_);
    AuditScene scene = audit_scene(asked_, false, common);
    scene.drive_file = drive_;
    scene.command = "roadbed report drive " + drive_.string();
    AuditedDrive audited{.name = map::one_line(drive_.string()),
                         .vehicle_of_drive = asked_.vehicle_of_drive()};
    audited.take(read_drive(drive_, of_drive_.options(scene.shape)));
    if (!common.quiet) streams.err << scene.vehicle_note << notes_text(audited.name, audited.notes);
    add_occupancy(scene, streams, common);
    audit_one(scene.demand(), audited);
    write(audited, scene);
    if (!is_asked(scene)) return Exit::ok;
    streams.out << audit_text(audited);
    return audited.is_clear() ? Exit::ok : Exit::no;
  }

 private:
  static bool is_asked(const AuditScene& scene) { return scene.occupancy || scene.road; }

  void write(const AuditedDrive& audited, const AuditScene& scene) const {
    std::optional<planning::AuditReport> report;
    if (is_asked(scene)) report = audited.whole();
    ReportInput page = report_of_recording(audited.drive, report, surroundings_of(audited, scene));
    page.title = map::one_line(drive_.filename().string());
    map::OutputFiles files(force_);
    files.add(output_, drive_report_html(page));
    page.drive.trajectory = audited.drive;  // as it was recorded, to be read again
    if (!mcap_.empty()) files.add(mcap_, drive_mcap(page, space_of(audited, scene)));
    files.commit();
  }

  std::filesystem::path drive_, output_, mcap_;
  DriveArguments of_drive_;
  AuditAsked asked_;
  bool force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_report_drive_command() {
  return std::make_unique<ReportDriveCommand>();
}

}  // namespace roadbed::tools::commands::drives
