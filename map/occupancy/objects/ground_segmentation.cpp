#include "roadbed/map/occupancy/objects/ground_segmentation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "roadbed/geometry/index/point_index.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/clouds/pcl_function.h"
#include "roadbed/map/occupancy/objects/pcl_objects.h"

namespace roadbed::map::inline occupancy::inline objects {
namespace {

constexpr double kMostCells = 4e6, kEnoughCells = 400'000.0, kCellsForEachPoint = 100.0;

void check_extent(const PointCloud& cloud, double cell_m) {
  const Box3 box = bounds(cloud);
  const Eigen::Vector3d extent_m = box.max_in_source - box.min_in_source;
  const double cells = (extent_m.x() / cell_m + 1.0) * (extent_m.y() / cell_m + 1.0);
  const double most = std::min(
      kMostCells, kEnoughCells + kCellsForEachPoint * static_cast<double>(cloud.points.size()));
  if (cells <= most) return;
  throw InputError(
      {.file = cloud.name,
       .element = "ground",
       .found = fmt::format("reaches over {:.0f} by {:.0f} m", extent_m.x(), extent_m.y()),
       .needed = fmt::format("at most {:.0f} cells of {} m for its points", most, cell_m),
       .remedy = "take points near the sensor (--range), or larger cells "
                 "(--ground-cell)"});
}

std::vector<Eigen::Vector3f> lowest_of_cells(const PointCloud& cloud, double cell_m) {
  std::map<std::pair<long, long>, Eigen::Vector3f> lowest;
  for (const Eigen::Vector3f& point : cloud.points) {
    const std::pair cell(std::lround(point.x() / cell_m), std::lround(point.y() / cell_m));
    const auto [known, is_new] = lowest.emplace(cell, point);
    if (!is_new && point.z() < known->second.z()) known->second = point;
  }
  std::vector<Eigen::Vector3f> points;
  for (const auto& [cell, point] : lowest) points.push_back(point);
  return points;
}

// The filter takes a slope for an object where it ends uphill, as there is nothing beyond to open
// it from: so points are told by how high they are above the slope as a whole.
std::vector<Eigen::Vector3f> levelled(const PointCloud& cloud, const GroundOptions& options) {
  static auto& fit = pcl_function_as<RoadbedPclPlane>("roadbed_pcl_plane");
  const std::vector<Eigen::Vector3f> lowest = lowest_of_cells(cloud, options.cell_m);
  std::vector<Eigen::Vector3f> points = cloud.points;
  Eigen::Vector3f plane;
  if (lowest.size() < 3 ||
      !fit(lowest.front().data(), lowest.size(), static_cast<float>(options.slope),
           static_cast<float>(options.most_height_m), plane.data())) {
    return points;
  }
  for (Eigen::Vector3f& point : points) {
    point.z() -= plane.x() * point.x() + plane.y() * point.y() + plane.z();
  }
  return points;
}

std::vector<std::uint8_t> ground_of(const std::vector<Eigen::Vector3f>& points,
                                    const GroundOptions& options) {
  static auto& segment = pcl_function_as<RoadbedPclGround>("roadbed_pcl_ground");
  const RoadbedPclGroundOptions told{
      static_cast<float>(options.cell_m), static_cast<float>(options.slope),
      static_cast<float>(options.least_height_m()), static_cast<float>(options.most_height_m),
      static_cast<float>(options.widest_m)};
  std::vector<std::uint8_t> is_ground(points.size());
  segment(points.front().data(), points.size(), &told, is_ground.data());
  return is_ground;
}

Eigen::Vector2d in_plan(const Eigen::Vector3f& point) { return point.head<2>().cast<double>(); }

}  // namespace

GroundSegmentation segment_ground(const PointCloud& cloud, const GroundOptions& options) {
  check_extent(cloud, options.cell_m);
  const std::vector<std::uint8_t> is_ground = ground_of(levelled(cloud, options), options);
  std::vector<Eigen::Vector2d> places;
  std::vector<float> z_m;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (is_ground[i] == 0) continue;
    places.push_back(in_plan(cloud.points[i]));
    z_m.push_back(cloud.points[i].z());
  }
  if (places.empty()) {
    throw InputError({.file = cloud.name,
                      .element = "ground",
                      .found = "has no point on the ground",
                      .needed = "some of it around every object",
                      .remedy = "allow steeper ground (--ground-slope), or name another cloud"});
  }
  const geometry::PointIndex ground(places);
  GroundSegmentation found{{is_ground.begin(), is_ground.end()},
                           std::vector<float>(cloud.points.size())};
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (is_ground[i] != 0) continue;
    found.heights_m[i] = cloud.points[i].z() - z_m[ground.nearest(in_plan(cloud.points[i]))->index];
  }
  return found;
}

}  // namespace roadbed::map::occupancy::objects
