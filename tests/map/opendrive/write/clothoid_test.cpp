#include "roadbed/map/opendrive/write/clothoid.h"

#include <gtest/gtest.h>

#include <random>

namespace roadbed::map::opendrive {
namespace {

TEST(Clothoid, LeadsFromPoseToPose) {
  std::mt19937 random(20261125);
  std::uniform_real_distribution<double> place(-100.0, 100.0), turn(-1.0, 1.0);
  int made = 0;
  for (int run = 0; run < 1000; ++run) {
    const geometry::Pose2 from{place(random), place(random), 3.0 * turn(random)};
    const double along_rad = from.heading_rad + turn(random);
    const Eigen::Vector2d to_place =
        from.position() + (1.0 + std::abs(place(random))) * unit(along_rad);
    const geometry::Pose2 to{to_place.x(), to_place.y(), along_rad + turn(random)};
    const auto piece = clothoid_between(from, to, 5.0);
    if (!piece) continue;
    ++made;
    const geometry::Pose2 end = geometry::plan_point(*piece, 5.0 + piece->length_m).pose;
    EXPECT_NEAR((end.position() - to.position()).norm(), 0.0, 1e-8);
    EXPECT_NEAR(std::remainder(end.heading_rad - to.heading_rad, 2.0 * M_PI), 0.0, 1e-9);
  }
  EXPECT_GT(made, 950);
}

TEST(Clothoid, OfAnArcIsThatArc) {
  const geometry::PlanPiece arc{0.0, 30.0, {1.0, 2.0, 0.5}, geometry::ArcCurve{0.02}};
  const auto piece = clothoid_between(arc.start, geometry::plan_point(arc, 30.0).pose, 0.0);
  ASSERT_TRUE(piece);
  EXPECT_NEAR(piece->length_m, 30.0, 1e-9);
  const auto* found = std::get_if<geometry::ArcCurve>(&piece->curve);
  ASSERT_NE(found, nullptr);
  EXPECT_NEAR(found->curvature_per_m, 0.02, 1e-12);
}

TEST(Clothoid, OfALineIsThatLine) {
  const auto piece = clothoid_between({0, 0, 0.25}, {std::cos(0.25), std::sin(0.25), 0.25}, 0.0);
  ASSERT_TRUE(piece);
  EXPECT_TRUE(std::holds_alternative<geometry::LineCurve>(piece->curve));
}

TEST(Clothoid, DoesNotTurnBack) {
  EXPECT_FALSE(clothoid_between({0, 0, 0}, {10, 0, 2.0}, 0.0));
  EXPECT_FALSE(clothoid_between({3, 4, 0}, {3, 4, 0}, 0.0));
}

}  // namespace
}  // namespace roadbed::map::opendrive
