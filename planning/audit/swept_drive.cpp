#include "roadbed/planning/audit/swept_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

namespace roadbed::planning::inline audit {
namespace {

void check(double length_m, const SweepOptions& options) {
  for (const double value : {length_m, options.speed_mps, options.step_m}) {
    if (value > 0.0 && std::isfinite(value)) continue;
    throw std::invalid_argument(fmt::format(
        "swept_along: length, speed and step must be finite and positive, got {}", value));
  }
  if (!std::isfinite(options.offset_m)) {
    throw std::invalid_argument("swept_along: the offset must be finite");
  }
}

// Of the way between neighbouring samples; the first sample's is the second's.
void set_curvatures(std::vector<geometry::TrajectoryPoint>& samples) {
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double way_m =
        std::hypot(samples[i].x_m - samples[i - 1].x_m, samples[i].y_m - samples[i - 1].y_m);
    const double turn_rad =
        std::remainder(samples[i].heading_rad - samples[i - 1].heading_rad, 2 * M_PI);
    samples[i].curvature_per_m = way_m > 0.0 ? turn_rad / way_m : 0.0;
  }
  samples.front().curvature_per_m = samples[1].curvature_per_m;
}

}  // namespace

geometry::Trajectory swept_along(const std::function<geometry::Pose2(double s_m)>& line,
                                 double length_m, const SweepOptions& options) {
  check(length_m, options);
  // A length that is a multiple but for rounding gets no sample of its own for that.
  const double steps_along = std::ceil(length_m / options.step_m - 1e-9);
  const auto steps = std::max<std::size_t>(1, static_cast<std::size_t>(steps_along));
  std::vector<geometry::TrajectoryPoint> samples;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double s_m = i < steps ? static_cast<double>(i) * options.step_m : length_m;
    const geometry::Pose2 at = line(s_m) * geometry::Pose2{0.0, options.offset_m, 0.0};
    samples.push_back({.t_s = s_m / options.speed_mps,
                       .x_m = at.x_m,
                       .y_m = at.y_m,
                       .heading_rad = at.heading_rad,
                       .speed_mps = options.speed_mps});
  }
  set_curvatures(samples);
  return geometry::Trajectory(std::move(samples));
}

}  // namespace roadbed::planning::audit
