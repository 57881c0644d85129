// Figs. 11 to 13 of the paper.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/control/stanley.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/tools/figures/paper_figures.h"
#include "roadbed/tools/figures/vehicle_outline.h"

namespace roadbed::tools::inline figures {
namespace {

using Eigen::Vector2d;
using geometry::Pose2;

std::vector<Vector2d> ray(const Vector2d& from, double heading_rad, double length_m) {
  return {from, from + length_m * Vector2d(std::cos(heading_rad), std::sin(heading_rad))};
}

std::vector<Vector2d> arc(const Vector2d& middle, double radius_m, double from_rad, double to_rad) {
  std::vector<Vector2d> points;
  for (int i = 0; i <= 20; ++i) {
    const double angle_rad = from_rad + (to_rad - from_rad) * i / 20;
    points.push_back(middle + radius_m * Vector2d(std::cos(angle_rad), std::sin(angle_rad)));
  }
  return points;
}

/// What the law sees, of a vehicle that is 1.8 m to the right of its path and turned 0.2 rad
/// clockwise to it.
Figure tracking_error() {
  constexpr double kBeside_m = 1.8, kTurned_rad = 0.2, kSpeed_mps = 10.0;
  constexpr geometry::VehicleShape kWheel{.length_m = 0.7, .width_m = 0.3, .rear_overhang_m = 0.35};
  const geometry::VehicleShape vehicle;
  const double ahead_m = control::look_forward_m(kSpeed_mps);
  const double error_rad = std::atan(control::cross_track_gain(kSpeed_mps) * kBeside_m / ahead_m);
  const double steering_rad = kTurned_rad + error_rad;
  const Vector2d front(0.0, -kBeside_m);
  const Pose2 rear =
      Pose2{front.x(), front.y(), -kTurned_rad} * Pose2{-vehicle.wheelbase_m, 0.0, 0.0};
  Panel panel{.x_label = "", .y_label = "", .series = {}, .is_plan = true};
  panel.bodies = {
      {outline_at(rear, vehicle), kBlue},
      {outline_at(rear, kWheel), kBlack},
      {outline_at({front.x(), front.y(), rear.heading_rad + steering_rad}, kWheel), kBlack}};
  panel.series = {
      {"path", Mark::line, kBlack, {{-6.0, 0.0}, {14.0, 0.0}}},
      {"direction of the vehicle", Mark::dash_dot, kBlue, ray(front, rear.heading_rad, 7.0)},
      {"direction of the path", Mark::dotted, kGrey, ray(front, 0.0, 12.0)},
      {"direction of the front wheels", Mark::dashed, kRed,
       ray(front, rear.heading_rad + steering_rad, 9.0)},
      {"", Mark::line, kBlue, arc(front, 5.0, rear.heading_rad, 0.0)},
      {"", Mark::line, kRed, arc(front, 7.0, 0.0, error_rad)}};
  panel.arrows = {{front, {0.0, 0.0}, true}, {{0.0, 1.2}, {ahead_m, 1.2}, true}};
  panel.notes = {{{0.1, -0.9}, "e_{fa}"},
                 {{4.9, -kBeside_m - 0.75}, "θ_e"},
                 {{7.1, -kBeside_m + 0.15}, "atan(k_e e_{fa} / L_x)"},
                 {{0.5 * ahead_m, 1.25}, "L_x"}};
  return {
      "figure_11_tracking_error",
      "Fig. 11: what the steering law sees",
      {std::move(panel)},
      "Errors are taken at the front axle: e_{fa} to the path, positive where the path is to "
      "the left, and "
      "θ_e from the vehicle's direction to that of the path. δ = θ_e + atan(k_e(v) e_{fa} / "
      "L_x(v)) turns "
      "the wheels to the point of the path that is L_x/k_e ahead (eq. 32). Drawn for 10 m/s, to "
      "scale."};
}

Series by_speed(const char* name, double (*value)(double)) {
  Series series{name, Mark::line, kBlue, {}};
  for (int i = 0; i <= 140; ++i) series.points.push_back({0.25 * i, value(0.25 * i)});
  return series;
}

Figure look_forward() {
  return {"figure_12_look_forward_distance",
          "Fig. 12: look-forward distance over speed",
          {{.x_label = "v [m/s]",
            .y_label = "L_x [m]",
            .series = {by_speed("L_x(v), eq. 33", control::look_forward_m)}}},
          "10 m below 12.5 m/s, 0.8 s · v up to 25 m/s, then 20 m."};
}

Figure gain() {
  return {"figure_13_gain",
          "Fig. 13: gain of the cross-track error over speed",
          {{.x_label = "v [m/s]",
            .y_label = "k_e [1]",
            .series = {by_speed("k_e(v)", control::cross_track_gain)}}},
          "Eq. 34 says nothing below 12.5 m/s; the paper's figure does: k_e = min(1, 0.5 + 0.02 v) "
          "from 0 m/s on."};
}

}  // namespace

std::vector<Figure> steering_law_figures() { return {tracking_error(), look_forward(), gain()}; }

}  // namespace roadbed::tools::figures
