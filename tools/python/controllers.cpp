#include <fmt/format.h>
#include <nanobind/stl/complex.h>
#include <nanobind/stl/pair.h>

#include <complex>
#include <map>
#include <stdexcept>

#include "roadbed/control/cruise_control.h"
#include "roadbed/control/lower_controller.h"
#include "roadbed/control/single_track.h"
#include "roadbed/control/stanley.h"
#include "roadbed/tools/python/motion.h"

namespace roadbed::tools::inline python {
namespace {

using control::CruiseOptions;

// Options as the arguments of the constructor name them; `step_s` is needed for the string gain.
struct Cruise {
  CruiseOptions options;
  control::CruiseControl control;
};

Eigen::Vector3d three(nb::handle given, const std::string& name) {
  const Rows row = rows_of(given, name, 3);
  if (row.shape(0) != 1) throw std::invalid_argument(name + ": needs three numbers");
  return {row.data()[0], row.data()[1], row.data()[2]};
}

CruiseOptions cruise_options(const nb::kwargs& given) {
  CruiseOptions options;
  const std::map<std::string, double CruiseOptions::*> numbers = {
      {"headway_s", &CruiseOptions::headway_s},
      {"standstill_gap_m", &CruiseOptions::standstill_gap_m},
      {"actuator_lag_s", &CruiseOptions::actuator_lag_s},
      {"actuator_gain", &CruiseOptions::actuator_gain},
      {"step_s", &CruiseOptions::step_s},
      {"input_weight", &CruiseOptions::input_weight},
      {"lead_acceleration_variance", &CruiseOptions::lead_acceleration_variance},
      {"actuator_noise_variance", &CruiseOptions::actuator_noise_variance},
      {"max_command_mps2", &CruiseOptions::max_command_mps2},
      {"max_jerk_mps3", &CruiseOptions::max_jerk_mps3},
      {"bridged_s", &CruiseOptions::bridged_s}};
  for (const auto [key, value] : given) {
    const auto name = nb::cast<std::string>(key);
    if (const auto number = numbers.find(name); number != numbers.end()) {
      options.*number->second = nb::cast<double>(value);
    } else if (name == "state_weights") {
      options.state_weights = three(value, name);
    } else if (name == "measurement_noise_variance") {
      options.measurement_noise_variance = three(value, name);
    } else {
      throw nb::type_error(fmt::format("there is no option of the cruise \"{}\"", name).c_str());
    }
  }
  return options;
}

template <typename Matrix>
nb::object matrix_array(const Matrix& matrix) {
  std::vector<double> values;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
      values.push_back(matrix(row, column));
    }
  }
  if (matrix.rows() == 1 || matrix.cols() == 1) return nb::cast(owned(std::move(values)));
  return nb::cast(owned<double, 2>(std::move(values), {static_cast<std::size_t>(matrix.rows()),
                                                       static_cast<std::size_t>(matrix.cols())}));
}

nb::dict design_of(const Cruise& cruise) {
  const control::CruiseDesign& design = cruise.control.design();
  nb::dict dict;
  dict["A"] = matrix_array(design.model.A);
  dict["B"] = matrix_array(design.model.B);
  dict["G"] = matrix_array(design.model.G);
  dict["K"] = matrix_array(design.K);
  dict["P"] = matrix_array(design.P);
  dict["L"] = matrix_array(design.L);
  dict["S"] = matrix_array(design.S);
  dict["K_speed"] = matrix_array(design.K_speed);
  return dict;
}

std::optional<control::LeadMeasurement> lead_of(std::optional<double> gap_m,
                                                std::optional<double> relative_speed_mps) {
  if (gap_m.has_value() != relative_speed_mps.has_value()) {
    throw std::invalid_argument("gap_m and relative_speed_mps: both are needed, or neither");
  }
  if (!gap_m) return std::nullopt;
  return control::LeadMeasurement{*gap_m, *relative_speed_mps};
}

geometry::Pose2 pose_of(nb::handle given, const std::string& name) {
  const Eigen::Vector3d pose = three(given, name);
  return {pose[0], pose[1], pose[2]};
}

void bind_cruise(nb::module_& module) {
  nb::class_<Cruise>(module, "CruiseControl",
                     "LQG cruise control: follows a lead at a headway, or holds a set speed, "
                     "whichever asks for less. To be called once every `step_s`.")
      .def(
          "__init__",
          [](Cruise* self, const nb::kwargs& given) {
            const CruiseOptions options = cruise_options(given);
            new (self) Cruise{options, control::CruiseControl(options)};
          },
          nb::arg("options"),
          nb::sig("def __init__(self, *, headway_s: float = 1.5, standstill_gap_m: float = 5.0, "
                  "actuator_lag_s: float = 0.45, actuator_gain: float = 1.0, step_s: float = 0.1, "
                  "state_weights: numpy.typing.ArrayLike = (1.0, 1.0, 0.0), input_weight: float = "
                  "1.0, measurement_noise_variance: numpy.typing.ArrayLike = (0.25, 0.04, 0.01), "
                  "lead_acceleration_variance: float = 1.0, actuator_noise_variance: float = "
                  "0.0001, max_command_mps2: float = 2.4525, max_jerk_mps3: float = 4.0, "
                  "bridged_s: float = 0.5) -> None"),
          "Raises ValueError if a value is unusable.")
      .def_prop_ro("design", &design_of,
                   nb::sig("def design(self) -> dict[str, numpy.typing.NDArray[numpy.float64]]"),
                   "Model A, B, G of the state [gap error, relative speed, acceleration], the gain "
                   "K in u = -K x, the cost-to-go P, the filter's gain L and innovation S, and "
                   "K_speed of the set-speed hold.")
      .def_prop_ro(
          "poles",
          [](const Cruise& cruise) {
            std::vector<std::complex<double>> poles = cruise.control.design().poles;
            return poles;
          },
          "Of the closed loop, A - B K.")
      .def_prop_ro(
          "string_gain",
          [](const Cruise& cruise) {
            return control::string_gain(cruise.control.design(), cruise.options.step_s).gain;
          },
          "Largest gain from a lead to its follower over frequency: 1 or less, and a disturbance "
          "does not grow down a platoon.")
      .def(
          "update",
          [](Cruise& cruise, double speed_mps, double acceleration_mps2, double set_speed_mps,
             std::optional<double> gap_m, std::optional<double> relative_speed_mps,
             double set_acceleration_mps2) {
            return cruise.control.update(speed_mps, acceleration_mps2,
                                         {set_speed_mps, set_acceleration_mps2},
                                         lead_of(gap_m, relative_speed_mps));
          },
          nb::arg("speed_mps"), nb::arg("acceleration_mps2"), nb::arg("set_speed_mps"),
          nb::arg("gap_m") = nb::none(), nb::arg("relative_speed_mps") = nb::none(), nb::kw_only(),
          nb::arg("set_acceleration_mps2") = 0.0,
          "One step: the desired acceleration [m/s²]. The lead's gap (bumper to bumper) and "
          "relative speed (lead's minus own) as measured; none: nobody is ahead.")
      .def(
          "sent", [](Cruise& cruise, double u) { cruise.control.sent(u); }, nb::arg("command_mps2"),
          "Tells the filter what was asked of the vehicle instead of what `update` said.")
      .def_prop_ro(
          "estimate",
          [](const Cruise& cruise) -> nb::object {
            if (!cruise.control.estimate()) return nb::none();
            return matrix_array(*cruise.control.estimate());
          },
          nb::sig("def estimate(self) -> numpy.typing.NDArray[numpy.float64] | None"),
          "The filter's state (3); None while no lead is followed.");
}

}  // namespace

void bind_controllers(nb::module_& module) {
  bind_cruise(module);
  module.def(
      "tracking_error",
      [](nb::handle pose, nb::handle path_pose, nb::handle vehicle) {
        const control::TrackingError error = control::tracking_error(
            pose_of(pose, "pose"), shape_of(vehicle).wheelbase_m, pose_of(path_pose, "path_pose"));
        return std::pair(error.cross_track_m, error.heading_rad);
      },
      nb::arg("pose"), nb::arg("path_pose"), nb::arg("vehicle") = nb::none(),
      nb::sig("def tracking_error(pose: numpy.typing.ArrayLike, path_pose: numpy.typing.ArrayLike, "
              "vehicle: Vehicle | str | os.PathLike[str] | None = None) -> tuple[float, float]"),
      "Cross-track [m] and heading error [rad] of a vehicle's front axle against the path's pose "
      "nearest to it; both positive where the path is to the left.\n\n"
      "pose: x, y, heading of the rear axle.");
  module.def(
      "stanley_steering",
      [](double cross_track_m, double heading_rad, double speed_mps, nb::handle vehicle) {
        return control::stanley_steering_rad({cross_track_m, heading_rad}, speed_mps,
                                             shape_of(vehicle));
      },
      nb::arg("cross_track_m"), nb::arg("heading_rad"), nb::arg("speed_mps"),
      nb::arg("vehicle") = nb::none(),
      nb::sig("def stanley_steering(cross_track_m: float, heading_rad: float, speed_mps: float, "
              "vehicle: Vehicle | str | os.PathLike[str] | None = None) -> float"),
      "Modified Stanley law: the steering angle [rad] for such errors, see `tracking_error`.");
  module.def("stanley_gain", &control::cross_track_gain, nb::arg("speed_mps"), "Its gain k(v).");
  module.def("stanley_look_forward", &control::look_forward_m, nb::arg("speed_mps"),
             "Its look-forward distance [m].");
  module.def(
      "single_track_step",
      [](nb::handle state, double acceleration_mps2, double steering_rate_radps, double step_s,
         nb::handle vehicle) {
        const Rows row = rows_of(state, "state", 5);
        if (row.shape(0) != 1) throw std::invalid_argument("state: needs five numbers");
        const double* at = row.data();
        const control::SingleTrackState moved =
            control::step({{at[0], at[1], at[2]}, at[3], at[4]},
                          {acceleration_mps2, steering_rate_radps}, step_s, shape_of(vehicle));
        return owned(std::vector<double>{moved.pose.x_m, moved.pose.y_m, moved.pose.heading_rad,
                                         moved.speed_mps, moved.steering_rad});
      },
      nb::arg("state"), nb::arg("acceleration_mps2"), nb::arg("steering_rate_radps"),
      nb::arg("step_s"), nb::arg("vehicle") = nb::none(),
      nb::sig("def single_track_step(state: numpy.typing.ArrayLike, acceleration_mps2: float, "
              "steering_rate_radps: float, step_s: float, vehicle: Vehicle | str | "
              "os.PathLike[str] | None = None) -> numpy.typing.NDArray[numpy.float64]"),
      "The kinematic single-track model: the state x, y, heading, speed, steering (5) after "
      "`step_s` of constant input; speed stays 0 or more, steering within the vehicle's limits.");
  module.def(
      "actuate",
      [](double acceleration_mps2, double desired_mps2, double step_s) {
        return control::actuate(acceleration_mps2, desired_mps2, step_s);
      },
      nb::arg("acceleration_mps2"), nb::arg("desired_mps2"), nb::arg("step_s"),
      "Acceleration after `step_s` of a constant desired one: a lag of 0.45 s [m/s²].");
}

}  // namespace roadbed::tools::python
