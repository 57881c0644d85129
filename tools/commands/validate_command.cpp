#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/visible_text.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/map/validate_file.h"
#include "roadbed/tools/commands/commands.h"
#include "roadbed/tools/commands/finding_reports.h"

namespace roadbed::tools::inline commands {
namespace {

using map::Validation;

class ValidateCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Report what makes a map unfit for planning");
    arguments.add("MAP", input_, "Any readable map").reads().ending(kMapEndings);
    arguments.flag("--rules", list_rules_,
                   "List all rules with their meaning, and do nothing else");
    arguments.flag("-j,--json", json_, "Print one JSON document");
    declare_outputs(arguments);
    arguments.add("--fail-on", fail_on_, "Least severity that makes the exit status 1")
        .one_of({"error", "warning", "info"})
        .with_default();
    declare_limits(arguments);
    arguments.require([this] {
      return input_.empty() && !list_rules_ ? std::string("MAP is required") : std::string();
    });
    arguments.says_no_if("a finding is as severe as --fail-on says");
    arguments.example(
        "  roadbed validate town.xodr --fail-on warning\n"
        "  roadbed validate town.xodr --sarif findings.sarif --svg findings.svg --force");
  }

  Exit run(const Streams& streams, const CommonOptions&) override {
    if (list_rules_) {
      streams.out << rules_table();
      return Exit::ok;
    }
    for (const std::filesystem::path* file : {&junit_, &sarif_, &geojson_, &svg_}) {
      if (!file->empty()) map::check_writable(*file, force_);
    }
    const Validation validation = map::validate_file(input_, options_);
    if (!validation.refusal.empty()) fmt::print(streams.err, "roadbed: {}\n", validation.refusal);
    const std::string name = map::one_line(input_.filename().string());
    streams.out << (json_ ? findings_json(validation) : findings_text(validation, name));
    write_files(streams, validation);
    return fails(validation) ? Exit::no : Exit::ok;
  }

 private:
  void declare_outputs(Arguments& arguments) {
    arguments.add("--junit", junit_, "Write the findings as JUnit test cases, one per rule")
        .writes(".xml");
    arguments.add("--sarif", sarif_, "Write the findings as SARIF 2.1.0").writes(".sarif");
    arguments.add("--geojson", geojson_, "Write the findings as a layer of points")
        .writes(".geojson");
    arguments.add("--svg", svg_, "Draw the map with its findings").writes(".svg");
    arguments.flag("-f,--force", force_, "Replace outputs that exist");
  }

  void declare_limits(Arguments& arguments) {
    const auto limit = [&](const char* option, double& value, const char* help) {
      arguments.add(option, value, help).not_negative().with_default();
    };
    limit("--max-gap", options_.max_gap_m, "Largest gap between what should meet [m]");
    limit("--max-kink", options_.max_kink_rad, "Largest change of heading where curves meet [rad]");
    limit("--max-step", options_.max_step_m, "Largest step of elevation, width, lane offset [m]");
    limit("--max-slope-jump", options_.max_slope_jump, "Largest change of slope at a point [m/m]");
    limit("--max-slope", options_.max_slope, "Steepest slope of a road [m/m]");
    limit("--max-curvature", options_.max_curvature_per_m, "Greatest curvature of a lane [1/m]");
    limit("--max-curvature-jump", options_.max_curvature_jump_per_m,
          "Largest change of curvature where curves meet [1/m]");
    limit("--max-speed", options_.max_speed_mps, "Greatest speed limit [m/s]");
    limit("--max-lateral-acceleration", options_.max_lateral_acceleration_mps2,
          "Greatest acceleration in a bend at the speed limit [m/s²]");
    limit("--max-signal-distance", options_.max_signal_distance_m,
          "Greatest distance of a signal from the next lane [m]");
    limit("--max-object-distance", options_.max_object_distance_m,
          "Greatest distance of an object from the next lane [m]");
    limit("--min-overlap", options_.min_overlap_m,
          "Length over which lanes of two roads may lie on top of each other [m]");
  }

  void write_files(const Streams& streams, const Validation& validation) const {
    const std::string name = map::one_line(input_.filename().string());
    const std::string source = input_.generic_string();
    if (!junit_.empty()) map::write_output(junit_, findings_junit(validation, name), force_);
    if (!sarif_.empty()) map::write_output(sarif_, findings_sarif(validation, source), force_);
    if (!geojson_.empty()) map::write_output(geojson_, findings_geojson(validation), force_);
    if (svg_.empty()) return;
    if (validation.road_map) {
      map::write_output(svg_, findings_svg(validation), force_);
    } else {
      fmt::print(streams.err, "roadbed: {} is not written, since there is no map to draw\n",
                 svg_.string());
    }
  }

  bool fails(const Validation& validation) const {
    const map::validation::Severity least = fail_on_ == "error" ? map::validation::Severity::error
                                            : fail_on_ == "warning"
                                                ? map::validation::Severity::warning
                                                : map::validation::Severity::info;
    return std::any_of(
        validation.findings.begin(), validation.findings.end(),
        [&](const map::validation::Finding& finding) { return finding.severity >= least; });
  }

  std::filesystem::path input_, junit_, sarif_, geojson_, svg_;
  map::validation::ValidateOptions options_;
  std::string fail_on_ = "error";
  bool json_ = false, list_rules_ = false, force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_validate_command() { return std::make_unique<ValidateCommand>(); }

}  // namespace roadbed::tools::commands
