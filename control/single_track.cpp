#include "roadbed/control/single_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

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

constexpr double kGravity_mps2 = 9.81;
constexpr double kRolls_mps = 0.1;  // slower, slip has no meaning

/// x, y, ψ, v, δ, ψ̇, β.
using DynamicValues = Eigen::Vector<double, 7>;

/// Slip angles follow from rolling: β = atan(l_r tan δ / L), ψ̇ = v cos β tan δ / L.
DynamicValues rolling_derivative(const DynamicValues& at, const SingleTrackInput& input,
                                 const DynamicVehicle& car) {
  const double L = car.front_axle_m + car.rear_axle_m;
  const double speed = at[3], tan_steering = std::tan(at[4]), rear = car.rear_axle_m / L;
  const double beta = std::atan(rear * tan_steering);
  const double tan_rate = input.steering_rate_radps * (1.0 + tan_steering * tan_steering);
  const double beta_rate = rear * tan_rate / (1.0 + rear * rear * tan_steering * tan_steering);
  const double yaw_acceleration =
      (input.acceleration_mps2 * std::cos(beta) * tan_steering -
       speed * std::sin(beta) * beta_rate * tan_steering + speed * std::cos(beta) * tan_rate) /
      L;
  DynamicValues rates;
  rates << speed * std::cos(at[2] + beta), speed * std::sin(at[2] + beta),
      speed * std::cos(beta) * tan_steering / L, input.acceleration_mps2, input.steering_rate_radps,
      yaw_acceleration, beta_rate;
  return rates;
}

DynamicValues slipping_derivative(const DynamicValues& at, const SingleTrackInput& input,
                                  const DynamicVehicle& car) {
  const double lf = car.front_axle_m, lr = car.rear_axle_m, L = lf + lr;
  const double speed = at[3], steering = at[4], yaw_rate = at[5], slip = at[6];
  // Cornering force per rad of slip, over the mass: C (g l ∓ a h) / L with the load it carries.
  const double a_h = input.acceleration_mps2 * car.height_m;
  const double stiffness = car.friction * car.cornering_stiffness_per_rad / L;
  const double front = stiffness * (kGravity_mps2 * lr - a_h);
  const double rear = stiffness * (kGravity_mps2 * lf + a_h);
  const double front_slip = steering - slip - lf * yaw_rate / speed;
  const double rear_slip = -slip + lr * yaw_rate / speed;
  DynamicValues rates;
  rates << speed * std::cos(at[2] + slip), speed * std::sin(at[2] + slip), yaw_rate,
      input.acceleration_mps2, input.steering_rate_radps,
      car.mass_kg / car.yaw_inertia_kgm2 * (lf * front * front_slip - lr * rear * rear_slip),
      (front * front_slip + rear * rear_slip) / speed - yaw_rate;
  return rates;
}

DynamicValues dynamic_derivative(const DynamicValues& at, const SingleTrackInput& input,
                                 const DynamicVehicle& car) {
  return std::abs(at[3]) < kRolls_mps ? rolling_derivative(at, input, car)
                                      : slipping_derivative(at, input, car);
}

/// The slower, the faster slip dies out, at a rate of about μ C g / v: steps of no more than its
/// inverse keep Runge–Kutta stable.
int parts_of(double step_s, double speed_mps, const DynamicVehicle& car) {
  const double rate_per_s =
      car.friction * car.cornering_stiffness_per_rad * kGravity_mps2 / speed_mps;
  return std::max(1, static_cast<int>(std::ceil(step_s * rate_per_s)));
}

SingleTrackInput within_limits(const DynamicState& state, SingleTrackInput input, double step_s,
                               const DynamicVehicle& car) {
  const double rate = std::clamp(input.steering_rate_radps, -car.max_steering_rate_radps,
                                 car.max_steering_rate_radps);
  const double end =
      std::clamp(state.steering_rad + rate * step_s, -car.max_steering_rad, car.max_steering_rad);
  input.steering_rate_radps = (end - state.steering_rad) / step_s;
  input.acceleration_mps2 = std::max(input.acceleration_mps2, -state.speed_mps / step_s);
  return input;
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

DynamicVehicle common_road_vehicle(int number) {
  switch (number) {
    case 1:
      return {1225.8878467253344, 1538.8533713561394, 0.88392, 1.50876, 0.59436, 0.91, 0.4};
    case 2:
      return {1093.2952334674046,
              1791.5995300122856,
              1.1561957064,
              1.4227170936,
              0.61373004,
              1.066,
              0.4};
    case 3:
      return {1478.8979637767998,
              2473.1176915564442,
              1.1507916024,
              1.3211363976,
              0.804490644,
              1.023,
              0.4};
    default:
      throw std::invalid_argument(
          fmt::format("common_road_vehicle: there are vehicles 1 to 3, got {}", number));
  }
}

DynamicState step(const DynamicState& state, const SingleTrackInput& input, double step_s,
                  const DynamicVehicle& vehicle) {
  if (!(step_s > 0.0)) return state;
  const SingleTrackInput u = within_limits(state, input, step_s, vehicle);
  const int parts = parts_of(step_s, std::max(kRolls_mps, state.speed_mps), vehicle);
  const double part_s = step_s / parts;
  DynamicValues at;
  at << state.pose.x_m, state.pose.y_m, state.pose.heading_rad, state.speed_mps, state.steering_rad,
      state.yaw_rate_radps, state.slip_rad;
  for (int i = 0; i < parts; ++i) {
    const DynamicValues k1 = dynamic_derivative(at, u, vehicle);
    const DynamicValues k2 = dynamic_derivative(at + 0.5 * part_s * k1, u, vehicle);
    const DynamicValues k3 = dynamic_derivative(at + 0.5 * part_s * k2, u, vehicle);
    const DynamicValues k4 = dynamic_derivative(at + part_s * k3, u, vehicle);
    at += part_s / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return {.pose = {at[0], at[1], at[2]},
          .speed_mps = std::max(0.0, at[3]),
          .steering_rad = at[4],
          .yaw_rate_radps = at[5],
          .slip_rad = at[6]};
}

}  // namespace roadbed::control
