#include "roadbed/control/tracking_run.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "roadbed/control/stanley.h"

namespace roadbed::control {
namespace {

class TrackingRun {
 public:
  TrackingRun(const SampledPath& path, const TrackingOptions& options)
      : path_(path), options_(options), random_(options.seed) {
    state_.pose = path.at(0.0) * geometry::Pose2{0.0, options.start_offset_m, 0.0};
    state_.speed_mps = options.speed_mps;
    if (options.slips) {
      slipping_ = {.pose = state_.pose * geometry::Pose2{options.slips->rear_axle_m, 0.0, 0.0},
                   .speed_mps = options.speed_mps};
    }
  }

  std::vector<TrackingSample> rows() {
    std::vector<TrackingSample> rows;
    const double longest_s = 2.0 * path_.length_m() / options_.speed_mps;
    for (int k = 0; k * options_.step_s < longest_s; ++k) {
      const TrackingError error = locate();
      if (front_s_m_ >= path_.length_m()) break;
      rows.push_back(advance(k * options_.step_s, error));
    }
    return rows;
  }

 private:
  double wheelbase_m() const { return options_.vehicle.wheelbase_m; }

  TrackingError locate() {
    const Eigen::Vector2d front = state_.pose * Eigen::Vector2d(wheelbase_m(), 0.0);
    front_s_m_ = path_.nearest_s_m(front, front_s_m_);
    rear_s_m_ = path_.nearest_s_m(state_.pose.position(), rear_s_m_);
    return tracking_error(state_.pose, wheelbase_m(), path_.at(front_s_m_));
  }

  geometry::Pose2 measured() {
    return {state_.pose.x_m + options_.position_noise_m * normal_(random_),
            state_.pose.y_m + options_.position_noise_m * normal_(random_),
            state_.pose.heading_rad + options_.heading_noise_rad * normal_(random_)};
  }

  TrackingSample advance(double t_s, const TrackingError& error) {
    const double before = state_.steering_rad, wanted = steering(measured());
    TrackingSample row{.t_s = t_s,
                       .state = state_,
                       .cross_track_m = error.cross_track_m,
                       .heading_rad = error.heading_rad};
    if (options_.euler) {
      euler_step(wanted);
    } else {
      drive({.steering_rate_radps = (wanted - before) / options_.step_s});
    }
    row.steering_rate_radps = (state_.steering_rad - before) / options_.step_s;
    row.lateral_jerk_mps3 = options_.speed_mps * options_.speed_mps / wheelbase_m() *
                            (std::tan(state_.steering_rad) - std::tan(before)) / options_.step_s;
    return row;
  }

  void drive(const SingleTrackInput& input) {
    if (!options_.slips) {
      state_ = step(state_, input, options_.step_s, options_.vehicle);
      return;
    }
    slipping_ = step(slipping_, input, options_.step_s, *options_.slips);
    state_ = {.pose = slipping_.pose * geometry::Pose2{-options_.slips->rear_axle_m, 0.0, 0.0},
              .speed_mps = slipping_.speed_mps,
              .steering_rad = slipping_.steering_rad};
  }

  double steering(const geometry::Pose2& seen) const {
    const double speed = options_.speed_mps;
    TrackingError error = tracking_error(seen, wheelbase_m(), path_.at(front_s_m_));
    switch (options_.law) {
      case SteeringLaw::stanley:
        error.heading_rad += path_.at(front_s_m_ + speed * options_.preview_s).heading_rad -
                             path_.at(front_s_m_).heading_rad;
        return stanley_steering_rad(error, speed, options_.vehicle);
      case SteeringLaw::original_stanley:
        return original_stanley_steering_rad(error, speed, options_.original_gain_per_s,
                                             options_.vehicle);
      case SteeringLaw::pure_pursuit:
        break;
    }
    return pure_pursuit_steering_rad(seen, path_, rear_s_m_, pursuit_distance_m(speed),
                                     options_.vehicle);
  }

  void euler_step(double steering_rad) {
    const double way_m = options_.speed_mps * options_.step_s;
    geometry::Pose2& pose = state_.pose;
    pose = {pose.x_m + way_m * std::cos(pose.heading_rad),
            pose.y_m + way_m * std::sin(pose.heading_rad),
            pose.heading_rad + way_m / wheelbase_m() * std::tan(steering_rad)};
    state_.steering_rad = steering_rad;
  }

  const SampledPath& path_;
  const TrackingOptions& options_;
  SingleTrackState state_;  ///< of the rear axle
  DynamicState slipping_;   ///< the same of the centre of gravity, if it slips
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double front_s_m_ = 0.0, rear_s_m_ = 0.0;
};

struct Extent {
  double squares = 0.0, largest = 0.0;

  void add(double value) {
    squares += value * value;
    largest = std::max(largest, std::abs(value));
  }
  double rms(std::size_t count) const { return std::sqrt(squares / static_cast<double>(count)); }
};

}  // namespace

std::vector<TrackingSample> track_path(const SampledPath& path, const TrackingOptions& options) {
  if (!(options.speed_mps > 0.0) || !(options.step_s > 0.0)) {
    throw std::invalid_argument("track_path: speed and step must be positive");
  }
  return TrackingRun(path, options).rows();
}

TrackingSummary summarise(const std::vector<TrackingSample>& run) {
  if (run.empty()) return {};
  Extent cross_track, steering, heading, rate, jerk;
  for (const TrackingSample& row : run) {
    cross_track.add(row.cross_track_m);
    steering.add(row.state.steering_rad);
    heading.add(row.heading_rad);
    rate.add(row.steering_rate_radps);
    jerk.add(row.lateral_jerk_mps3);
  }
  const std::size_t n = run.size();
  return {.cross_track_rms_m = cross_track.rms(n),
          .largest_cross_track_m = cross_track.largest,
          .largest_steering_rad = steering.largest,
          .heading_rms_rad = heading.rms(n),
          .largest_heading_rad = heading.largest,
          .steering_rate_rms_radps = rate.rms(n),
          .largest_steering_rate_radps = rate.largest,
          .lateral_jerk_rms_mps3 = jerk.rms(n),
          .largest_lateral_jerk_mps3 = jerk.largest};
}

}  // namespace roadbed::control
