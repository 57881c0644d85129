#include "roadbed/control/single_track.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace roadbed::control {
namespace {

/// x, y, ψ, v, δ.
using Values = Eigen::Vector<double, 5>;

Values derivative(const Values& at, const SingleTrackInput& input, double wheelbase_m) {
  const double heading = at[2], speed = at[3], steering = at[4];
  return {speed * std::cos(heading), speed * std::sin(heading),
          speed * std::tan(steering) / wheelbase_m, input.acceleration_mps2,
          input.steering_rate_radps};
}

Values runge_kutta(const Values& at, const SingleTrackInput& input, double step_s, double L) {
  const Values k1 = derivative(at, input, L);
  const Values k2 = derivative(at + 0.5 * step_s * k1, input, L);
  const Values k3 = derivative(at + 0.5 * step_s * k2, input, L);
  const Values k4 = derivative(at + step_s * k3, input, L);
  return at + step_s / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
}

/// The steering rate that the limits leave, constant over the step.
double possible_rate_radps(const SingleTrackState& state, double wanted_radps, double step_s,
                           const geometry::VehicleShape& vehicle) {
  const double rate =
      std::clamp(wanted_radps, -vehicle.max_steering_rate_radps, vehicle.max_steering_rate_radps);
  const double end = std::clamp(state.steering_rad + rate * step_s, -vehicle.max_steering_rad,
                                vehicle.max_steering_rad);
  return (end - state.steering_rad) / step_s;
}

SingleTrackState moved(const SingleTrackState& state, const SingleTrackInput& input, double step_s,
                       double wheelbase_m) {
  const Values start{state.pose.x_m, state.pose.y_m, state.pose.heading_rad, state.speed_mps,
                     state.steering_rad};
  const Values end = runge_kutta(start, input, step_s, wheelbase_m);
  return {
      .pose = {end[0], end[1], end[2]}, .speed_mps = std::max(0.0, end[3]), .steering_rad = end[4]};
}

}  // namespace

SingleTrackState step(const SingleTrackState& state, const SingleTrackInput& input, double step_s,
                      const geometry::VehicleShape& vehicle) {
  if (!(step_s > 0.0)) return state;
  SingleTrackInput possible = input;
  possible.steering_rate_radps =
      possible_rate_radps(state, input.steering_rate_radps, step_s, vehicle);
  // A vehicle that brakes to standstill within the step drives until then and turns its wheels on.
  const double rolling_s = input.acceleration_mps2 < 0.0
                               ? std::min(step_s, -state.speed_mps / input.acceleration_mps2)
                               : step_s;
  SingleTrackState end = moved(state, possible, rolling_s, vehicle.wheelbase_m);
  if (rolling_s < step_s) {
    end.speed_mps = 0.0;
    end.steering_rad += possible.steering_rate_radps * (step_s - rolling_s);
  }
  return end;
}

}  // namespace roadbed::control
