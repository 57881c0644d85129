#include "roadbed/planning/lateral/candidates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "roadbed/planning/lateral/candidate_batch.h"
#include "roadbed/tests/support/analytic_line.h"

namespace roadbed::planning {
namespace {

TEST(Grid, HasThePapersCounts) {
  EXPECT_EQ(Grid({0.1, 2.0, 4.0, 0.2, 15.0, 30.0}).size(), 1596u);   // Fig. 9: 21 × 76
  EXPECT_EQ(Grid({0.1, -3.5, 3.5, 0.2, 15.0, 30.0}).size(), 5396u);  // 71 × 76
}

TEST(Grid, HoldsZeroAndItsEndsExactly) {
  const Grid grid({0.1, -3.5, 3.5, 0.2, 15.0, 30.0});
  EXPECT_NEAR(grid.end_d_m().front(), -3.5, 1e-12);
  EXPECT_EQ(grid.end_d_m()[35], 0.0);
  EXPECT_NEAR(grid.end_d_m().back(), 3.5, 1e-12);
  EXPECT_NEAR(grid.max_l_m(), 30.0, 1e-12);
  EXPECT_EQ(grid.end_d_m(71), grid.end_d_m(0));  // d_e fastest
  EXPECT_GT(grid.end_l_m(71), grid.end_l_m(70));
}

TEST(Grid, RefusesRangesThatHoldNothing) {
  EXPECT_THROW(Grid({0.0, -1.0, 1.0, 0.2, 15.0, 30.0}), std::invalid_argument);
  EXPECT_THROW(Grid({0.1, 1.0, -1.0, 0.2, 15.0, 30.0}), std::invalid_argument);
  EXPECT_THROW(Grid({0.5, 0.1, 0.4, 0.2, 15.0, 30.0}), std::invalid_argument);
  EXPECT_THROW(Grid({0.1, -1.0, 1.0, 0.2, -1.0, 30.0}), std::invalid_argument);
  EXPECT_THROW(Grid({1e-9, -1.0, 1.0, 0.2, 15.0, 30.0}), std::invalid_argument);
}

struct Problem {
  tests::AnalyticLine line;
  LateralState start;
  SpeedPlan speed;
};

Problem random_problem(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  return {.line = {.curvature = {0.1 * unit(random), 5e-3 * unit(random), 1e-4 * unit(random),
                                 1e-6 * unit(random), 1e-8 * unit(random)},
                   .left_m = 3.0 + 1.5 * unit(random),
                   .right_m = 3.0 + 1.5 * unit(random)},
          .start = {.s_m = 1.0,
                    .d_m = unit(random),
                    .d_slope = 0.1 * unit(random),
                    .d_curvature_per_m = 0.02 * unit(random)},
          .speed = {10.0 + 6.0 * unit(random), 2.0 * unit(random), 10.0 + 6.0 * unit(random)}};
}

// The fused row against each candidate evaluated for itself.
TEST(CandidateBatch, CostsAndVerdictsAreThoseOfEachCandidateAlone) {
  std::mt19937 random(11);
  const Grid grid({0.1, -3.5, 3.5, 5.0, 15.0, 30.0});
  const geometry::VehicleShape vehicle;
  std::array<int, kRejections> seen{};
  for (int i = 0; i < 60; ++i) {
    const Problem problem = random_problem(random);
    const LineView view = problem.line.view();
    const std::function<double(double)> previous = [](double s_m) { return 0.1 * s_m - 1.0; };
    const CycleContext context{.line = view,
                               .start = problem.start,
                               .speed = PlannedSpeed(problem.speed),
                               .previous_d_m = previous,
                               .half_width_m = 0.5 * vehicle.width_m,
                               .recovery_m = 10.0};
    for (const double end_l_m : grid.end_l_m()) {
      const auto stations = stations_over(context, end_l_m, 31);
      const QuinticFamily family(problem.start, end_l_m);
      const BatchConfig config{
          .end_d_m = grid.end_d_m(),
          .weights = default_weights(),
          .frame = {end_l_m, grid.max_l_m(), problem.speed.speed_mps},
          .limits = {.max_curvature_per_m = 0.15, .max_lateral_acceleration_mps2 = 4.0}};
      const BatchCosts row = evaluate_batch(stations, family, config);
      for (std::size_t lane = 0; lane < grid.offset_count(); ++lane) {
        const geometry::Quintic quintic = family.member(grid.end_d_m()[lane]);
        const auto points = cost_points(stations, quintic);
        const Rejection alone = judge(stations, quintic, points, config.limits);
        ASSERT_EQ(row.rejection[lane], alone);
        ++seen[static_cast<std::size_t>(alone)];
        if (points.empty()) continue;
        const double cost = total_cost(cost_terms(points, config.frame), config.weights);
        // Digits are lost as 1/(1 − κ d): only what can be chosen must agree closely.
        ASSERT_NEAR(row.cost[lane], cost, (alone == Rejection::none ? 1e-9 : 1e-5) * cost);
      }
    }
  }
  for (int cause = 0; cause < 4; ++cause) EXPECT_GT(seen[static_cast<std::size_t>(cause)], 50);
}

TEST(Candidates, DriveHasTheTimesOfItsSpeedsAndGoesOnAtItsEnd) {
  const tests::AnalyticLine straight;
  const LineView view = straight.view();
  const std::function<double(double)> none;
  const CycleContext context{.line = view,
                             .start = {.d_m = 1.0},
                             .speed = PlannedSpeed({5.0, -1.0, 10.0}),  // brakes: v² = 25 − 2 l
                             .previous_d_m = none,
                             .half_width_m = 0.8,
                             .recovery_m = 10.0};
  const auto stations = stations_over(context, 10.0, 101);
  const auto drive =
      drive_along(stations, QuinticFamily(context.start, 5.0).member(1.0), 2.0, 2.58);
  ASSERT_EQ(drive.size(), 101u);
  EXPECT_EQ(drive.front().t_s, 2.0);
  EXPECT_NEAR(drive.back().t_s, 2.0 + 5.0 - std::sqrt(5.0), 1e-9);
  EXPECT_NEAR(drive.back().y_m, 1.0, 1e-12);
  EXPECT_NEAR(drive.back().speed_mps, std::sqrt(5.0), 1e-12);
}

TEST(Candidates, SteeringIsThatOfTheCurvature) {
  const tests::AnalyticLine circle{.curvature = {0.05, 0, 0, 0, 0}};
  const LineView view = circle.view();
  const std::function<double(double)> none;
  const CycleContext context{.line = view,
                             .start = {.d_m = 2.0},
                             .speed = PlannedSpeed({5.0, 0.0, 5.0}),
                             .previous_d_m = none,
                             .half_width_m = 0.8,
                             .recovery_m = 10.0};
  for (const auto& point : drive_along(stations_over(context, 10.0, 11),
                                       QuinticFamily(context.start, 10.0).member(2.0), 0.0, 2.5)) {
    EXPECT_NEAR(point.curvature_per_m, 1.0 / 18.0, 1e-12);
    EXPECT_NEAR(std::tan(point.steering_rad), 2.5 / 18.0, 1e-12);
    EXPECT_NEAR(std::hypot(point.x_m, point.y_m - 20.0), 18.0, 1e-9);
  }
}

}  // namespace
}  // namespace roadbed::planning
