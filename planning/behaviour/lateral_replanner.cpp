#include "roadbed/planning/behaviour/lateral_replanner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "roadbed/geometry/motion/longitudinal.h"
#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/planning/plan.h"

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kLeastReturn_m = 20.0, kReturn_mps2 = 1.5;  // back to the line, and to the side
constexpr double kFineGrid_m = 0.2;
constexpr double kCoarseGrid_m = 0.6;  // between ends of what is tried after the first plan
constexpr double kDrawnStep_m = 0.5;   // of a kept drive
constexpr double kCrawl_mps = 1.5, kBraking_mps2 = 5.0;
constexpr double kHoldStep_m = 1.0;
constexpr double kHeldOffset_m = 1.2;  // more is another lane, or partly
constexpr double kLeastKnot_m = 0.2, kMostSlope = 1.5;
constexpr double kSettle_m = 15.0, kSettle_s = 2.0;  // the longer of the two, past the last knot

/// The way that leads back from an offset at a speed. The quintic's second derivative is at most
/// 10/√3 of the offset over the square of its length.
double return_m(double offset_m, double speed_mps) {
  const double most = 10.0 / std::sqrt(3.0);
  return std::max(kLeastReturn_m, speed_mps * std::sqrt(most * std::abs(offset_m) / kReturn_mps2));
}

/// The offset times 1 up to `from_m`, 0 from `over_m` later on, with its derivatives.
LateralState faded(LateralState lateral, double from_m, double over_m) {
  const double u = std::clamp((lateral.s_m - from_m) / over_m, 0.0, 1.0);
  const double f = 1.0 - u * u * u * (10.0 - u * (15.0 - 6.0 * u));
  const double f_d1 = -30.0 * u * u * (1.0 - u) * (1.0 - u) / over_m;
  const double f_d2 = -60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) / (over_m * over_m);
  lateral.d_curvature_per_m =
      f * lateral.d_curvature_per_m + 2.0 * f_d1 * lateral.d_slope + f_d2 * lateral.d_m;
  lateral.d_slope = f * lateral.d_slope + f_d1 * lateral.d_m;
  lateral.d_m *= f;
  return lateral;
}

/// The line as planning sees it: past `end_m`, where the vehicle never comes, it goes on straight
/// with the width that it has there, so that no bend or dead end behind the goal matters.
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

ExplainedPlan::ExplainedPlan(const ReferenceLine& on_line, double end_m, const PlanInput& asked,
                             Plan answer)
    : line(on_line),
      obstacles(asked.obstacles),
      input{.line = straight_past(line, end_m),
            .start = asked.start,
            .start_t_s = asked.start_t_s,
            .speed = asked.speed,
            .obstacles = obstacles,
            .static_field = asked.static_field,
            .origin_in_source = asked.origin_in_source},
      plan(std::move(answer)) {}

LateralReplanner::LateralReplanner(const geometry::VehicleShape& vehicle, const DrivingTask& task,
                                   const ReferenceLine& line, const Bounds& bounds)
    : vehicle_(vehicle),
      task_(task),
      reference_(line),
      bounds_(bounds),
      line_end_m_(task.goal ? line.length_m() : line.goal_s_m() + vehicle.front_m() + 1.0),
      line_(straight_past(line, line_end_m_)) {}

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

/// Its path is taken to go on beside this line as it is there now.
void LateralReplanner::take_over(const LateralReplanner& before) {
  s_m_ = before.s_m_;
  if (!before.path_) return;
  const PlannedPath::Place driven = before.path().place_at(before.s_m_);
  const LateralState now =
      lateral_state(reference_, driven.pose, driven.curvature_per_m, before.s_m_);
  path_end_s_m_ = checked_to_s_m_ = now.s_m;
  path_.emplace(reference_, [now](double s_m) {
    LateralState state = now;
    state.s_m = s_m;
    return state;
  });
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

// A bend or a gap that is too sharp at the planned speed may be driven while braking. After the
// first attempt to squeeze past a coarse grid will do.
std::vector<LateralReplanner::FallbackLevel> LateralReplanner::fallback_levels(
    const Question& question, bool may_leave_lanes) const {
  const bool may_brake = bounds_.squeezes_past && question.speed.speed_mps > 2.0 * kCrawl_mps;
  std::vector<FallbackLevel> levels;
  for (const SafetyMargins& margins : bounds_.margin_levels) {
    if (!may_leave_lanes && margins.border_margin_m < 0.0) continue;
    const bool is_fine = may_leave_lanes && (levels.empty() || !bounds_.squeezes_past);
    levels.push_back({margins, is_fine ? kFineGrid_m : kCoarseGrid_m, false});
    if (may_brake) levels.push_back({margins, kCoarseGrid_m, true});
  }
  return levels;
}

PlanOptions LateralReplanner::options_for(const Question& question, const Offsets& offsets,
                                          double l_step_m) const {
  PlanOptions options;
  options.min_d_m = offsets.least_m;
  options.max_d_m = offsets.most_m;
  const double default_m = options.max_l_m - options.min_l_m;
  options.min_l_m = question.ends.least_m;
  options.max_l_m = question.ends.most_m;
  options.l_step_m = l_step_m * std::max(1.0, (options.max_l_m - options.min_l_m) / default_m);
  options.keep_stations = true;  // what collides is looked for at them again
  options.weights = bounds_.weights;
  if (!question.checks_completion) options.completion_horizon_s = 0.0;
  return options;
}

/// What was evaluated from one start on, by the speed and the grid of a fallback level: each is
/// made when it is asked for.
struct LateralReplanner::Cycles {
  std::vector<Obstacle> obstacles;  ///< those of the inputs, if they outlive the question
  std::vector<PlanInput> inputs;    ///< at the planned speed, and while braking
  std::map<std::pair<bool, double>, std::unique_ptr<PlanningCycle>> by_level;
};

std::shared_ptr<LateralReplanner::Cycles> LateralReplanner::cycles_for(
    const Question& question) const {
  auto cycles = std::make_shared<Cycles>();
  if (shares_cycles()) cycles->obstacles = question.obstacles;
  cycles->inputs.reserve(2);
  cycles->inputs.push_back(
      input_for({.t_s = question.t_s,
                 .measured = question.measured,
                 .speed = question.speed,
                 .ends = question.ends,
                 .obstacles = shares_cycles() ? cycles->obstacles : question.obstacles}));
  cycles->inputs.push_back(cycles->inputs.front());
  cycles->inputs.back().speed = {.speed_mps = question.speed.speed_mps,
                                 .acceleration_mps2 = -kBraking_mps2,
                                 .target_mps = kCrawl_mps};
  return cycles;
}

// Questions with other offsets look at the same grids.
LateralReplanner::Proposal LateralReplanner::propose(const Question& question,
                                                     const Offsets& offsets,
                                                     bool may_leave_lanes) const {
  const std::shared_ptr<Cycles> cycles =
      shares_cycles() && cycles_ ? cycles_ : cycles_for(question);
  if (shares_cycles()) cycles_ = cycles;
  Proposal last;
  for (const FallbackLevel& level : fallback_levels(question, may_leave_lanes)) {
    std::unique_ptr<PlanningCycle>& cycle = cycles->by_level[{level.brakes, level.l_step_m}];
    if (!cycle) {
      cycle = std::make_unique<PlanningCycle>(
          cycles->inputs[level.brakes ? 1 : 0], vehicle_,
          options_for(question, shares_cycles() ? Offsets{} : offsets, level.l_step_m));
    }
    const EndOffsetRange ends{offsets.least_m, offsets.most_m};
    last = {.plan = cycle->plan(level.margins, ends),
            .beyond_the_edge_m = std::max(0.0, -level.margins.border_margin_m),
            .checked_m = question.ends.most_m,
            .margins = level.margins,
            .ends = ends};
    last.explains = question.explains;
    if (bounds_.keeps_candidates || last.explains) last.cycle = {cycles, cycle.get()};
    const bool waits = !bounds_.squeezes_past && last.plan.meets_something();
    if (last.plan.chosen || waits) break;
  }
  if (!last.plan.chosen) last.checked_m = std::numeric_limits<double>::infinity();
  return last;
}

double LateralReplanner::kept_within_m(const Offsets& offsets) const {
  constexpr double kFarther_m = 0.1;
  const PlannedPath path = kept_path();
  const auto front_d_m = [&](double s_m) {
    const LateralState lateral = path.lateral_at(s_m);
    return lateral.d_m + vehicle_.front_m() * lateral.d_slope;
  };
  const double here_m = front_d_m(s_m_);
  const double most_m = std::max(offsets.most_m, here_m + kFarther_m);
  const double least_m = std::min(offsets.least_m, here_m - kFarther_m);
  for (double s_m = s_m_; s_m < checked_to_s_m_; s_m += kDrawnStep_m) {
    const double d_m = front_d_m(s_m);
    if (d_m > most_m || d_m < least_m) return std::max(0.0, s_m - kDrawnStep_m - s_m_);
  }
  return std::numeric_limits<double>::infinity();
}

/// Past the plan's end its offset is held as long as the corridor is wide enough for it, less the
/// way back.
double LateralReplanner::held_until_m(const Plan& plan) const {
  const double offset = plan.chosen->end_d_m;
  double s_m = plan.start.s_m + plan.chosen->end_l_m;
  for (; s_m < reference_.length_m(); s_m += kHoldStep_m) {
    const Corridor corridor = reference_.corridor_at(s_m);
    const double room_m = offset > 0.0 ? corridor.left_m : corridor.right_m;
    if (std::abs(offset) + 0.5 * vehicle_.width_m > room_m) break;
  }
  return std::max(plan.start.s_m + plan.chosen->end_l_m, s_m - return_m(offset, speed_mps_));
}

/// Before the first plan: straight on beside the line.
PlannedPath LateralReplanner::kept_path() const {
  if (path_) return *path_;
  return PlannedPath(
      reference_, [d_m = start_.d_m](double s_m) { return LateralState{.s_m = s_m, .d_m = d_m}; });
}

PlannedPath LateralReplanner::path_of(const Proposal& proposal) const {
  if (!proposal.plan.chosen) return kept_path();
  if (proposal.knots) {
    return PlannedPath(reference_, [knots = proposal.knots](double s_m) { return knots->at(s_m); });
  }
  if (!bounds_.squeezes_past || std::abs(proposal.plan.chosen->end_d_m) < kHeldOffset_m) {
    return PlannedPath(reference_,
                       [kept = proposal.plan](double s_m) { return kept.lateral_at(s_m); });
  }
  const double held_m = held_until_m(proposal.plan);
  const double over_m = return_m(proposal.plan.chosen->end_d_m, speed_mps_);
  return PlannedPath(reference_, [kept = proposal.plan, held_m, over_m](double s_m) {
    return faded(kept.lateral_at(s_m), held_m, over_m);
  });
}

std::shared_ptr<const ExplainedPlan> LateralReplanner::explain(const Proposal& proposal) const {
  Plan plan = proposal.cycle->plan_and_judge_all(proposal.margins, proposal.ends);
  plan.reason = proposal.plan.reason;
  if (proposal.knots) {
    plan.chosen = proposal.plan.chosen;
    plan.trajectory = proposal.plan.trajectory;
  }
  return std::make_shared<const ExplainedPlan>(reference_, line_end_m_, proposal.cycle->input(),
                                               std::move(plan));
}

std::optional<LateralReplanner::Proposal> LateralReplanner::through(
    std::span<const VehicleState> drive, double start_s) const {
  std::vector<LateralState> knots;
  std::vector<geometry::TrajectoryPoint> points;
  double near_s_m = s_m_;
  for (const VehicleState& state : drive) {
    const double curvature = std::tan(state.steering_rad) / vehicle_.wheelbase_m;
    const LateralState knot =
        lateral_state(reference_, state.map_from_vehicle, curvature, near_s_m);
    if (std::abs(knot.d_slope) > kMostSlope) return std::nullopt;
    const double t_s =
        start_s + geometry::kLongitudinal.cycle_s * static_cast<double>(points.size());
    points.push_back({.t_s = t_s,
                      .x_m = state.map_from_vehicle.x_m,
                      .y_m = state.map_from_vehicle.y_m,
                      .heading_rad = state.map_from_vehicle.heading_rad,
                      .speed_mps = state.speed_mps,
                      .acceleration_mps2 = state.acceleration_mps2,
                      .steering_rad = state.steering_rad,
                      .curvature_per_m = curvature});
    near_s_m = knot.s_m;
    if (knots.empty() || knot.s_m > knots.back().s_m + kLeastKnot_m) knots.push_back(knot);
  }
  if (knots.size() < 2) return std::nullopt;
  const LateralState first = knots.front(), last = knots.back();
  const double settle_m = std::max(kSettle_m, kSettle_s * drive.back().speed_mps);
  knots.push_back({.s_m = last.s_m + settle_m, .d_m = last.d_m + 0.5 * settle_m * last.d_slope});
  Proposal found;
  found.plan.chosen =
      Candidate{.end_d_m = knots.back().d_m, .end_l_m = knots.back().s_m - first.s_m};
  found.plan.start = first;
  found.plan.trajectory = geometry::Trajectory(std::move(points));
  found.checked_m = last.s_m - first.s_m;
  found.knots = std::make_shared<const KnottedOffset>(std::move(knots));
  return found;
}

std::optional<LateralReplanner::Proposal> LateralReplanner::kept_drive(double now_s,
                                                                       double speed_mps) const {
  if (!drive_ || from_measurement_) return std::nullopt;
  const double end_s_m = drive_->knots->knots().back().s_m;
  if (s_m_ >= end_s_m) return std::nullopt;
  Proposal kept = *drive_;
  const PlannedPath path = path_of(kept);
  std::vector<geometry::TrajectoryPoint> points;
  double t_s = now_s;
  for (double s_m = s_m_; s_m < end_s_m; s_m += kDrawnStep_m) {
    const PlannedPath::Place place = path.place_at(s_m);
    points.push_back({.t_s = t_s,
                      .x_m = place.pose.x_m,
                      .y_m = place.pose.y_m,
                      .heading_rad = place.pose.heading_rad,
                      .speed_mps = speed_mps,
                      .curvature_per_m = place.curvature_per_m});
    t_s += kDrawnStep_m * place.stretch / std::max(kCrawl_mps, speed_mps);
  }
  kept.plan.trajectory = geometry::Trajectory(std::move(points));
  return kept;
}

void LateralReplanner::explain_by_candidates(const Question& question, Proposal& drive) const {
  if (!question.explains) return;
  const Proposal instead = propose(question, {});
  drive.explains = true;
  drive.cycle = instead.cycle;
  drive.margins = instead.margins;
  drive.ends = instead.ends;
}

void LateralReplanner::take(const Proposal& proposal) {
  drive_ = proposal.knots ? std::optional(proposal) : std::nullopt;
  candidates_.reset();
  if (bounds_.keeps_candidates && proposal.cycle) {
    candidates_ = proposal.cycle->judge(proposal.margins, proposal.ends, proposal.plan);
  }
  explained_ = proposal.explains && proposal.cycle ? explain(proposal) : nullptr;
  cycles_.reset();  // they ask for the path so far
  plan_ = proposal.plan;
  beyond_the_edge_m_ = proposal.beyond_the_edge_m;
  kept_to_s_m_ = std::numeric_limits<double>::infinity();
  if (plan_.chosen) {
    path_end_s_m_ = plan_.start.s_m + plan_.chosen->end_l_m;
    checked_to_s_m_ = plan_.start.s_m + proposal.checked_m;
    path_.emplace(path_of(proposal));
  } else if (path_) {
    kept_to_s_m_ = s_m_ + proposal.checked_m;
  } else {
    path_end_s_m_ = checked_to_s_m_ = start_.s_m;
    path_.emplace(kept_path());
  }
}

bool LateralReplanner::something_is_in_the_way() const { return plan_.meets_something(); }

PlannedPath LateralReplanner::expected_path_of(const Proposal& proposal) const {
  const Plan& plan = proposal.plan;
  const double end_s_m = plan.chosen ? plan.start.s_m + plan.chosen->end_l_m : path_end_s_m_;
  return led_back(path_of(proposal), end_s_m);
}

PlannedPath LateralReplanner::led_back(const PlannedPath& path, double end_s_m) const {
  const double over_m = return_m(path.lateral_at(end_s_m).d_m, speed_mps_);
  return PlannedPath(reference_, [path, end_s_m, over_m](double s_m) {
    return faded(path.lateral_at(s_m), end_s_m, over_m);
  });
}

}  // namespace roadbed::planning::behaviour
