#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/visible_text.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/map/validate_file.h"
#include "roadbed/tools/commands/maps/commands.h"
#include "roadbed/tools/commands/maps/finding_baseline.h"
#include "roadbed/tools/commands/maps/finding_reports.h"

namespace roadbed::tools::inline commands::inline maps {
namespace {

using map::Validation;
using map::validation::Profile;
using map::validation::RuleChoice;
using map::validation::Severity;

/// What is wrong with a pattern of rules; nothing if it fits one.
std::string pattern_fault(const std::string& pattern) {
  const auto catalogue = map::rule_catalogue();
  const bool fits_one = std::ranges::any_of(
      catalogue, [&](const auto& rule) { return map::validation::fits(pattern, rule); });
  if (fits_one) return {};
  if (map::is_there(pattern)) return "MAP has to be named before it";
  return fmt::format("no rule is called \"{}\"; see: roadbed validate --rules",
                     map::one_line(pattern));
}

/// "geometry.gap=info" as what it says, or what is wrong with it.
struct NamedSeverity {
  std::string pattern;
  std::optional<Severity> severity;  ///< none: off
  std::string fault;
};

NamedSeverity severity_of(const std::string& text) {
  const std::size_t sign = text.rfind('=');
  if (sign == std::string::npos) return {{}, {}, "RULE=error, warning, info or off is needed"};
  NamedSeverity named{text.substr(0, sign), {}, pattern_fault(text.substr(0, sign))};
  const std::string severity = text.substr(sign + 1);
  if (severity == "error") {
    named.severity = Severity::error;
  } else if (severity == "warning") {
    named.severity = Severity::warning;
  } else if (severity == "info") {
    named.severity = Severity::info;
  } else if (severity != "off") {
    named.fault =
        fmt::format("\"{}\" is none of error, warning, info and off", map::one_line(severity));
  }
  return named;
}

class ValidateCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Report what makes a map unfit for planning");
    arguments.add("MAP", input_, "Any readable map").reads().ending(kMapEndings);
    arguments
        .add("--source", source_,
             "What a compiled MAP was made from, where that is not beside it: for line numbers and "
             "rules about its text")
        .reads();
    arguments.flag("--rules", list_rules_,
                   "List all rules with their meaning, and do nothing else");
    arguments.flag("-j,--json", json_, "Print one JSON document");
    arguments.flag("--all", all_, "Print every finding, not the first five of each rule");
    declare_outputs(arguments);
    declare_choice(arguments);
    declare_baseline(arguments);
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
        "  roadbed validate town.rbm --source town.xodr\n"
        "  roadbed validate town.xodr --sarif findings.sarif --svg findings.svg --force\n"
        "  roadbed validate data/crossing.osm --profile autoware --severity 'autoware.*=warning'\n"
        "  roadbed validate town.xodr --disable 'link.*' --severity geometry.kink=info\n"
        "  roadbed validate town.xodr --write-baseline known.json --force\n"
        "  roadbed validate town.xodr --baseline known.json --fail-on info");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    if (list_rules_) {
      streams.out << rules_table();
      return Exit::ok;
    }
    for (const std::filesystem::path* file :
         {&junit_, &sarif_, &geojson_, &svg_, &written_baseline_}) {
      if (!file->empty()) map::check_writable(*file, force_);
    }
    options_.choice = chosen_rules();
    if (!speed_range_kmph_.empty()) {
      options_.min_tagged_speed_kmph = speed_range_kmph_[0];
      options_.max_tagged_speed_kmph = speed_range_kmph_[1];
    }
    std::vector<map::validation::Finding> baseline;
    if (!baseline_.empty()) baseline = read_baseline(baseline_);
    const Validation validation = map::validate_file(input_, options_, source_);
    if (!validation.refusal.empty()) fmt::print(streams.err, "roadbed: {}\n", validation.refusal);
    if (!validation.note.empty() && !common.quiet) {
      fmt::print(streams.err, "note: {}\n", validation.note);
    }
    FindingReport report(validation);
    report.is_complete = all_;
    report.choice = options_.choice;
    if (!baseline_.empty()) {
      report.baseline =
          compare_with_baseline(validation.findings, std::move(baseline), options_.choice);
    }
    const std::string name = map::one_line(input_.filename().string());
    streams.out << (json_ ? findings_json(report) : findings_text(report, name));
    write_files(streams, report);
    return fails(report) ? Exit::no : Exit::ok;
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

  void declare_choice(Arguments& arguments) {
    arguments
        .add("--profile", profile_,
             "Only rules for a use: planning (all but Autoware's, the default), asam, autoware, "
             "commonroad")
        .one_of({"planning", "asam", "autoware", "commonroad"});
    arguments
        .add(
            "--only", only_,
            "Only rules whose id, ASAM or Autoware name fits, as 'geometry.*,link.*'; may be given "
            "again")
        .one_each()
        .separated_by(',')
        .checked(pattern_fault);
    arguments.add("--disable", disabled_, "Not these rules; may be given again")
        .one_each()
        .separated_by(',')
        .checked(pattern_fault);
    arguments
        .add("--severity", severities_,
             "RULE=error, warning, info or off: how grave findings of a rule are; may be given "
             "again, the last that fits counts")
        .one_each()
        .separated_by(',')
        .checked([](const std::string& text) { return severity_of(text).fault; });
  }

  void declare_baseline(Arguments& arguments) {
    arguments
        .add("--baseline", baseline_,
             "Findings that are known (written by --write-baseline or --json): they count neither "
             "for the exit status nor in the text, which says what is new and what is gone")
        .reads()
        .ending(".json");
    arguments.add("--write-baseline", written_baseline_, "Write all findings as a baseline")
        .writes(".json");
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
    arguments
        .add(
            "--speed-range", speed_range_kmph_,
            "Least and greatest speed limit that Autoware's rule allows, 10,50 if not given [km/h]")
        .values(2)
        .separated_by(',');
  }

  RuleChoice chosen_rules() const {
    RuleChoice choice;
    if (profile_ == "planning") choice.profile = Profile::planning;
    if (profile_ == "asam") choice.profile = Profile::asam;
    if (profile_ == "autoware") choice.profile = Profile::autoware;
    if (profile_ == "commonroad") choice.profile = Profile::commonroad;
    choice.only = only_;
    choice.disabled = disabled_;
    for (const std::string& text : severities_) {
      const NamedSeverity named = severity_of(text);
      choice.severities.emplace_back(named.pattern, named.severity);
    }
    return choice;
  }

  void write_files(const Streams& streams, const FindingReport& report) const {
    const std::string name = map::one_line(input_.filename().string());
    const std::string source = input_.generic_string();
    map::OutputFiles files(force_);
    const auto write = [&](const std::filesystem::path& file, const auto& content) {
      if (!file.empty()) files.add(file, content());
    };
    write(junit_, [&] { return findings_junit(report, name); });
    write(sarif_, [&] { return findings_sarif(report, source); });
    write(geojson_, [&] { return findings_geojson(report); });
    write(written_baseline_, [&] { return findings_json(report.validation); });
    if (report.validation.road_map) write(svg_, [&] { return findings_svg(report); });
    files.commit();
    if (svg_.empty() || report.validation.road_map) return;
    fmt::print(streams.err, "roadbed: {} is not written, since there is no map to draw\n",
               svg_.string());
  }

  bool fails(const FindingReport& report) const {
    const Severity least = fail_on_ == "error"     ? Severity::error
                           : fail_on_ == "warning" ? Severity::warning
                                                   : Severity::info;
    const auto& findings = report.validation.findings;
    for (std::size_t i = 0; i < findings.size(); ++i) {
      if (!report.is_known(i) && findings[i].severity >= least) return true;
    }
    return false;
  }

  std::filesystem::path input_, source_, junit_, sarif_, geojson_, svg_, baseline_,
      written_baseline_;
  map::validation::ValidateOptions options_;
  std::string fail_on_ = "error", profile_;
  std::vector<double> speed_range_kmph_;
  std::vector<std::string> only_, disabled_, severities_;
  bool json_ = false, list_rules_ = false, force_ = false, all_ = false;
};

}  // namespace

std::unique_ptr<Command> make_validate_command() { return std::make_unique<ValidateCommand>(); }

}  // namespace roadbed::tools::commands::maps
