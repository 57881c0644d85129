// What tells the steering laws of Fig. 14 apart: a start beside the path, noise, a car that slips.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/control/sampled_path.h"
#include "roadbed/control/tracking_run.h"
#include "roadbed/tools/report/paper_figures.h"
#include "roadbed/tools/report/steering_laws.h"

namespace roadbed::tools::inline report {
namespace {

using control::SteeringLaw;
using control::TrackingOptions;
using control::TrackingSample;

constexpr std::array<double, 9> kFromCrawling_mps{0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0};
constexpr double kOffset_m = 1.0;

TrackingOptions slipping(SteeringLaw law, double speed_mps) {
  return {.law = law, .speed_mps = speed_mps, .slips = control::common_road_vehicle(2)};
}

std::vector<TrackingSample> from_beside(SteeringLaw law, double speed_mps) {
  const double length_m = 60.0 + 7.0 * speed_mps;
  const control::SampledPath straight({{0.0, 0.0, 0.0}, {length_m, 0.0, 0.0}});
  TrackingOptions options = slipping(law, speed_mps);
  options.start_offset_m = kOffset_m;
  return control::track_path(straight, options);
}

/// Driven until the error stays below a tenth of the start's.
double settling_m(const std::vector<TrackingSample>& run) {
  double last_s = 0.0;
  for (const TrackingSample& row : run) {
    if (std::abs(row.cross_track_m) > 0.1 * kOffset_m) last_s = row.t_s;
  }
  return last_s * run.front().state.speed_mps;
}

/// A chart over speed, and what it shows of a run.
struct OverSpeed {
  std::string name, title, label;
  std::function<double(const std::vector<TrackingSample>&)> value;
};

/// Each run is driven once for all charts.
template <typename Drive>
std::vector<Figure> over_speed(const std::vector<OverSpeed>& charts, const Drive& drive) {
  std::vector<Figure> figures;
  for (const OverSpeed& of : charts) {
    figures.push_back({"figure_14_" + of.name, {"Fig. 14: " + of.title, "v [m/s]", of.label, {}}});
  }
  for (const LawLook& law : kSteeringLaws) {
    for (Figure& figure : figures) {
      figure.chart.series.push_back({law.name, Mark::line, law.colour, {}});
    }
    for (const double speed_mps : kFromCrawling_mps) {
      const std::vector<TrackingSample> run = drive(law.law, speed_mps);
      for (std::size_t i = 0; i < charts.size(); ++i) {
        figures[i].chart.series.back().points.push_back({speed_mps, charts[i].value(run)});
      }
    }
  }
  return figures;
}

std::vector<Figure> offset_starts() {
  const std::string title = "start 1 m beside a straight, slipping car";
  return over_speed(
      {{"offset_start_largest_steering", title, "largest |δ| [rad]",
        [](const auto& run) { return control::summarise(run).largest_steering_rad; }},
       {"offset_start_settling", title, "way until |e_fa| stays below 0.1 m [m]", settling_m}},
      from_beside);
}

Figure return_to_path() {
  Figure figure{"figure_14_offset_start_cross_track",
                {.title = "Fig. 14: start 1 m beside a straight, at 0.2 and 30 m/s",
                 .x_label = "way [m]",
                 .y_label = "e_fa [m]",
                 .series = {}}};
  constexpr double kShown_m = 60.0, kStep_m = 0.25;
  for (const double speed_mps : {0.2, 30.0}) {
    for (const LawLook& law : {kSteeringLaws[0], kSteeringLaws[1]}) {
      Series series{fmt::format("{}, {:g} m/s", law.name, speed_mps),
                    speed_mps < 1.0 ? Mark::dashed : Mark::line,
                    law.colour,
                    {}};
      for (const TrackingSample& row : from_beside(law.law, speed_mps)) {
        const double way_m = row.t_s * speed_mps;
        const double next_m = kStep_m * static_cast<double>(series.points.size());
        if (way_m > kShown_m) break;
        if (way_m >= next_m - 1e-9) series.points.push_back({way_m, row.cross_track_m});
      }
      figure.chart.series.push_back(std::move(series));
    }
  }
  return figure;
}

struct Course {
  const char *name, *title;
  control::SampledPath (*path)(double speed_mps);
};

std::vector<Figure> with_noise(const Course& course) {
  const std::string name = fmt::format("{}_noise_", course.name);
  const std::string title = fmt::format("{}, slipping car, noise of 2 cm, 1 mrad", course.title);
  return over_speed(
      {{name + "cross_track", title, "RMS of e_fa [m]",
        [](const auto& run) { return control::summarise(run).cross_track_rms_m; }},
       {name + "steering_rate", title, "RMS of the steering rate [rad/s]",
        [](const auto& run) { return control::summarise(run).steering_rate_rms_radps; }}},
      [&](SteeringLaw law, double speed_mps) {
        TrackingOptions options = slipping(law, speed_mps);
        options.position_noise_m = 0.02;
        options.heading_noise_rad = 0.001;
        return control::track_path(course.path(speed_mps), options);
      });
}

}  // namespace

std::vector<Figure> steering_law_figures() {
  std::vector<Figure> figures = offset_starts();
  figures.push_back(return_to_path());
  for (const Course& course :
       {Course{"right_turn", "right turn at a crossroad", control::right_turn_path},
        Course{"zig_zag", "zig-zag", control::zig_zag_path}}) {
    for (Figure& figure : with_noise(course)) figures.push_back(std::move(figure));
  }
  return figures;
}

}  // namespace roadbed::tools::report
