#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "roadbed/map/occupancy/clouds/pcl_function.h"
#include "roadbed/map/occupancy/objects/pcl_objects.h"
#include "roadbed/tests/support/needs_pcl.h"

namespace roadbed::map {
namespace {

class EuclideanClustersTest : public tests::NeedsPcl {};

using Points = std::vector<Eigen::Vector3f>;
using Numbers = std::vector<std::int32_t>;

Numbers clusters(const Points& points, double tolerance_m, std::size_t least) {
  Numbers numbers(points.size(), -2);
  pcl_function_as<RoadbedPclClusters>("roadbed_pcl_clusters")(points.front().data(), points.size(),
                                                              tolerance_m, least, numbers.data());
  return numbers;
}

// By looking at all pairs, over and over.
Numbers clusters_by_pairs(const Points& points, double tolerance_m, std::size_t least) {
  Numbers labels(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) labels[i] = static_cast<std::int32_t>(i);
  for (bool is_done = false; !is_done;) {
    is_done = true;
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t k = 0; k < points.size(); ++k) {
        if (labels[k] <= labels[i]) continue;
        if ((points[i] - points[k]).cast<double>().norm() > tolerance_m) continue;
        labels[k] = labels[i];
        is_done = false;
      }
    }
  }
  Numbers numbers(points.size(), -1);
  std::int32_t used = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto first = static_cast<std::size_t>(labels[i]);
    const auto size = static_cast<std::size_t>(std::ranges::count(labels, labels[i]));
    numbers[i] = first < i ? numbers[first] : size >= least ? used++ : -1;
  }
  return numbers;
}

Points scattered(std::size_t count, float side_m, std::mt19937& random) {
  std::uniform_real_distribution<float> along(-0.5f * side_m, 0.5f * side_m);
  Points points;
  while (points.size() < count) points.emplace_back(along(random), along(random), along(random));
  return points;
}

TEST_F(EuclideanClustersTest, AreThoseThatStepsFromPointToPointConnect) {
  std::mt19937 random(7);
  for (const float side_m : {1.0f, 3.0f, 5.0f, 8.0f, 20.0f}) {
    Points points = scattered(300, side_m, random);
    points.insert(points.end(), points.begin(), points.begin() + 40);  // some twice
    for (const double tolerance_m : {0.15, 0.5, 0.7, 1.3}) {
      EXPECT_EQ(clusters(points, tolerance_m, 3), clusters_by_pairs(points, tolerance_m, 3))
          << side_m << " m, " << tolerance_m << " m";
    }
  }
}

// Two heaps of 400 points, so many that they are not compared pair by pair.
TEST_F(EuclideanClustersTest, OfTwoHeapsAreOneWhereTheirNearestPointsAreNear) {
  std::mt19937 random(8);
  for (const float apart_m : {0.52f, 0.56f, 0.6f, 0.64f, 0.68f, 0.72f}) {
    Points points = scattered(400, 0.1f, random);
    for (const Eigen::Vector3f& point : scattered(400, 0.1f, random)) {
      points.push_back(point + Eigen::Vector3f(apart_m, 0.0f, 0.0f));
    }
    EXPECT_EQ(clusters(points, 0.5, 1), clusters_by_pairs(points, 0.5, 1)) << apart_m << " m";
  }
}

}  // namespace
}  // namespace roadbed::map
