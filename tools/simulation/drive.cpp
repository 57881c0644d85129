#include "roadbed/tools/simulation/drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace roadbed::tools::inline simulation {
namespace {

using planning::Candidate;

std::optional<Candidate> runner_up_of(const planning::Plan& plan) {
  std::optional<Candidate> best;
  for (const Candidate& candidate : plan.candidates) {
    if (candidate.rejection != planning::Rejection::none) continue;
    if (plan.chosen && candidate.end_d_m == plan.chosen->end_d_m) continue;
    if (!best || candidate.cost < best->cost) best = candidate;
  }
  return best;
}

}  // namespace

std::string_view to_string(EventLevel level) {
  switch (level) {
    case EventLevel::info:
      return "info";
    case EventLevel::warning:
      return "warning";
    case EventLevel::fault:
      return "fault";
  }
  return "";
}

std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::goal_reached:
      return "goal reached";
    case Outcome::stopped:
      return "stopped";
    case Outcome::collision:
      return "collision";
    case Outcome::timed_out:
      return "timed out";
    case Outcome::left_road:
      return "left the road";
  }
  return "";
}

std::vector<DriveEvent> events_of(const DriveCycle& cycle, const DriveCycle* last) {
  std::vector<DriveEvent> events;
  const auto log = [&](EventLevel level, std::string text) {
    events.push_back({cycle.t_s, level, std::move(text)});
  };
  if (cycle.from_measurement) {
    log(EventLevel::warning, "planned from the measured state: tracking was too far off");
  }
  if (!cycle.chosen && (!last || last->chosen)) {
    log(EventLevel::warning, "nothing is feasible: " + cycle.plan_reason);
  }
  if (cycle.chosen && cycle.beyond_the_edge_m > 0.0 &&
      (!last || last->beyond_the_edge_m < cycle.beyond_the_edge_m)) {
    log(EventLevel::info, fmt::format("no candidate keeps to the lanes; up to {:.1f} m beyond",
                                      cycle.beyond_the_edge_m));
  }
  if (cycle.behaviour == planning::Behaviour::emergency &&
      (!last || last->behaviour != planning::Behaviour::emergency)) {
    log(EventLevel::warning, "emergency: " + cycle.reason);
  }
  const std::string lead = cycle.lead ? cycle.lead->id : "";
  const std::string last_lead = last && last->lead ? last->lead->id : "";
  if (lead != last_lead) {
    log(EventLevel::info,
        lead.empty() ? last_lead + " is no longer ahead" : lead + " is ahead on the path");
  }
  return events;
}

std::optional<CandidateGrid> candidate_grid(const planning::Plan& plan, std::size_t row_stride) {
  if (plan.candidates.empty()) return std::nullopt;
  CandidateGrid grid{.end_d_m = {}, .end_l_m = {}, .causes = {}, .runner_up = runner_up_of(plan)};
  const double first_l_m = plan.candidates.front().end_l_m;
  for (const Candidate& candidate : plan.candidates) {
    if (candidate.end_l_m != first_l_m) break;
    grid.end_d_m.push_back(candidate.end_d_m);
  }
  const std::size_t lanes = grid.end_d_m.size();
  for (std::size_t row = 0; row * lanes < plan.candidates.size(); row += row_stride) {
    grid.end_l_m.push_back(plan.candidates[row * lanes].end_l_m);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      grid.causes.push_back(
          static_cast<std::uint8_t>(plan.candidates[row * lanes + lane].rejection));
    }
  }
  return grid;
}

}  // namespace roadbed::tools::simulation
