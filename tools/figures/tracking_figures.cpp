// Fig. 14 of the paper.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/control/sampled_path.h"
#include "roadbed/control/tracking_run.h"
#include "roadbed/tools/figures/paper_figures.h"

namespace roadbed::tools::inline figures {
namespace {

using control::SteeringLaw;
using control::TrackingOptions;
using control::TrackingSample;
using control::TrackingSummary;
using Run = std::vector<TrackingSample>;

struct LawLook {
  SteeringLaw law;
  const char* name;
  const char* colour;
  Mark mark;
};
constexpr std::array<LawLook, 3> kLaws{{
    {SteeringLaw::stanley, "modified Stanley, eq. 32", kBlue, Mark::line},
    {SteeringLaw::original_stanley, "original Stanley, eq. 31", kRed, Mark::dashed},
    {SteeringLaw::pure_pursuit, "pure pursuit", kGreen, Mark::dash_dot},
}};

struct SpeedLook {
  double speed_mps;
  const char* colour;
  Mark mark;
};
constexpr std::array<SpeedLook, 6> kSpeeds{{{5.0, kBlue, Mark::line},
                                            {10.0, kRed, Mark::dashed},
                                            {15.0, kGreen, Mark::dash_dot},
                                            {20.0, kOrange, Mark::dotted},
                                            {25.0, kViolet, Mark::long_dash},
                                            {30.0, kBlack, Mark::dash_dot_dot}}};
constexpr int kEveryRow = 5;  // rows are 0.01 s apart

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
  const char *name, *label, *largest_label;
  double TrackingSample::*value;
  double TrackingSummary::*largest;
};
constexpr std::array<Quantity, 4> kQuantities{{
    {"cross-track error", "e_{fa} [m]", "max |e_{fa}| [m]", &TrackingSample::cross_track_m,
     &TrackingSummary::largest_cross_track_m},
    {"heading error", "θ_e [rad]", "max |θ_e| [rad]", &TrackingSample::heading_rad,
     &TrackingSummary::largest_heading_rad},
    {"steering rate", "dδ/dt [rad/s]", "max |dδ/dt| [rad/s]", &TrackingSample::steering_rate_radps,
     &TrackingSummary::largest_steering_rate_radps},
    {"lateral jerk", "da_{lat}/dt [m/s^3]", "max |da_{lat}/dt| [m/s^3]",
     &TrackingSample::lateral_jerk_mps3, &TrackingSummary::largest_lateral_jerk_mps3},
}};

std::vector<Run> runs_of(const Test& test, SteeringLaw law) {
  std::vector<Run> runs;
  for (const SpeedLook& look : kSpeeds) {
    runs.push_back(
        control::track_path(test.path(look.speed_mps), {.law = law, .speed_mps = look.speed_mps}));
  }
  return runs;
}

Panel driven_course(const Test& test) {
  const double speed_mps = kSpeeds.front().speed_mps;
  const control::SampledPath path = test.path(speed_mps);
  Series course{"course", Mark::line, kGrey, {}},
      driven{"front axle, 5 m/s", Mark::dashed, kRed, {}};
  for (double s_m = 0.0; s_m <= path.length_m(); s_m += 0.25) {
    course.points.push_back(path.at(s_m).position());
  }
  const TrackingOptions options{.speed_mps = speed_mps};
  for (const TrackingSample& row : control::track_path(path, options)) {
    const geometry::Pose2 front =
        row.state.pose * geometry::Pose2{options.vehicle.wheelbase_m, 0.0, 0.0};
    driven.points.push_back(front.position());
  }
  return {.title = "course, as driven at 5 m/s",
          .x_label = "x [m]",
          .y_label = "y [m]",
          .series = {course, driven},
          .is_plan = true,
          .columns = 2};
}

Panel over_time(const Quantity& quantity, const std::vector<Run>& runs) {
  Panel panel{.title = fmt::format("{}, modified law", quantity.name),
              .x_label = "t [s]",
              .y_label = quantity.label,
              .series = {}};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    Series series{
        fmt::format("{:g} m/s", kSpeeds[i].speed_mps), kSpeeds[i].mark, kSpeeds[i].colour, {}};
    for (std::size_t k = 0; k < runs[i].size(); k += kEveryRow) {
      series.points.push_back({runs[i][k].t_s, runs[i][k].*quantity.value});
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

/// Beside the curves over time, the largest values of all laws.
Figure figure_of(const Test& test) {
  std::array<std::vector<Run>, kLaws.size()> runs;
  for (std::size_t law = 0; law < kLaws.size(); ++law) runs[law] = runs_of(test, kLaws[law].law);
  std::vector<Panel> panels{driven_course(test)};
  for (const Quantity& quantity : kQuantities) {
    panels.push_back(over_time(quantity, runs[0]));
    Panel largest{.title = fmt::format("largest {}", quantity.name),
                  .x_label = "v [m/s]",
                  .y_label = quantity.largest_label,
                  .series = {}};
    for (std::size_t law = 0; law < kLaws.size(); ++law) {
      Series series{kLaws[law].name, kLaws[law].mark, kLaws[law].colour, {}};
      for (std::size_t i = 0; i < kSpeeds.size(); ++i) {
        series.points.push_back(
            {kSpeeds[i].speed_mps, control::summarise(runs[law][i]).*quantity.largest});
      }
      largest.series.push_back(std::move(series));
    }
    panels.push_back(std::move(largest));
  }
  return {fmt::format("figure_14_{}", test.name), fmt::format("Fig. 14: {}", test.title),
          std::move(panels),
          "The vehicle starts on the course, aligned with it, and rolls without slip; nothing is "
          "noisy. So both "
          "Stanley laws do nearly the same here, and the paper's claim does not show: see the "
          "figures of a start "
          "beside the path and of noise. The law takes the path's heading at the front axle, which "
          "keeps that one "
          "on the course; the rear axle runs inside it.",
          2};
}

constexpr std::array<double, 9> kFromCrawling_mps{0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0};
constexpr double kOffset_m = 1.0;

TrackingOptions slipping(SteeringLaw law, double speed_mps) {
  return {.law = law, .speed_mps = speed_mps, .slips = control::common_road_vehicle(2)};
}

Run from_beside(SteeringLaw law, double speed_mps) {
  const double length_m = 60.0 + 7.0 * speed_mps;
  const control::SampledPath straight({{0.0, 0.0, 0.0}, {length_m, 0.0, 0.0}});
  TrackingOptions options = slipping(law, speed_mps);
  options.start_offset_m = kOffset_m;
  return control::track_path(straight, options);
}

Run with_noise(const Test& test, SteeringLaw law, double speed_mps) {
  TrackingOptions options = slipping(law, speed_mps);
  options.position_noise_m = 0.02;
  options.heading_noise_rad = 0.001;
  return control::track_path(test.path(speed_mps), options);
}

/// Driven until the error stays below a tenth of the start's.
double settling_m(const Run& run) {
  double last_s = 0.0;
  for (const TrackingSample& row : run) {
    if (std::abs(row.cross_track_m) > 0.1 * kOffset_m) last_s = row.t_s;
  }
  return last_s * run.front().state.speed_mps;
}

/// A panel over speed, and what it shows of a run.
struct OverSpeed {
  std::string title, label;
  std::function<double(const Run&)> value;
};

/// Each run is driven once for all panels.
template <typename Drive>
void add_over_speed(std::vector<Panel>& panels, const std::vector<OverSpeed>& asked,
                    const Drive& drive) {
  const std::size_t first = panels.size();
  for (const OverSpeed& one : asked) {
    panels.push_back(
        {.title = one.title, .x_label = "v [m/s]", .y_label = one.label, .series = {}});
  }
  for (const LawLook& law : kLaws) {
    for (std::size_t i = first; i < panels.size(); ++i) {
      panels[i].series.push_back({law.name, law.mark, law.colour, {}});
    }
    for (const double speed_mps : kFromCrawling_mps) {
      const Run run = drive(law.law, speed_mps);
      for (std::size_t i = 0; i < asked.size(); ++i) {
        panels[first + i].series.back().points.push_back({speed_mps, asked[i].value(run)});
      }
    }
  }
}

Panel return_to_path(double speed_mps) {
  constexpr double kShown_m = 60.0, kStep_m = 0.25;
  Panel panel{.title = fmt::format("way back at {:g} m/s", speed_mps),
              .x_label = "way [m]",
              .y_label = "e_{fa} [m]",
              .series = {}};
  for (const LawLook& law : kLaws) {
    Series series{law.name, law.mark, law.colour, {}};
    for (const TrackingSample& row : from_beside(law.law, speed_mps)) {
      const double way_m = row.t_s * speed_mps;
      const double next_m = kStep_m * static_cast<double>(series.points.size());
      if (way_m > kShown_m) break;
      if (way_m >= next_m - 1e-9) series.points.push_back({way_m, row.cross_track_m});
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

Figure offset_start() {
  std::vector<Panel> panels{return_to_path(0.2), return_to_path(30.0)};
  add_over_speed(panels,
                 {{"largest steering angle", "max |δ| [rad]",
                   [](const Run& run) { return control::summarise(run).largest_steering_rad; }},
                  {"way until |e_{fa}| stays below 0.1 m", "way [m]", settling_m}},
                 from_beside);
  return {"figure_14_offset_start",
          "Fig. 14, added: start 1 m beside a straight, a car that slips",
          std::move(panels),
          "Not in the paper, whose tests start on the course. CommonRoad's vehicle 2 on its tyres. "
          "Eq. 31 divides by "
          "the speed: near standstill it turns the wheels nearly as far as they go, and is back "
          "soonest there; at "
          "30 m/s it comes back late. Eq. 32 divides by L_x(v), and needs 33 to 46 m at any speed.",
          2,
          true};
}

Figure noise() {
  std::vector<Panel> panels;
  for (const Test& test : kTests) {
    add_over_speed(
        panels,
        {{fmt::format("{}: cross-track error", test.title), "RMS of e_{fa} [m]",
          [](const Run& run) { return control::summarise(run).cross_track_rms_m; }},
         {fmt::format("{}: steering rate", test.title), "RMS of dδ/dt [rad/s]",
          [](const Run& run) { return control::summarise(run).steering_rate_rms_radps; }}},
        [&](SteeringLaw law, double speed_mps) { return with_noise(test, law, speed_mps); });
  }
  return {"figure_14_noise",
          "Fig. 14, added: noise of 2 cm and 1 mrad, a car that slips",
          std::move(panels),
          "Not in the paper. CommonRoad's vehicle 2 on its tyres, pose measured with white noise, "
          "seeded. Up to 5 m/s "
          "the modified law steers less, as the original one divides by the speed, which keeps "
          "that one nearer to "
          "the path; from 10 m/s on it is the other way round. Pure pursuit keeps nearest from 15 "
          "m/s on.",
          2,
          true};
}

}  // namespace

std::vector<Figure> tracking_figures() {
  return {figure_of(kTests[0]), figure_of(kTests[1]), offset_start(), noise()};
}

}  // namespace roadbed::tools::figures
