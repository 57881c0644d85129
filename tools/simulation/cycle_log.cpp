#include "roadbed/tools/simulation/cycle_log.h"

#include "roadbed/map/files/json_text.h"

namespace roadbed::tools::inline simulation {
namespace {

Json json_or_null(const std::optional<double>& number) { return number ? Json(*number) : Json(); }

Json start_json(const planning::LateralState& start) {
  return {{"s_m", start.s_m},
          {"d_m", start.d_m},
          {"d_slope", start.d_slope},
          {"d_curvature_per_m", start.d_curvature_per_m}};
}

Json chosen_json(const std::optional<planning::Candidate>& chosen) {
  if (!chosen) return {};
  return {{"d_e_m", chosen->end_d_m}, {"l_e_m", chosen->end_l_m}, {"cost", chosen->cost}};
}

}  // namespace

Json lead_json(const std::optional<planning::DriveLead>& lead) {
  if (!lead) return {};
  return {{"id", lead->id}, {"gap_m", lead->gap_m}, {"speed_mps", lead->speed_mps}};
}

Json hypotheses_json(const std::vector<planning::HypothesisOutcome>& hypotheses) {
  Json list = Json::array();
  for (const planning::HypothesisOutcome& one : hypotheses) {
    list.push_back({{"maneuver", planning::to_string(one.maneuver)},
                    {"d_e_m", json_or_null(one.end_d_m)},
                    {"l_e_m", json_or_null(one.end_l_m)},
                    {"path_cost", json_or_null(one.path_cost)},
                    {"drive_cost", json_or_null(one.drive_cost)},
                    {"driven", one.is_driven},
                    {"reason", one.reason}});
  }
  return list;
}

Json cycle_json(const DriveCycle& cycle, const DriveSample& row) {
  return {{"t_s", cycle.t_s},
          {"behaviour", planning::to_string(cycle.behaviour)},
          {"reason", cycle.reason},
          {"set_speed_mps", row.set_speed_mps},
          {"desired_acceleration_mps2", row.command_mps2},
          {"lead", lead_json(cycle.lead)},
          {"start", start_json(cycle.start)},
          {"from_measurement", cycle.from_measurement},
          {"chosen", chosen_json(cycle.chosen)},
          {"why_none", cycle.plan_reason},
          {"beyond_the_edge_m", cycle.beyond_the_edge_m},
          {"hypotheses", hypotheses_json(cycle.hypotheses)}};
}

std::string cycle_log(const Drive& drive) {
  std::string lines;
  for (std::size_t i = 0; i < drive.cycles.size(); ++i) {
    lines += map::json_text(cycle_json(drive.cycles[i], drive.samples[i])) + "\n";
  }
  return lines;
}

}  // namespace roadbed::tools::simulation
