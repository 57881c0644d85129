#include "roadbed/planning/audit/body_probe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/audit/clearance_audit.h"
#include "roadbed/tests/support/part_distance.h"
#include "roadbed/tests/support/random_drive.h"

namespace roadbed::planning {
namespace {

using geometry::BodyPart;
using geometry::Trajectory;
using map::ClearanceField;
using map::ObstacleKind;
using map::OccupancyMap;

OccupancyMap posts_at(const std::vector<Eigen::Vector2d>& places) {
  map::PointCloud cloud;
  for (const Eigen::Vector2d& place : places) {
    cloud.points.emplace_back(static_cast<float>(place.x()), static_cast<float>(place.y()), 0.75f);
  }
  return OccupancyMap::build(std::vector{cloud}, {.resolution_m = 0.1});
}

double away_m(const OccupancyMap& posts, const BodyPart& part, const geometry::Pose2& pose) {
  double least_m = std::numeric_limits<double>::infinity();
  for (const map::OccupancyCell& cell : posts.cells()) {
    least_m = std::min(least_m, tests::part_to_cell_m(part, 0.0, pose, cell));
  }
  return least_m;
}

double least_within_m(const OccupancyMap& posts, const BodyPart& part, const Trajectory& drive,
                      const Span& span) {
  const auto& rows = drive.points();
  const double from_s = rows[span.segment].t_s + span.from;  // a second from row to row
  const double to_s = rows[span.segment + span.segments - 1].t_s + span.to;
  double least_m = std::numeric_limits<double>::infinity();
  constexpr int steps = 60;
  for (int i = 0; i <= steps; ++i) {
    const double t_s = from_s + (to_s - from_s) * i / steps;
    least_m = std::min(least_m, away_m(posts, part, drive.at(t_s).pose()));
  }
  return least_m;
}

// Turns of up to 0.5 rad from row to row: a car that sways.
TEST(BodyProbe, SweptBoundIsNeverOverADistanceOnTheWay) {
  const std::vector<BodyPart> parts{
      geometry::body_of({}),
      {"mirror", 1.7, 1.9, 0.805, 1.05, 0.0, 0.2, 1.5},
      {"lamp", 2.5, 2.5, -0.3, -0.3, 0.4, 0.2, 1.5},
  };
  std::mt19937 random(29);
  std::uniform_real_distribution<double> place(-9.0, 9.0), fraction(0.0, 1.0);
  int told = 0, near = 0;
  for (int round = 0; round < 400; ++round) {
    std::vector<Eigen::Vector2d> places;
    for (int i = 0; i < 20; ++i) places.emplace_back(place(random), place(random));
    const OccupancyMap posts = posts_at(places);
    const ClearanceField field(posts, map::HeightBand{0.2, 1.5});
    const auto first = tests::random_start(random, {0.0, 0.0}, 6.0, 3.6);
    const Trajectory drive = tests::random_drive(
        random, first, {.rows = 7, .step_s = 1.0, .way_m = 0.4, .turn_rad = 0.5});
    for (const BodyPart& part : parts) {
      const BodyProbe probe(field, drive, part, {ObstacleKind::occupied});
      const std::size_t segments = 1 + random() % 7, segment = random() % (8 - segments);
      Span span{segment, 0.0, 1.0, segments};
      if (segments == 1) span.from = 0.9 * fraction(random), span.to = span.from + 0.1;
      constexpr double within_m = 4.0;
      const double bound_m = probe.swept_bound_m(span, within_m);
      const double least_m = least_within_m(posts, part, drive, span);
      ASSERT_LE(bound_m, std::min(least_m, within_m) + 1e-9)
          << part.name << ", " << segments << " segments";
      told += bound_m > 0.0;
      near += bound_m > least_m - 0.1 && least_m < within_m;
    }
  }
  EXPECT_GT(told, 300);
  EXPECT_GT(near, 50);
}

// Sliding past a post to its left, of which the motion bound would take half the way.
TEST(BodyProbe, SweptBoundOfAStraightPassageIsTheDistance) {
  const OccupancyMap posts = posts_at({{1.75, 3.15}});
  const BodyPart car = geometry::body_of({});
  std::vector<geometry::TrajectoryPoint> rows;
  for (int i = 0; i <= 20; ++i) rows.push_back({.t_s = 0.1 * i, .x_m = 0.1 * i, .y_m = 0.05 * i});
  for (auto& row : rows) row.heading_rad = std::atan2(0.05, 0.1);
  const Trajectory drive(rows);
  const ClearanceField field(posts, map::HeightBand{0.2, 1.5});
  const BodyProbe probe(field, drive, car, {ObstacleKind::occupied});
  double least_m = std::numeric_limits<double>::infinity();
  for (const auto& row : rows) least_m = std::min(least_m, away_m(posts, car, row.pose()));
  const double bound_m = probe.swept_bound_m({0, 0.0, 1.0, 20}, 5.0);
  EXPECT_LE(bound_m, least_m + 1e-9);
  EXPECT_NEAR(bound_m, least_m, 1e-6);
}

TEST(BodyProbe, SaysNothingOfSpansLargerThanTheFieldsBodies) {
  const OccupancyMap posts = posts_at({{20.05, 5.05}});
  const BodyPart car = geometry::body_of({});
  std::vector<geometry::TrajectoryPoint> rows;
  for (int i = 0; i <= 100; ++i) rows.push_back({.t_s = 0.1 * i, .x_m = 0.1 * i});
  const Trajectory drive(rows);
  const ClearanceField field(posts, map::HeightBand{0.2, 1.5},
                             audited_region(drive, {&car, 1}, {}));
  const BodyProbe probe(field, drive, car, {ObstacleKind::occupied});
  EXPECT_EQ(probe.swept_bound_m({0, 0.0, 1.0, 100}, 5.0), 0.0);
  EXPECT_EQ(probe.swept_bound_m({40, 0.0, 1.0, 10}, 5.0), 5.0);
  EXPECT_EQ(probe.swept_bound_m({0, 0.0, 1.0, 4}, 5.0), 5.0);
}

}  // namespace
}  // namespace roadbed::planning
