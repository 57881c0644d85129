#include "roadbed/tools/support/audit_json.h"

#include <fmt/format.h>

#include <vector>

namespace roadbed::tools {
namespace {

using Json = nlohmann::ordered_json;

Json box_json(const map::Box2& box) {
  return {{"min_x_m", box.min_in_source.x()},
          {"min_y_m", box.min_in_source.y()},
          {"max_x_m", box.max_in_source.x()},
          {"max_y_m", box.max_in_source.y()}};
}

Json conflict_json(const planning::Conflict& conflict) {
  return {{"from_s", conflict.from_s},
          {"to_s", conflict.to_s},
          {"least_clearance_m", conflict.least_clearance_m},
          {"at",
           {{"t_s", conflict.at.t_s},
            {"x_m", conflict.at.x_m},
            {"y_m", conflict.at.y_m},
            {"heading_rad", conflict.at.heading_rad}}},
          {"witness", box_json(conflict.witness)}};
}

Json stretches_json(const std::vector<planning::Stretch>& stretches) {
  Json json = Json::array();
  for (const planning::Stretch& stretch : stretches) {
    json.push_back({{"from_s", stretch.from_s}, {"to_s", stretch.to_s}});
  }
  return json;
}

std::string middle_of(const map::Box2& box) {
  const Eigen::Vector2d middle = 0.5 * (box.min_in_source + box.max_in_source);
  return fmt::format("({:.2f}, {:.2f})", middle.x(), middle.y());
}

std::string least_text(const planning::AuditReport& report) {
  if (report.beyond_horizon) {
    return fmt::format("over {:.0f} m all along: nothing is nearer\n", report.least_clearance_m);
  }
  return fmt::format("{:.3f} m at {:.3f} s, from the cell at {}; nowhere under {:.3f} m\n",
                     report.least_clearance_m, report.least_clearance_at_s,
                     middle_of(*report.witness), report.proven_clearance_m);
}

}  // namespace

Json audit_json(const planning::AuditReport& report) {
  Json json;
  json["verdict"] = std::string(name(report.verdict));
  json["least_clearance_m"] = report.least_clearance_m;
  json["proven_clearance_m"] = report.proven_clearance_m;
  json["least_clearance_at_s"] = report.least_clearance_at_s;
  json["beyond_horizon"] = report.beyond_horizon;
  json["witness"] = report.witness ? box_json(*report.witness) : Json();
  json["unknown_share"] = report.unknown_share;
  json["conflicts"] = Json::array();
  for (const auto& conflict : report.conflicts)
    json["conflicts"].push_back(conflict_json(conflict));
  json["unknown"] = stretches_json(report.unknown);
  json["undecided"] = stretches_json(report.undecided);
  return json;
}

std::string audit_text(const planning::AuditReport& report) {
  std::string text = fmt::format("{:<17}{}\n", "verdict", name(report.verdict));
  text += fmt::format("{:<17}", "least clearance") + least_text(report);
  text += fmt::format("{:<17}{:.1f} % of the space that the vehicle takes\n", "not measured",
                      100.0 * report.unknown_share);
  for (const planning::Conflict& conflict : report.conflicts) {
    text += fmt::format(
        "{:<17}{:.3f} s to {:.3f} s: {:.3f} m from the cell at {} at {:.3f} s, at ({:.2f}, "
        "{:.2f})\n",
        "conflict", conflict.from_s, conflict.to_s, conflict.least_clearance_m,
        middle_of(conflict.witness), conflict.at.t_s, conflict.at.x_m, conflict.at.y_m);
  }
  for (const planning::Stretch& stretch : report.unknown) {
    text += fmt::format(
        "{:<17}{:.3f} s to {:.3f} s: near space that was not measured; measure it, "
        "or give --unknown\n",
        "unknown", stretch.from_s, stretch.to_s);
  }
  for (const planning::Stretch& stretch : report.undecided) {
    text += fmt::format("{:<17}{:.3f} s to {:.3f} s: within 1 mm of the clearance asked for\n",
                        "undecided", stretch.from_s, stretch.to_s);
  }
  return text;
}

}  // namespace roadbed::tools
