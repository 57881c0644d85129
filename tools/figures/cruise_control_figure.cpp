// Fig. 10 of the paper.
#include <fmt/format.h>

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/control/cruise_control.h"
#include "roadbed/control/lower_controller.h"
#include "roadbed/tools/figures/paper_figures.h"

namespace roadbed::tools::inline figures {
namespace {

using Eigen::Vector2d;

/// A box of the block diagram, with a word in its middle.
struct Block {
  Vector2d middle;
  double half_width;
  const char* text;
};

constexpr double kHalfHeight = 1.1;

std::vector<Vector2d> ring_of(const Block& block) {
  const Vector2d half(block.half_width, kHalfHeight);
  return {block.middle - half, block.middle + Vector2d(half.x(), -half.y()), block.middle + half,
          block.middle + Vector2d(-half.x(), half.y())};
}

Panel block_diagram() {
  const std::vector<Block> blocks{{{9.0, 4.0}, 3.2, "LQR: u = −K x"},
                                  {{19.5, 4.0}, 3.2, "|u| ≤ 0.25 g"},
                                  {{31.0, 4.0}, 4.2, "vehicle, K_L/(T_L s+1)"},
                                  {{43.0, 4.0}, 3.6, "gap to the lead"},
                                  {{19.5, -1.5}, 4.4, "Kalman filter"}};
  Panel panel{.title = "loop", .x_label = "", .y_label = "", .series = {}, .is_plan = true};
  for (const Block& block : blocks) {
    panel.bodies.push_back({ring_of(block), kGrey});
    panel.notes.push_back({block.middle + Vector2d(-block.half_width + 0.2, -0.5), block.text});
  }
  panel.arrows = {
      {{12.2, 4.0}, {16.3, 4.0}},   {{22.7, 4.0}, {26.8, 4.0}},  {{35.2, 4.0}, {39.4, 4.0}},
      {{43.0, 7.6}, {43.0, 5.1}},   {{46.6, 4.0}, {50.0, 4.0}},  {{48.5, 4.0}, {48.5, -1.5}},
      {{48.5, -1.5}, {23.9, -1.5}}, {{15.1, -1.5}, {3.0, -1.5}}, {{3.0, -1.5}, {3.0, 4.0}},
      {{3.0, 4.0}, {5.8, 4.0}},     {{24.7, 4.0}, {24.7, -0.4}}};
  panel.notes.insert(panel.notes.end(), {{{13.4, 4.2}, "u"},
                                         {{36.4, 4.2}, "a_f, v_f"},
                                         {{43.2, 6.4}, "v_p"},
                                         {{30.0, -1.3}, "y = x + noise"},
                                         {{3.2, -1.3}, "estimate of x = (d_{error}, v_{rel}, a_f)"},
                                         {{24.9, 1.2}, "u that is sent"}});
  panel.columns = 2;
  return panel;
}

/// A quantity of the state, as it is, as it is measured, and as the filter has it.
struct Compared {
  Series measured{"measured", Mark::dots, kGrey, {}};
  Series truth{"true", Mark::line, kBlack, {}};
  Series estimated{"estimated by the Kalman filter", Mark::dashed, kRed, {}};

  void add(double t_s, double measured_value, double true_value, double estimated_value) {
    measured.points.push_back({t_s, measured_value});
    truth.points.push_back({t_s, true_value});
    estimated.points.push_back({t_s, estimated_value});
  }

  /// From when the filter has settled.
  double rms(const Series& of) const {
    constexpr std::size_t kSettled = 50;
    double squares = 0.0;
    for (std::size_t i = kSettled; i < truth.points.size(); ++i) {
      squares += std::pow(of.points[i].y() - truth.points[i].y(), 2);
    }
    return std::sqrt(squares / static_cast<double>(truth.points.size() - kSettled));
  }

  Panel panel(std::string title, std::string label) const {
    return {.title = std::move(title),
            .x_label = "t [s]",
            .y_label = std::move(label),
            .series = {measured, truth, estimated}};
  }
};

/// The loop at work behind a lead that slows down, with noisy measurements; seeded.
class NoisyFollowing {
 public:
  Figure figure() {
    for (int k = 0; k < 400; ++k) advance(0.1 * k);
    return {"figure_10_lqg",
            "Fig. 10: the LQG loop",
            {block_diagram(),
             distance_.panel("distance error", "d_{error} = d_{desire} − d [m]"),
             relative_.panel("relative speed", "v_{rel} [m/s]"),
             acceleration_.panel("own acceleration", "a_f [m/s^2]"),
             {.title = "command", .x_label = "t [s]", .y_label = "u [m/s^2]", .series = {command_}},
             {.title = "speeds",
              .x_label = "t [s]",
              .y_label = "v [m/s]",
              .series = {lead_, own_},
              .columns = 2}},
            fmt::format("A lead slows from 20 to 12 m/s from 10 to 18 s. Gap, relative speed and "
                        "own acceleration "
                        "are measured with σ = 0.5 m, 0.2 m/s and 0.1 m/s^2. The estimate of "
                        "d_{{error}} is off by "
                        "{:.3f} m RMS, the measurement by {:.3f} m. The paper shows the loop only. "
                        "Its Riccati equation "
                        "(eq. 30) has a wrong sign and mixes continuous and discrete time; the "
                        "gain here is that of "
                        "the discrete one. The filter predicts with the command after its "
                        "limit, which is not reached here.",
                        distance_.rms(distance_.estimated), distance_.rms(distance_.measured)),
            2};
  }

 private:
  void advance(double t_s) {
    const double gap_m = lead_m_ - own_m_;
    const double desired_m =
        geometry::kLongitudinal.headway_s * speed_mps_ + geometry::kLongitudinal.standstill_gap_m;
    const control::LeadMeasurement seen{
        .gap_m = gap_m + 0.5 * normal_(random_),
        .relative_speed_mps = lead_mps_ - speed_mps_ + 0.2 * normal_(random_)};
    const double seen_mps2 = acceleration_mps2_ + 0.1 * normal_(random_);
    const double command = cruise_.update(speed_mps_, seen_mps2, {.speed_mps = 40.0}, seen);
    const auto estimate = *cruise_.estimate();
    distance_.add(t_s, desired_m - seen.gap_m, desired_m - gap_m, estimate[0]);
    relative_.add(t_s, seen.relative_speed_mps, lead_mps_ - speed_mps_, estimate[1]);
    acceleration_.add(t_s, seen_mps2, acceleration_mps2_, estimate[2]);
    command_.points.push_back({t_s, command});
    own_.points.push_back({t_s, speed_mps_});
    lead_.points.push_back({t_s, lead_mps_});
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
  Compared distance_, relative_, acceleration_;
  Series command_{"command of the LQR", Mark::line, kBlue, {}};
  Series own_{"vehicle, v_f", Mark::line, kBlue, {}}, lead_{"lead, v_p", Mark::dashed, kGreen, {}};
};

}  // namespace

Figure cruise_control_figure() { return NoisyFollowing().figure(); }

}  // namespace roadbed::tools::figures
