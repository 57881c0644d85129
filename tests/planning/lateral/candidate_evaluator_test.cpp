#include "roadbed/planning/lateral/candidate_evaluator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "roadbed/tests/support/analytic_line.h"

namespace roadbed::planning {
namespace {

constexpr int kParts = 8;

// The place of a drive at which its stations have that length, and how far it is driven to there.
struct OnDrive {
  geometry::TrajectoryPoint point;
  double driven_m;
};

OnDrive on_drive(const CandidateDrive& drive, double l_m) {
  double driven_m = 0.0;
  std::size_t i = 0;
  const auto step_m = [&](std::size_t from) {
    const auto &a = drive.points[from], &b = drive.points[from + 1];
    return std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
  };
  for (; drive.stations[i + 1].l_m < l_m - 1e-9; ++i) driven_m += step_m(i);
  const double fraction =
      (l_m - drive.stations[i].l_m) / (drive.stations[i + 1].l_m - drive.stations[i].l_m);
  return {interpolate(drive.points[i], drive.points[i + 1], fraction),
          driven_m + fraction * step_m(i)};
}

TEST(CandidateEvaluator, HasBodiesWhereTheDrivesOfTheirCandidatesAre) {
  const std::vector<Obstacle> none;
  const tests::AnalyticLine circle{.curvature = {0.03}};
  const LineView line = circle.view();
  const PlanInput input{.line = line,
                        .start = {.s_m = 40.0, .d_m = 0.3, .d_slope = 0.05},
                        .start_t_s = 2.0,
                        .speed = {8.0, 0.5, 12.0},
                        .obstacles = none,
                        .previous_d_m = {}};
  const geometry::VehicleShape vehicle;
  const PlanOptions options{.l_step_m = 3.0};
  CandidateEvaluator evaluator(input, vehicle, options);
  const Grid& grid = evaluator.grid();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int past_end = 0;
  for (int i = 0; i < 500; ++i) {
    const std::size_t index = random() % grid.size(), batch = index / grid.offset_count();
    const double end_d_m = grid.end_d_m(index), l_m = unit(random) * grid.max_l_m();
    const auto bodies = evaluator.bodies(batch, std::span(&end_d_m, 1), l_m,
                                         {.with_lengths = true, .parts = kParts});
    if (bodies.empty()) continue;  // between the candidate's end and the next station
    const CandidateBody& body = bodies.front();
    EXPECT_NEAR(body.l_m, l_m,
                0.5 * grid.max_l_m() / 30 / kParts + 1.0 * (l_m > grid.end_l_m(index)));
    const OnDrive at = on_drive(evaluator.drive(index), body.l_m);
    const geometry::Rectangle expected = geometry::body_at(at.point.pose(), vehicle);
    EXPECT_LT((body.body.centre - expected.centre).norm(), 1e-9);
    EXPECT_LT((body.body.axis - expected.axis).norm(), 1e-9);
    EXPECT_NEAR(body.t_s, at.point.t_s, 1e-9);
    EXPECT_NEAR(body.driven_m, at.driven_m, 0.01);
    past_end += l_m > grid.end_l_m(index) ? 1 : 0;
  }
  EXPECT_GT(past_end, 50);
}

}  // namespace
}  // namespace roadbed::planning
