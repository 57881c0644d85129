#include "roadbed/planning/behaviour/goal_lines.h"

#include <cmath>
#include <utility>

#include "roadbed/planning/reference/road_end.h"

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kCompareEvery_m = 4.0, kAlike_m = 0.1;  // of two lines

LateralReplanner::Bounds replanner_bounds(const PlannerSetup& setup) {
  LateralReplanner::Bounds bounds{.tracking_error_m = setup.planner.max_tracking_error_m,
                                  .heading_error_rad = setup.planner.max_heading_error_rad,
                                  .margin_levels = {},
                                  .keeps_candidates = setup.planner.keeps_candidates,
                                  .weights = setup.driving.weights};
  if (setup.task.goal) {
    bounds.margin_levels = {{0.2, 0.3}, {0.05, 0.12}, {-0.05, 0.2}, {-0.15, 0.2}, {-0.6, 0.12}};
    bounds.squeezes_past = true;
  } else {
    bounds.margin_levels = margin_levels_on_route(setup.driving.clearance_m);
  }
  return bounds;
}

GoalLine goal_line_on(const ReferenceLine& line, std::vector<StopPoint> lights,
                      const PlannerSetup& setup) {
  const DrivingTask& task = setup.task;
  std::erase_if(lights, [](const auto& place) { return place.kind != StopKind::light; });
  return {.line = line,
          .road_end_s_m = road_end_s_m(line, task.road_map),
          .ceiling = ceiling_of(line, setup.vehicle, setup.driving),
          .stretches = task.goal ? goal_stretches(*task.goal, task.road_map, line, setup.vehicle)
                                 : std::vector<GoalStretch>{},
          .lights = task.goal ? std::move(lights) : std::vector<StopPoint>{},
          .replanner = {setup.vehicle, task, line, replanner_bounds(setup)}};
}

std::vector<GoalLine> goal_lines_of(const PlannerSetup& setup) {
  const DrivingTask& task = setup.task;
  std::vector<GoalLine> lines;
  lines.push_back(goal_line_on(task.line, task.stop_points, setup));
  for (std::size_t i = 0; i < task.other_lines.size(); ++i) {
    const bool has_places = i < task.other_stop_points.size();
    lines.push_back(goal_line_on(task.other_lines[i],
                                 has_places ? task.other_stop_points[i] : std::vector<StopPoint>{},
                                 setup));
  }
  return lines;
}

}  // namespace

GoalLines::GoalLines(const PlannerSetup& setup) : setup_(setup), lines_(goal_lines_of(setup)) {}

void GoalLines::drive_along(const Merging& merging, Merging::Along along,
                            const VehicleState& measured) {
  const std::shared_ptr<const MergeLines>& lines = merging.lines();
  if (to_merge_ && to_merge_->lines != lines) {
    change_to(first(), measured);
    to_merge_.reset();
  }
  if (lines && !to_merge_) {
    to_merge_.emplace(LinesToMerge{lines, goal_line_on(lines->own_lane, {}, setup_),
                                   goal_line_on(lines->next_lane, {}, setup_)});
  }
  if (along == Merging::Along::route_line) change_to(first(), measured);
  if (along == Merging::Along::own_lane) change_to(to_merge_->own_lane, measured);
  if (along == Merging::Along::next_lane) change_to(to_merge_->next_lane, measured);
}

void GoalLines::change_to(GoalLine& on, const VehicleState& measured) {
  if (&on == driven_) return;
  on.replanner.take_over(driven_->replanner);
  on.replanner.locate(measured);
  driven_ = &on;
}

/// Whether two lines, and the room beside them, are the same from the vehicle on.
bool run_alike(const GoalLine& a, const GoalLine& b, double ahead_m) {
  for (double l_m = 0.0; l_m <= ahead_m; l_m += kCompareEvery_m) {
    const double in_a_m = a.replanner.s_m() + l_m, in_b_m = b.replanner.s_m() + l_m;
    if ((a.line.at(in_a_m).in_map - b.line.at(in_b_m).in_map).norm() > kAlike_m) return false;
    const Corridor of_a = a.line.corridor_at(in_a_m), of_b = b.line.corridor_at(in_b_m);
    if (std::abs(of_a.left_m - of_b.left_m) > kAlike_m ||
        std::abs(of_a.right_m - of_b.right_m) > kAlike_m)
      return false;
  }
  return true;
}

}  // namespace roadbed::planning::behaviour
