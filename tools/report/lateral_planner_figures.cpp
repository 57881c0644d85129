// Figs. 8 and 9 of the paper.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "roadbed/planning/plan.h"
#include "roadbed/tools/report/paper_figures.h"

namespace roadbed::tools::inline report {
namespace {

using Eigen::Vector2d;
using planning::LateralState;
using planning::PlanInput;
using FigurePoints = std::vector<Vector2d>;

// A gentle bend, one lane to the right of the line's middle and one to the left.
planning::ReferenceLine bend() {
  FigurePoints points;
  for (int i = 0; i <= 24; ++i) {
    points.push_back({10.0 * i, 6.0 * std::sin(10.0 * i / 60.0)});
  }
  return planning::ReferenceLine::through(points, 4.5, 50.0 / 3.6);
}

Vector2d beside(const planning::ReferenceLine& line, double s_m, double d_m) {
  const planning::ReferencePoint at = line.at(s_m);
  return at.in_map + d_m * Vector2d(-std::sin(at.heading_rad), std::cos(at.heading_rad));
}

struct Overtaking {
  FigurePoints driven, other;  // every 0.5 s
};

// Plans ten times a second, each time on from the last plan; the vehicle follows it exactly.
Overtaking overtake(const planning::ReferenceLine& line, double speed_mps, double other_mps,
                    double duration_s) {
  constexpr double kCycle_s = 0.1, kOtherFrom_m = 45.0;
  Overtaking overtaking;
  LateralState state{.s_m = 10.0};
  planning::Plan last;
  for (int cycle = 0; cycle * kCycle_s <= duration_s; ++cycle) {
    const double t_s = cycle * kCycle_s, other_s_m = kOtherFrom_m + other_mps * t_s;
    const planning::ReferencePoint at = line.at(other_s_m);
    const planning::ObservedMotion seen{
        .t_s = t_s, .pose = {at.in_map.x(), at.in_map.y(), at.heading_rad}, .speed_mps = other_mps};
    const std::vector<planning::PredictedObstacle> predicted = {
        {.id = "car",
         .motion = planning::Prediction::along_line(line, {other_s_m, 0.0}, seen, 6.0)}};
    PlanInput input{.line = line,
                    .start = state,
                    .start_t_s = t_s,
                    .speed = {speed_mps, 0.0, speed_mps},
                    .obstacles = {},
                    .predicted = predicted};
    if (last.chosen) {
      input.previous_d_m = [&last](double s_m) { return last.lateral_at(s_m).d_m; };
    }
    planning::Plan plan = planning::plan_path(input, geometry::VehicleShape{});
    if (plan.chosen) last = std::move(plan);
    if (cycle % 5 == 0) {
      overtaking.driven.push_back(beside(line, state.s_m, state.d_m));
      overtaking.other.push_back(at.in_map);
    }
    if (!last.chosen) break;
    const double along = 1.0 - line.at(state.s_m).curvature_per_m * state.d_m;
    state = last.lateral_at(state.s_m + speed_mps * kCycle_s / std::hypot(along, state.d_slope));
  }
  return overtaking;
}

Figure overtaking() {
  const planning::ReferenceLine line = bend();
  const Overtaking drive = overtake(line, 12.0, 4.0, 12.0);
  FigurePoints reference;
  for (double s_m = 0.0; s_m <= 190.0; s_m += 1.0) reference.push_back(line.at(s_m).in_map);
  return {"figure_8_overtaking",
          {.title = "Fig. 8: avoiding a moving obstacle, positions every 0.5 s",
           .x_label = "x [m]",
           .y_label = "y [m]",
           .series = {{"reference line", Mark::line, kBlue, reference},
                      {"car ahead, 4 m/s", Mark::squares, kGreen, drive.other},
                      {"vehicle, 12 m/s (rear axle)", Mark::circles, kRed, drive.driven}}}};
}

Figure candidates() {
  const planning::ReferenceLine line =
      planning::ReferenceLine::through({{0.0, 0.0}, {50.0, 0.0}, {100.0, 0.0}}, 5.5, 50.0 / 3.6);
  const std::vector<planning::Obstacle> obstacles;
  planning::PlanOptions options;
  options.min_d_m = 2.0;
  options.max_d_m = 4.0;
  options.keep_candidates = true;
  const LateralState start{.s_m = 20.0};
  const planning::Plan plan = planning::plan_path(
      {.line = line, .start = start, .speed = {6.0, 0.0, 6.0}, .obstacles = obstacles},
      geometry::VehicleShape{}, options);
  Chart chart{.title = fmt::format("Fig. 9: {} candidates of one cycle", plan.candidates.size()),
              .x_label = "l [m]",
              .y_label = "d [m]",
              .series = {}};
  const auto draw = [&](const planning::Candidate& candidate, int parts, Series series) {
    const auto quintic =
        planning::QuinticFamily(start, candidate.end_l_m).member(candidate.end_d_m);
    for (int i = 0; i <= parts; ++i) {
      const double l_m = candidate.end_l_m * i / parts;
      series.points.push_back({l_m, quintic.at(l_m)[0]});
    }
    chart.series.push_back(std::move(series));
  };
  for (const planning::Candidate& candidate : plan.candidates) {
    draw(candidate, 15, {"candidates", Mark::thin, kBlue, {}});
  }
  if (plan.chosen) draw(*plan.chosen, 60, {"optimal, free of collision", Mark::line, kRed, {}});
  return {"figure_9_candidates", chart};
}

}  // namespace

std::vector<Figure> lateral_planner_figures() { return {overtaking(), candidates()}; }

}  // namespace roadbed::tools::report
