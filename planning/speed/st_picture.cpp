#include "roadbed/planning/speed/st_picture.h"

#include <algorithm>
#include <cmath>

namespace roadbed::planning::inline speed {
namespace {

constexpr double kNear_m = 40.0;  // before and behind all of the drive

/// Steps up to the end of the drive.
std::size_t steps_of(const StGraph& graph, std::span<const SpeedState> drive) {
  if (drive.empty() || graph.times() == 0) return 0;
  const double until_s =
      std::min(drive.back().t_s, StGraph::kStep_s * static_cast<double>(graph.times() - 1));
  return static_cast<std::size_t>(until_s / StPicture::kStep_s + 1e-6) + 1;
}

double ahead_m_at(std::span<const SpeedState> drive, double t_s) {
  const auto after = std::ranges::lower_bound(drive, t_s, {}, &SpeedState::t_s);
  if (after == drive.begin()) return drive.front().ahead_m;
  if (after == drive.end()) return drive.back().ahead_m;
  const SpeedState &a = *(after - 1), &b = *after;
  return a.ahead_m + (b.ahead_m - a.ahead_m) * (t_s - a.t_s) / (b.t_s - a.t_s);
}

}  // namespace

StPicture st_picture(const StGraph& graph, std::span<const SpeedState> drive) {
  StPicture picture;
  const std::size_t steps = steps_of(graph, drive);
  if (steps == 0) return picture;
  const double end_m = drive.back().ahead_m;
  for (std::size_t step = 0; step < steps; ++step) {
    const double t_s = StPicture::kStep_s * static_cast<double>(step);
    picture.drive_m.push_back(static_cast<float>(ahead_m_at(drive, t_s)));
    for (const StInterval& part : graph.at(static_cast<int>(std::lround(t_s / StGraph::kStep_s)))) {
      if (part.from_m > end_m + kNear_m || part.to_m < -kNear_m) continue;
      picture.parts.push_back({.step = static_cast<std::uint16_t>(step),
                               .from_m = static_cast<float>(std::max(part.from_m, -kNear_m)),
                               .to_m = static_cast<float>(std::min(part.to_m, end_m + kNear_m)),
                               .obstacle = part.obstacle});
    }
  }
  return picture;
}

}  // namespace roadbed::planning::speed
