// Figs. 8 and 9 of the paper.
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/planning/plan.h"
#include "roadbed/tools/figures/paper_figures.h"
#include "roadbed/tools/figures/vehicle_outline.h"

namespace roadbed::tools::inline figures {
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
  struct Moment {
    double t_s;
    geometry::Pose2 vehicle, other;  // rear axle; middle
    double s_m, d_m, other_s_m;
  };
  std::vector<Moment> moments;  // every 0.1 s
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
    const Vector2d place = beside(line, state.s_m, state.d_m);
    const double turned_rad =
        std::atan2(state.d_slope, 1.0 - line.at(state.s_m).curvature_per_m * state.d_m);
    overtaking.moments.push_back(
        {t_s,
         {place.x(), place.y(), line.at(state.s_m).heading_rad + turned_rad},
         seen.pose,
         state.s_m,
         state.d_m,
         other_s_m});
    if (!last.chosen) break;
    const double along = 1.0 - line.at(state.s_m).curvature_per_m * state.d_m;
    state = last.lateral_at(state.s_m + speed_mps * kCycle_s / std::hypot(along, state.d_slope));
  }
  return overtaking;
}

// About the middle.
constexpr geometry::VehicleShape kOther{
    .length_m = 4.5, .width_m = 1.8, .rear_overhang_m = 2.25, .wheelbase_m = 2.0};

Body body_of_other(const geometry::Pose2& at) { return {outline_at(at, kOther), kGreen}; }

Body body_of(const geometry::Pose2& rear_axle) {
  return {outline_at(rear_axle, geometry::VehicleShape{}), kRed};
}

Figure overtaking() {
  constexpr double kHalfRoad_m = 4.5;
  constexpr int kBodyEvery = 15;  // moments
  const planning::ReferenceLine line = bend();
  const Overtaking drive = overtake(line, 12.0, 4.0, 12.0);
  FigurePoints reference, left, right;
  for (double s_m = 0.0; s_m <= 170.0; s_m += 1.0) {
    reference.push_back(line.at(s_m).in_map);
    left.push_back(beside(line, s_m, kHalfRoad_m));
    right.push_back(beside(line, s_m, -kHalfRoad_m));
  }
  Series driven{"vehicle, 12 m/s (rear axle)", Mark::line, kRed, {}},
      other{"car ahead, 4 m/s", Mark::dashed, kGreen, {}};
  Series offset{"offset of the vehicle", Mark::line, kRed, {}},
      gap{"station of the car less that of the vehicle", Mark::dashed, kGreen, {}};
  Panel plan{.title = "positions, with bodies every 1.5 s",
             .x_label = "x [m]",
             .y_label = "y [m]",
             .series = {},
             .is_plan = true,
             .columns = 2};
  for (std::size_t i = 0; i < drive.moments.size(); ++i) {
    const Overtaking::Moment& now = drive.moments[i];
    driven.points.push_back(now.vehicle.position());
    other.points.push_back(now.other.position());
    offset.points.push_back({now.t_s, now.d_m});
    gap.points.push_back({now.t_s, now.other_s_m - now.s_m});
    if (i % kBodyEvery != 0) continue;
    plan.bodies.push_back(body_of(now.vehicle));
    plan.bodies.push_back(body_of_other(now.other));
    const std::string time = fmt::format("{:g} s", now.t_s);
    plan.notes.push_back({beside(line, now.s_m, kHalfRoad_m + 0.6), time});
  }
  plan.series = {{"reference line", Mark::dash_dot, kBlue, reference},
                 {"edges of the road", Mark::line, kGrey, left},
                 {"edges of the road", Mark::line, kGrey, right},
                 driven,
                 other};
  return {
      "figure_8_overtaking",
      "Fig. 8: avoiding a moving obstacle",
      {std::move(plan),
       {.title = "offset from the reference line",
        .x_label = "t [s]",
        .y_label = "d [m]",
        .series = {offset}},
       {.title = "distance along the line",
        .x_label = "t [s]",
        .y_label = "Δs [m]",
        .series = {gap}}},
      "Planned ten times a second at a constant 12 m/s, each time on from the last plan, against "
      "where "
      "the car ahead is foreseen to be. x and y have the same scale, which they have not in the "
      "paper. "
      "Times in (a) are those of the vehicle below them. In a closed loop, with speed planned too, "
      "simulate drives the same past traffic of a map.",
      2};
}

Figure candidates() {
  const planning::ReferenceLine line =
      planning::ReferenceLine::through({{0.0, 0.0}, {50.0, 0.0}, {100.0, 0.0}}, 5.5, 50.0 / 3.6);
  const LateralState start{.s_m = 20.0};
  const geometry::Pose2 parked{line.at(42.0).in_map.x(), 0.0, 0.0};
  const std::vector<planning::Obstacle> obstacles{
      {.id = "parked",
       .kind = "car",
       .length_m = kOther.length_m,
       .width_m = kOther.width_m,
       .motion = geometry::Trajectory({{.x_m = parked.x_m, .y_m = parked.y_m}})}};
  planning::PlanOptions options;
  options.min_d_m = 2.0;
  options.max_d_m = 4.0;
  options.keep_candidates = true;
  const planning::Plan plan = planning::plan_path(
      {.line = line, .start = start, .speed = {6.0, 0.0, 6.0}, .obstacles = obstacles},
      geometry::VehicleShape{}, options);
  Panel panel{.x_label = "l [m]", .y_label = "d [m]", .series = {}, .is_plan = true};
  const auto draw = [&](const planning::Candidate& candidate, int parts, Series series) {
    const auto quintic =
        planning::QuinticFamily(start, candidate.end_l_m).member(candidate.end_d_m);
    for (int i = 0; i <= parts; ++i) {
      const double l_m = candidate.end_l_m * i / parts;
      series.points.push_back({l_m, quintic.at(l_m)[0]});
    }
    panel.series.push_back(std::move(series));
  };
  std::size_t colliding = 0, others = 0;
  for (const planning::Candidate& candidate : plan.candidates) {
    switch (candidate.rejection) {
      case planning::Rejection::none:
        draw(candidate, 15, {"feasible, free of collision", Mark::thin, kBlue, {}});
        break;
      case planning::Rejection::collision:
        ++colliding;
        draw(candidate, 15, {"in collision", Mark::thin, kOrange, {}});
        break;
      default:
        ++others;
        draw(candidate, 15, {"not feasible", Mark::thin, kGrey, {}});
    }
  }
  if (plan.chosen) draw(*plan.chosen, 60, {"optimal", Mark::line, kRed, {}});
  const double from_m = line.at(start.s_m).in_map.x();
  panel.bodies = {body_of({0.0, 0.0, 0.0}), body_of_other({parked.x_m - from_m, parked.y_m, 0.0})};
  panel.notes = {{{parked.x_m - from_m - 1.0, parked.y_m - 2.6}, "parked car"}};
  return {
      "figure_9_candidates",
      fmt::format("Fig. 9: {} candidates of one cycle", plan.candidates.size()),
      {std::move(panel)},
      fmt::format(
          "d_e from 2 to 4 m every 0.1 m, l_e from 15 to 30 m every 0.2 m, as in the paper, which "
          "shows no obstacle. {} of them would touch the parked car or come too near, {} turn or "
          "swing "
          "too sharply; of the others the cheapest is taken.",
          colliding, others)};
}

}  // namespace

std::vector<Figure> lateral_planner_figures() { return {overtaking(), candidates()}; }

}  // namespace roadbed::tools::figures
