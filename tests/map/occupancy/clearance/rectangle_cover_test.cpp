#include "roadbed/map/occupancy/clearance/rectangle_cover.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace roadbed::map {
namespace {

bool holds(const geometry::Rectangle& rectangle, const Eigen::Vector2d& point) {
  return geometry::distance_m(rectangle, point) == 0.0;
}

TEST(RectangleCover, IsTheShareOfEachCellByDenseSampling) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-3.0, 3.0), half(0.02, 2.0), turn(-4.0, 4.0);
  for (int round = 0; round < 60; ++round) {
    const double cell_m = round % 2 == 0 ? 0.5 : 0.31;
    const double heading = round % 5 == 0 ? round * M_PI / 2 : turn(random);
    const geometry::Rectangle rectangle{.centre = {place(random), place(random)},
                                        .axis = {std::cos(heading), std::sin(heading)},
                                        .half_length_m = half(random),
                                        .half_width_m = half(random)};
    const RectangleCover cover(rectangle, cell_m);
    double sum = 0.0;
    for (std::int64_t y = cover.range().from_y; y < cover.range().to_y; ++y) {
      for (std::int64_t x = cover.range().from_x; x < cover.range().to_x; ++x) {
        int inside = 0;
        const int steps = 40;
        for (int i = 0; i < steps * steps; ++i) {
          const Eigen::Vector2d at(static_cast<double>(x) + (i % steps + 0.5) / steps,
                                   static_cast<double>(y) + (i / steps + 0.5) / steps);
          inside += holds(rectangle, cell_m * at);
        }
        ASSERT_NEAR(cover.fraction(x, y), inside / double(steps * steps), 0.04);
        sum += cover.fraction(x, y);
      }
    }
    ASSERT_NEAR(sum * cell_m * cell_m, 4.0 * rectangle.half_length_m * rectangle.half_width_m,
                1e-9);
  }
}

TEST(RectangleCover, OfARectangleOfWholeCellsIsOneInThemAndNothingBeside) {
  const RectangleCover cover(
      {.centre = {2.0, 1.0}, .axis = {1.0, 0.0}, .half_length_m = 1.0, .half_width_m = 0.5}, 0.5);
  for (std::int64_t y = cover.range().from_y; y < cover.range().to_y; ++y) {
    for (std::int64_t x = cover.range().from_x; x < cover.range().to_x; ++x) {
      const bool inside = x >= 2 && x < 6 && y >= 1 && y < 3;
      EXPECT_EQ(cover.fraction(x, y), inside ? 1.0 : 0.0) << x << " " << y;
    }
  }
}

}  // namespace
}  // namespace roadbed::map
