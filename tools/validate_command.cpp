#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "roadbed/map/load_map.h"
#include "roadbed/map/validation/validate.h"
#include "roadbed/tools/command.h"

namespace roadbed::tools {
namespace {

using Json = nlohmann::ordered_json;
using Findings = std::vector<map::Finding>;

Json finding_json(const map::RoadMap& road_map, const map::Finding& finding) {
  Json json = {{"rule", finding.rule}};
  json["asam_rule"] = finding.asam_rule.empty() ? Json() : Json(finding.asam_rule);
  json["severity"] = name(finding.severity);
  json["element"] = finding.element;
  json["line"] = finding.line > 0 ? Json(finding.line) : Json();
  const Eigen::Vector2d in_source =
      finding.in_map ? road_map.to_source(*finding.in_map) : Eigen::Vector2d(0, 0);
  json["x_m"] = finding.in_map ? Json(in_source.x()) : Json();
  json["y_m"] = finding.in_map ? Json(in_source.y()) : Json();
  json["message"] = finding.message;
  return json;
}

std::string findings_json(const map::RoadMap& road_map, const Findings& findings) {
  Json list = Json::array();
  for (const map::Finding& finding : findings) list.push_back(finding_json(road_map, finding));
  return Json{{"findings", std::move(list)}}.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string place_text(const map::RoadMap& road_map, const map::Finding& finding) {
  std::string text = finding.line > 0 ? fmt::format(":{}", finding.line) : "";
  if (finding.in_map) {
    const Eigen::Vector2d in_source = road_map.to_source(*finding.in_map);
    text += fmt::format(" ({:.2f}, {:.2f})", in_source.x(), in_source.y());
  }
  return text;
}

long count(const Findings& findings, map::Severity severity) {
  return std::count_if(findings.begin(), findings.end(),
                       [&](const map::Finding& f) { return f.severity == severity; });
}

class ValidateCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Report what makes a map unfit for planning");
    arguments.add("MAP", input_, "Any readable map").required();
    arguments.flag("--json", json_, "Print one JSON document");
    arguments.add("--fail-on", fail_on_, "Least severity that makes the exit status 1")
        .one_of({"error", "warning"})
        .with_default();
    arguments
        .add("--max-gap", options_.max_gap_m, "Largest gap between the ends of linked lanes [m]")
        .not_negative()
        .with_default();
    arguments
        .add("--max-kink", options_.max_kink_rad,
             "Largest change of heading between linked lanes [rad]")
        .not_negative()
        .with_default();
    arguments.example("  roadbed validate town.xodr --fail-on warning");
  }

  Exit run(const Streams& streams, const CommonOptions&) override {
    const map::RoadMap road_map = map::load_map(input_);
    const Findings findings = map::validate(road_map, options_);
    if (json_) {
      streams.out << findings_json(road_map, findings) << '\n';
    } else {
      print(streams.out, road_map, findings);
    }
    const bool fails = count(findings, map::Severity::error) > 0 ||
                       (fail_on_ == "warning" && count(findings, map::Severity::warning) > 0);
    return fails ? Exit::failed : Exit::ok;
  }

 private:
  void print(std::ostream& out, const map::RoadMap& road_map, const Findings& findings) const {
    for (const map::Finding& finding : findings) {
      fmt::print(out, "{}{}: {}: {}: {} [{}]\n", input_.filename().string(),
                 place_text(road_map, finding), name(finding.severity), finding.element,
                 finding.message, finding.rule);
    }
    fmt::print(out, "{} errors, {} warnings, {} notes\n", count(findings, map::Severity::error),
               count(findings, map::Severity::warning), count(findings, map::Severity::info));
  }

  std::filesystem::path input_;
  map::ValidateOptions options_;
  std::string fail_on_ = "error";
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_validate_command() { return std::make_unique<ValidateCommand>(); }

}  // namespace roadbed::tools
