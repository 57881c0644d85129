#include "roadbed/planning/behaviour/lateral_replanner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/planning/lateral/plan_cycle.h"

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kReturn_m = 20.0;
constexpr double kFineGrid_m = 0.2;
constexpr double kCoarseGrid_m = 0.6;  // between ends of what is tried after the first plan
constexpr double kCrawl_mps = 1.5, kBraking_mps2 = 5.0;
constexpr double kHoldStep_m = 1.0;
constexpr double kHeldOffset_m = 1.2;  // more is another lane, or partly

/// 1 up to `from`, 0 from `from` + kReturn_m on.
double fade(double s_m, double from_m) {
  const double share = std::clamp((s_m - from_m) / kReturn_m, 0.0, 1.0);
  return 1.0 - share * share * (3.0 - 2.0 * share);
}

/// The line as planning sees it: past `end_m`, where the vehicle never comes, it goes on straight
/// with the room that it has there, so that no bend or dead end behind the goal matters.
LineView straight_past(const ReferenceLine& line, double end_m) {
  const auto at = [&line, end_m](double s_m) {
    ReferencePoint point = line.at(std::min(s_m, end_m));
    if (s_m <= end_m) return point;
    const Eigen::Vector2d along{std::cos(point.heading_rad), std::sin(point.heading_rad)};
    return ReferencePoint{.s_m = s_m,
                          .in_map = point.in_map + (s_m - end_m) * along,
                          .heading_rad = point.heading_rad};
  };
  const auto corridor_at = [&line, end_m](double s_m) {
    return line.corridor_at(std::min(s_m, end_m));
  };
  return {at, corridor_at};
}

}  // namespace

LateralReplanner::LateralReplanner(const geometry::VehicleShape& vehicle, const DrivingTask& task,
                                   const ReferenceLine& line, const Bounds& bounds)
    : vehicle_(vehicle),
      task_(task),
      reference_(line),
      bounds_(bounds),
      line_(straight_past(
          line, task.goal ? line.length_m() : line.goal_s_m() + vehicle.front_m() + 1.0)) {}

LateralState LateralReplanner::start_state(const VehicleState& measured) {
  const double curvature = std::tan(measured.steering_rad) / vehicle_.wheelbase_m;
  const LateralState here = lateral_state(reference_, measured.map_from_vehicle, curvature, s_m_);
  s_m_ = here.s_m;
  from_measurement_ = true;
  if (!path_) return here;
  LateralState planned = path_->lateral_at(here.s_m);
  planned.s_m = here.s_m;
  const double turned = geometry::wrap_angle(path_->pose_at(here.s_m).heading_rad -
                                             measured.map_from_vehicle.heading_rad);
  from_measurement_ = std::abs(planned.d_m - here.d_m) > bounds_.tracking_error_m ||
                      std::abs(turned) > bounds_.heading_error_rad;
  return from_measurement_ ? here : planned;
}

PlanInput LateralReplanner::input_for(const Question& question) const {
  PlanInput input{.line = line_,
                  .start = start_,
                  .start_t_s = question.t_s,
                  .speed = question.speed,
                  .obstacles = question.obstacles,
                  .static_field = task_.field.get(),
                  .origin_in_source = task_.road_map.origin_in_source(),
                  .previous_d_m = {}};
  if (path_) {
    input.previous_d_m = [this](double s_m) { return path_->lateral_at(s_m).d_m; };
  }
  return input;
}

std::vector<Room> LateralReplanner::rooms(bool may_leave_lanes) const {
  std::vector<Room> rooms = bounds_.rooms;
  if (!may_leave_lanes) {
    std::erase_if(rooms, [](const Room& room) { return room.border_margin_m < 0.0; });
  }
  return rooms;
}

PlanOptions LateralReplanner::options_for(const Question& question, const Offsets& offsets,
                                          double l_step_m) const {
  PlanOptions options;
  options.min_d_m = offsets.least_m;
  options.max_d_m = offsets.most_m;
  options.l_step_m = l_step_m;
  options.min_l_m = question.ends.least_m;
  options.max_l_m = question.ends.most_m;
  options.keep_candidates = bounds_.keeps_candidates;
  if (!question.asks_for_way_on) options.way_on_horizon_s = 0.0;
  return options;
}

LateralReplanner::Proposal LateralReplanner::propose(const Question& question,
                                                     const Offsets& offsets,
                                                     bool may_leave_lanes) const {
  if (bounds_.squeezes_past) return squeeze(question, offsets, may_leave_lanes);
  const PlanOptions options =
      options_for(question, offsets, may_leave_lanes ? kFineGrid_m : kCoarseGrid_m);
  const std::vector<Room> in_turn = rooms(may_leave_lanes);
  const PlanInput input = input_for(question);
  PlanCycle cycle(input, vehicle_, options);
  std::vector<Plan> plans = plan_in_rooms(cycle, in_turn);
  const double border_m = in_turn[plans.size() - 1].border_margin_m;
  return {std::move(plans.back()), std::max(0.0, -border_m), options.max_l_m};
}

/// What was evaluated from one start on, at the planned speed and while braking, on a fine grid and
/// on coarse ones: each is made when it is asked for.
struct LateralReplanner::Cycles {
  std::vector<Obstacle> obstacles;
  std::vector<PlanInput> inputs;  ///< the first at the planned speed
  std::unique_ptr<PlanCycle> fine;
  std::array<std::unique_ptr<PlanCycle>, 2> coarse;
};

std::shared_ptr<LateralReplanner::Cycles> LateralReplanner::cycles_for(
    const Question& question) const {
  auto cycles = std::make_shared<Cycles>();
  cycles->obstacles = question.obstacles;
  cycles->inputs.reserve(2);
  cycles->inputs.push_back(input_for({.t_s = question.t_s,
                                      .measured = question.measured,
                                      .speed = question.speed,
                                      .ends = question.ends,
                                      .obstacles = cycles->obstacles}));
  if (question.speed.speed_mps > 2.0 * kCrawl_mps) {
    cycles->inputs.push_back(cycles->inputs.front());
    cycles->inputs.back().speed = {.speed_mps = question.speed.speed_mps,
                                   .acceleration_mps2 = -kBraking_mps2,
                                   .target_mps = kCrawl_mps};
  }
  return cycles;
}

/// With less and less room, at the planned speed and while braking: a bend or a gap that is too
/// sharp at the one may be driven at the other. After the first look a coarse grid will do. Tries
/// with other ends look at the same grids, unless candidates are kept: those are of one try.
LateralReplanner::Proposal LateralReplanner::squeeze(const Question& question,
                                                     const Offsets& offsets,
                                                     bool may_leave_lanes) const {
  const bool shares = !bounds_.keeps_candidates;
  if (!shares || !cycles_) cycles_ = cycles_for(question);
  Cycles& cycles = *cycles_;
  const std::vector<Room> in_turn = rooms(may_leave_lanes);
  const std::size_t speeds = cycles.inputs.size();
  const auto plan = [&](std::size_t i, double l_step_m, std::unique_ptr<PlanCycle>& cycle) {
    if (!cycle) {
      const Offsets on_grid = shares ? Offsets{} : offsets;
      cycle = std::make_unique<PlanCycle>(cycles.inputs[i % speeds], vehicle_,
                                          options_for(question, on_grid, l_step_m));
    }
    const Room& room = in_turn[i / speeds];
    return Proposal{cycle->plan(room, {offsets.least_m, offsets.most_m}),
                    std::max(0.0, -room.border_margin_m), question.ends.most_m};
  };
  Proposal last = may_leave_lanes ? plan(0, kFineGrid_m, cycles.fine)
                                  : plan(0, kCoarseGrid_m, cycles.coarse.front());
  for (std::size_t i = 1; i < in_turn.size() * speeds && !last.plan.chosen; ++i) {
    last = plan(i, kCoarseGrid_m, cycles.coarse[i % speeds]);
  }
  return last;
}

/// Past the plan's end its offset is held as long as the corridor has room for it.
double LateralReplanner::held_until_m(const Plan& plan) const {
  const double offset = plan.chosen->end_d_m;
  double s_m = plan.start.s_m + plan.chosen->end_l_m;
  for (; s_m < reference_.length_m(); s_m += kHoldStep_m) {
    const Corridor corridor = reference_.corridor_at(s_m);
    const double room_m = offset > 0.0 ? corridor.left_m : corridor.right_m;
    if (std::abs(offset) + 0.5 * vehicle_.width_m > room_m) break;
  }
  return std::max(plan.start.s_m + plan.chosen->end_l_m, s_m - kReturn_m);
}

PlannedPath LateralReplanner::path_of(const Proposal& proposal) const {
  if (!bounds_.squeezes_past || std::abs(proposal.plan.chosen->end_d_m) < kHeldOffset_m) {
    return PlannedPath(reference_,
                       [kept = proposal.plan](double s_m) { return kept.lateral_at(s_m); });
  }
  const double held_m = held_until_m(proposal.plan);
  return PlannedPath(reference_, [kept = proposal.plan, held_m](double s_m) {
    LateralState lateral = kept.lateral_at(s_m);
    lateral.d_m *= fade(s_m, held_m);
    return lateral;
  });
}

void LateralReplanner::take(const Proposal& proposal) {
  cycles_.reset();  // they ask for the path so far
  plan_ = proposal.plan;
  beyond_the_edge_m_ = proposal.beyond_the_edge_m;
  if (plan_.chosen) {
    path_end_s_m_ = plan_.start.s_m + plan_.chosen->end_l_m;
    checked_to_s_m_ = plan_.start.s_m + proposal.checked_m;
    path_.emplace(path_of(proposal));
  } else if (!path_) {
    path_end_s_m_ = checked_to_s_m_ = start_.s_m;
    path_.emplace(reference_,
                  [d_m = start_.d_m](double s_m) { return LateralState{.s_m = s_m, .d_m = d_m}; });
  }
}

bool LateralReplanner::something_is_in_the_way() const { return is_in_the_way(plan_); }

PlannedPath LateralReplanner::expected_path() const {
  return PlannedPath(reference_, [path = *path_, end_m = path_end_s_m_](double s_m) {
    LateralState lateral = path.lateral_at(s_m);
    lateral.d_m *= fade(s_m, end_m);  // its slope is small enough to leave the heading alone
    return lateral;
  });
}

}  // namespace roadbed::planning::behaviour
