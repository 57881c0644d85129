#include "roadbed/map/drawing/svg.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace roadbed::map {
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

TEST(Svg, ShowsBoxesThatReachIntoThePicture) {
  const PictureFrame frame{.centre_px = {50.0, 40.0}, .px_per_m = 2.0, .size_px = {100.0, 80.0}};
  const auto shows = [&](double x, double y) {
    return frame.shows({Eigen::Vector2d(x, y), Eigen::Vector2d(x + 2.0, y + 2.0)});
  };
  EXPECT_TRUE(shows(0.0, 0.0));
  EXPECT_TRUE(shows(-26.0, 19.0));
  EXPECT_FALSE(shows(-28.0, 0.0));
  EXPECT_FALSE(shows(0.0, -23.0));
  EXPECT_FALSE(frame.shows({}));
}

TEST(Svg, RoundsLengthsDown) {
  EXPECT_EQ(round_length_m(7.3), 5.0);
  EXPECT_EQ(round_length_m(0.49), 0.2);
  EXPECT_EQ(round_length_m(100.0), 100.0);
}

TEST(SvgCanvas, WritesMetresWithTwoDecimals) {
  const SvgCanvas canvas({10.0, 20.0}, 0.1);
  EXPECT_EQ(canvas.line(std::vector<Eigen::Vector2d>{{10.0, 20.0}, {12.0, 19.5}}),
            "M0.00 0.00L2.00 0.50");
  EXPECT_EQ(canvas.ring({{10.0, 20.0}, {12.0, 20.0}, {12.0, 19.0}}),
            "M0.00 0.00L2.00 0.00L2.00 1.00L0.00 0.00Z");
}

}  // namespace
}  // namespace roadbed::map
