#include "roadbed/planning/tracking/motion_filter.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "roadbed/geometry/primitives/angle.h"

namespace roadbed::planning::inline tracking {
namespace {

constexpr double kFades_s = 2.0;    // the acceleration, to 1/e of it
constexpr double kJerk_mps3 = 3.0;  // deviation after a second of white jerk
constexpr double kTurnAcceleration_radps2 = 0.5;
constexpr double kFirstAcceleration_mps2 = 2.0, kFirstTurnRate_radps = 0.3;
constexpr double kStands_mps = 0.1;        // slower is noise
constexpr double kMostStanding_mps = 1.0;  // who is not measured for long still drives
constexpr double kDrivesAgain_m = 0.5, kDrivesAgainDeviations = 4.0;
constexpr double kFirstDrivesDeviations = 3.0;  // when it is first measured
constexpr double kLeastTurning_mps = 0.5;

}  // namespace

MotionFilter::MotionFilter(const MeasuredMotion& first, const ObjectNoise& noise)
    : t_s_(first.t_s), covariance_(Covariance::Zero()) {
  state_ << first.pose.x_m, first.pose.y_m, first.pose.heading_rad, first.speed_mps, 0.0, 0.0;
  noise_variance_ =
      Eigen::Vector4d(noise.position_m, noise.position_m, noise.heading_rad, noise.speed_mps)
          .cwiseMax(1e-4)
          .cwiseAbs2();
  covariance_.diagonal() << noise_variance_, kFirstAcceleration_mps2 * kFirstAcceleration_mps2,
      kFirstTurnRate_radps * kFirstTurnRate_radps;
  stand(std::abs(first.speed_mps) < kFirstDrivesDeviations * speed_deviation_mps());
}

void MotionFilter::predict(double to_s) {
  const double dt = to_s - t_s_;
  if (!(dt > 0.0)) return;
  const double speed = state_[kSpeed] + 0.5 * dt * state_[kAcceleration];
  const double heading = state_[kHeading] + 0.5 * dt * state_[kTurnRate];
  const double along_x = std::cos(heading), along_y = std::sin(heading);
  const double kept = std::exp(-dt / kFades_s);

  Covariance moved = Covariance::Identity();
  moved(kX, kHeading) = -dt * speed * along_y;
  moved(kY, kHeading) = dt * speed * along_x;
  moved(kX, kSpeed) = dt * along_x;
  moved(kY, kSpeed) = dt * along_y;
  moved(kX, kAcceleration) = 0.5 * dt * dt * along_x;
  moved(kY, kAcceleration) = 0.5 * dt * dt * along_y;
  moved(kX, kTurnRate) = -0.5 * dt * dt * speed * along_y;
  moved(kY, kTurnRate) = 0.5 * dt * dt * speed * along_x;
  moved(kHeading, kTurnRate) = dt;
  moved(kSpeed, kAcceleration) = dt;
  moved(kAcceleration, kAcceleration) = kept;

  // White jerk and turn acceleration, over the step.
  Covariance gained = Covariance::Zero();
  const auto add = [&](Index rate, Index value, double deviation) {
    const double variance = deviation * deviation;
    gained(rate, rate) = variance * dt;
    gained(value, rate) = gained(rate, value) = variance * dt * dt / 2.0;
    gained(value, value) = variance * dt * dt * dt / 3.0;
  };
  add(kAcceleration, kSpeed, kJerk_mps3);
  add(kTurnRate, kHeading, kTurnAcceleration_radps2);

  covariance_ = moved * covariance_ * moved.transpose() + gained;
  state_[kX] += dt * speed * along_x;
  state_[kY] += dt * speed * along_y;
  state_[kHeading] += dt * state_[kTurnRate];
  state_[kSpeed] += dt * state_[kAcceleration];
  state_[kAcceleration] *= kept;
  t_s_ = to_s;
}

Eigen::Vector4d MotionFilter::innovation(const MeasuredMotion& measured) const {
  return {measured.pose.x_m - state_[kX], measured.pose.y_m - state_[kY],
          geometry::wrap_angle(measured.pose.heading_rad - state_[kHeading]),
          measured.speed_mps - state_[kSpeed]};
}

Eigen::Matrix4d MotionFilter::innovation_covariance() const {
  Eigen::Matrix4d sum = covariance_.topLeftCorner<4, 4>();
  sum.diagonal() += noise_variance_;
  return sum;
}

double MotionFilter::misfit(const MeasuredMotion& measured) const {
  const Eigen::Vector4d off = innovation(measured);
  return off.dot(innovation_covariance().llt().solve(off));
}

void MotionFilter::update(const MeasuredMotion& measured) {
  const Eigen::Matrix<double, kSize, 4> gain =
      innovation_covariance().llt().solve(covariance_.topRows<4>()).transpose();
  state_ += gain * innovation(measured);
  // Joseph's form keeps it symmetric and positive.
  Covariance left = Covariance::Identity();
  left.leftCols<4>() -= gain;
  covariance_ = left * covariance_ * left.transpose() +
                gain * noise_variance_.asDiagonal() * gain.transpose();
  tell_whether_it_stands();
}

/// Not less than what is noise.
double MotionFilter::speed_deviation_mps() const {
  return std::clamp(std::sqrt(covariance_(kSpeed, kSpeed)), kStands_mps, kMostStanding_mps);
}

void MotionFilter::stand(bool stands) {
  stands_ = stands;
  stands_at_ = state_.head<2>();
  stands_at_deviation_m_ = position_deviation_m();
}

void MotionFilter::tell_whether_it_stands() {
  const double speed_mps = std::abs(state_[kSpeed]), deviation_mps = speed_deviation_mps();
  if (!stands_) return stand(speed_mps < deviation_mps);
  const double away_m = (state_.head<2>() - stands_at_).norm();
  const double deviation_m = std::hypot(position_deviation_m(), stands_at_deviation_m_);
  stands_ = speed_mps < std::min(kDrivesAgainDeviations * deviation_mps, kMostStanding_mps) &&
            away_m < std::max(kDrivesAgain_m, kDrivesAgainDeviations * deviation_m);
}

SeenMotion MotionFilter::state() const {
  SeenMotion seen{.t_s = t_s_,
                  .pose = {state_[kX], state_[kY], geometry::wrap_angle(state_[kHeading])},
                  .speed_mps = state_[kSpeed]};
  if (stands_ || std::abs(seen.speed_mps) < speed_deviation_mps()) {
    seen.speed_mps = 0.0;
    return seen;
  }
  seen.acceleration_mps2 = state_[kAcceleration];
  if (std::abs(seen.speed_mps) > kLeastTurning_mps) {
    seen.curvature_per_m = state_[kTurnRate] / seen.speed_mps;
  }
  return seen;
}

double MotionFilter::position_deviation_m() const {
  return std::sqrt(std::max(covariance_(kX, kX), covariance_(kY, kY)));
}

}  // namespace roadbed::planning::tracking
