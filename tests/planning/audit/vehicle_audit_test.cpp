#include "roadbed/planning/audit/vehicle_audit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/audit/check/certificate_check.h"
#include "roadbed/tests/support/part_distance.h"
#include "roadbed/tests/support/random_drive.h"

namespace roadbed::planning {
namespace {

using geometry::BodyPart;
using geometry::Pose2;
using geometry::Trajectory;
using map::OccupancyMap;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr double kCellSide_m = 0.1;

/// A car, its mirrors, a load that hangs over behind, and a round lamp on the roof.
std::vector<BodyPart> car_with_parts() {
  std::vector<BodyPart> parts{geometry::body_of({})};
  parts.push_back({"left mirror", 1.7, 1.9, 0.805, 1.05, 0.0, 0.9, 1.2});
  parts.push_back({"right mirror", 1.7, 1.9, -1.05, -0.805, 0.0, 0.9, 1.2});
  parts.push_back({"load", -2.4, 1.0, -1.2, 1.2, 0.0, 1.5, 2.2});
  parts.push_back({"lamp", 1.2, 1.2, 0.3, 0.3, 0.9, 2.3, 2.8});
  return parts;
}

OccupancyMap posts_at_random(std::mt19937& random, int posts) {
  std::uniform_real_distribution<float> place(-9.0f, 9.0f), height(0.0f, 3.0f);
  map::PointCloud cloud;
  for (int i = 0; i < posts; ++i) {
    cloud.points.emplace_back(place(random), place(random), height(random));
  }
  return OccupancyMap::build(std::vector{cloud}, {.resolution_m = kCellSide_m});
}

Trajectory drive_of_parts(std::mt19937& random) {
  const auto first = tests::random_start(random, {0.0, 0.0}, 6.0, 3.6);
  return tests::random_drive(random, first,
                             {.rows = 1 + random() % 2, .way_m = 3.0, .turn_rad = 1.2});
}

/// Least distance of any part from any cell at its heights, and of which part.
std::pair<double, std::size_t> least_of_parts(const std::vector<BodyPart>& parts, double margin_m,
                                              const std::vector<map::OccupancyCell>& cells,
                                              const Pose2& pose) {
  std::pair<double, std::size_t> least{std::numeric_limits<double>::infinity(), 0};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (const map::OccupancyCell& cell : cells) {
      const double low_m = cell.centre_in_source.z() - 0.5 * cell.size_m;
      if (low_m + cell.size_m <= parts[i].from_height_m + 1e-6) continue;
      if (low_m >= parts[i].to_height_m - 1e-6) continue;
      least = std::min(least, {tests::part_to_cell_m(parts[i], margin_m, pose, cell), i});
    }
  }
  return least;
}

struct AskedOfParts {
  Trajectory drive;
  AuditOptions options;
  VehicleSurroundings around;
  VehicleAudit audit;
};

AskedOfParts ask_parts(const OccupancyMap& occupancy, const std::vector<BodyPart>& parts,
                       std::mt19937& random) {
  std::uniform_real_distribution<double> margin(0.0, 0.4);
  const AuditOptions options{.clearance_m = random() % 2 == 0 ? 0.0 : margin(random),
                             .inflate_m = random() % 2 == 0 ? 0.0 : margin(random),
                             .unknown = UnknownPolicy::free};
  Trajectory drive = drive_of_parts(random);
  VehicleSurroundings around(occupancy, {}, parts, audited_region(drive, parts, options));
  VehicleAudit audit = audit_vehicle(around, drive, options);
  return {std::move(drive), options, std::move(around), std::move(audit)};
}

TEST(VehicleAudit, AgreesWithADenseSweepOfEveryPart) {
  const std::vector<BodyPart> parts = car_with_parts();
  std::mt19937 random(8);
  std::vector<int> conflicts_of(parts.size());
  int clear = 0;
  for (int round = 0; round < 40; ++round) {
    const OccupancyMap occupancy = posts_at_random(random, 25);
    const auto cells = occupancy.cells();
    for (int i = 0; i < 5; ++i) {
      const AskedOfParts made = ask_parts(occupancy, parts, random);
      const AuditReport& whole = made.audit.whole;
      double least_m = std::numeric_limits<double>::infinity();
      const double step_s = 0.004;  // under 3 cm of motion
      for (double t_s = 0.0; t_s <= made.drive.end_s(); t_s += step_s) {
        const auto [distance_m, part] =
            least_of_parts(parts, made.options.inflate_m, cells, made.drive.at(t_s).pose());
        least_m = std::min(least_m, distance_m);
        if (distance_m > 0.0 && distance_m >= made.options.clearance_m) continue;
        ASSERT_EQ(whole.verdict, Verdict::conflict);
        const std::string& name = parts[part].name;
        ASSERT_TRUE(std::ranges::any_of(whole.conflicts,
                                        [&](const Conflict& conflict) {
                                          return conflict.part.starts_with(name) &&
                                                 conflict.from_s <= t_s + 1e-12 &&
                                                 t_s <= conflict.to_s + 1e-12;
                                        }))
            << name << " at " << t_s << " s is in no conflict";
        ++conflicts_of[part];
      }
      const double horizon_m = made.around.field_of(0).horizon_m();
      ASSERT_LE(whole.proven_clearance_m, least_m + 1e-6);
      ASSERT_NEAR(whole.least_clearance_m, std::min(least_m, horizon_m), 0.04);
      ASSERT_NEAR(least_of_parts(parts, made.options.inflate_m, cells,
                                 made.drive.at(whole.least_clearance_at_s).pose())
                      .first,
                  whole.least_clearance_m, 1e-6);
      clear += whole.verdict == Verdict::clear;
    }
  }
  for (const int count : conflicts_of) EXPECT_GT(count, 5);
  EXPECT_GT(clear, 20);
}

TEST(VehicleAudit, CertificatesOfAllPartsHoldAndNoneSurvivesAnObstacleAtItsHeight) {
  const std::vector<BodyPart> parts = car_with_parts();
  std::mt19937 random(9);
  int refuted = 0;
  for (int round = 0; round < 40; ++round) {
    const OccupancyMap occupancy = posts_at_random(random, 5);
    const AskedOfParts made = ask_parts(occupancy, parts, random);
    const auto certificates = certify_vehicle(made.around, made.drive, made.options, made.audit);
    auto cells = occupancy.cells();
    for (std::size_t i = 0; i < parts.size(); ++i) {
      EXPECT_THAT(check_certificate(certificates[i], cells, kCellSide_m, made.drive), IsEmpty())
          << parts[i].name;
    }
    if (!made.audit.whole.conflicts.empty() || !made.audit.whole.undecided.empty()) continue;
    // In the middle of the part, a third of the way: within its heights, between those of others.
    const std::size_t part = random() % parts.size();
    const Pose2 pose = made.drive.at(0.33 * made.drive.end_s()).pose();
    const Eigen::Vector2d there = pose * parts[part].middle_in_vehicle();
    const double height_m = 0.5 * (parts[part].from_height_m + parts[part].to_height_m);
    cells.push_back({{there.x(), there.y(), height_m}, kCellSide_m, map::CellState::occupied});
    EXPECT_THAT(check_certificate(certificates[part], cells, kCellSide_m, made.drive),
                Not(IsEmpty()))
        << parts[part].name;
    ++refuted;
  }
  EXPECT_GT(refuted, 5);
}

TEST(VehicleAudit, OfOnePartIsTheAuditOfTheVehiclesRectangle) {
  std::mt19937 random(10);
  const std::vector<BodyPart> body{geometry::body_of({})};
  for (int round = 0; round < 20; ++round) {
    const OccupancyMap occupancy = posts_at_random(random, 12);
    const AskedOfParts made = ask_parts(occupancy, body, random);
    const map::ClearanceField field(occupancy, {0.2, 1.5},
                                    audited_region(made.drive, body, made.options));
    const AuditReport plain =
        audit_clearance(field, made.drive, geometry::VehicleShape{}, made.options);
    EXPECT_EQ(made.audit.whole.verdict, plain.verdict);
    EXPECT_EQ(made.audit.whole.least_clearance_m, plain.least_clearance_m);
    EXPECT_EQ(made.audit.whole.part, plain.part);
    EXPECT_EQ(made.audit.whole.conflicts.size(), plain.conflicts.size());
  }
}

TEST(VehicleAudit, EachPartKeepsItsDistanceFromWhatMoves) {
  const std::vector<BodyPart> parts = car_with_parts();
  const OccupancyMap far_away = [] {
    map::PointCloud cloud;
    cloud.points.emplace_back(500.0f, 500.0f, 1.0f);
    return OccupancyMap::build(std::vector{cloud}, {.resolution_m = kCellSide_m});
  }();
  // A bicycle of 1.8 m by 0.6 m rides 1.4 m to the left of the car's axis: 0.05 m off the mirror.
  const auto along = [](double y_m, double from_m, double to_m) {
    return Trajectory({{.t_s = 0, .x_m = from_m, .y_m = y_m}, {.t_s = 4, .x_m = to_m, .y_m = y_m}});
  };
  const std::vector<ObstacleInSource> moving{
      {.id = "bicycle", .length_m = 1.8, .width_m = 0.6, .motion = along(1.4, 30.0, 40.0)}};
  const AuditOptions options{.unknown = UnknownPolicy::free};
  const Trajectory drive = along(0.0, 0.0, 60.0);
  const VehicleSurroundings around(far_away, {}, parts, audited_region(drive, parts, options));
  const VehicleAudit audit = audit_vehicle(around, drive, options, moving);
  EXPECT_EQ(audit.whole.verdict, Verdict::conflict);  // the load reaches to 1.2 m
  EXPECT_NEAR(audit.of_parts[1].least_clearance_m, 0.05, 0.02);
  EXPECT_NEAR(audit.of_parts[2].least_clearance_m, 1.1 + 0.805, 0.02);
  EXPECT_NEAR(audit.of_parts[3].least_clearance_m, 0.0, 1e-9);
}

/// Counts how often each place is asked for.
class CountedOccupancy : public map::OccupancySource {
 public:
  explicit CountedOccupancy(const OccupancyMap& occupancy) : occupancy_(occupancy) {}

  double resolution_m() const override { return occupancy_.resolution_m(); }
  const Eigen::Vector3d& origin_in_source() const override { return occupancy_.origin_in_source(); }
  const std::string& crs() const override { return occupancy_.crs(); }
  std::optional<map::SeeThroughRemoval> seen_through() const override { return std::nullopt; }
  std::optional<map::Box3> bounds() const override { return occupancy_.bounds(); }
  void for_each_cell(const UseCell& use) const override { occupancy_.for_each_cell(use); }
  void for_each_in(const map::Box3& box, const UseCell& use) const override {
    ++times_[{box.min_in_source.x(), box.min_in_source.y()}];
    occupancy_.for_each_in(box, use);
  }

  const std::map<std::pair<double, double>, int>& times() const { return times_; }

 private:
  const OccupancyMap& occupancy_;
  mutable std::map<std::pair<double, double>, int> times_;
};

TEST(VehicleAudit, ReadsEachPlaceOfALongDriveTwiceForAllPartsOfOneHeight) {
  map::PointCloud cloud;
  for (float x_m = 0.0f; x_m < 1500.0f; x_m += 5.0f) cloud.points.emplace_back(x_m, 4.0f, 1.0f);
  const OccupancyMap posts = OccupancyMap::build(std::vector{cloud}, {.resolution_m = 0.4});
  const CountedOccupancy counted(posts);
  std::vector<BodyPart> parts{geometry::body_of({})};
  for (int i = 0; i < 4; ++i) parts.push_back({"rail", 0.1 * i, 2.0, -1.0, 1.0, 0.0, 0.3, 1.5});
  parts.front().from_height_m = 0.3;
  parts.front().to_height_m = 1.5;
  std::vector<geometry::TrajectoryPoint> rows;
  for (int i = 0; i <= 14'000; ++i) rows.push_back({.t_s = 0.01 * i, .x_m = 20.0 + 0.1 * i});
  const Trajectory drive(rows);
  const AuditOptions options{};  // unknown space is reported
  map::FieldRegion region = audited_region(drive, parts, options);
  region.tile_m = 40.0;
  region.most_cells = 1'000'000;  // a few tiles
  const VehicleSurroundings around(counted, {}, parts, region);
  EXPECT_EQ(audit_vehicle(around, drive, options).whole.conflicts.size(), 0u);
  std::size_t reads = 0;
  for (const auto& [place, times] : counted.times()) reads += static_cast<std::size_t>(times);
  const std::size_t places = counted.times().size();
  EXPECT_GT(places, 30u);
  EXPECT_LE(reads, 2 * places + parts.size());  // glances, the audit, and where each part begins
}

}  // namespace
}  // namespace roadbed::planning
