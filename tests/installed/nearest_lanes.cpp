// Which lane is nearest to each of many points?
//
//     nearest_lanes town.xodr 1000000        a table: lane, points that are nearest to it
//     nearest_lanes town.xodr 200 points     a row a point: x_m,y_m,lane,distance_m
#include <roadbed/map/load_map.h>

#include <Eigen/Geometry>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <random>
#include <string>
#include <vector>

int main(int count, char** arguments) try {
  if (count < 3) return 2;
  const roadbed::map::RoadMap map = roadbed::map::load_map(arguments[1]);

  // Around the lanes; positions in a map are relative to its origin.
  Eigen::AlignedBox2d bounds;
  for (const roadbed::map::Lane& lane : map.lanes()) {
    for (const Eigen::Vector2d& point : lane.centre.in_map.points()) bounds.extend(point);
  }
  std::mt19937 random(20261125);
  std::uniform_real_distribution<double> x(bounds.min().x(), bounds.max().x()),
      y(bounds.min().y(), bounds.max().y());
  std::vector<Eigen::Vector2d> points(static_cast<std::size_t>(std::atol(arguments[2])));
  for (Eigen::Vector2d& point : points) point = {x(random), y(random)};

  const roadbed::map::LaneMatches nearest =
      map.locate(points, /*radius_m=*/1000.0, /*count=*/1, /*only_drivable=*/false);

  const bool lists_points = count > 3;
  std::map<std::string, std::size_t> points_of_lane;
  if (lists_points) std::puts("x_m,y_m,lane,distance_m");
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (nearest.of(i).empty()) continue;
    const roadbed::map::LaneMatch& match = nearest.of(i).front();
    const std::string& lane = map.lane(match.place.lane).name;
    ++points_of_lane[lane];
    const Eigen::Vector2d at = map.to_source(points[i]);
    if (lists_points) {
      std::printf("%.17g,%.17g,%s,%.9f\n", at.x(), at.y(), lane.c_str(), match.distance_m);
    }
  }
  if (lists_points) return 0;
  for (const auto& [lane, number] : points_of_lane) std::printf("%s %zu\n", lane.c_str(), number);
} catch (const std::exception& fault) {
  std::fprintf(stderr, "%s\n", fault.what());
  return 1;
}
