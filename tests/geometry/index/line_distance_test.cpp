#include "roadbed/geometry/index/line_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace roadbed::geometry {
namespace {

using Eigen::Vector2d;

Polyline wandering_line(std::size_t count, std::mt19937& random) {
  std::normal_distribution<double> turn(0.0, 0.4);
  std::vector<Vector2d> points{{0.0, 0.0}};
  double heading_rad = 0.0;
  while (points.size() < count) {
    heading_rad += turn(random);
    const double length_m = points.size() % 7 == 0 ? 0.0 : 3.0;
    points.push_back(points.back() +
                     length_m * Vector2d(std::cos(heading_rad), std::sin(heading_rad)));
  }
  return Polyline(std::move(points));
}

TEST(LineDistance, IsThatToTheNearestOfAllSegments) {
  std::mt19937 random(20261130);
  for (const std::size_t count : {2u, 9u, 48u, 49u, 57u, 1'000u}) {
    const Polyline line = wandering_line(count, random);
    const LineDistance distance_m(line);
    const Box around = box_around(line.points());
    std::uniform_real_distribution<double> part(-0.5, 1.5);
    for (int i = 0; i < 500; ++i) {
      const Vector2d share(part(random), part(random));
      const Vector2d point = around.min() + around.sizes().cwiseProduct(share);
      EXPECT_NEAR(distance_m(point), std::abs(line.project(point).d_m), 1e-9) << count;
    }
  }
}

TEST(LineDistance, OfALineWithoutLengthIsThatToItsPoint) {
  const Polyline line({{1.0, 2.0}, {1.0, 2.0}});
  EXPECT_NEAR(LineDistance(line)({4.0, 6.0}), 5.0, 1e-12);
}

TEST(Farthest, IsThatOfTheVertexThatIsFarthestOff) {
  std::mt19937 random(7);
  const Polyline line = wandering_line(300, random), other = wandering_line(200, random);
  double most_m = 0.0;
  for (const Vector2d& point : line.points()) {
    most_m = std::max(most_m, std::abs(other.project(point).d_m));
  }
  EXPECT_NEAR(farthest_m(line, other), most_m, 1e-9);
  EXPECT_EQ(farthest_m(line, line), 0.0);
}

}  // namespace
}  // namespace roadbed::geometry
