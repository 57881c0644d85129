#include "roadbed/planning/tracking/assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <utility>

namespace roadbed::planning {
namespace {

using Costs = std::map<std::pair<std::size_t, std::size_t>, double>;

/// Least sum over every way of giving columns to rows from `row` on.
double least_sum(const Costs& costs, std::size_t row, std::size_t rows, std::size_t columns,
                 std::set<std::size_t>& used, double cost_of_none) {
  if (row == rows) return 0.0;
  double best = cost_of_none + least_sum(costs, row + 1, rows, columns, used, cost_of_none);
  for (std::size_t column = 0; column < columns; ++column) {
    const auto pair = costs.find({row, column});
    if (pair == costs.end() || !used.insert(column).second) continue;
    best =
        std::min(best, pair->second + least_sum(costs, row + 1, rows, columns, used, cost_of_none));
    used.erase(column);
  }
  return best;
}

TEST(Assignment, CostsTheLeastOfAll) {
  std::mt19937_64 random(11);
  for (int trial = 0; trial < 400; ++trial) {
    const std::size_t rows = random() % 6, columns = random() % 6;
    const double none = 10.0;
    std::uniform_real_distribution<double> cost(0.0, none);
    Costs costs;
    std::vector<PossiblePair> pairs;
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t column = 0; column < columns; ++column) {
        if (random() % 3 == 0) continue;
        costs[{row, column}] = cost(random);
        pairs.push_back({row, column, costs[{row, column}]});
      }
    }
    std::ranges::shuffle(pairs, random);
    const auto given = assign(rows, columns, pairs, none);
    ASSERT_EQ(given.size(), rows);
    double sum = 0.0;
    std::set<std::size_t> used;
    for (std::size_t row = 0; row < rows; ++row) {
      if (!given[row]) {
        sum += none;
        continue;
      }
      EXPECT_TRUE(used.insert(*given[row]).second) << "column twice";
      ASSERT_TRUE(costs.contains({row, *given[row]}));
      sum += costs[{row, *given[row]}];
    }
    used.clear();
    EXPECT_NEAR(sum, least_sum(costs, 0, rows, columns, used, none), 1e-9) << "trial " << trial;
  }
}

// Three hundred in one place: each still has the one that fits it, and nobody two.
TEST(Assignment, OfACrowdIsWholeAndEndsSoon) {
  std::vector<PossiblePair> pairs;
  for (std::size_t row = 0; row < 300; ++row) {
    for (std::size_t column = 0; column < 300; ++column) {
      pairs.push_back({row, column, row == column ? 0.5 : 5.0});
    }
  }
  const auto given = assign(300, 300, pairs, 9.0);
  for (std::size_t row = 0; row < 300; ++row) EXPECT_EQ(given[row], row);
}

TEST(Assignment, DoesNotTakeTheNearestFirst) {
  // Row 0 is nearest to column 0, but row 1 has no other.
  const auto given = assign(2, 2, {{0, 0, 1.0}, {0, 1, 2.0}, {1, 0, 1.5}}, 9.0);
  EXPECT_EQ(given[0], 1u);
  EXPECT_EQ(given[1], 0u);
}

}  // namespace
}  // namespace roadbed::planning
