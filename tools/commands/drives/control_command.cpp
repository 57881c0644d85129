#include <fmt/format.h>
#include <fmt/ostream.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "roadbed/control/cruise_design.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/tools/commands/drives/commands.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline drives {
namespace {

using nlohmann::ordered_json;

template <typename Matrix>
ordered_json rows(const Matrix& matrix) {
  ordered_json result = ordered_json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    ordered_json row = ordered_json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    result.push_back(row);
  }
  return result;
}

ordered_json pairs(const std::vector<std::complex<double>>& poles) {
  ordered_json result = ordered_json::array();
  for (const auto& pole : poles) result.push_back({pole.real(), pole.imag()});
  return result;
}

/// Gains from a lead to its follower: of the bare loop, and of the one that is run.
struct StringGains {
  control::StringGain bare, whole;
  double delay_s;
};

ordered_json design_json(const control::CruiseDesign& design, const StringGains& string) {
  return {{"A", rows(design.model.A)},
          {"B", rows(design.model.B)},
          {"G", rows(design.model.G)},
          {"K", rows(design.K)[0]},
          {"K_speed", rows(design.K_speed)[0]},
          {"P", rows(design.P)},
          {"L", rows(design.L)},
          {"poles", pairs(design.poles)},
          {"filter_poles", pairs(design.filter_poles)},
          {"riccati_residual", design.riccati_residual},
          {"kalman_residual", design.kalman_residual},
          {"string_gain", string.bare.gain},
          {"string_gain_at_radps", string.bare.at_radps},
          {"delay_s", string.delay_s},
          {"loop_string_gain", string.whole.gain},
          {"loop_string_gain_at_radps", string.whole.at_radps}};
}

void print_poles(std::ostream& out, const char* name,
                 const std::vector<std::complex<double>>& poles) {
  fmt::print(out, "{}\n", name);
  for (const auto& pole : poles) {
    fmt::print(out, "  {:.6f} {:+.6f}i   |z| = {:.6f}\n", pole.real(), pole.imag(), std::abs(pole));
  }
}

void print_gain(std::ostream& out, std::string_view of, const control::StringGain& string) {
  fmt::print(out, "largest gain from lead to follower, of {}: {:.6f} at {:.4f} rad/s{}\n", of,
             string.gain, string.at_radps, string.gain > 1.0 + 1e-6 ? " (string unstable)" : "");
}

void print_design(std::ostream& out, const control::CruiseDesign& design,
                  const StringGains& string) {
  fmt::print(out, "gain K on [d_desire − d, v_p − v_f, a_f]\n  {:.10f} {:.10f} {:.10f}\n",
             design.K[0], design.K[1], design.K[2]);
  fmt::print(out, "gain of the set speed on [v_set − v, a_f]\n  {:.10f} {:.10f}\n",
             design.K_speed[0], design.K_speed[1]);
  fmt::print(out, "Kalman gain L (filter form)\n");
  for (Eigen::Index i = 0; i < 3; ++i) {
    fmt::print(out, "  {:.10f} {:.10f} {:.10f}\n", design.L(i, 0), design.L(i, 1), design.L(i, 2));
  }
  print_poles(out, "poles of A − B K", design.poles);
  print_poles(out, "poles of A (I − L)", design.filter_poles);
  fmt::print(out, "residual of the Riccati equation {:.1e}, of the filter's {:.1e}\n",
             design.riccati_residual, design.kalman_residual);
  print_gain(out, "acceleration, without filter and delay", string.bare);
  print_gain(out,
             fmt::format("speed, 0.01 to 1 Hz, with filter and {:g} s of delay", string.delay_s),
             string.whole);
}

class ControlCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Design the controllers");
    Arguments design = arguments.part("design");
    design.description("Gains and poles of the cruise control");
    const auto positive = [&](const char* name, double& value, const char* help) {
      design.add(name, value, help).positive().with_default();
    };
    positive("--headway", options_.headway_s, "Time gap to the lead [s]");
    positive("--lag", options_.actuator_lag_s, "Time constant of the actuator [s]");
    positive("--gain", options_.actuator_gain, "Gain of the actuator");
    positive("--step", options_.step_s, "Sampling time [s]");
    design.add("--weights", weights_, "Weights of distance error, relative speed and acceleration")
        .values(3)
        .not_negative()
        .with_default();
    positive("--input-weight", options_.input_weight, "Weight of the command");
    design.add("--delay", delay_steps_, "Sampling times by which a command is late")
        .within(0, 50)
        .with_default();
    design.flag("-j,--json", json_, "Print one JSON document");
    design.example("  roadbed control design --weights 1 2 0.5 --input-weight 5");
    arguments.example("  roadbed control design --json");
  }

  Exit run(const Streams& streams, const CommonOptions& /*common*/) override {
    const control::CruiseDesign design = design_or_refuse();
    const StringGains string{
        .bare = control::string_gain(design, options_.step_s),
        .whole = control::loop_string_gain(design, options_.step_s, delay_steps_),
        .delay_s = options_.step_s * delay_steps_};
    if (json_) {
      streams.out << map::json_text(versioned("control_design", design_json(design, string)), 2)
                  << '\n';
    } else {
      print_design(streams.out, design, string);
    }
    return Exit::ok;
  }

 private:
  control::CruiseDesign design_or_refuse() {
    options_.state_weights = {weights_[0], weights_[1], weights_[2]};
    try {
      return control::design_cruise(options_);
    } catch (const std::invalid_argument& error) {  // the numbers are the user's
      throw map::InputError(
          {.file = "control design", .found = error.what(), .remedy = "change the options"});
    }
  }

  control::CruiseOptions options_;
  int delay_steps_ = 2;
  std::vector<double> weights_{1.0, 1.0, 0.0};
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_control_command() { return std::make_unique<ControlCommand>(); }

}  // namespace roadbed::tools::commands::drives
