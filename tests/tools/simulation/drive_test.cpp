#include "roadbed/tools/simulation/drive.h"

#include <gtest/gtest.h>

namespace roadbed::tools {
namespace {

using planning::Candidate;
using planning::Rejection;

/// Three offsets by four lengths; only those of the second row are feasible, the left ones cheaper.
planning::Plan plan_of_twelve() {
  planning::Plan plan;
  for (int row = 0; row < 4; ++row) {
    for (int lane = 0; lane < 3; ++lane) {
      plan.candidates.push_back({.end_d_m = lane - 1.0,
                                 .end_l_m = 15.0 + row,
                                 .cost = 10.0 - lane,
                                 .rejection = row == 1 ? Rejection::none : Rejection::collision});
    }
  }
  plan.chosen = plan.candidates[5];
  return plan;
}

TEST(CandidateGrid, HoldsTheCauseOfEveryCandidateOfTheRowsThatAreKept) {
  const auto grid = candidate_grid(plan_of_twelve(), 1);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->end_d_m, (std::vector<double>{-1.0, 0.0, 1.0}));
  EXPECT_EQ(grid->end_l_m, (std::vector<double>{15.0, 16.0, 17.0, 18.0}));
  const auto collides = static_cast<std::uint8_t>(Rejection::collision);
  EXPECT_EQ(grid->causes,
            (std::vector<std::uint8_t>{collides, collides, collides, 0, 0, 0, collides, collides,
                                       collides, collides, collides, collides}));
  EXPECT_EQ(candidate_grid(plan_of_twelve(), 3)->end_l_m, (std::vector<double>{15.0, 18.0}));
}

TEST(CandidateGrid, RunnerUpIsTheCheapestThatEndsElsewhere) {
  const auto grid = candidate_grid(plan_of_twelve(), 1);
  ASSERT_TRUE(grid->runner_up);
  EXPECT_EQ(grid->runner_up->end_d_m, 0.0);
  EXPECT_EQ(grid->runner_up->end_l_m, 16.0);
}

TEST(CandidateGrid, PlanThatKeptNoCandidatesHasNone) {
  EXPECT_FALSE(candidate_grid(planning::Plan{}));
}

}  // namespace
}  // namespace roadbed::tools
