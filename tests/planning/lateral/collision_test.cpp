#include "roadbed/planning/lateral/collision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/planning/obstacles/static_obstacles.h"

namespace roadbed::planning {
namespace {

using geometry::Trajectory;
using geometry::TrajectoryPoint;
using geometry::VehicleShape;

std::vector<TrajectoryPoint> straight_drive(double length_m, double step_m, double speed_mps) {
  std::vector<TrajectoryPoint> drive;
  for (double x = 0.0; x <= length_m + 1e-9; x += step_m) {
    drive.push_back({.t_s = x / speed_mps, .x_m = x, .speed_mps = speed_mps});
  }
  return drive;
}

bool is_free(const std::vector<TrajectoryPoint>& drive, const std::vector<Obstacle>& obstacles,
             const CollisionOptions& options = {}) {
  const CollisionScene scene{.obstacles = obstacles};
  return CollisionChecker(scene, VehicleShape{}, options).is_free(drive);
}

// A post or a fence: thinner than the steps of the drive are long.
Obstacle thing(double x_m, double y_m, double length_m, double width_m, double heading_rad = 0.0) {
  return {.id = "thing",
          .length_m = length_m,
          .width_m = width_m,
          .motion = Trajectory({{.x_m = x_m, .y_m = y_m, .heading_rad = heading_rad}})};
}

TEST(CollisionChecker, SeesAThinPostBetweenTwoDistantPoints) {
  // Points 20 m apart: at none of them is the car near the post.
  const auto drive = straight_drive(40.0, 20.0, 20.0);
  EXPECT_FALSE(is_free(drive, {thing(12.0, 0.0, 0.02, 0.02)}));
  EXPECT_TRUE(is_free(drive, {thing(12.0, 3.0, 0.02, 0.02)}));
}

TEST(CollisionChecker, DemandsTheClearanceWithinItsTolerance) {
  const auto drive = straight_drive(40.0, 1.0, 10.0);
  const double side_m = 0.5 * 1.61 + 0.3;  // where clearance_m is just kept
  EXPECT_FALSE(is_free(drive, {thing(30.0, side_m + 0.009, 0.02, 0.02)}));  // 0.299 m
  EXPECT_TRUE(is_free(drive, {thing(30.0, side_m + 0.031, 0.02, 0.02)}));   // 0.321 m
}

TEST(CollisionChecker, DemandsTheClearanceFromTheBeginningOn) {
  const auto drive = straight_drive(40.0, 1.0, 10.0);
  const double side_m = 0.5 * 1.61 + 0.28 + 0.01;
  EXPECT_FALSE(is_free(drive, {thing(6.0, side_m, 0.02, 0.02)}));
}

TEST(CollisionChecker, LetsADriveBeginNearerThanTheClearance) {
  const auto drive = straight_drive(40.0, 1.0, 10.0);
  const double side_m = 0.5 * 1.61 + 0.1 + 0.01;
  EXPECT_TRUE(is_free(drive, {thing(-0.5, side_m, 0.02, 0.02)}));  // beside the rear overhang
  EXPECT_FALSE(is_free(drive, {thing(3.0, side_m, 0.02, 0.02)}));  // to be passed as near as that
}

TEST(CollisionChecker, SeesACarThatCrossesBetweenTwoPoints) {
  // Both are at x = 20 m at t = 1 s; the drive has points at 0, 2 and 4 s only.
  const auto drive = straight_drive(80.0, 40.0, 20.0);
  const auto crossing = [](double at_s) {
    return Obstacle{
        .id = "crossing",
        .motion = Trajectory(
            {{.t_s = at_s - 1.0, .x_m = 20.0, .y_m = -20.0, .heading_rad = 0.5 * std::numbers::pi},
             {.t_s = at_s + 1.0,
              .x_m = 20.0,
              .y_m = 20.0,
              .heading_rad = 0.5 * std::numbers::pi}})};
  };
  EXPECT_FALSE(is_free(drive, {crossing(1.0)}));
  EXPECT_TRUE(is_free(drive, {crossing(3.0)}));
}

TEST(CollisionChecker, LooksAtMovingThingsUpToItsHorizonOnly) {
  const auto drive = straight_drive(100.0, 1.0, 10.0);
  const Obstacle oncoming{.id = "oncoming",
                          .motion = Trajectory({{.t_s = 0.0, .x_m = 160.0},
                                                {.t_s = 10.0, .x_m = 60.0}})};  // met at 8 s
  EXPECT_TRUE(is_free(drive, {oncoming}, {.horizon_s = 5.0}));
  EXPECT_FALSE(is_free(drive, {oncoming}, {.horizon_s = 9.0}));
}

TEST(CollisionChecker, SeesWhatIsInsideALargeBody) {
  EXPECT_FALSE(is_free(straight_drive(10.0, 1.0, 10.0), {thing(5.0, 0.0, 80.0, 60.0)}));
}

// Clearance minus demand at 200 times per leg. Where the drive begins the demand is at most the
// distance there, less the tolerance; each obstacle is of a kind of its own.
double least_slack_m(const std::vector<TrajectoryPoint>& drive,
                     const std::vector<Obstacle>& obstacles) {
  double slack_m = 1e300, driven_m = 0.0;
  std::vector<double> at_start_m;
  for (const Obstacle& obstacle : obstacles) {
    const auto body = geometry::body_at(drive.front().pose(), VehicleShape{});
    const double distance_m = geometry::distance_m(body, rectangle_at(obstacle, drive[0].t_s));
    at_start_m.push_back(std::clamp(distance_m - 0.02, 0.0, 0.3));
  }
  for (std::size_t i = 0; i + 1 < drive.size(); ++i) {
    const double leg_m =
        std::hypot(drive[i + 1].x_m - drive[i].x_m, drive[i + 1].y_m - drive[i].y_m);
    for (int k = 0; k <= 200; ++k) {
      const TrajectoryPoint at = interpolate(drive[i], drive[i + 1], k / 200.0);
      const auto body = geometry::body_at(at.pose(), VehicleShape{});
      const double fraction = std::min(1.0, (driven_m + leg_m * k / 200.0) / 10.0);
      for (std::size_t o = 0; o < obstacles.size(); ++o) {
        const Obstacle& obstacle = obstacles[o];
        const double demanded_m = at_start_m[o] + (0.3 - at_start_m[o]) * fraction;
        if (!obstacle.is_static() && at.t_s > 5.0) continue;
        slack_m = std::min(slack_m,
                           geometry::distance_m(body, rectangle_at(obstacle, at.t_s)) - demanded_m);
      }
    }
    driven_m += leg_m;
  }
  return slack_m;
}

// Whether it is found free, which dense sampling has to bear out.
bool is_free_as_sampled(const std::vector<TrajectoryPoint>& drive,
                        const std::vector<Obstacle>& obstacles, int scene) {
  const double slack_m = least_slack_m(drive, obstacles);
  const bool found_free = is_free(drive, obstacles);
  if (found_free) {
    EXPECT_GE(slack_m, -1e-9) << "scene " << scene;
  } else {
    EXPECT_LE(slack_m, 0.02 + 0.01) << "scene " << scene;
  }
  return found_free;
}

TEST(CollisionChecker, AgreesWithDenseSamplingOnRandomScenes) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int free = 0, colliding = 0;
  for (int scene = 0; scene < 300; ++scene) {
    std::vector<TrajectoryPoint> drive{{}};
    for (int i = 0; i < 20; ++i) {
      TrajectoryPoint next = drive.back();
      next.heading_rad += 0.1 * unit(random);
      next.x_m += 1.5 * std::cos(next.heading_rad);
      next.y_m += 1.5 * std::sin(next.heading_rad);
      next.t_s += 0.3 + 0.2 * unit(random);
      drive.push_back(next);
    }
    std::vector<Obstacle> obstacles;
    for (int i = 0; i < 2; ++i) {
      const TrajectoryPoint from{.x_m = 18.0 + 15.0 * unit(random),
                                 .y_m = 6.0 * unit(random),
                                 .heading_rad = 4.0 * unit(random)};
      TrajectoryPoint to = from;
      to.t_s = 4.0;
      to.x_m += 20.0 * unit(random);
      to.y_m += 20.0 * unit(random);
      to.heading_rad += unit(random);
      obstacles.push_back(
          {.id = "random", .motion = i == 0 ? Trajectory({from, to}) : Trajectory({from})});
    }
    ++(is_free_as_sampled(drive, obstacles, scene) ? free : colliding);
  }
  EXPECT_GT(free, 50);
  EXPECT_GT(colliding, 50);
}

// A post beside a bend that comes about as near to the body as is allowed, anywhere.
Obstacle post_beside(const std::vector<TrajectoryPoint>& drive, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const std::size_t leg = 7 + random() % (drive.size() - 8);  // the whole clearance holds there
  const auto at = interpolate(drive[leg], drive[leg + 1], 0.5 + 0.5 * unit(random));
  const auto body = geometry::body_at(at.pose(), VehicleShape{});
  const double beside_m = body.half_width_m + 0.6 + 0.3 * unit(random);
  const Eigen::Vector2d left(-body.axis.y(), body.axis.x());
  const Eigen::Vector2d place = body.centre + unit(random) * body.half_length_m * body.axis +
                                (random() % 2 == 0 ? 1.0 : -1.0) * beside_m * left;
  return thing(place.x(), place.y(), 0.1, 0.1, at.heading_rad);
}

TEST(CollisionChecker, KeepsTheClearanceToWhatABendPassesClosely) {
  std::mt19937 random(19);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int free = 0, colliding = 0;
  for (int scene = 0; scene < 800; ++scene) {
    const double turn_rad = 0.3 * unit(random);
    std::vector<TrajectoryPoint> drive{{}};
    for (int i = 0; i < 14; ++i) {
      TrajectoryPoint next = drive.back();
      next.heading_rad += turn_rad;
      next.x_m += 1.5 * std::cos(next.heading_rad - 0.5 * turn_rad);
      next.y_m += 1.5 * std::sin(next.heading_rad - 0.5 * turn_rad);
      next.t_s += 0.3;
      drive.push_back(next);
    }
    const std::vector<Obstacle> posts{post_beside(drive, random)};
    ++(is_free_as_sampled(drive, posts, scene) ? free : colliding);
  }
  EXPECT_GT(free, 50);
  EXPECT_GT(colliding, 50);
}

// Beside the vehicle, at nearly its speed, about as near as is allowed.
Obstacle cyclist_beside(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<TrajectoryPoint> track{
      {.t_s = -1.0, .x_m = 1.0 + 3.0 * unit(random), .y_m = -1.45 + 0.2 * unit(random)}};
  for (int i = 0; i < 20; ++i) {
    TrajectoryPoint next = track.back();
    next.t_s += 0.35;
    next.heading_rad += 0.03 * unit(random);
    next.x_m += 0.35 * 4.0 * std::cos(next.heading_rad);
    next.y_m += 0.35 * 4.0 * std::sin(next.heading_rad);
    track.push_back(next);
  }
  return {.id = "cyclist", .length_m = 1.8, .width_m = 0.6, .motion = Trajectory(track)};
}

// Drives that differ only in how fast they leave the line.
std::vector<TrajectoryPoint> drive_to_the_left(double left_m) {
  std::vector<TrajectoryPoint> drive;
  for (int i = 0; i <= 25; ++i) {
    const double x = 1.0 * i;
    drive.push_back({.t_s = x / 6.0,
                     .x_m = x,
                     .y_m = left_m * x * x / 200.0,
                     .heading_rad = std::atan(left_m * x / 100.0),
                     .speed_mps = 6.0});
  }
  return drive;
}

TEST(CollisionChecker, KeepsTheClearanceToWhatMovesBesideTheVehicle) {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int free = 0, colliding = 0;
  for (int scene = 0; scene < 400; ++scene) {
    const std::vector<Obstacle> cyclist{cyclist_beside(random)};
    ++(is_free_as_sampled(drive_to_the_left(unit(random)), cyclist, scene) ? free : colliding);
  }
  EXPECT_GT(free, 50);
  EXPECT_GT(colliding, 50);
}

// All along a drive, at the ends of the parts of its segments.
bool is_surely_hit(const CollisionChecker& checker, const Contact& other,
                   const std::vector<TrajectoryPoint>& drive) {
  double driven_m = 0.0;
  for (std::size_t i = 0; i + 1 < drive.size(); ++i) {
    const double leg_m =
        std::hypot(drive[i + 1].x_m - drive[i].x_m, drive[i + 1].y_m - drive[i].y_m);
    for (int part = 0; part <= CollisionChecker::parts(other); ++part) {
      const double fraction = static_cast<double>(part) / CollisionChecker::parts(other);
      const TrajectoryPoint at = interpolate(drive[i], drive[i + 1], fraction);
      const auto body = geometry::body_at(at.pose(), VehicleShape{});
      if (checker.surely_hits(other, body, at.t_s, driven_m + fraction * leg_m)) return true;
    }
    driven_m += leg_m;
  }
  return false;
}

TEST(CollisionChecker, FindsNoDriveFreeThatSurelyHitsWhatAnotherDriveCameTooNearTo) {
  std::mt19937 random(29);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int hit = 0, colliding = 0;
  for (int scene = 0; scene < 400; ++scene) {
    std::vector<Obstacle> things{cyclist_beside(random)};
    if (scene % 2 == 0) things = {thing(12.0, -1.3 + 0.2 * unit(random), 0.8, 0.6, unit(random))};
    const CollisionScene at{.obstacles = things};
    const CollisionChecker checker(at, VehicleShape{}, {});
    const auto other = checker.first_contact(drive_to_the_left(-0.2));
    if (!other) continue;
    for (int i = 0; i < 5; ++i) {
      const auto drive = drive_to_the_left(0.5 + unit(random));
      const bool is_hit = is_surely_hit(checker, *other, drive);
      EXPECT_TRUE(!is_hit || checker.first_contact(drive)) << "scene " << scene;
      hit += is_hit ? 1 : 0;
      colliding += checker.first_contact(drive) ? 1 : 0;
    }
  }
  EXPECT_GT(hit, 200);
  EXPECT_GE(hit, colliding * 95 / 100) << "of " << colliding;  // the first look finds nearly all
}

TEST(StaticObstacles, BoundIsBelowTheDistanceAndNear) {
  std::mt19937 random(19);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Obstacle> obstacles;
  for (int i = 0; i < 40; ++i) {
    obstacles.push_back(thing(50.0 * unit(random), 50.0 * unit(random), 5.0 + 4.0 * unit(random),
                              2.0 + unit(random), 4.0 * unit(random)));
  }
  const StaticObstacles standing(obstacles);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d point(60.0 * unit(random), 60.0 * unit(random));
    double exact_m = 1e300;
    for (const Obstacle& obstacle : obstacles) {
      exact_m = std::min(exact_m, geometry::distance_m(rectangle_at(obstacle, 0.0), point));
    }
    EXPECT_LE(standing.distance_bound_m(point), exact_m + 1e-12);
    EXPECT_GE(standing.distance_bound_m(point), exact_m - 2.0 * StaticObstacles::kLargestGap_m);
  }
}

TEST(StaticObstacles, OfNoneAreInfinitelyFar) {
  const StaticObstacles none({});
  EXPECT_TRUE(none.empty());
  EXPECT_TRUE(std::isinf(none.distance_bound_m({0.0, 0.0})));
  EXPECT_TRUE(std::isinf(none.distance_m(geometry::Rectangle{})));
}

}  // namespace
}  // namespace roadbed::planning
