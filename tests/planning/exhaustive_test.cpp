// The planner's answer held against a plain loop over the whole grid with a slow evaluation of its
// own: power series for the terms, dense sampling for road and collisions. A campaign asks for more
// scenes by ROADBED_PLANNER_SCENES.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <numeric>
#include <random>
#include <thread>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/planning/lateral/collision.h"
#include "roadbed/planning/plan.h"
#include "roadbed/tests/support/analytic_line.h"
#include "roadbed/tests/support/slow_candidate.h"

namespace roadbed::planning {
namespace {

using geometry::Rectangle;
using geometry::TrajectoryPoint;
using geometry::VehicleShape;
using tests::AnalyticLine;
using tests::SlowCandidate;

std::uint32_t scene_count(std::uint32_t otherwise) {
  const char* named = std::getenv("ROADBED_PLANNER_SCENES");
  return named != nullptr ? static_cast<std::uint32_t>(std::strtoul(named, nullptr, 10))
                          : otherwise;
}

struct Scene {
  AnalyticLine line;
  LateralState start;
  SpeedPlan speed;
  std::vector<Obstacle> obstacles;
  std::vector<PredictedObstacle> predicted;
  PlanOptions options;
  double previous_d_m = 0.0;

  PlanInput input() const {
    return {.line = line.view(),
            .start = start,
            .speed = speed,
            .obstacles = obstacles,
            .previous_d_m = [d = previous_d_m](double s_m) { return d + 0.01 * s_m; },
            .predicted = predicted};
  }
};

Obstacle random_obstacle(std::mt19937& random, const AnalyticLine& line) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const ReferencePoint at = line.at(20.0 + 15.0 * unit(random));
  const double side = 4.0 * unit(random), turn = at.heading_rad + 0.3 * unit(random);
  TrajectoryPoint from{.x_m = at.in_map.x() - side * std::sin(at.heading_rad),
                       .y_m = at.in_map.y() + side * std::cos(at.heading_rad),
                       .heading_rad = turn};
  if (unit(random) < 0.0) return {.id = "stands", .motion = geometry::Trajectory({from})};
  TrajectoryPoint to = from;
  const double speed = 8.0 * unit(random);
  to.t_s = 6.0;
  to.x_m += 6.0 * speed * std::cos(turn);
  to.y_m += 6.0 * speed * std::sin(turn);
  to.heading_rad += 0.4 * unit(random);
  return {.id = "moves", .motion = geometry::Trajectory({from, to})};
}

PredictedObstacle random_prediction(std::mt19937& random, const AnalyticLine& line) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double s_m = 25.0 + 20.0 * unit(random), d_m = 4.0 * unit(random);
  const ReferencePoint at = line.at(s_m);
  const ObservedMotion seen{
      .t_s = unit(random),
      .pose = {at.in_map.x() - d_m * std::sin(at.heading_rad),
               at.in_map.y() + d_m * std::cos(at.heading_rad), at.heading_rad + 0.5 * unit(random)},
      .speed_mps = 8.0 * unit(random),
      .turn_rate_radps = 0.4 * unit(random)};
  switch (random() % 3) {
    case 0:
      return {.id = "straight on", .motion = Prediction::constant_velocity(seen)};
    case 1:
      return {.id = "turns", .motion = Prediction::constant_turn(seen)};
    default:
      return {.id = "along the line",
              .motion = Prediction::along_line(line.view(), {s_m, d_m}, seen, 6.0)};
  }
}

Scene random_scene(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Scene scene;
  scene.line.curvature = {0.05 * unit(random), 2e-3 * unit(random), 5e-5 * unit(random), 0.0, 0.0};
  scene.line.left_m = 3.5 + 0.5 * unit(random);
  scene.line.right_m = 3.5 + 0.5 * unit(random);
  scene.start = {.s_m = 2.0 + unit(random),
                 .d_m = 0.8 * unit(random),
                 .d_slope = 0.05 * unit(random),
                 .d_curvature_per_m = 0.01 * unit(random)};
  const double v = 8.0 + 6.0 * unit(random);
  scene.speed = {.speed_mps = v,
                 .acceleration_mps2 = 2.0 * unit(random),
                 .target_mps = std::max(0.0, v + 3.0 * unit(random))};
  scene.previous_d_m = unit(random);
  for (double& weight : scene.options.weights) weight *= std::exp(1.6 * unit(random));
  scene.options.d_step_m = 0.5;
  scene.options.l_step_m = 3.0;
  scene.options.points = 17;
  scene.options.completion_horizon_s = 0.0;  // overtaking_test.cpp asks for it
  const int obstacles = static_cast<int>(random() % 5);
  for (int i = 0; i < obstacles; ++i)
    scene.obstacles.push_back(random_obstacle(random, scene.line));
  if (unit(random) > 0.0) scene.predicted.push_back(random_prediction(random, scene.line));
  return scene;
}

Rectangle rectangle_of(const Obstacle& obstacle, double t_s) {
  const TrajectoryPoint at = obstacle.motion.at(t_s);
  return {{at.x_m, at.y_m},
          {std::cos(at.heading_rad), std::sin(at.heading_rad)},
          0.5 * obstacle.length_m,
          0.5 * obstacle.width_m};
}

// Distance minus demanded clearance at one moment of a drive.
double slack_at_m(const Scene& scene, const TrajectoryPoint& at, double driven_m) {
  double slack_m = 1e300;
  const Rectangle body = geometry::body_at(at.pose(), VehicleShape{});
  const double demanded_m =
      scene.options.clearance_m * (0.5 + 0.5 * std::min(1.0, driven_m / 10.0));
  for (const Obstacle& obstacle : scene.obstacles) {
    if (!obstacle.is_static() && at.t_s > scene.options.horizon_s) continue;
    slack_m =
        std::min(slack_m, geometry::distance_m(body, rectangle_of(obstacle, at.t_s)) - demanded_m);
  }
  for (const PredictedObstacle& obstacle : scene.predicted) {
    if (at.t_s > scene.options.horizon_s) continue;
    const geometry::Pose2 centre = obstacle.motion.at(at.t_s);
    const Rectangle other{centre.position(),
                          {std::cos(centre.heading_rad), std::sin(centre.heading_rad)},
                          0.5 * obstacle.length_m,
                          0.5 * obstacle.width_m};
    slack_m = std::min(slack_m, geometry::distance_m(body, other) - demanded_m);
  }
  return slack_m;
}

// The least of them over a densely sampled drive. A vehicle that has all but stopped is on one leg
// for minutes: its part before the horizon is sampled as densely as all of it.
double least_slack_m(const Scene& scene, const SlowCandidate& slow) {
  constexpr int kSamples = 40;
  double slack_m = 1e300, driven_m = 0.0;
  for (std::size_t i = 0; i + 1 < slow.drive.size(); ++i) {
    const TrajectoryPoint &a = slow.drive[i], &b = slow.drive[i + 1];
    const double length_m = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    const double within = (scene.options.horizon_s - a.t_s) / (b.t_s - a.t_s);
    for (const double part : {1.0, std::clamp(within, 0.0, 1.0)}) {
      for (int k = 0; k <= kSamples; ++k) {
        const double fraction = part * k / kSamples;
        slack_m = std::min(slack_m, slack_at_m(scene, interpolate(a, b, fraction),
                                               driven_m + length_m * fraction));
      }
    }
    driven_m += length_m;
  }
  return slack_m;
}

// Offset of a point from the line by a fine search for its foot.
double offset_m(const LineView& line, const Eigen::Vector2d& point, double near_s_m) {
  double s = near_s_m;
  for (int i = 0; i < 12; ++i) {
    const ReferencePoint at = line.at(s);
    const Eigen::Vector2d tangent(std::cos(at.heading_rad), std::sin(at.heading_rad));
    s += (point - at.in_map).dot(tangent);
  }
  const ReferencePoint at = line.at(s);
  return std::cos(at.heading_rad) * (point.y() - at.in_map.y()) -
         std::sin(at.heading_rad) * (point.x() - at.in_map.x());
}

// How far the corners are inside the corridor; every scene starts inside.
double road_slack_m(const Scene& scene, const LineView& line, const SlowCandidate& slow) {
  double slack_m = 1e300;
  for (std::size_t i = 0; i < slow.drive.size(); ++i) {
    for (const Eigen::Vector2d& corner : VehicleShape{}.corners_in_vehicle()) {
      const Eigen::Vector2d point = slow.drive[i].pose() * corner;
      const double d_m = offset_m(line, point, slow.drive_s_m[i] + corner.x());
      slack_m = std::min({slack_m, scene.line.left_m - d_m, d_m + scene.line.right_m});
    }
  }
  return slack_m;
}

// What the slow way says; near a limit it says neither.
struct Verdict {
  bool surely_rejected = false, surely_feasible = false;
};

Verdict judge_slowly(const Scene& scene, const LineView& line, const SlowCandidate& slow) {
  const VehicleShape vehicle;
  constexpr double kRounding = 1e-6, kRoadBand_m = 0.003, kSampling_m = 0.025;
  if (slow.folded) return {.surely_rejected = true};
  const double limits = std::min(
      {std::tan(vehicle.max_steering_rad) / vehicle.wheelbase_m - slow.worst_curvature_per_m,
       scene.options.max_lateral_acceleration_mps2 - slow.worst_lateral_mps2,
       vehicle.max_steering_rate_radps - slow.worst_steering_radps,
       scene.line.left_m - slow.most_d_m - 0.5 * vehicle.width_m,
       scene.line.right_m + slow.least_d_m - 0.5 * vehicle.width_m});
  if (limits < -kRounding) return {.surely_rejected = true};
  const double road_m = road_slack_m(scene, line, slow);
  if (road_m < -kRoadBand_m) return {.surely_rejected = true};
  const double slack_m = least_slack_m(scene, slow);
  const double tolerance_m = CollisionOptions{}.tolerance_m;
  return {.surely_rejected = slack_m<-kRounding, .surely_feasible = limits> kRounding &&
                             road_m > kRoadBand_m && slack_m > tolerance_m + kSampling_m};
}

Grid grid_of(const PlanOptions& o) {
  return Grid({o.d_step_m, o.min_d_m, o.max_d_m, o.l_step_m, o.min_l_m, o.max_l_m});
}

TEST(PlanPath, TakesWhatAPlainLoopOverTheWholeGridTakes) {
  int found = 0, detours = 0;
  const std::uint32_t scenes = scene_count(300);
  for (std::uint32_t seed = 0; seed < scenes; ++seed) {
    const Scene scene = random_scene(seed);
    const Grid grid = grid_of(scene.options);
    const PlanInput input = scene.input();
    const Plan plan = plan_path(input, VehicleShape{}, scene.options);
    const double chosen_cost = plan.chosen ? plan.chosen->cost : 1e300;
    bool detour = false;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const SlowCandidate slow = tests::slow_candidate(input, scene.options, grid.max_l_m(),
                                                       grid.end_d_m(i), grid.end_l_m(i));
      if (plan.chosen && plan.chosen->end_d_m == grid.end_d_m(i) &&
          plan.chosen->end_l_m == grid.end_l_m(i)) {
        EXPECT_NEAR(slow.cost, chosen_cost, 1e-9 * chosen_cost) << "seed " << seed;
        EXPECT_FALSE(judge_slowly(scene, input.line, slow).surely_rejected) << "seed " << seed;
      } else if (slow.cost < chosen_cost * (1.0 - 1e-9)) {
        detour = true;
        EXPECT_FALSE(judge_slowly(scene, input.line, slow).surely_feasible)
            << "seed " << seed << ", cheaper: d_e " << grid.end_d_m(i) << ", l_e "
            << grid.end_l_m(i);
      }
    }
    found += plan.chosen ? 1 : 0;
    detours += detour && plan.chosen ? 1 : 0;
  }
  EXPECT_GT(found, static_cast<int>(scenes / 4));     // the scenes are neither hopeless
  EXPECT_GT(detours, static_cast<int>(scenes / 20));  // nor trivial
}

std::size_t all_rejected(const RejectionCounts& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::size_t{0});
}

std::size_t colliding(const Plan& plan) {
  return plan.rejected[static_cast<std::size_t>(Rejection::collision)];
}

void expect_same(const Plan& a, const Plan& b, std::uint32_t seed) {
  ASSERT_EQ(a.chosen.has_value(), b.chosen.has_value()) << "seed " << seed;
  if (!a.chosen) {
    EXPECT_EQ(all_rejected(a.rejected), all_rejected(b.rejected)) << "seed " << seed;
    EXPECT_EQ(colliding(a) > 0, colliding(b) > 0) << "seed " << seed;
    return;
  }
  EXPECT_EQ(a.chosen->end_d_m, b.chosen->end_d_m) << "seed " << seed;
  EXPECT_EQ(a.chosen->end_l_m, b.chosen->end_l_m) << "seed " << seed;
  EXPECT_EQ(a.chosen->cost, b.chosen->cost) << "seed " << seed;
}

TEST(PlanPath, LeavesOutOnlyWhatCannotBeTheCheapest) {
  const std::uint32_t scenes = scene_count(200);
  std::size_t evaluated = 0, all = 0;
  for (std::uint32_t seed = 0; seed < scenes; ++seed) {
    Scene scene = random_scene(seed);
    scene.options.d_step_m = 0.1;
    const Plan pruned = plan_path(scene.input(), VehicleShape{}, scene.options);
    scene.options.exhaustive = true;
    const Plan exhaustive = plan_path(scene.input(), VehicleShape{}, scene.options);
    expect_same(pruned, exhaustive, seed);
    EXPECT_LE(pruned.evaluated, exhaustive.evaluated);
    evaluated += pruned.evaluated;
    all += exhaustive.evaluated;
  }
  EXPECT_LT(evaluated, all - all / 3);  // hopeless scenes need all of them
}

TEST(PlanPath, IsTheSameFromManyThreads) {
  constexpr std::uint32_t kScenes = 60;
  std::vector<Plan> alone(kScenes), together(kScenes);
  for (std::uint32_t seed = 0; seed < kScenes; ++seed) {
    const Scene scene = random_scene(seed);
    alone[seed] = plan_path(scene.input(), VehicleShape{}, scene.options);
  }
  std::vector<std::thread> threads;
  for (std::uint32_t first = 0; first < 4; ++first) {
    threads.emplace_back([&together, first] {
      for (std::uint32_t seed = first; seed < kScenes; seed += 4) {
        const Scene scene = random_scene(seed);
        together[seed] = plan_path(scene.input(), VehicleShape{}, scene.options);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::uint32_t seed = 0; seed < kScenes; ++seed) {
    expect_same(together[seed], alone[seed], seed);
  }
}

TEST(PlanPath, LooksLazilyAtNothingThatAFullLookWouldChange) {
  for (std::uint32_t seed = 1000; seed < 1100; ++seed) {
    Scene scene = random_scene(seed);
    scene.options.keep_candidates = true;
    const Plan plan = plan_path(scene.input(), VehicleShape{}, scene.options);
    const Candidate* best = nullptr;
    for (const Candidate& candidate : plan.candidates) {
      if (candidate.rejection != Rejection::none) continue;
      if (best == nullptr || candidate.cost < best->cost) best = &candidate;
    }
    ASSERT_EQ(best != nullptr, plan.chosen.has_value()) << "seed " << seed;
    if (best == nullptr) continue;
    EXPECT_EQ(best->end_d_m, plan.chosen->end_d_m) << "seed " << seed;
    EXPECT_EQ(best->end_l_m, plan.chosen->end_l_m) << "seed " << seed;
  }
}

const Candidate* cheapest_elsewhere(const std::vector<Candidate>& candidates, std::size_t stride,
                                    std::size_t offsets, const std::optional<Candidate>& chosen) {
  const Candidate* best = nullptr;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    if (candidate.rejection != Rejection::none || i / offsets % stride != 0) continue;
    if (chosen && candidate.end_d_m == chosen->end_d_m) continue;
    if (best == nullptr || candidate.cost < best->cost) best = &candidate;
  }
  return best;
}

// With moving obstacles every other scene asks for a completion of the maneuver too.
TEST(PlanningCycle, JudgesTheCandidatesThatAreKeptAsEachOneByItself) {
  constexpr std::size_t kStride = 2;
  RejectionCounts seen{};
  const std::uint32_t scenes = scene_count(300);
  for (std::uint32_t seed = 3000; seed < 3000 + scenes; ++seed) {
    Scene scene = random_scene(seed);
    scene.options.d_step_m = 0.1;
    if (seed % 2 == 0) scene.options.completion_horizon_s = 10.0;
    const PlanInput input = scene.input();
    const VehicleShape vehicle;
    const SafetyMargins margins = margins_of(scene.options);
    PlanningCycle cycle(input, vehicle, scene.options);
    cycle.plan({-0.3, 0.1});  // margins of an earlier question leave nothing behind
    const Plan plan = cycle.plan(margins);
    const CandidateGrid grid = cycle.judge(margins, {}, plan, kStride);
    scene.options.keep_candidates = true;
    const std::vector<Candidate> all = plan_path(input, vehicle, scene.options).candidates;
    const std::size_t offsets = grid.end_d_m.size();
    ASSERT_EQ(grid.causes.size(), offsets * ((all.size() / offsets + kStride - 1) / kStride));
    for (std::size_t i = 0; i < grid.causes.size(); ++i) {
      const Candidate& one = all[i / offsets * kStride * offsets + i % offsets];
      ++seen[static_cast<std::size_t>(one.rejection)];
      ASSERT_EQ(static_cast<Rejection>(grid.causes[i]), one.rejection)
          << "seed " << seed << ", d_e " << one.end_d_m << ", l_e " << one.end_l_m;
    }
    const Candidate* second = cheapest_elsewhere(all, kStride, offsets, plan.chosen);
    ASSERT_EQ(grid.runner_up.has_value(), second != nullptr) << "seed " << seed;
    if (second == nullptr) continue;
    EXPECT_NEAR(grid.runner_up->cost, second->cost, 1e-9 * second->cost) << "seed " << seed;
  }
  for (const Rejection cause : {Rejection::none, Rejection::off_road, Rejection::collision}) {
    EXPECT_GT(seen[static_cast<std::size_t>(cause)], 10 * scenes) << to_string(cause);
  }
}

TEST(PlanPath, TermsAreThoseOfTheSlowEvaluation) {
  for (std::uint32_t seed = 2000; seed < 2030; ++seed) {
    Scene scene = random_scene(seed);
    scene.options.keep_candidates = true;
    const PlanInput input = scene.input();
    const Grid grid = grid_of(scene.options);
    const Plan plan = plan_path(input, VehicleShape{}, scene.options);
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const SlowCandidate slow = tests::slow_candidate(input, scene.options, grid.max_l_m(),
                                                       grid.end_d_m(i), grid.end_l_m(i));
      if (slow.folded) continue;
      const Candidate& candidate = plan.candidates[i];
      EXPECT_NEAR(candidate.cost, slow.cost, 1e-9 * slow.cost);
      for (std::size_t term = 0; term < slow.terms.size(); ++term) {
        EXPECT_NEAR(candidate.terms[term], slow.terms[term], 1e-9 * (1e-3 + slow.terms[term]))
            << to_string(static_cast<CostTerm>(term));
      }
    }
  }
}

}  // namespace
}  // namespace roadbed::planning
