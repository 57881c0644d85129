#include "street_scene.h"

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace roadbed {
namespace {

using Eigen::Array3d;
using Eigen::Vector3d;

constexpr double kFarthest_m = 100.0;

struct SceneBox {
  Array3d least, most;
};

// A street along x from -60 to 260 m.
std::vector<SceneBox> street() {
  std::vector<SceneBox> boxes;
  for (const double side : {-1.0, 1.0}) {
    const auto add = [&](double x_m, double y_m, const Array3d& half, double from_z_m) {
      const Array3d centre(x_m, side * y_m, from_z_m + half.z());
      boxes.push_back({centre - half, centre + half});
    };
    for (double x_m = -60.0; x_m < 260.0; x_m += 20.0) {
      add(x_m, 12.5 + 0.1 * std::fmod(std::abs(x_m), 7.0), {9.5, 0.5, 5.0}, 0.0);
      add(x_m + 5.0, 8.0, {0.1, 0.1, 3.0}, 0.0);
      add(x_m + 12.0, 8.5, {0.2, 0.2, 1.5}, 0.0);
      add(x_m + 12.0, 8.5, {1.5, 1.5, 1.5}, 3.0);
    }
    for (double x_m = -60.0; x_m < 260.0; x_m += 7.0) add(x_m, 5.0, {2.25, 0.9, 0.75}, 0.0);
  }
  return boxes;
}

// Distance along the ray at which it enters the box; infinite if it does not.
double enters_m(const SceneBox& box, const Vector3d& from, const Array3d& inverse) {
  const Array3d a = (box.least - from.array()) * inverse, b = (box.most - from.array()) * inverse;
  const double in_m = a.min(b).maxCoeff(), out_m = a.max(b).minCoeff();
  return in_m > 0.0 && in_m <= out_m ? in_m : std::numeric_limits<double>::infinity();
}

}  // namespace

std::vector<map::PointCloud> street_scans(int count) {
  constexpr int beams = 64, turns = 1800;
  const std::vector<SceneBox> boxes = street();
  std::mt19937 random(20261122);
  std::normal_distribution<double> noise_m(0.0, 0.01);
  std::vector<map::PointCloud> scans;
  for (int scan = 0; scan < count; ++scan) {
    map::PointCloud cloud;
    const Vector3d sensor(2.0 * scan, 0.1, 1.8);
    cloud.sensor_in_source = sensor;
    for (int turn = 0; turn < turns; ++turn) {
      for (int beam = 0; beam < beams; ++beam) {
        const double azimuth = 2.0 * std::numbers::pi * turn / turns;
        const double elevation = (2.0 - 26.8 * beam / (beams - 1)) * std::numbers::pi / 180.0;
        const Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        const Array3d inverse = 1.0 / direction.array();
        double range_m = direction.z() < 0.0 ? -sensor.z() / direction.z() : kFarthest_m;
        for (const SceneBox& box : boxes)
          range_m = std::min(range_m, enters_m(box, sensor, inverse));
        if (range_m >= kFarthest_m) continue;
        const Vector3d hit = sensor + (range_m + noise_m(random)) * direction;
        cloud.points.push_back(hit.cast<float>());
      }
    }
    scans.push_back(std::move(cloud));
  }
  return scans;
}

}  // namespace roadbed
