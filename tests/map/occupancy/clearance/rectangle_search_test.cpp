#include "roadbed/map/occupancy/clearance/rectangle_search.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace roadbed::map {
namespace {

struct MadeCells {
  CellRange range;
  std::vector<std::uint8_t> set;

  CellBits bits() const { return {range, set}; }
};

MadeCells random_cells(std::mt19937& random, std::uint32_t one_in) {
  const auto from_x = static_cast<std::int64_t>(random() % 300) - 200;
  const auto from_y = static_cast<std::int64_t>(random() % 300) - 200;
  const auto width = static_cast<std::int64_t>(1 + random() % 170);
  const auto height = static_cast<std::int64_t>(1 + random() % 90);
  MadeCells cells{{from_x, from_y, from_x + width, from_y + height}, {}};
  cells.set.resize(cells.range.count());
  for (std::uint8_t& cell : cells.set) cell = random() % one_in == 0;
  return cells;
}

/// The same cells with some that are not set around them.
MadeCells with_margin(const MadeCells& cells, std::int64_t margin) {
  MadeCells wider{cells.range.grown(margin), {}};
  wider.set.resize(wider.range.count());
  for (std::int64_t y = cells.range.from_y; y < cells.range.to_y; ++y) {
    for (std::int64_t x = cells.range.from_x; x < cells.range.to_x; ++x) {
      wider.set[wider.range.index(x, y)] = cells.set[cells.range.index(x, y)];
    }
  }
  return wider;
}

geometry::Rectangle random_rectangle(std::mt19937& random, const CellRange& range, double cell_m) {
  std::uniform_real_distribution<double> fraction(-0.2, 1.2), turn(-4.0, 4.0), half(0.01, 3.0);
  const std::array<double, 6> straight{0.0, M_PI / 2, M_PI, -M_PI / 2, M_PI / 4, 1e-8};
  const double heading = random() % 3 == 0 ? straight[random() % straight.size()] : turn(random);
  Eigen::Vector2d axis(std::cos(heading), std::sin(heading));
  if (random() % 4 == 0) axis = Eigen::Vector2d(0.0, random() % 2 == 0 ? 1.0 : -1.0);
  return {.centre =
              cell_m * Eigen::Vector2d(static_cast<double>(range.from_x) +
                                           fraction(random) * static_cast<double>(range.width()),
                                       static_cast<double>(range.from_y) +
                                           fraction(random) * static_cast<double>(range.height())),
          .axis = axis,
          .half_length_m = half(random),
          .half_width_m = half(random)};
}

double to_cell_m(const geometry::Rectangle& rectangle, std::int64_t x, std::int64_t y,
                 double cell_m) {
  return geometry::distance_m(rectangle,
                              {.centre = cell_m * Eigen::Vector2d(static_cast<double>(x) + 0.5,
                                                                  static_cast<double>(y) + 0.5),
                               .axis = {1.0, 0.0},
                               .half_length_m = 0.5 * cell_m,
                               .half_width_m = 0.5 * cell_m});
}

double brute_force_m(const MadeCells& cells, const geometry::Rectangle& rectangle, double cell_m) {
  double least_m = std::numeric_limits<double>::infinity();
  for (std::int64_t y = cells.range.from_y; y < cells.range.to_y; ++y) {
    for (std::int64_t x = cells.range.from_x; x < cells.range.to_x; ++x) {
      if (cells.set[cells.range.index(x, y)] == 0) continue;
      least_m = std::min(least_m, to_cell_m(rectangle, x, y, cell_m));
    }
  }
  return least_m;
}

TEST(RectangleSearch, FindsTheNearestOfAllSetCellsByBruteForce) {
  std::mt19937 random(20261122);
  int overlaps = 0, apart = 0;
  for (int round = 0; round < 400; ++round) {
    const MadeCells cells = random_cells(random, 1u << random() % 13);
    const double cell_m = round % 2 == 0 ? 0.1 : 0.37;
    for (int i = 0; i < 12; ++i) {
      const geometry::Rectangle rectangle = random_rectangle(random, cells.range, cell_m);
      const double expected_m = brute_force_m(cells, rectangle, cell_m);
      const auto found = nearest_set_cell(cells.bits(), cell_m, rectangle, 100.0);
      ASSERT_EQ(found.has_value(), expected_m <= 100.0);
      if (!found) continue;
      ASSERT_NEAR(found->distance_m, expected_m, 1e-9);
      ASSERT_TRUE(cells.range.holds(found->x, found->y));
      ASSERT_NE(cells.set[cells.range.index(found->x, found->y)], 0);
      ASSERT_NEAR(to_cell_m(rectangle, found->x, found->y, cell_m), expected_m, 1e-9);
      (expected_m == 0.0 ? overlaps : apart) += 1;
    }
  }
  EXPECT_GT(overlaps, 500);
  EXPECT_GT(apart, 500);
}

TEST(RectangleSearch, ANearReachLosesNothingThatIsWithinIt) {
  std::mt19937 random(2);
  for (int round = 0; round < 300; ++round) {
    const MadeCells cells = random_cells(random, 300);
    for (int i = 0; i < 12; ++i) {
      const geometry::Rectangle rectangle = random_rectangle(random, cells.range, 0.1);
      const auto far = nearest_set_cell(cells.bits(), 0.1, rectangle, 50.0);
      if (!far || far->distance_m == 0.0) continue;
      const auto near = nearest_set_cell(cells.bits(), 0.1, rectangle, far->distance_m + 1e-9);
      ASSERT_TRUE(near);
      ASSERT_EQ(near->distance_m, far->distance_m);
      ASSERT_EQ(near->x, far->x);
      ASSERT_EQ(near->y, far->y);
      ASSERT_FALSE(nearest_set_cell(cells.bits(), 0.1, rectangle, far->distance_m - 1e-9));
    }
  }
}

TEST(RectangleSearch, SaysTheSameBitForBitInAWiderRange) {
  std::mt19937 random(3);
  for (int round = 0; round < 300; ++round) {
    const MadeCells cells = random_cells(random, 1u << random() % 10);
    const MadeCells wider = with_margin(cells, static_cast<std::int64_t>(1 + random() % 130));
    for (int i = 0; i < 12; ++i) {
      const geometry::Rectangle rectangle = random_rectangle(random, cells.range, 0.1);
      const auto expected = nearest_set_cell(cells.bits(), 0.1, rectangle, 30.0);
      const auto found = nearest_set_cell(wider.bits(), 0.1, rectangle, 30.0);
      ASSERT_EQ(found.has_value(), expected.has_value());
      if (!found) continue;
      ASSERT_EQ(found->distance_m, expected->distance_m);
      ASSERT_EQ(found->x, expected->x);
      ASSERT_EQ(found->y, expected->y);
    }
  }
}

TEST(CellBits, AnswersWhatALookAtEachCellDoes) {
  std::mt19937 random(4);
  for (int round = 0; round < 200; ++round) {
    const MadeCells cells = random_cells(random, 1u << random() % 10);
    const CellBits bits = cells.bits();
    const CellRange& range = cells.range;
    const auto is_set = [&](std::int64_t x, std::int64_t y) {
      return cells.set[range.index(x, y)] != 0;
    };
    for (int i = 0; i < 30; ++i) {
      const auto any_of = [&](std::int64_t from, std::int64_t count) {
        return from + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(count));
      };
      const std::int64_t y = any_of(range.from_y, range.height());
      const std::int64_t from = any_of(range.from_x, range.width());
      const std::int64_t to = any_of(from, range.to_x - from);
      std::optional<std::int64_t> first, last;
      bool any = false;
      const std::int64_t band = floor_div(y, CellBits::kBandRows);
      for (std::int64_t x = from; x <= to; ++x) {
        if (is_set(x, y)) last = x;
        if (is_set(x, y) && !first) first = x;
        for (std::int64_t row = 8 * band; row < 8 * band + 8; ++row) {
          any = any || (range.holds(x, row) && is_set(x, row));
        }
      }
      ASSERT_EQ(bits.next_in_row(y, from, to), first);
      ASSERT_EQ(bits.last_in_row(y, to, from), last);
      ASSERT_EQ(bits.any_in_band(band, from, to), any);
    }
  }
}

}  // namespace
}  // namespace roadbed::map
