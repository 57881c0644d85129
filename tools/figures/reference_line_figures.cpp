// Figs. 2–7 of the paper.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>

#include "roadbed/geometry/curves/quintic_bezier.h"
#include "roadbed/geometry/curves/spline_curve.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/tools/figures/paper_figures.h"

namespace roadbed::tools::inline figures {
namespace {

using Eigen::Vector2d;
using Points = std::vector<Vector2d>;

// A bending road as it is measured: every 3 to 8 m, each point up to 0.5 m off along and across.
Points measured_centreline() {
  std::mt19937 random(2);
  const auto fraction = [&] { return static_cast<double>(random()) / 4294967296.0; };
  Points points;
  for (double x_m = 0.0; x_m <= 70.0; x_m += 3.0 + 5.0 * fraction()) {
    const Vector2d noise(fraction() - 0.5, fraction() - 0.5);
    points.push_back(Vector2d(x_m, 6.0 * std::sin(x_m / 12.0)) + noise);
  }
  return points;
}

Points points_of(const planning::ReferenceLine& line, double step_m) {
  Points points;
  for (double s_m = 0.0; s_m <= line.length_m(); s_m += step_m) {
    points.push_back(line.at(s_m).in_map);
  }
  return points;
}

Points beside(const planning::ReferenceLine& line, double d_m) {
  Points points;
  for (double s_m = 0.0; s_m <= line.length_m(); s_m += 0.25) {
    const planning::ReferencePoint at = line.at(s_m);
    points.push_back(at.in_map +
                     d_m * Vector2d(-std::sin(at.heading_rad), std::cos(at.heading_rad)));
  }
  return points;
}

// Of a curve that is sampled, from three of its points each.
Points curvature_of(const Points& points) {
  Points rows;
  double s_m = 0.0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Vector2d a = points[i] - points[i - 1], b = points[i + 1] - points[i];
    s_m += a.norm();
    const double turn_rad = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
    rows.push_back({s_m, turn_rad / (0.5 * (a.norm() + b.norm()))});
  }
  return rows;
}

Figure path_model() {
  constexpr double kHalfWidth_m = 1.75, kLightAt_m = 62.0;
  const Points way_points = measured_centreline();
  const auto line =
      planning::ReferenceLine::through(way_points, kHalfWidth_m, 14.0, {.max_smoothing_m = 0.8});
  const Points interpolated = geometry::SplineCurve::through(way_points).resample(0.25);
  Points smoothed;
  for (double s_m = 0.0; s_m <= line.length_m(); s_m += 0.25) {
    smoothed.push_back({s_m, line.at(s_m).curvature_per_m});
  }
  const auto at_light = static_cast<std::size_t>(kLightAt_m / 0.25);
  const Points line_to_stop_at{beside(line, kHalfWidth_m).at(at_light),
                               beside(line, -kHalfWidth_m).at(at_light)};
  return {
      "figure_2_path_model",
      "Fig. 2: path model",
      {{.title = "road",
        .x_label = "x [m]",
        .y_label = "y [m]",
        .series = {{"way-points of the centreline", Mark::circles, kBlack, way_points},
                   {"interpolated: cubic spline", Mark::dashed, kRed, interpolated},
                   {"smoothed: reference line", Mark::line, kBlue, points_of(line, 0.25)},
                   {"edges of the road", Mark::line, kGrey, beside(line, kHalfWidth_m)},
                   {"edges of the road", Mark::line, kGrey, beside(line, -kHalfWidth_m)},
                   {"traffic light", Mark::line, kGreen, line_to_stop_at}},
        .is_plan = true,
        .notes = {{line.at(2.0).in_map + Vector2d(0.0, 5.2), "50 km/h"},
                  {line_to_stop_at[0], "light"}}},
       {.title = "curvature",
        .x_label = "s [m]",
        .y_label = "κ [1/m]",
        .series = {{"interpolated: cubic spline", Mark::dashed, kRed, curvature_of(interpolated)},
                   {"smoothed: reference line", Mark::line, kBlue, smoothed}}}},
      "The map gives the road's width, its speed limit, traffic lights and a centreline of "
      "way-points "
      "that were measured every 3 to 8 m, each up to 0.5 m off in x and in y. The paper "
      "interpolates them (eq. 1 "
      "to 5); "
      "a spline through noise bends where the road does not. The line that is planned along is "
      "smoothed, "
      "within 0.8 m of the way-points, which the paper does not do."};
}

Figure cubic_spline() {
  const Points way_points = {{0.0, 0.0},  {8.0, 5.0},   {14.0, 4.0},  {23.0, -3.0}, {30.0, 1.0},
                             {34.0, 9.0}, {30.0, 16.0}, {20.0, 17.0}, {11.0, 14.0}};
  const auto curve = geometry::SplineCurve::through(way_points);
  return {
      "figure_3_cubic_spline",
      "Fig. 3: cubic spline interpolation of a road that turns back",
      {{.x_label = "x [m]",
        .y_label = "y [m]",
        .series = {{"way-points", Mark::dots, kRed, way_points},
                   {"natural spline of x(s) and y(s)", Mark::line, kBlue, curve.resample(0.1)}},
        .is_plan = true}},
      "A road that turns back is no function y(x), so x(s) and y(s) are interpolated over the same "
      "parameter, which is corrected to the arc length. In eq. 3 the slope is divided by h_i, "
      "where "
      "the paper has a_i."};
}

// A right angle of two legs of 14 m and 6 m more, smoothed with the given gaps.
class Corner {
 public:
  explicit Corner(const geometry::CornerGaps& gaps)
      : curve_(geometry::QuinticBezier::corner(kBefore, kAt, kAfter, gaps)) {}

  Points control_points() const {
    return {curve_.control_points().begin(), curve_.control_points().end()};
  }

  // The leg, the curve and the other leg, about 5 cm apart. For each point: the arc length, and
  // what `of` makes of the derivatives with respect to it.
  template <typename Of>
  Points along(const Of& of) const {
    Points rows;
    const auto add_leg = [&](const Vector2d& from, const Vector2d& to, double from_s_m) {
      const double length_m = (to - from).norm();
      for (double l_m = 0.0; l_m < length_m; l_m += 0.05) {
        rows.push_back({from_s_m + l_m, of(State::on_leg(from, to, l_m))});
      }
    };
    add_leg(kBefore, curve_.at(0.0), 0.0);
    double s_m = (curve_.at(0.0) - kBefore).norm();
    Vector2d last = curve_.at(0.0);
    for (int i = 0; i <= kSamples; ++i) {
      const double t = static_cast<double>(i) / kSamples;
      s_m += (curve_.at(t) - last).norm();
      last = curve_.at(t);
      rows.push_back({s_m, of(State::on_curve(curve_, t))});
    }
    add_leg(last, kAfter, s_m);
    return rows;
  }

  struct State {
    Vector2d position, tangent, bend;  // bend: second derivative by arc length
    double curvature_per_m;

    static State on_leg(const Vector2d& from, const Vector2d& to, double s_m) {
      const Vector2d tangent = (to - from).normalized();
      return {from + s_m * tangent, tangent, {0.0, 0.0}, 0.0};
    }
    static State on_curve(const geometry::QuinticBezier& curve, double t) {
      const Vector2d tangent = curve.derivative(t, 1).normalized();
      const double curvature = curve.curvature_per_m(t);
      return {curve.at(t), tangent, curvature * Vector2d(-tangent.y(), tangent.x()), curvature};
    }
  };

  Points positions() const {
    Points points;
    along([&](const State& state) {
      points.push_back(state.position);
      return 0.0;
    });
    return points;
  }

  inline static const Vector2d kBefore{-20.0, 0.0}, kAt{0.0, 0.0}, kAfter{0.0, 20.0};

 private:
  static constexpr int kSamples = 500;
  geometry::QuinticBezier curve_;
};

Figure corner_curve() {
  const Corner corner(geometry::kPaperGaps);
  Points legs;
  for (double s_m = -20.0; s_m <= 0.0; s_m += 0.5) legs.push_back({s_m, 0.0});
  for (double s_m = 0.5; s_m <= 20.0; s_m += 0.5) legs.push_back({0.0, s_m});
  Panel panel{.x_label = "x [m]",
              .y_label = "y [m]",
              .series = {{"road centreline", Mark::dots, kGrey, legs},
                         {"reference line", Mark::line, kBlue, corner.positions()},
                         {"control points", Mark::circles, kRed, corner.control_points()}},
              .is_plan = true};
  for (std::size_t i = 0; i < corner.control_points().size(); ++i) {
    panel.notes.push_back({corner.control_points()[i], fmt::format("P_{}", i)});
  }
  return {"figure_4_corner",
          "Fig. 4: Bézier curve at a corner",
          {std::move(panel)},
          "Gaps of d_1, d_2, d_3 = 3, 3 and 8 m, as in the paper. The centreline is drawn every "
          "0.5 m; the "
          "paper draws it every 0.01 m, as a line."};
}

Figure first_derivative(const Corner& corner) {
  using State = Corner::State;
  return {"figure_5_first_derivative",
          "Fig. 5: first derivative of the reference line at the corner",
          {{.x_label = "s [m]",
            .y_label = "dx/ds, dy/ds [1]",
            .series = {{"dx/ds", Mark::line, kBlue,
                        corner.along([](const State& at) { return at.tangent.x(); })},
                       {"dy/ds", Mark::dashed, kRed,
                        corner.along([](const State& at) { return at.tangent.y(); })}}}},
          "By the arc length s, from 20 m before the corner."};
}

Figure second_derivative(const Corner& corner) {
  using State = Corner::State;
  return {"figure_6_second_derivative",
          "Fig. 6: second derivative of the reference line at the corner",
          {{.x_label = "s [m]",
            .y_label = "d^2x/ds^2, d^2y/ds^2 [1/m]",
            .series = {{"d^2x/ds^2", Mark::line, kBlue,
                        corner.along([](const State& at) { return at.bend.x(); })},
                       {"d^2y/ds^2", Mark::dashed, kRed,
                        corner.along([](const State& at) { return at.bend.y(); })}}}},
          "Zero where the curve leaves the legs: equal first gaps make B'' vanish at both ends."};
}

Figure curvature(const Corner& corner) {
  const auto of = [](const Corner::State& at) { return at.curvature_per_m; };
  // Its legs are longer, so that its ends do not count; 0 is where the others begin.
  const auto line = planning::ReferenceLine::through(
      {3.0 * Corner::kBefore, Corner::kBefore, Corner::kAt, Corner::kAfter, 3.0 * Corner::kAfter},
      1.75, 10.0);
  const double from_m = line.project(Corner::kBefore).s_m;
  Points planned;
  for (double l_m = 0.0; l_m <= line.project(Corner::kAfter).s_m - from_m; l_m += 0.05) {
    planned.push_back({l_m, line.at(from_m + l_m).curvature_per_m});
  }
  return {
      "figure_7_curvature",
      "Fig. 7: curvature of the reference line at the corner",
      {{.x_label = "s [m]",
        .y_label = "κ [1/m]",
        .series = {{"gaps 3, 3, 8 m", Mark::line, kBlue, corner.along(of)},
                   {"gaps 5, 5, 4 m", Mark::dashed, kRed, Corner(geometry::kGentleGaps).along(of)},
                   {"line that is planned along", Mark::dash_dot, kGreen, planned}}}},
      "The paper's gaps of 3, 3 and 8 m bend twice: at 0.4 rad/s of steering rate a car may drive "
      "1.1 m/s "
      "there. The same 14 m as 5, 5 and 4 m are good for 10 m/s. The line that is planned along "
      "has a "
      "continuous κ' besides, which candidates beside it need; it swings out before and after the "
      "corner, "
      "so that κ is below zero there."};
}

}  // namespace

std::vector<Figure> reference_line_figures() {
  const Corner corner(geometry::kPaperGaps);
  return {path_model(),
          cubic_spline(),
          corner_curve(),
          first_derivative(corner),
          second_derivative(corner),
          curvature(corner)};
}

}  // namespace roadbed::tools::figures
