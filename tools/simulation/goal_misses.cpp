#include "roadbed/tools/simulation/goal_misses.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"

namespace roadbed::tools::inline simulation {

void GoalMisses::look(const planning::TimedGoal& goal, const map::RoadMap& road_map, double t_s,
                      const planning::VehicleState& truth, const geometry::VehicleShape& vehicle) {
  const geometry::Pose2& pose = truth.map_from_vehicle;
  const Eigen::Vector2d centre = geometry::body_at(pose, vehicle).centre;
  for (const planning::GoalState& state : goal.states) {
    if (!state.time_s.holds(t_s)) continue;
    std::vector<std::string> missed;
    if (!is_at_place(state, road_map, centre)) missed.emplace_back("place");
    if (state.heading_rad && !holds_heading(*state.heading_rad, pose.heading_rad)) {
      missed.emplace_back("heading");
    }
    if (!state.speed_mps.holds(truth.speed_mps)) missed.emplace_back("speed");
    if (missed.size() >= fewest_) continue;
    fewest_ = missed.size();
    what_ = fmt::format("{}", fmt::join(missed, " and "));
    at_s_ = t_s;
  }
}

std::string GoalMisses::at_best() const {
  if (what_.empty()) return "";
  return fmt::format("at best only its {} {} missed, after {:.2f} s", what_,
                     fewest_ == 1 ? "was" : "were", at_s_);
}

}  // namespace roadbed::tools::simulation
