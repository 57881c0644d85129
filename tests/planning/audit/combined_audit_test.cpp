#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/audit/check/certificate_check.h"
#include "roadbed/planning/audit/vehicle_audit.h"
#include "roadbed/tests/support/brute_force_distance.h"
#include "roadbed/tests/support/random_drive.h"

namespace roadbed::planning {
namespace {

using geometry::BodyPart;
using geometry::Pose2;
using geometry::Trajectory;
using map::OccupancyMap;
using testing::IsEmpty;
using tests::Quad;

constexpr double kGrid_m = 0.4;
constexpr int kColumns = 40;  // a side, around the origin
constexpr double kEdge_m = 0.5 * kColumns * kGrid_m;

/// A short car, a load that hangs over on one side, and a round lamp, each at its own heights.
std::vector<BodyPart> short_car() {
  return {{"body", -0.6, 2.4, -0.7, 0.7, 0.0, 0.25, 1.3},
          {"load", -1.3, 0.8, -0.4, 1.1, 0.0, 1.3, 1.9},
          {"lamp", 1.9, 1.9, -0.3, -0.3, 0.6, 1.5, 2.3}};
}

double middle_of_column(int column) { return (column + 0.5) * kGrid_m - kEdge_m; }

/// Ground that rays from above reach nearly everywhere, and posts. Some columns no ray goes
/// through, some only in part.
OccupancyMap world_with_gaps(std::mt19937& random) {
  std::uniform_real_distribution<double> height(0.0, 3.0), fraction(0.0, 1.0);
  map::PointCloud cloud;
  const auto shoot = [&](double x, double y, double from_z, double to_z, bool has_ray) {
    std::optional<Eigen::Vector3d> sensor;
    if (has_ray) sensor = Eigen::Vector3d(x, y, from_z);
    cloud.scans.push_back({cloud.points.size(), sensor});
    cloud.points.push_back(Eigen::Vector3d(x, y, to_z).cast<float>());
  };
  for (int i = 0; i < kColumns * kColumns; ++i) {
    const double x = middle_of_column(i % kColumns), y = middle_of_column(i / kColumns);
    const double what = fraction(random);
    if (what > 0.02) shoot(x, y, what < 0.03 ? height(random) : 4.5, -1.5, true);
    if (fraction(random) < 0.01) shoot(x, y, 0.0, height(random), false);
  }
  return OccupancyMap::build(std::vector{cloud}, {.resolution_m = kGrid_m});
}

Trajectory drive_in_the_middle(std::mt19937& random) {
  const auto first = tests::random_start(random, {0.0, 0.0}, 3.0, 3.6);
  return tests::random_drive(random, first,
                             {.rows = 1 + random() % 2, .way_m = 2.0, .turn_rad = 1.2});
}

/// Level, at another height, or of planes that lean; the latter two with a margin at times.
GroundUnder random_ground(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-6.0, 6.0), height(-0.4, 0.4), lean(-0.06, 0.06);
  GroundUnder under{.margin_m = random() % 2 == 0 ? 0.0 : 0.15};
  if (random() % 3 == 0) under.level_m = height(random);
  if (random() % 3 == 0) return under;
  std::vector<map::GroundPlace> places;
  for (int i = 0; i < 4; ++i) {
    places.push_back(
        {{place(random), place(random)}, height(random), {lean(random), lean(random)}});
  }
  under.surface = std::make_shared<const map::Ground>(places);
  return under;
}

// The nearest place's plane, looked for one after the other.
double plain_ground_m(const GroundUnder& under, const Eigen::Vector2d& at) {
  if (!under.surface) return under.level_m;
  const auto& places = under.surface->places();
  const auto nearest = std::ranges::min_element(
      places, {}, [&](const map::GroundPlace& place) { return (place.in_source - at).norm(); });
  return nearest->z_m + nearest->slope.dot(at - nearest->in_source);
}

/// What a part may meet at its heights: boxes of one column, or larger.
struct Around {
  std::vector<Quad> occupied, unknown;
};

// Column by column, from every leaf over it.
Around around_of(const std::vector<map::OccupancyCell>& leaves, const BodyPart& part,
                 const GroundUnder& under) {
  Around around;
  const double band_m = part.to_height_m - part.from_height_m + 2.0 * under.margin_m;
  std::vector<double> measured_m(kColumns * kColumns);
  std::vector<bool> is_hit(kColumns * kColumns);
  for (const map::OccupancyCell& leaf : leaves) {
    const auto side = std::llround(leaf.size_m / kGrid_m);
    const auto first = [&](double centre_m) {
      return std::llround((centre_m - 0.5 * leaf.size_m + kEdge_m) / kGrid_m);
    };
    for (auto k = side * side; k-- > 0;) {
      const auto x = first(leaf.centre_in_source.x()) + k % side;
      const auto y = first(leaf.centre_in_source.y()) + k / side;
      if (x < 0 || y < 0 || x >= kColumns || y >= kColumns) continue;
      const auto i = y * kColumns + x;
      const Eigen::Vector2d at(middle_of_column(static_cast<int>(x)),
                               middle_of_column(static_cast<int>(y)));
      const double from_m = plain_ground_m(under, at) + part.from_height_m - under.margin_m;
      const double low_m = leaf.centre_in_source.z() - 0.5 * leaf.size_m;
      const double overlap_m =
          std::min(low_m + leaf.size_m, from_m + band_m) - std::max(low_m, from_m);
      if (overlap_m <= 1e-6) continue;
      const auto at_i = static_cast<std::size_t>(i);
      measured_m[at_i] += overlap_m;
      if (leaf.state == map::CellState::occupied) is_hit[at_i] = true;
    }
  }
  for (int i = 0; i < kColumns * kColumns; ++i) {
    const Eigen::Array2d at(middle_of_column(i % kColumns), middle_of_column(i / kColumns));
    const Quad box = tests::box_quad(at - 0.5 * kGrid_m, at + 0.5 * kGrid_m);
    const auto at_i = static_cast<std::size_t>(i);
    if (is_hit[at_i]) {
      around.occupied.push_back(box);
    } else if (measured_m[at_i] < band_m - 1e-4) {
      around.unknown.push_back(box);
    }
  }
  constexpr double far_m = 100.0;
  around.unknown.push_back(tests::box_quad({-far_m, -far_m}, {-kEdge_m, far_m}));
  around.unknown.push_back(tests::box_quad({kEdge_m, -far_m}, {far_m, far_m}));
  around.unknown.push_back(tests::box_quad({-far_m, -far_m}, {far_m, -kEdge_m}));
  around.unknown.push_back(tests::box_quad({-far_m, kEdge_m}, {far_m, far_m}));
  return around;
}

double from_box_m(const Eigen::Vector2d& point, const Quad& box) {
  const Eigen::Array2d least = box[0].cwiseMin(box[2]), most = box[0].cwiseMax(box[2]);
  return (least - point.array()).max(point.array() - most).max(0.0).matrix().norm();
}

double away_from_m(const BodyPart& part, const Pose2& pose, double margin_m,
                   const std::vector<Quad>& boxes) {
  double least_m = std::numeric_limits<double>::infinity();
  if (part.radius_m > 0.0) {
    const Eigen::Vector2d middle = pose * Eigen::Vector2d(part.front_m, part.left_m);
    for (const Quad& box : boxes) least_m = std::min(least_m, from_box_m(middle, box));
    return std::max(0.0, least_m - part.radius_m - margin_m);
  }
  const double rear = part.rear_m - margin_m, front = part.front_m + margin_m;
  const double right = part.right_m - margin_m, left = part.left_m + margin_m;
  const Quad body{pose * Eigen::Vector2d(rear, right), pose * Eigen::Vector2d(front, right),
                  pose * Eigen::Vector2d(front, left), pose * Eigen::Vector2d(rear, left)};
  for (const Quad& box : boxes) least_m = std::min(least_m, tests::quad_distance(box, body));
  return least_m;
}

/// Least distances of any part at a time.
struct Least {
  double occupied_m = std::numeric_limits<double>::infinity();
  double unknown_m = std::numeric_limits<double>::infinity();
};

Least least_at(const std::vector<BodyPart>& parts, const std::vector<Around>& around,
               const Pose2& pose, double margin_m) {
  Least least;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    least.occupied_m =
        std::min(least.occupied_m, away_from_m(parts[i], pose, margin_m, around[i].occupied));
    least.unknown_m =
        std::min(least.unknown_m, away_from_m(parts[i], pose, margin_m, around[i].unknown));
  }
  return least;
}

template <typename Stretches>
bool is_in_one(const Stretches& stretches, double t_s) {
  return std::ranges::any_of(stretches, [&](const auto& stretch) {
    return stretch.from_s <= t_s + 1e-12 && t_s <= stretch.to_s + 1e-12;
  });
}

struct Case {
  std::vector<BodyPart> parts = short_car();
  std::vector<Around> around;
  Trajectory drive;
  AuditOptions options;
  AuditReport report;
};

// Every time that is too near is in a stretch that says so, and figures are those of the sweep.
void expect_as_swept(const Case& made) {
  const bool counts = made.options.unknown == UnknownPolicy::occupied;
  const bool reports = made.options.unknown == UnknownPolicy::report;
  const auto is_near = [&](double away_m) {
    return away_m == 0.0 || away_m < made.options.clearance_m;
  };
  double least_m = std::numeric_limits<double>::infinity(), least_unknown_m = least_m;
  const double step_s = 0.01;  // under 6 cm of motion
  for (double t_s = 0.0; t_s <= made.drive.end_s(); t_s += step_s) {
    const Least least =
        least_at(made.parts, made.around, made.drive.at(t_s).pose(), made.options.inflate_m);
    const double away_m = counts ? std::min(least.occupied_m, least.unknown_m) : least.occupied_m;
    least_m = std::min(least_m, away_m);
    least_unknown_m = std::min(least_unknown_m, least.unknown_m);
    if (is_near(away_m)) {
      ASSERT_EQ(made.report.verdict, Verdict::conflict);
      ASSERT_TRUE(is_in_one(made.report.conflicts, t_s)) << t_s << " s is in no conflict";
    }
    if (reports && is_near(least.unknown_m)) {
      ASSERT_NE(made.report.verdict, Verdict::clear);
      ASSERT_TRUE(is_in_one(made.report.unknown, t_s)) << t_s << " s is in no unknown stretch";
    }
  }
  const double motion_m = 0.03;
  ASSERT_LE(made.report.proven_clearance_m, least_m + 1e-6);
  if (made.report.witness) {
    ASSERT_LE(made.report.least_clearance_m, least_m + 0.02 + 1e-6);
    ASSERT_GE(made.report.least_clearance_m, least_m - motion_m - 1e-6);
  }
  const double clear_from_m = made.options.clearance_m + motion_m + 3e-3;
  if (least_m > clear_from_m && (!reports || least_unknown_m > clear_from_m)) {
    ASSERT_EQ(made.report.verdict, Verdict::clear);
  }
}

class CombinedAudit : public testing::TestWithParam<double> {};

TEST_P(CombinedAudit, OfPartsOverAnyGroundAndUnknownSpaceAgreesWithADenseSweep) {
  std::mt19937 random(static_cast<unsigned>(31 + 10.0 * GetParam()));
  std::uniform_real_distribution<double> margin(0.0, 0.3);
  int verdicts[4] = {};
  for (int round = 0; round < 14; ++round) {
    const OccupancyMap occupancy = world_with_gaps(random);
    const auto leaves = occupancy.cells();
    const GroundUnder under = random_ground(random);
    Case made;
    for (const BodyPart& part : made.parts) made.around.push_back(around_of(leaves, part, under));
    for (int i = 0; i < 6; ++i) {
      made.drive = drive_in_the_middle(random);
      made.options = {.clearance_m = i % 2 == 0 ? 0.0 : margin(random),
                      .inflate_m = random() % 2 == 0 ? 0.0 : margin(random),
                      .unknown = static_cast<UnknownPolicy>(i % 3)};
      map::FieldRegion region = audited_region(made.drive, made.parts, made.options);
      region.horizon_m = 6.0;
      region.tile_m = GetParam();
      const VehicleSurroundings around(occupancy, under, made.parts, region);
      const VehicleAudit audit = audit_vehicle(around, made.drive, made.options);
      made.report = audit.whole;
      ASSERT_NO_FATAL_FAILURE(expect_as_swept(made)) << "round " << round << ", drive " << i;
      for (const auto& certificate : certify_vehicle(around, made.drive, made.options, audit)) {
        ASSERT_THAT(check_certificate(certificate, leaves, kGrid_m, made.drive), IsEmpty());
      }
      ++verdicts[static_cast<std::size_t>(audit.whole.verdict)];
    }
  }
  EXPECT_GT(verdicts[static_cast<std::size_t>(Verdict::clear)], 3);
  EXPECT_GT(verdicts[static_cast<std::size_t>(Verdict::conflict)], 10);
  EXPECT_GT(verdicts[static_cast<std::size_t>(Verdict::unknown)], 3);
}

INSTANTIATE_TEST_SUITE_P(Tiles, CombinedAudit, testing::Values(0.0, 1.0, 5.0));

TEST(CircleAudit, OfOneLargerThanTheUsualHorizonKeepsItsDistance) {
  map::PointCloud cloud;
  cloud.points.emplace_back(0.0f, 70.0f, 0.75f);
  const OccupancyMap occupancy = OccupancyMap::build(std::vector{cloud}, {.resolution_m = 0.5});
  const AuditOptions options{.unknown = UnknownPolicy::free};
  const Trajectory drive({{.t_s = 0, .x_m = -10.0}, {.t_s = 4, .x_m = 10.0}});
  for (const auto& [radius_m, verdict] :
       {std::pair(69.0, Verdict::clear), std::pair(71.0, Verdict::conflict)}) {
    const std::vector<BodyPart> disc{
        {.name = "disc", .radius_m = radius_m, .from_height_m = 0.2, .to_height_m = 1.5}};
    const VehicleSurroundings around(occupancy, {}, disc, audited_region(drive, disc, options));
    const AuditReport report = audit_vehicle(around, drive, options).whole;
    EXPECT_EQ(report.verdict, verdict);
    EXPECT_NEAR(report.least_clearance_m, std::max(0.0, 70.0 - radius_m), 0.02);
  }
  const std::vector<BodyPart> too_large{
      {.name = "disc", .radius_m = 1000.0, .from_height_m = 0.2, .to_height_m = 1.5}};
  const VehicleSurroundings around(occupancy, {}, too_large,
                                   audited_region(drive, too_large, options));
  EXPECT_THROW(audit_vehicle(around, drive, options), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::planning
