#include "roadbed/map/opendrive/write/reference_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "roadbed/map/opendrive/write/clothoid.h"

namespace roadbed::map::opendrive {
namespace {

// Lines, arcs and clothoids behind each other, as gentle and as sharp as roads are, far from (0,
// 0).
std::vector<geometry::PlanPiece> random_line(std::mt19937& random) {
  std::uniform_real_distribution<double> length(0.3, 30.0), curvature(-0.3, 0.3);
  std::vector<geometry::PlanPiece> pieces;
  geometry::Pose2 pose{400.0, -300.0, 1.0};
  double s_m = 0.0;
  for (int i = 0; i < 9; ++i) {
    geometry::PlanCurve curve = geometry::LineCurve{};
    if (i % 3 == 1) curve = geometry::ArcCurve{curvature(random)};
    if (i % 3 == 2) curve = geometry::SpiralCurve{curvature(random), curvature(random)};
    pieces.push_back({s_m, length(random), pose, curve});
    s_m += pieces.back().length_m;
    pose = geometry::plan_point(pieces.back(), s_m).pose;
  }
  return pieces;
}

TEST(ReferenceTable, IsWhereTheCurvesAreThatItIsMadeOf) {
  std::mt19937 random(20261126);
  for (int run = 0; run < 50; ++run) {
    const auto pieces = random_line(random);
    const geometry::PlanView view(pieces);
    const ReferenceTable table(pieces);
    ASSERT_EQ(table.end_s_m(), view.end_s_m());
    std::uniform_real_distribution<double> s(0.0, view.end_s_m());
    for (int i = 0; i < 500; ++i) {
      const double s_m = s(random);
      const geometry::PlanPoint expected = view.at(s_m);
      const ReferenceTable::Point point = table.at(s_m);
      EXPECT_LE((point.in_map - expected.pose.position()).norm(), 1e-8);
      EXPECT_LE((point.along - unit(expected.pose.heading_rad)).norm(), 1e-8);
      EXPECT_NEAR(point.curvature_per_m, expected.curvature_per_m, 1e-12);
      EXPECT_LE((point.beside(2.0) - expected.pose * Eigen::Vector2d(0.0, 2.0)).norm(), 3e-8);
    }
  }
}

TEST(ReferenceTable, MeetsBothEnds) {
  std::mt19937 random(20261127);
  const auto pieces = random_line(random);
  const ReferenceTable table(pieces);
  EXPECT_LE((table.at(0.0).in_map - pieces.front().start.position()).norm(), 1e-8);
  const geometry::PlanPoint end = geometry::plan_point(pieces.back(), table.end_s_m());
  EXPECT_LE((table.at(table.end_s_m()).in_map - end.pose.position()).norm(), 1e-8);
}

TEST(ReferenceTable, KnowsLinesArcsAndClothoidsOnly) {
  const std::vector<geometry::PlanPiece> pieces{{0.0, 1.0, {}, geometry::Poly3Curve{}}};
  EXPECT_THROW(ReferenceTable{pieces}, std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::map::opendrive
