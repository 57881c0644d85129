#include "roadbed/tests/benchmark/planner_scene.h"

#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"

namespace roadbed::benchmark_scene {
namespace {

constexpr double kHalfWidth_m = 4.5;
constexpr double kStart_m = 70.0;
constexpr double kInTheWay_m = 1.5;  // to the right of the line, of the cars that block it

struct Place {
  double s_m, side_m, speed_mps;
};

Place place_of(int number, bool blocked) {
  if (blocked) return {kStart_m + 18.0 + 6.0 * number, -kInTheWay_m, 3.0};
  return {kStart_m + 12.0 + 8.0 * number, -3.5 + 3.5 * (number % 3), 8.0};
}

// A car that drives beside the line at constant speed for five seconds.
planning::Obstacle car_beside(const planning::ReferenceLine& line, int number, bool blocked) {
  const auto [from_s_m, side_m, speed_mps] = place_of(number, blocked);
  std::vector<geometry::TrajectoryPoint> points;
  for (int i = 0; i <= 50; ++i) {
    const double t_s = 0.1 * i;
    const auto at = line.at(from_s_m + speed_mps * t_s);
    points.push_back({.t_s = t_s,
                      .x_m = at.in_map.x() - side_m * std::sin(at.heading_rad),
                      .y_m = at.in_map.y() + side_m * std::cos(at.heading_rad),
                      .heading_rad = at.heading_rad,
                      .speed_mps = speed_mps});
  }
  return {.id = fmt::format("car {}", number), .motion = geometry::Trajectory(std::move(points))};
}

}  // namespace

std::vector<Eigen::Vector2d> read_way_points(const std::filesystem::path& file) {
  std::istringstream lines(map::read_file(file));
  std::vector<Eigen::Vector2d> points;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream row(line);
    double x_m = 0.0, y_m = 0.0;
    char comma = '\0';
    if (!(row >> x_m >> comma >> y_m) || comma != ',') {
      throw map::InputError({.file = file.string(),
                             .place = std::to_string(number),
                             .found = "is not `x,y`",
                             .needed = "two numbers in metres",
                             .remedy = "correct or remove the line"});
    }
    points.emplace_back(x_m, y_m);
  }
  return points;
}

PlannerScene::PlannerScene(const std::vector<Eigen::Vector2d>& way_points, bool blocked)
    : line(planning::ReferenceLine::through(way_points, kHalfWidth_m, 50.0 / 3.6)),
      start{.s_m = kStart_m, .d_m = 0.2, .d_slope = 0.1 / 12.0, .d_curvature_per_m = 0.0},
      speed{.speed_mps = 12.0, .acceleration_mps2 = 0.3, .target_mps = 13.0} {
  for (int number = 0; number < 10; ++number)
    obstacles.push_back(car_beside(line, number, blocked));
}

planning::PlanInput PlannerScene::input() const {
  return {.line = line, .start = start, .speed = speed, .obstacles = obstacles};
}

planning::PlanOptions options_with(int points) {
  planning::PlanOptions options;
  options.points = points;
  return options;
}

}  // namespace roadbed::benchmark_scene
