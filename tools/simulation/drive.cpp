#include "roadbed/tools/simulation/drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace roadbed::tools::inline simulation {
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

std::size_t line_at(const Drive& drive, double t_s) {
  return static_cast<std::size_t>(std::ranges::count_if(
      drive.given_up, [&](const GivenUpRoute& route) { return route.until_s <= t_s; }));
}

std::vector<DriveEvent> events_of(const DriveCycle& cycle, const DriveCycle* last) {
  std::vector<DriveEvent> events;
  const auto log = [&](EventLevel level, std::string text) {
    events.push_back({cycle.t_s, level, std::move(text)});
  };
  if (cycle.from_measurement) {
    log(EventLevel::warning, "planned from the measured state: tracking was too far off");
  }
  if (!cycle.has_plan() && (!last || last->has_plan())) {
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
  const bool was_said = last && last->is_news && last->reason == cycle.reason;
  if (cycle.is_news && !was_said) log(EventLevel::warning, cycle.reason);
  const std::string lead = cycle.lead ? cycle.lead->id : "";
  const std::string last_lead = last && last->lead ? last->lead->id : "";
  if (lead != last_lead) {
    log(EventLevel::info,
        lead.empty() ? last_lead + " is no longer ahead" : lead + " is ahead on the path");
  }
  return events;
}

}  // namespace roadbed::tools::simulation
