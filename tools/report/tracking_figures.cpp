// Figs. 10 and 12 to 14 of the paper.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>

#include "roadbed/control/cruise_control.h"
#include "roadbed/control/lower_controller.h"
#include "roadbed/control/sampled_path.h"
#include "roadbed/control/stanley.h"
#include "roadbed/control/tracking_run.h"
#include "roadbed/tools/report/paper_figures.h"
#include "roadbed/tools/report/steering_laws.h"

namespace roadbed::tools::inline report {
namespace {

using control::SteeringLaw;
using control::TrackingSample;
using control::TrackingSummary;

constexpr std::array<double, 6> kSpeeds_mps{5.0, 10.0, 15.0, 20.0, 25.0, 30.0};
constexpr std::array<const char*, 6> kSpeedColours{"#0072b2", "#d62728", "#00785a",
                                                   "#b8860b", "#7b3294", "#10141a"};
constexpr int kEveryRow = 5;  // rows are 0.01 s apart

Series by_speed(const char* name, double (*value)(double)) {
  Series series{name, Mark::line, kBlue, {}};
  for (int i = 0; i <= 140; ++i) series.points.push_back({0.25 * i, value(0.25 * i)});
  return series;
}

Figure look_forward() {
  return {"figure_12_look_forward_distance",
          {.title = "Fig. 12: look-forward distance over speed",
           .x_label = "v [m/s]",
           .y_label = "L_x [m]",
           .series = {by_speed("L_x(v), eq. 33", control::look_forward_m)}}};
}

Figure gain() {
  return {"figure_13_gain",
          {.title = "Fig. 13: gain of the cross-track error over speed",
           .x_label = "v [m/s]",
           .y_label = "k_e [1]",
           .series = {by_speed("k_e(v), eq. 34", control::cross_track_gain)}}};
}

/// The loop of Fig. 10 at work behind a lead that slows down, with noisy measurements; seeded.
class NoisyFollowing {
 public:
  Figure figure() {
    for (int k = 0; k < 400; ++k) advance(0.1 * k);
    return {"figure_10_lqg",
            {.title = "Fig. 10: the LQG loop behind a lead that slows from 20 to 12 m/s",
             .x_label = "t [s]",
             .y_label = "d_desire − d [m]",
             .series = {measured_, true_, estimated_}}};
  }

 private:
  void advance(double t_s) {
    const double gap_m = lead_m_ - own_m_;
    const double desired_m =
        geometry::kLongitudinal.headway_s * speed_mps_ + geometry::kLongitudinal.standstill_gap_m;
    const double error_m = desired_m - gap_m;
    const control::LeadMeasurement seen{
        .gap_m = gap_m + 0.5 * normal_(random_),
        .relative_speed_mps = lead_mps_ - speed_mps_ + 0.2 * normal_(random_)};
    const double command = cruise_.update(speed_mps_, acceleration_mps2_ + 0.1 * normal_(random_),
                                          {.speed_mps = 40.0}, seen);
    measured_.points.push_back({t_s, desired_m - seen.gap_m});
    true_.points.push_back({t_s, error_m});
    estimated_.points.push_back({t_s, (*cruise_.estimate())[0]});
    for (int i = 0; i < 10; ++i) {
      acceleration_mps2_ = control::actuate(acceleration_mps2_, command, 0.01);
      own_m_ += 0.01 * speed_mps_;
      speed_mps_ += 0.01 * acceleration_mps2_;
    }
    lead_m_ += 0.1 * lead_mps_;
    if (t_s >= 10.0 && t_s < 18.0) lead_mps_ -= 0.1;
  }

  control::CruiseControl cruise_{{}};
  std::mt19937 random_{20261121};
  std::normal_distribution<double> normal_;
  double own_m_ = 0.0, speed_mps_ = 20.0, acceleration_mps2_ = 0.0;
  double lead_m_ = 35.0, lead_mps_ = 20.0;
  Series measured_{"measured y", Mark::dots, kGreen, {}};
  Series true_{"true", Mark::line, kBlack, {}};
  Series estimated_{"estimated by the Kalman filter", Mark::line, kRed, {}};
};

/// One of the paper's two tests.
struct Test {
  const char *name, *title;
  control::SampledPath (*path)(double speed_mps);
};
constexpr std::array<Test, 2> kTests{{
    {"right_turn", "right turn at a crossroad", control::right_turn_path},
    {"zig_zag", "zig-zag", control::zig_zag_path},
}};

/// A quantity of a run, over time and as its largest value.
struct Quantity {
  const char *name, *label;
  double TrackingSample::*value;
  double TrackingSummary::*largest;
};
constexpr std::array<Quantity, 4> kQuantities{{
    {"cross_track", "e_fa [m]", &TrackingSample::cross_track_m,
     &TrackingSummary::largest_cross_track_m},
    {"heading", "θ_e [rad]", &TrackingSample::heading_rad, &TrackingSummary::largest_heading_rad},
    {"steering_rate", "steering rate [rad/s]", &TrackingSample::steering_rate_radps,
     &TrackingSummary::largest_steering_rate_radps},
    {"lateral_jerk", "lateral jerk [m/s³]", &TrackingSample::lateral_jerk_mps3,
     &TrackingSummary::largest_lateral_jerk_mps3},
}};

using Runs = std::vector<std::vector<TrackingSample>>;  // one per speed

Runs runs_of(const Test& test, SteeringLaw law) {
  Runs runs;
  for (const double speed : kSpeeds_mps) {
    runs.push_back(control::track_path(test.path(speed), {.law = law, .speed_mps = speed}));
  }
  return runs;
}

Figure driven_way(const Test& test) {
  const control::SampledPath path = test.path(kSpeeds_mps.front());
  Series way{"course", Mark::line, kBlack, {}}, driven{"rear axle, 5 m/s", Mark::dashed, kRed, {}};
  for (double s_m = 0.0; s_m <= path.length_m(); s_m += 0.25) {
    way.points.push_back(path.at(s_m).position());
  }
  for (const TrackingSample& row : control::track_path(path, {.speed_mps = kSpeeds_mps.front()})) {
    driven.points.push_back(row.state.pose.position());
  }
  return {fmt::format("figure_14_{}_course", test.name),
          {.title = fmt::format("Fig. 14: {}, as driven at 5 m/s", test.title),
           .x_label = "x [m]",
           .y_label = "y [m]",
           .series = {way, driven},
           .is_plan = true}};
}

Figure over_time(const Test& test, const Quantity& quantity, const Runs& runs) {
  Figure figure{fmt::format("figure_14_{}_{}", test.name, quantity.name),
                {.title = fmt::format("Fig. 14: {}, modified Stanley law", test.title),
                 .x_label = "t [s]",
                 .y_label = quantity.label,
                 .series = {}}};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    Series series{fmt::format("{:g} m/s", kSpeeds_mps[i]), Mark::line, kSpeedColours[i], {}};
    for (std::size_t k = 0; k < runs[i].size(); k += kEveryRow) {
      series.points.push_back({runs[i][k].t_s, runs[i][k].*quantity.value});
    }
    figure.chart.series.push_back(std::move(series));
  }
  return figure;
}

/// Beside the curves over time, the largest values of all laws.
std::vector<Figure> figures_of(const Test& test) {
  std::vector<Figure> largest;
  for (const Quantity& quantity : kQuantities) {
    largest.push_back({fmt::format("figure_14_{}_largest_{}", test.name, quantity.name),
                       {.title = fmt::format("Fig. 14: {}, largest values", test.title),
                        .x_label = "v [m/s]",
                        .y_label = quantity.label,
                        .series = {}}});
  }
  std::vector<Figure> figures{driven_way(test)};
  for (const LawLook& look : kSteeringLaws) {
    const Runs runs = runs_of(test, look.law);
    for (std::size_t q = 0; q < kQuantities.size(); ++q) {
      if (look.law == SteeringLaw::stanley) {
        figures.push_back(over_time(test, kQuantities[q], runs));
      }
      Series series{look.name, Mark::line, look.colour, {}};
      for (std::size_t i = 0; i < runs.size(); ++i) {
        series.points.push_back(
            {kSpeeds_mps[i], control::summarise(runs[i]).*kQuantities[q].largest});
      }
      largest[q].chart.series.push_back(std::move(series));
    }
  }
  for (Figure& figure : largest) figures.push_back(std::move(figure));
  return figures;
}

}  // namespace

std::vector<Figure> tracking_figures() {
  std::vector<Figure> figures{NoisyFollowing().figure(), look_forward(), gain()};
  for (const Test& test : kTests) {
    for (Figure& figure : figures_of(test)) figures.push_back(std::move(figure));
  }
  return figures;
}

}  // namespace roadbed::tools::report
