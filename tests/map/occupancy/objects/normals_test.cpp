#include "roadbed/map/occupancy/objects/normals.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <random>

#include "roadbed/tests/support/needs_pcl.h"

namespace roadbed::map {
namespace {

class NormalsTest : public tests::NeedsPcl {};

PointCloud points_of_plane(const Eigen::Vector3f& normal) {
  const Eigen::Vector3f along = normal.unitOrthogonal(), across = normal.cross(along);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-5.0f, 5.0f);
  PointCloud cloud;
  for (int i = 0; i < 500; ++i) {
    cloud.points.push_back(place(random) * along + place(random) * across);
  }
  return cloud;
}

TEST_F(NormalsTest, AreThoseOfThePlaneAndLookAtTheSensor) {
  for (const Eigen::Vector3f& direction :
       {Eigen::Vector3f(0, 0, 1), Eigen::Vector3f(1, 0, 0), Eigen::Vector3f(1, -2, 0.5f)}) {
    const Eigen::Vector3f normal = direction.normalized();
    PointCloud cloud = points_of_plane(normal);
    for (const double side : {30.0, -30.0}) {
      cloud.sensor_in_source = side * normal.cast<double>();
      for (const Eigen::Vector3f& found : normals(cloud, 10)) {
        EXPECT_NEAR(found.dot(normal), side > 0.0 ? 1.0f : -1.0f, 1e-4f);
      }
    }
  }
}

TEST_F(NormalsTest, LookUpWhereNobodyKnowsTheSensor) {
  PointCloud cloud = points_of_plane(Eigen::Vector3f(0.2f, 0.1f, -1.0f).normalized());
  cloud.origin_in_source = {443210.0, 5400000.0, 300.0};
  for (const Eigen::Vector3f& found : normals(cloud, 8)) EXPECT_GT(found.z(), 0.9f);
}

}  // namespace
}  // namespace roadbed::map
