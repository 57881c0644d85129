#include "roadbed/tools/report/svg.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "roadbed/tools/report/speed_colour.h"

namespace roadbed::tools {
namespace {

TEST(Svg, PutsTheCentreInTheCentreAndNorthUp) {
  const PictureFrame frame{{1000.0, 2000.0}, {450.0, 300.0}, 2.0};
  EXPECT_EQ(frame.to_px({1000.0, 2000.0}), Eigen::Vector2d(450.0, 300.0));
  EXPECT_EQ(frame.to_px({1010.0, 2005.0}), Eigen::Vector2d(470.0, 290.0));
}

TEST(Svg, WritesShortNumbers) {
  EXPECT_EQ(svg_number(12.34), "12.3");
  EXPECT_EQ(svg_number(-0.04), "0");
  EXPECT_EQ(svg_number(900.0), "900");
}

TEST(Svg, LeavesOutPointsThatNobodySees) {
  const std::vector<Eigen::Vector2d> line = {{0, 0}, {5, 0.01}, {10, 0}};
  EXPECT_EQ(svg_line({{0, 0}, {0, 0}, 1.0}, line), "M0 0L10 0");
  EXPECT_EQ(svg_line({{0, 0}, {0, 0}, 100.0}, line), "M0 0L500 -1L1000 0");
}

TEST(Svg, ClosesRingsAndDrawsNothingOutOfNothing) {
  EXPECT_EQ(svg_ring({}, std::vector<Eigen::Vector2d>{{0, 0}, {1, 0}, {1, 1}}), "M0 0L1 0L1 -1Z");
  EXPECT_EQ(svg_path("a", svg_ring({}, {})), "");
}

int brightness(const std::string& colour) {
  const auto part = [&](std::size_t at) { return std::stoi(colour.substr(at, 2), nullptr, 16); };
  return 299 * part(1) + 587 * part(3) + 114 * part(5);
}

TEST(SpeedColour, IsBrighterTheFasterItIs) {
  for (double share = 0.0; share < 0.99; share += 0.02) {
    EXPECT_LT(brightness(speed_colour(share)), brightness(speed_colour(share + 0.02)));
  }
  EXPECT_EQ(speed_colour(-1.0), "#440154");
  EXPECT_EQ(speed_colour(2.0), "#fde725");
}

}  // namespace
}  // namespace roadbed::tools
