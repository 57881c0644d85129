// A vehicle that starts half a metre beside a path and is steered onto it, at 6 m/s.
#include <roadbed/control/sampled_path.h>
#include <roadbed/control/single_track.h>
#include <roadbed/control/stanley.h>

#include <cmath>
#include <cstdio>

using namespace roadbed;

int main() {
  const control::SampledPath path = control::right_turn_path(6.0);
  const geometry::VehicleShape vehicle;
  constexpr double step_s = 0.01;
  control::SingleTrackState state{.pose = path.at(0.0) * geometry::Pose2{0.0, 0.5, 0.0},
                                  .speed_mps = 6.0};
  double front_s_m = vehicle.wheelbase_m, error_m = 0.0;
  while (front_s_m < path.length_m()) {
    front_s_m = path.nearest_s_m(state.pose * Eigen::Vector2d(vehicle.wheelbase_m, 0.0), front_s_m);
    const control::TrackingError error =
        control::tracking_error(state.pose, vehicle.wheelbase_m, path.at(front_s_m));
    const double wanted_rad = control::stanley_steering_rad(error, state.speed_mps, vehicle);
    state =
        control::step(state, {.steering_rate_radps = (wanted_rad - state.steering_rad) / step_s},
                      step_s, vehicle);
    error_m = error.cross_track_m;
  }
  std::printf("%.3f m beside the path at its end\n", std::abs(error_m));
  return std::abs(error_m) < 0.1 ? 0 : 1;
}
