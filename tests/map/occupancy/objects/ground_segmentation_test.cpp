#include "roadbed/map/occupancy/objects/ground_segmentation.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tests/support/made_street.h"
#include "roadbed/tests/support/needs_pcl.h"

namespace roadbed::map {
namespace {

using tests::MadeBody;
using tests::MadeStreet;
using tests::rectangle;

class GroundSegmentationTest : public tests::NeedsPcl {};

TEST_F(GroundSegmentationTest, TellsGroundFromBodiesOnASlopeAndMeasuresHeightsAboveIt) {
  for (const double slope : {0.0, 0.1, -0.15}) {
    const MadeStreet street{.bodies = {MadeBody{rectangle(8, 4, 0.3, 4.5, 1.8)},
                                       MadeBody{rectangle(-15, -6, 1.2, 12, 2.5), 0.15, 3.5}},
                            .slope = slope};
    const PointCloud cloud = street.cloud();
    const std::vector<int> body = street.body_of_point();
    const GroundSegmentation found = segment_ground(cloud);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      const double height_m = cloud.points[i].z() - slope * cloud.points[i].x();
      if (body[i] < 0 ? !found.is_ground[i] : height_m > 0.5 && found.is_ground[i]) ++wrong;
      if (body[i] >= 0 && !found.is_ground[i]) {
        EXPECT_NEAR(found.heights_m[i], height_m, GroundOptions().most_height_m);
      }
    }
    EXPECT_EQ(wrong, 0u) << "slope " << slope;
  }
}

// As a survey's octree has it: nothing below the surface, and no ground below what stands on it.
TEST_F(GroundSegmentationTest, AsksForNothingBelowTheGround) {
  MadeStreet street{.bodies = {MadeBody{rectangle(5, 0, 0, 6, 6), 0.0, 6.0}}};
  const PointCloud cloud = street.cloud();
  const std::vector<int> body = street.body_of_point();
  const GroundSegmentation found = segment_ground(cloud);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (body[i] < 0) {
      EXPECT_TRUE(found.is_ground[i]);
    }
  }
}

TEST_F(GroundSegmentationTest, RefusesACloudThatReachesTooFar) {
  PointCloud cloud;
  cloud.name = "far.pcd";
  cloud.points = {{0, 0, 0}, {3000, 3000, 0}};
  try {
    segment_ground(cloud);
    FAIL() << "taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("far.pcd: ground: reaches over 3000 by 3000 m"));
  }
  EXPECT_NO_THROW(segment_ground(cloud, {.cell_m = 5.0}));
}

}  // namespace
}  // namespace roadbed::map
