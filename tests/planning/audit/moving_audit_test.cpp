#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/audit/certificate.h"
#include "roadbed/planning/audit/check/certificate_check.h"
#include "roadbed/planning/audit/clearance_audit.h"
#include "roadbed/tests/support/brute_force_distance.h"
#include "roadbed/tests/support/random_drive.h"

namespace roadbed::planning {
namespace {

using geometry::Pose2;
using geometry::Trajectory;
using geometry::VehicleShape;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using tests::Quad;

constexpr map::HeightBand kBodyBand{0.2, 1.5};

/// One hit, 500 m away: all that happens is between the drive and what moves.
map::OccupancyMap far_post() {
  map::PointCloud cloud;
  cloud.points.emplace_back(500.0f, 0.0f, 0.75f);
  return map::OccupancyMap::build(std::vector{cloud}, {.resolution_m = 0.1});
}

// That nothing was measured near the drive is not what these tests are about.
Verdict among_what_moves(AuditReport report) {
  report.unknown.clear();
  return verdict_of(report);
}

Trajectory any_motion(std::mt19937& random, double spread_m, std::size_t rows, double from_s) {
  auto first = tests::random_start(random, {0.0, 0.0}, spread_m, 3.0);
  first.t_s = from_s;
  return tests::random_drive(random, first, {.rows = rows - 1, .step_s = 0.6, .way_m = 4.0});
}

/// A box that comes at any time, before the drive too, and may go before its end.
ObstacleInSource any_mover(std::mt19937& random, int number) {
  std::uniform_real_distribution<double> start(-1.0, 1.5), size(0.3, 5.0);
  ObstacleInSource obstacle{.id = std::to_string(number),
                            .length_m = size(random),
                            .width_m = 0.5 * size(random),
                            .motion = any_motion(random, 14.0, 1 + random() % 4, start(random))};
  if (!obstacle.is_static()) {
    obstacle.validity = {obstacle.motion.start_s(), obstacle.motion.end_s()};
  }
  return obstacle;
}

struct Traffic {
  Trajectory drive;
  std::vector<ObstacleInSource> moving;
};

Traffic random_traffic(std::mt19937& random) {
  Traffic traffic{any_motion(random, 6.0, 1 + random() % 4, 0.0), {}};
  for (int i = 0; i < 6; ++i) traffic.moving.push_back(any_mover(random, i));
  return traffic;
}

Quad quad_at(const Pose2& centre, double length_m, double width_m) {
  const double l = 0.5 * length_m, w = 0.5 * width_m;
  return {centre * Eigen::Vector2d(-l, -w), centre * Eigen::Vector2d(l, -w),
          centre * Eigen::Vector2d(l, w), centre * Eigen::Vector2d(-l, w)};
}

double distance_at(const Traffic& traffic, const VehicleShape& shape, double t_s) {
  const Pose2 pose = traffic.drive.at(t_s).pose();
  const auto c = shape.corners_in_vehicle();
  const Quad body{pose * c[0], pose * c[1], pose * c[2], pose * c[3]};
  double least_m = std::numeric_limits<double>::infinity();
  for (const ObstacleInSource& box : traffic.moving) {
    if (!box.is_there(t_s)) continue;
    const Quad quad = quad_at(box.motion.at(t_s).pose(), box.length_m, box.width_m);
    least_m = std::min(least_m, tests::quad_distance(body, quad));
  }
  return least_m;
}

/// Times so dense that nothing moves over 3 cm between two, and all at which something comes.
std::vector<double> dense_times(const Traffic& traffic) {
  const double from_s = traffic.drive.start_s(), to_s = traffic.drive.end_s();
  std::vector<double> times{from_s, to_s};
  for (double t_s = from_s; t_s < to_s; t_s += 0.0008) times.push_back(t_s);
  for (const ObstacleInSource& moving : traffic.moving) {
    for (const double t_s : {moving.validity.from_s, moving.validity.to_s}) {
      if (from_s < t_s && t_s < to_s) times.push_back(t_s);
    }
  }
  return times;
}

TEST(MovingAudit, AgreesWithADenseSweepAndNeverCallsANearTimeClear) {
  std::mt19937 random(20261122);
  std::uniform_real_distribution<double> margin(0.0, 0.6);
  const map::OccupancyMap post = far_post();
  const map::ClearanceField field(post, kBodyBand);
  const VehicleShape shape;
  constexpr double step_m = 0.03;
  int conflicts = 0, clear = 0;
  for (int round = 0; round < 400; ++round) {
    const Traffic traffic = random_traffic(random);
    const AuditOptions options{.clearance_m = round % 2 == 0 ? 0.0 : margin(random),
                               .unknown = UnknownPolicy::free};
    const AuditReport report =
        audit_clearance(field, traffic.drive, shape, options, traffic.moving);
    double least_m = std::numeric_limits<double>::infinity();
    for (const double t_s : dense_times(traffic)) {
      const double distance_m = distance_at(traffic, shape, t_s);
      least_m = std::min(least_m, distance_m);
      if (distance_m > 0.0 && distance_m >= options.clearance_m) continue;
      ASSERT_TRUE(std::ranges::any_of(report.conflicts,
                                      [&](const Conflict& conflict) {
                                        return conflict.from_s <= t_s + 1e-9 &&
                                               t_s <= conflict.to_s + 1e-9;
                                      }))
          << "round " << round << ": the conflict at " << t_s << " s is in no stretch";
    }
    if (std::isinf(least_m)) continue;  // nobody came
    ASSERT_LE(report.proven_clearance_m, least_m + 1e-6) << round;
    ASSERT_GE(report.least_clearance_m, least_m - step_m) << round;
    ASSERT_LE(report.least_clearance_m, least_m + 0.02 + 1e-6) << round;
    ASSERT_GE(report.proven_clearance_m, report.least_clearance_m - 0.02 - 1e-9) << round;
    if (least_m - step_m > options.clearance_m + 2e-3) {
      ASSERT_EQ(among_what_moves(report), Verdict::clear) << round;
    }
    conflicts += report.verdict == Verdict::conflict;
    clear += among_what_moves(report) == Verdict::clear;
  }
  EXPECT_GT(conflicts, 60);
  EXPECT_GT(clear, 60);
}

TEST(MovingAudit, EveryConflictNamesItsObstacleAndItsClearanceThen) {
  std::mt19937 random(3);
  const map::OccupancyMap post = far_post();
  const map::ClearanceField field(post, kBodyBand);
  const VehicleShape shape;
  int seen = 0;
  for (int round = 0; round < 100; ++round) {
    const Traffic traffic = random_traffic(random);
    const AuditReport report =
        audit_clearance(field, traffic.drive, shape,
                        {.clearance_m = 0.4, .unknown = UnknownPolicy::free}, traffic.moving);
    for (const Conflict& conflict : report.conflicts) {
      const auto named =
          std::ranges::find(traffic.moving, conflict.obstacle, &ObstacleInSource::id);
      ASSERT_NE(named, traffic.moving.end());
      const Traffic alone{traffic.drive, {*named}};
      EXPECT_NEAR(distance_at(alone, shape, conflict.at.t_s), conflict.least_clearance_m, 1e-6);
      EXPECT_FALSE(conflict.part.empty());
      ++seen;
    }
  }
  EXPECT_GT(seen, 30);
}

TEST(MovingAudit, MeetsAtTheMomentWhenBothAreThereNotBeforeNorAfter) {
  // A car crosses the drive's way at x = 20 m; at 10 m/s the two meet around second 2.
  const map::OccupancyMap post = far_post();
  const map::ClearanceField field(post, kBodyBand);
  const Trajectory drive({{.t_s = 0, .x_m = 0}, {.t_s = 4, .x_m = 40}});
  const auto crossing = [](double t_s) {
    return ObstacleInSource{
        .id = "crossing",
        .length_m = 4.0,
        .width_m = 2.0,
        .motion =
            Trajectory({{.t_s = 0, .x_m = 20, .y_m = -10 * t_s, .heading_rad = M_PI / 2},
                        {.t_s = 10, .x_m = 20, .y_m = -10 * t_s + 100, .heading_rad = M_PI / 2}})};
  };
  const auto audited = [&](double t_s) {
    return audit_clearance(field, drive, VehicleShape{}, {.unknown = UnknownPolicy::free},
                           std::vector{crossing(t_s)});
  };
  EXPECT_EQ(audited(2.0).verdict, Verdict::conflict);
  EXPECT_EQ(audited(2.0).conflicts.front().obstacle, "crossing");
  EXPECT_EQ(among_what_moves(audited(4.0)), Verdict::clear);
  EXPECT_EQ(among_what_moves(audited(0.5)), Verdict::clear);
}

TEST(MovingAudit, TheCertificateHoldsAndIsRefutedByAnObstacleThatWasNotSeen) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> margin(0.0, 0.5), fraction(0.0, 1.0);
  const map::OccupancyMap post = far_post();
  const auto cells = post.cells();
  const map::ClearanceField field(post, kBodyBand);
  const VehicleShape shape;
  int refuted = 0;
  for (int round = 0; round < 150; ++round) {
    Traffic traffic = random_traffic(random);
    const AuditOptions options{.clearance_m = round % 2 == 0 ? 0.0 : margin(random),
                               .inflate_m = round % 3 == 0 ? 0.2 : 0.0,
                               .unknown = UnknownPolicy::free};
    const AuditReport report =
        audit_clearance(field, traffic.drive, shape, options, traffic.moving);
    const AuditCertificate certificate =
        certify(field, kBodyBand, traffic.drive, shape, options, report, traffic.moving);
    const auto faults = [&](const AuditCertificate& of,
                            const std::vector<ObstacleInSource>& moving) {
      return check_certificate(of, cells, 0.1, traffic.drive, moving);
    };
    EXPECT_EQ(certificate.verdict, report.verdict) << round;
    EXPECT_THAT(faults(certificate, traffic.moving), IsEmpty()) << round;
    if (among_what_moves(report) != Verdict::clear || certificate.from_moving.empty()) continue;

    AuditCertificate cut = certificate;
    cut.from_moving.erase(cut.from_moving.begin() +
                          static_cast<std::ptrdiff_t>(random() % cut.from_moving.size()));
    if (traffic.drive.points().size() > 1) {
      EXPECT_THAT(faults(cut, traffic.moving), Contains(HasSubstr("nothing is said of")));
    }
    const double span_s = traffic.drive.end_s() - traffic.drive.start_s();
    const Pose2 pose = traffic.drive.at(traffic.drive.start_s() + fraction(random) * span_s).pose();
    traffic.moving.push_back(
        {.id = "unseen",
         .length_m = 0.5,
         .width_m = 0.5,
         .motion = Trajectory({{.t_s = 0.0, .x_m = pose.x_m, .y_m = pose.y_m}})});
    EXPECT_THAT(faults(certificate, traffic.moving), Contains(HasSubstr("an obstacle is nearer")));
    ++refuted;
  }
  EXPECT_GT(refuted, 20);
}

}  // namespace
}  // namespace roadbed::planning
