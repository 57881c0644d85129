#include "roadbed/tests/support/made_street.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace roadbed::tests {
namespace {

/// Points of a street, and whose they are.
struct Seen {
  std::vector<Eigen::Vector3d> points;
  std::vector<int> of;
};

void see_side(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const MadeBody& body,
              double slope, int number, Seen& seen) {
  const Eigen::Vector2d side = to - from;
  const Eigen::Vector2d outward(side.y(), -side.x());  // corners go round counter-clockwise
  if (outward.dot(from) >= 0.0) return;                // turned away from the scanner
  const int steps = std::max(1, static_cast<int>(side.norm() / 0.1));
  for (int k = 0; k <= steps; ++k) {
    const Eigen::Vector2d at = from + side * k / steps;
    for (double z = body.bottom_m; z <= body.top_m; z += 0.1) {
      seen.points.emplace_back(at.x(), at.y(), slope * at.x() + z);
      seen.of.push_back(number);
    }
  }
}

Seen look(const MadeStreet& street) {
  Seen seen;
  for (double x = -street.reach_m; x <= street.reach_m; x += 0.25) {
    for (double y = -street.reach_m; y <= street.reach_m; y += 0.25) {
      const auto is_on = [&](const MadeBody& body) {
        return geometry::distance_m(body.box, Eigen::Vector2d(x, y)) == 0.0;
      };
      if (std::ranges::any_of(street.bodies, is_on)) continue;
      seen.points.emplace_back(x, y, street.slope * x);
      seen.of.push_back(-1);
    }
  }
  for (std::size_t i = 0; i < street.bodies.size(); ++i) {
    const auto corners = street.bodies[i].box.corners();
    for (std::size_t k = 0; k < 4; ++k) {
      see_side(corners[k], corners[(k + 1) % 4], street.bodies[i], street.slope,
               static_cast<int>(i), seen);
    }
  }
  std::mt19937 random(street.seed);
  std::normal_distribution<double> noise_m(0.0, 0.01);
  for (Eigen::Vector3d& point : seen.points) {
    for (int axis = 0; axis < 3; ++axis) point[axis] += noise_m(random);
  }
  return seen;
}

}  // namespace

map::PointCloud MadeStreet::cloud() const {
  map::PointCloud cloud;
  cloud.name = "street";
  cloud.unit = map::LengthUnit::metre;
  for (const Eigen::Vector3d& point : look(*this).points) {
    cloud.points.push_back(point.cast<float>());
  }
  return cloud;
}

std::vector<int> MadeStreet::body_of_point() const { return look(*this).of; }

std::string pcd_of(const map::PointCloud& cloud) {
  std::string text = fmt::format(
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {0}\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA ascii\n",
      cloud.points.size());
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3d at = cloud.in_source(i);
    text += fmt::format("{} {} {}\n", at.x(), at.y(), at.z());
  }
  return text;
}

geometry::Rectangle rectangle(double x_m, double y_m, double heading_rad, double length_m,
                              double width_m) {
  return {.centre = {x_m, y_m},
          .axis = {std::cos(heading_rad), std::sin(heading_rad)},
          .half_length_m = 0.5 * length_m,
          .half_width_m = 0.5 * width_m};
}

}  // namespace roadbed::tests
