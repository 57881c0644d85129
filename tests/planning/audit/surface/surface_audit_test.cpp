#include "roadbed/planning/audit/surface/surface_audit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/load_map.h"
#include "roadbed/planning/audit/check/surface_check.h"
#include "roadbed/planning/audit/swept_drive.h"
#include "roadbed/tests/support/bent_lanes.h"
#include "roadbed/tests/support/random_drive.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::planning {
namespace {

using Eigen::Vector2d;
using geometry::BodyPart;
using geometry::Polygon;
using geometry::Ring;
using geometry::Trajectory;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

const BodyPart kBody = geometry::body_of({});
constexpr double kSeam_m = SurfaceRule{}.seam_m;

std::vector<Polygon> polygons_of(const map::RoadMap& road_map) {
  std::vector<Polygon> polygons;
  for (const map::Lane& lane : road_map.lanes()) {
    if (map::is_drivable(lane.type)) polygons.push_back({lane.polygon, {}});
  }
  return polygons;
}

Polygon box(double x0, double y0, double x1, double y1) {
  return {geometry::box_ring({x0, y0}, {x1, y1}), {}};
}

Trajectory line(const geometry::Pose2& from, const geometry::Pose2& to, double end_s = 10.0) {
  return Trajectory(
      {{.t_s = 0.0, .x_m = from.x_m, .y_m = from.y_m, .heading_rad = from.heading_rad},
       {.t_s = end_s, .x_m = to.x_m, .y_m = to.y_m, .heading_rad = to.heading_rad}});
}

SurfaceReport audited(const std::vector<Polygon>& polygons, const Trajectory& drive,
                      double margin_m = 0.0, const map::RoadMap* road_map = nullptr,
                      const BodyPart& part = kBody) {
  return audit_surface(road_surface(polygons, kSeam_m), drive, {&part, 1}, margin_m, road_map);
}

/// Whether the surface has a point, ring by ring.
bool has(const std::vector<Polygon>& polygons, const Vector2d& point) {
  return std::ranges::any_of(polygons, [&](const Polygon& p) { return contains(p, point); });
}

double ring_distance_m(const Ring& ring, const Vector2d& point) {
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d &a = ring[i], along = ring[(i + 1) % ring.size()] - a;
    const double u = std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least_m = std::min(least_m, (a + u * along - point).norm());
  }
  return least_m;
}

/// How far a point is off the surface, one polygon after the other.
double off_m(const std::vector<Polygon>& polygons, const Vector2d& point) {
  double least_m = std::numeric_limits<double>::infinity();
  for (const Polygon& polygon : polygons) {
    if (contains(polygon, point)) return 0.0;
    least_m = std::min(least_m, ring_distance_m(polygon.outer, point));
  }
  return least_m;
}

/// Points of the body, a few centimetres apart, at moments of a drive a few millimetres apart.
template <typename Visit>
void visit_swept_points(const Trajectory& drive, double apart_m, const Visit& visit) {
  const auto& rows = drive.points();
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
    const double motion_m =
        (rows[i + 1].pose().position() - rows[i].pose().position()).norm() +
        kBody.reach_m() * std::abs(rows[i + 1].heading_rad - rows[i].heading_rad);
    const int steps = 1 + static_cast<int>(motion_m / apart_m);
    for (int step = 0; step <= steps; ++step) {
      const auto pose =
          geometry::interpolate(rows[i], rows[i + 1], static_cast<double>(step) / steps).pose();
      for (int k = 0; k <= 30; ++k) {
        const double x_m = kBody.rear_m + kBody.length_m() * k / 30.0;
        for (const double y_m : {kBody.right_m, 0.0, kBody.left_m})
          visit(pose * Vector2d(x_m, y_m));
      }
      for (int k = 0; k <= 10; ++k) {
        const double y_m = kBody.right_m + kBody.width_m() * k / 10.0;
        for (const double x_m : {kBody.rear_m, kBody.front_m}) visit(pose * Vector2d(x_m, y_m));
      }
    }
  }
}

/// Wide lanes that cross each other: a body stays on them now and then.
map::RoadMap crossing_lanes(std::mt19937& random) {
  tests::MadeMap made;
  const map::RoadId road = made.add_road("1");
  std::uniform_real_distribution<double> place(-15.0, 15.0), angle(-3.2, 3.2), bend(-0.06, 0.06),
      width(4.0, 9.0);
  for (int i = 0; i < 10; ++i) {
    tests::add_arc_lane(made, road, std::to_string(-1 - i),
                        {place(random), place(random), angle(random)}, bend(random), 30.0,
                        width(random));
  }
  return made.build();
}

TEST(SurfaceAudit, IsNeverClearWhereAPointOfTheBodyIsOff) {
  std::mt19937 random(20261125);
  int clear = 0, off = 0, missed = 0;
  for (int map = 0; map < 5; ++map) {
    const map::RoadMap road_map = crossing_lanes(random);
    const std::vector<Polygon> polygons = polygons_of(road_map);
    const RoadSurface surface = road_surface(polygons, kSeam_m);
    for (int i = 0; i < 30; ++i) {
      const Trajectory drive =
          tests::random_drive(random, tests::random_start(random, {0.0, 0.0}, 8.0, 3.2),
                              {.rows = 2, .way_m = 1.5, .turn_rad = 0.5});
      const SurfaceReport report = audit_surface(surface, drive, {&kBody, 1}, 0.0, &road_map);
      double worst_m = 0.0;
      visit_swept_points(drive, 0.08, [&](const Vector2d& point) {
        if (!has(polygons, point)) worst_m = std::max(worst_m, off_m(polygons, point));
      });
      if (report.verdict == Verdict::clear) {
        ++clear;
        ASSERT_EQ(worst_m, 0.0);
      } else if (report.verdict == Verdict::conflict && worst_m > 0.0) {
        ++off;
        double deepest_m = 0.0;
        for (const Excursion& out : report.conflicts) {
          deepest_m = std::max(deepest_m, out.depth_m);
          EXPECT_NEAR(off_m(polygons, out.point_in_source), out.depth_m, 2.5 * kSeam_m);
        }
        EXPECT_NEAR(deepest_m, worst_m, 0.15);
      } else if (worst_m == 0.0) {
        ++missed;  // off by less than what is sampled, or by what closing seams moved
      }
    }
  }
  EXPECT_GT(clear, 15);
  EXPECT_GT(off, 50);
  EXPECT_LT(missed, 8);
}

TEST(SurfaceAudit, CertificatesHoldByBruteForceAndForgedOnesDoNot) {
  std::mt19937 random(3);
  int checked = 0;
  for (int map = 0; map < 6; ++map) {
    const map::RoadMap road_map = crossing_lanes(random);
    const std::vector<Polygon> polygons = polygons_of(road_map);
    const RoadSurface surface = road_surface(polygons, kSeam_m);
    for (int i = 0; i < 20; ++i) {
      const Trajectory drive =
          tests::random_drive(random, tests::random_start(random, {0.0, 0.0}, 8.0, 3.2),
                              {.rows = 3, .way_m = 1.5, .turn_rad = 0.5});
      const SurfaceReport report = audit_surface(surface, drive, {&kBody, 1}, 0.0);
      auto certificate = certify_surface(surface, drive, {&kBody, 1}, 0.0, report).front();
      const auto faults = [&] {
        return check_surface_certificate(certificate, polygons, kSeam_m, 0.0, drive);
      };
      EXPECT_THAT(faults(), IsEmpty());
      if (report.verdict != Verdict::clear) {
        certificate.off.clear();
        EXPECT_THAT(faults(), Not(IsEmpty()));
        continue;
      }
      ++checked;
      if (report.beyond_horizon) continue;
      for (ProvenSpan& span : certificate.from_edge) span.at_least_m = report.least_margin_m + 0.1;
      EXPECT_THAT(faults(), Not(IsEmpty()));
    }
  }
  EXPECT_GT(checked, 10);
}

TEST(SurfaceAudit, ProvesTheLeastMarginBetweenRows) {
  // The front swings out to the left while the body turns on the spot by 60 degrees.
  const std::vector<Polygon> square{box(-6.0, -6.0, 6.0, 6.0)};
  const Trajectory turn = line({1.0, 0.0, -0.5}, {1.0, 0.0, 0.5});
  const SurfaceReport report = audited(square, turn);
  EXPECT_EQ(report.verdict, Verdict::clear);
  double least_m = 1e9;
  visit_swept_points(turn, 0.001, [&](const Vector2d& point) {
    least_m = std::min(least_m, 6.0 - point.cwiseAbs().maxCoeff());
  });
  EXPECT_NEAR(report.least_margin_m, least_m, 0.02);
  EXPECT_LE(report.proven_margin_m, least_m);
  EXPECT_EQ(audited(square, turn, least_m + 0.01).verdict, Verdict::conflict);
  EXPECT_EQ(audited(square, turn, least_m - 0.03).verdict, Verdict::clear);
}

TEST(SurfaceAudit, SeesACornerLeaveBetweenTwoRowsThatAreInside) {
  const double far_m = std::hypot(kBody.front_m, kBody.left_m);  // of the front corners
  const std::vector<Polygon> square{box(-6.0, -6.0, far_m - 0.05, 6.0)};
  const double steep = std::atan2(kBody.left_m, kBody.front_m) + 0.6;
  const SurfaceReport report = audited(square, line({0, 0, -steep}, {0, 0, steep}));
  ASSERT_EQ(report.verdict, Verdict::conflict);
  ASSERT_THAT(report.conflicts, SizeIs(2));  // one front corner after the other
  EXPECT_EQ(report.conflicts[0].part, "front left corner");
  EXPECT_EQ(report.conflicts[1].part, "front right corner");
  for (const Excursion& out : report.conflicts) EXPECT_NEAR(out.depth_m, 0.05, 1e-3);
}

TEST(SurfaceAudit, SeesAHoleBelowTheMiddleOfTheBody) {
  Polygon ground = box(-10.0, -10.0, 30.0, 10.0);
  ground.holes.push_back({{9.9, -0.1}, {9.9, 0.1}, {10.1, 0.1}, {10.1, -0.1}});
  const SurfaceReport report = audited({ground}, line({0, 0, 0}, {20, 0, 0}));
  ASSERT_THAT(report.conflicts, SizeIs(1));
  const Excursion& out = report.conflicts.front();
  // From when the front reaches it until the rear has left it.
  EXPECT_NEAR(out.from_s, 0.5 * (9.9 - kBody.front_m), 0.03);
  EXPECT_NEAR(out.to_s, 0.5 * (10.1 - kBody.rear_m), 0.03);
  EXPECT_EQ(out.onto.kind, BesideSurface::Kind::gap);
  EXPECT_NEAR(out.depth_m, 0.1, 0.03);  // half as wide as the hole
}

TEST(SurfaceAudit, SaysHowFarAndOntoWhatADriveLeaves) {
  tests::MadeMap made = tests::straight_two_lane_road(100.0);
  const auto pavement = [&](double low, double high) {
    return std::pair(std::vector<Vector2d>{{0, high}, {100, high}},
                     std::vector<Vector2d>{{0, low}, {100, low}});
  };
  const auto [left, right] = pavement(-5.5, -3.5);
  made.add_lane(map::RoadId{0}, "-2", left, right, map::LaneType::sidewalk);
  const map::RoadMap road_map = made.build();
  const auto polygons = polygons_of(road_map);
  const double aside_m = -3.5 - 1.0 - kBody.right_m;  // its right side 1 m over the edge
  const SurfaceReport over =
      audited(polygons, line({20, aside_m, 0}, {60, aside_m, 0}), 0.0, &road_map);
  ASSERT_THAT(over.conflicts, SizeIs(1));
  const Excursion& out = over.conflicts.front();
  EXPECT_NEAR(out.depth_m, 1.0, 1e-9);
  EXPECT_EQ(out.from_s, 0.0);
  EXPECT_EQ(out.to_s, 10.0);
  EXPECT_THAT(out.part, testing::HasSubstr("right"));
  EXPECT_EQ(out.onto.kind, BesideSurface::Kind::pavement);
  EXPECT_EQ(out.onto.name, "1/0/-2");
  // Against lane 1/0/1 alone: the lane of the other direction is oncoming.
  const SurfaceRule lanes{.kind = SurfaceRule::Kind::lanes, .road_map = &road_map};
  const Trajectory astray = line({20, -1.75, 0}, {60, -0.5, 0});
  const SurfaceReport across =
      audited(surface_polygons(lanes, astray, kBody.reach_m()), astray, 0.0, &road_map);
  ASSERT_THAT(across.conflicts, SizeIs(1));
  EXPECT_EQ(across.conflicts.front().onto.kind, BesideSurface::Kind::oncoming_lane);
  EXPECT_EQ(audited(polygons, astray).verdict, Verdict::clear);
}

TEST(SurfaceAudit, TakesSeamsForNoHolesAndGapsForHoles) {
  for (const double gap_m : {0.0, 1e-6, 1e-3, 0.05, 0.3}) {
    std::vector<Polygon> tiles;  // across and along
    for (int i = 0; i < 12; ++i) {
      for (int k = -1; k < 1; ++k) {
        tiles.push_back(box(5.0 * i, 4.0 * k, 5.0 * (i + 1) - gap_m, 4.0 * (k + 1) - gap_m));
      }
    }
    const SurfaceReport report = audited(tiles, line({5, 0.7, 0.02}, {50, -0.7, 0.02}));
    EXPECT_EQ(report.verdict, gap_m < kSeam_m ? Verdict::clear : Verdict::conflict) << gap_m;
    if (gap_m <= 1e-6) {
      EXPECT_NEAR(
          report.least_margin_m,
          audited({box(0, -4, 60, 4)}, line({5, 0.7, 0.02}, {50, -0.7, 0.02})).least_margin_m,
          1e-5);
    }
    if (gap_m > kSeam_m) {
      EXPECT_EQ(report.conflicts.front().onto.kind, BesideSurface::Kind::gap);
    }
  }
}

TEST(SurfaceAudit, FarFromAnyEdgeSaysSo) {
  const SurfaceReport report = audited({box(-100, -100, 100, 100)}, line({0, 0, 0}, {10, 0, 0}));
  EXPECT_TRUE(report.beyond_horizon);
  EXPECT_EQ(report.verdict, Verdict::clear);
  EXPECT_EQ(report.proven_margin_m, kSurfaceHorizon_m);
  const SurfaceReport nowhere = audited({}, line({0, 0, 0}, {10, 0, 0}));
  EXPECT_EQ(nowhere.verdict, Verdict::conflict);
}

TEST(SurfaceAudit, OfDrivesAlongLanesOfTown04IsClearUntilTheyAreShiftedOverTheEdge) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  const map::RoadMap town =
      map::load_map(real / "opendrive/BerkeleyLearnVerify+Scenic/Town04.xodr");
  const SurfaceRule rule{.road_map = &town};
  int clear = 0, shifted = 0;
  for (const map::Lane& lane : town.lanes()) {
    constexpr double ends_m = 6.0;  // the body stays within the lane's ends
    if (lane.type != map::LaneType::driving || lane.length_m() < 40.0) continue;
    double narrowest_m = 1e9;
    for (double s_m = 0.0; s_m < lane.length_m(); s_m += 0.5)
      narrowest_m = std::min(narrowest_m, lane.width_m(s_m));
    if (narrowest_m < 3.0) continue;
    const auto along = [&](double offset_m) {
      return swept_along(
          [&](double s_m) {
            const geometry::Pose2 pose = lane.pose_at(ends_m + s_m);
            const Vector2d at = town.to_source(pose.position());
            return geometry::Pose2{at.x(), at.y(), pose.heading_rad};
          },
          std::min(60.0, lane.length_m() - 2.0 * ends_m), {.offset_m = offset_m});
    };
    const Trajectory drive = along(0.0);
    const auto polygons = surface_polygons(rule, drive, kBody.reach_m());
    const SurfaceReport report = audited(polygons, drive, 0.0, &town);
    EXPECT_EQ(report.verdict, Verdict::clear) << lane.name;
    clear += report.verdict == Verdict::clear ? 1 : 0;
    // Held against every lane's own polygon, one after the other.
    const Trajectory over = along(-(0.5 * narrowest_m + 1.0 + kBody.right_m));
    double worst_m = 0.0;
    visit_swept_points(over, 0.5, [&](const Vector2d& point) {
      worst_m = std::max(worst_m, off_m(polygons, point));
    });
    const SurfaceReport beside = audited(polygons, over, 0.0, &town);
    double deepest_m = 0.0;
    for (const Excursion& out : beside.conflicts) deepest_m = std::max(deepest_m, out.depth_m);
    EXPECT_NEAR(deepest_m, worst_m, 0.05) << lane.name;
    shifted += worst_m > 0.5 ? 1 : 0;
    if (clear > 25) break;
  }
  EXPECT_GT(clear, 20);
  EXPECT_GT(shifted, 5);
}

}  // namespace
}  // namespace roadbed::planning
