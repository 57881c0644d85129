#include "roadbed/planning/obstacles/obstacle_limits.h"

#include <fmt/format.h>

#include <cmath>

#include "roadbed/map/files/input_error.h"

namespace roadbed::planning::inline obstacles {
namespace {

constexpr double kEnough_m = 200'000.0, kForEachPose_m = 20.0;

[[noreturn]] void refuse(const std::string& file, const std::string& id, const std::string& found,
                         const std::string& needed, const std::string& remedy) {
  throw map::InputError({.file = file,
                         .element = "obstacle " + id,
                         .found = found,
                         .needed = needed,
                         .remedy = remedy});
}

}  // namespace

template <Frame kFrame>
void refuse_endless_ways(std::span<const ObstacleIn<kFrame>> obstacles, const std::string& file) {
  double way_m = 0.0, most_m = kEnough_m, longest_m = 0.0;
  const ObstacleIn<kFrame>* longest = nullptr;
  for (const ObstacleIn<kFrame>& obstacle : obstacles) {
    const auto& points = obstacle.motion.points();
    most_m += kForEachPose_m * static_cast<double>(points.size());
    for (std::size_t i = 1; i < points.size(); ++i) {
      if (points[i].t_s - points[i - 1].t_s < kLeastObstacleStep_s) {
        refuse(file, obstacle.id,
               fmt::format("poses {:.3g} s apart", points[i].t_s - points[i - 1].t_s),
               fmt::format("at least {} s", kLeastObstacleStep_s), "leave one of the two out");
      }
      const double step_m =
          std::hypot(points[i].x_m - points[i - 1].x_m, points[i].y_m - points[i - 1].y_m);
      way_m += step_m;
      if (step_m <= longest_m) continue;
      longest_m = step_m;
      longest = &obstacle;
    }
  }
  if (!(way_m > most_m)) return;
  refuse(file, longest->id,
         fmt::format("moves {:.6g} m from one pose to the next, all obstacles {:.6g} m", longest_m,
                     way_m),
         fmt::format("at most {:.6g} m in {:.0f} poses", most_m,
                     (most_m - kEnough_m) / kForEachPose_m),
         "remove the outlier, or give more poses between");
}

template void refuse_endless_ways(std::span<const Obstacle>, const std::string&);
template void refuse_endless_ways(std::span<const ObstacleInSource>, const std::string&);

}  // namespace roadbed::planning::obstacles
