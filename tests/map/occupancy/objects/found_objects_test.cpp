#include "roadbed/map/occupancy/objects/found_objects.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "roadbed/tests/support/made_street.h"
#include "roadbed/tests/support/needs_pcl.h"

namespace roadbed::map {
namespace {

using tests::MadeBody;
using tests::MadeStreet;
using tests::rectangle;

class FoundObjectsTest : public tests::NeedsPcl {};

bool holds(const FoundObject& object, const Eigen::Vector2d& point) {
  return geometry::distance_m(object.box, point) < 1e-6;
}

MadeStreet three_cars_and_a_post() {
  return {.bodies = {MadeBody{rectangle(8, 4, 0.1, 4.5, 1.8)},
                     MadeBody{rectangle(14.5, 4.6, 0.1, 4.4, 1.8)},  // 1.9 m behind
                     MadeBody{rectangle(-12, -7, 1.4, 8, 2.5), 0.15, 3.4},
                     MadeBody{rectangle(3, -9, 0, 0.2, 0.2), 0.15, 4.0}}};
}

TEST_F(FoundObjectsTest, AreTheBodiesWithABoxAroundAllTheirPoints) {
  const MadeStreet street = three_cars_and_a_post();
  const PointCloud cloud = street.cloud();
  const std::vector<int> body = street.body_of_point();
  const std::vector<FoundObject> found = find_objects(cloud);
  ASSERT_EQ(found.size(), street.bodies.size());
  for (std::size_t b = 0; b < street.bodies.size(); ++b) {
    std::size_t points = 0, most = 0;
    for (const FoundObject& object : found) {
      std::size_t inside = 0;
      points = 0;
      for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        if (body[i] != static_cast<int>(b)) continue;
        ++points;
        inside += holds(object, cloud.in_source(i).head<2>());
      }
      most = std::max(most, inside);
    }
    // Points on a side are outside by their noise, or not, where the lowest rows are ground.
    EXPECT_GE(static_cast<double>(most), 0.97 * static_cast<double>(points)) << "body " << b;
    const geometry::Rectangle& truth = street.bodies[b].box;
    const bool has_its_size = std::ranges::any_of(found, [&](const FoundObject& object) {
      return (object.box.centre - truth.centre).norm() < 0.2 &&
             std::abs(object.box.half_length_m - truth.half_length_m) < 0.15 &&
             std::abs(object.box.half_width_m - truth.half_width_m) < 0.15;
    });
    EXPECT_TRUE(has_its_size) << "body " << b;
  }
}

TEST_F(FoundObjectsTest, LieInSourceCoordinatesFarFromZero) {
  PointCloud cloud = three_cars_and_a_post().cloud();
  const std::vector<FoundObject> near = find_objects(cloud);
  cloud.origin_in_source = {443210.0, 5400000.0, 300.0};
  const std::vector<FoundObject> far = find_objects(cloud);
  ASSERT_EQ(far.size(), near.size());
  for (std::size_t i = 0; i < far.size(); ++i) {
    const Eigen::Vector2d moved =
        near[i].box.centre + cloud.origin_in_source.head<2>() - far[i].box.centre;
    EXPECT_LT(moved.norm(), 1e-6);
    EXPECT_NEAR(far[i].top_m - near[i].top_m, 300.0, 1e-6);
    EXPECT_EQ(far[i].points, near[i].points);
  }
}

// A house front with a wing: one box around it would lie over the street.
TEST_F(FoundObjectsTest, OfALongFrontAreBoxesCloseAroundIt) {
  const MadeStreet street{.bodies = {MadeBody{rectangle(0, 15, 0, 60, 0.4), 0.0, 6.0},
                                     MadeBody{rectangle(30, 7.5, 1.5708, 15, 0.4), 0.0, 6.0}}};
  const PointCloud cloud = street.cloud();
  const std::vector<int> body = street.body_of_point();
  const std::vector<FoundObject> found = find_objects(cloud);
  double area_m2 = 0.0;
  for (const FoundObject& object : found) {
    EXPECT_LE(2.0 * object.box.half_length_m, ObjectOptions().longest_m);
    EXPECT_LE(2.0 * object.box.half_width_m, ObjectOptions().widest_m);
    area_m2 += 4.0 * object.box.half_length_m * object.box.half_width_m;
  }
  EXPECT_LT(area_m2, 60.0);  // of the walls 30, of one box around both 900
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (body[i] < 0 || cloud.points[i].z() < 0.4f || cloud.points[i].z() > 1.9f) continue;
    EXPECT_TRUE(std::ranges::any_of(found, [&](const FoundObject& object) {
      return holds(object, cloud.in_source(i).head<2>());
    })) << i;
  }
}

TEST_F(FoundObjectsTest, AreNotMergedByACrownAboveThem) {
  MadeStreet street{.bodies = {MadeBody{rectangle(8, 4, 0, 4.5, 1.8)},
                               MadeBody{rectangle(8, 4, 0, 12, 8), 2.4, 6.0},
                               MadeBody{rectangle(8, 8.5, 0, 4.5, 1.8)}}};
  EXPECT_EQ(find_objects(street.cloud()).size(), 2u);
}

TEST_F(FoundObjectsTest, NeedEnoughPoints) {
  const PointCloud cloud = three_cars_and_a_post().cloud();
  EXPECT_EQ(find_objects(cloud, {.least_points = 100}).size(), 3u);
  EXPECT_EQ(find_objects(cloud, {.least_points = 100000}).size(), 0u);
}

}  // namespace
}  // namespace roadbed::map
