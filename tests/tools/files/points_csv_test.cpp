#include "roadbed/tools/files/points_csv.h"

#include <gtest/gtest.h>

#include "roadbed/map/files/input_error.h"

namespace roadbed::tools {
namespace {

TEST(PointsCsv, FindsItsColumnsInAnyOrderAndIgnoresOthers) {
  const auto points =
      parse_point_table("id, y ,x\r\n7, 1 ,2\r\n\r\n8,-3e2,4.5", "points.csv").points;
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0], Eigen::Vector2d(2, 1));
  EXPECT_EQ(points[1], Eigen::Vector2d(4.5, -300));
}

TEST(PointsCsv, RefusesWhatIsNotFinitePointsWithTheLine) {
  for (const char* bad : {"", "1,2\n", "x_m,z\n1,2\n", "x_m,y_m\n", "x_m,y_m\n1\n",
                          "x_m,y_m\n1,nan\n", "x_m,y_m\n1,1e10\n", "x_m,y_m\n1,2x\n"}) {
    EXPECT_THROW(parse_point_table(bad, "points.csv"), map::InputError) << bad;
  }
}

}  // namespace
}  // namespace roadbed::tools
