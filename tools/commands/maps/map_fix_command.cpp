#include <fmt/format.h>
#include <fmt/ostream.h>

#include <filesystem>
#include <iostream>
#include <string>

#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/repair/repair.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/tools/cli/output_format.h"
#include "roadbed/tools/commands/maps/commands.h"
#include "roadbed/tools/commands/maps/edit_output.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline maps {
namespace {

Json counts_json(const map::FindingCounts& counts) {
  return {{"errors", counts.errors}, {"warnings", counts.warnings}, {"infos", counts.infos}};
}

std::string counts_text(const map::FindingCounts& counts) {
  return fmt::format("{} errors, {} warnings, {} infos", counts.errors, counts.warnings,
                     counts.infos);
}

class MapFixCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description(
        "Mend in a map file what validate finds and what leaves no choice; all else stays byte for "
        "byte");
    arguments.add("MAP", map_file_, "OpenDRIVE, Lanelet2 or CommonRoad file")
        .required()
        .reads()
        .ending(".xodr .osm .xml");
    arguments
        .add("-o,--output", output_,
             "The mended file, of the same format; - for standard output; without it only what "
             "would be mended is said")
        .writes("");
    arguments
        .add("--tolerance", options_.tolerance_m,
             "Ends that are no farther apart are taken as one; no border moves farther [m]")
        .within(1e-6, 10.0)
        .with_default();
    arguments.flag("-j,--json", json_, "Print one JSON document");
    arguments.flag("-f,--force", force_, "Replace the output if it exists");
    arguments.require(
        [this] { return standard_output_fault(output_, false, "", json_ ? "--json" : ""); });
    arguments.says_no_if("an error is left, which somebody has to decide about");
    arguments.example(
        "  roadbed map fix town.xodr\n"
        "  roadbed map fix town.xodr -o mended.xodr --tolerance 0.05");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    if (!output_.empty()) map::check_writable(output_, force_);
    const map::RepairedFile file =
        map::repair_file(map::read_file(map_file_), map::input_name(map_file_), options_);
    if (!output_.empty()) {
      refuse_other_format(output_, file.bytes);
      map::write_output(output_, file.bytes, force_);
    }
    if (json_) {
      print_json(streams.out, file);
    } else {
      print_text(map::is_standard_stream(output_) ? streams.err : streams.out, file, common.quiet);
    }
    return file.after.errors > 0 ? Exit::no : Exit::ok;
  }

 private:
  static void print_json(std::ostream& out, const map::RepairedFile& file) {
    Json repairs = Json::array();
    for (const map::Repair& repair : file.repairs) {
      repairs.push_back({{"rule", repair.rule},
                         {"element", repair.element},
                         {"line", repair.line},
                         {"moved_m", repair.moved_m},
                         {"message", repair.what}});
    }
    const Json json{{"repairs", std::move(repairs)},
                    {"before", counts_json(file.before)},
                    {"after", counts_json(file.after)}};
    out << map::json_text(versioned("map_fix", json), 2) << '\n';
  }

  static void print_text(std::ostream& out, const map::RepairedFile& file, bool quiet) {
    for (const map::Repair& repair : file.repairs) {
      fmt::print(out, "{}:{}: {} ({})\n", repair.element, repair.line, repair.what, repair.rule);
    }
    if (quiet) return;
    fmt::print(out, "{} repairs; before: {}; after: {}\n", file.repairs.size(),
               counts_text(file.before), counts_text(file.after));
  }

  std::filesystem::path map_file_, output_;
  map::RepairOptions options_;
  bool json_ = false, force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_map_fix_command() { return std::make_unique<MapFixCommand>(); }

}  // namespace roadbed::tools::commands::maps
