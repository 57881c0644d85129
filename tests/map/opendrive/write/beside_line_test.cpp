#include "roadbed/map/opendrive/write/beside_line.h"

#include <gtest/gtest.h>

#include <random>
#include <utility>
#include <vector>

#include "roadbed/map/opendrive/write/clothoid.h"

namespace roadbed::map::opendrive {
namespace {

// A line, a clothoid and an arc to the left of 25 m radius.
geometry::PlanView bend() {
  std::vector<geometry::PlanPiece> pieces{{0.0, 30.0, {5.0, -3.0, 0.4}, geometry::LineCurve{}}};
  const auto add = [&](double length_m, const geometry::PlanCurve& curve) {
    const geometry::PlanPiece& last = pieces.back();
    const double s_m = last.s_m + last.length_m;
    pieces.push_back({s_m, length_m, geometry::plan_point(last, s_m).pose, curve});
  };
  add(20.0, geometry::SpiralCurve{0.0, 0.04});
  add(30.0, geometry::ArcCurve{0.04});
  return geometry::PlanView(pieces);
}

ReferenceTable table(const geometry::PlanView& view) { return ReferenceTable(view.pieces()); }

Eigen::Vector2d place(const geometry::PlanView& view, double s_m, double t_m) {
  return view.at(s_m).pose * Eigen::Vector2d(0.0, t_m);
}

TEST(BesideLine, FindsThePlaceThatAPointWasPutAt) {
  const geometry::PlanView view = bend();
  std::mt19937 random(20261125);
  std::uniform_real_distribution<double> s(0.0, 80.0), t(-15.0, 20.0), off(-3.0, 3.0);
  for (int run = 0; run < 1000; ++run) {
    const double s_m = s(random), t_m = t(random);
    const RoadPosition at = position_beside(table(view), place(view, s_m, t_m), s_m + off(random));
    EXPECT_NEAR(at.s_m, s_m, 1e-6);
    EXPECT_NEAR(at.t_m, t_m, 1e-6);
    EXPECT_NEAR(at.bend, 1.0 - view.at(s_m).curvature_per_m * t_m, 1e-6);
  }
}

TEST(BesideLine, FindsAPlaceOutsideOfATightBendFromBeyondItsEnds) {
  const geometry::PlanView view({{0.0, 2.5, {0.0, 0.0, 0.1}, geometry::ArcCurve{-0.5}}});
  std::mt19937 random(20261129);
  std::uniform_real_distribution<double> s(0.0, 2.5), t(-1.0, 9.0), beyond(0.0, 4.0);
  for (int run = 0; run < 1000; ++run) {
    const double s_m = s(random), t_m = t(random), beyond_m = beyond(random);
    for (const double from_m : {-beyond_m, 2.5 + beyond_m}) {
      const RoadPosition at = position_beside(table(view), place(view, s_m, t_m), from_m);
      EXPECT_NEAR(at.s_m, s_m, 1e-6);
      EXPECT_NEAR(at.t_m, t_m, 1e-6);
    }
  }
}

RoadBorder border_at(const geometry::PlanView& view,
                     const std::vector<std::pair<double, double>>& st) {
  RoadBorder border;
  for (const auto& [s_m, t_m] : st) {
    const Eigen::Vector2d at = place(view, s_m, t_m);
    border.points.emplace_back(at.x(), at.y(), 1.0);
  }
  border.own_to = border.points.size() - 1;
  return border;
}

TEST(BesideLine, ReachesFromEndToEndAndStaysOnTheBorder) {
  const geometry::PlanView view = bend();
  const RoadBorder border = border_at(view, {{-1, 4}, {20, 5}, {41, 6}, {55, 5}, {66, 5}, {81, 4}});
  BesideFaults faults;
  const BesideLine line = line_beside(table(view), border, 0.0, 80.0, faults).line;
  EXPECT_EQ(line.front().s_m, 0.0);
  EXPECT_EQ(line.back().s_m, 80.0);
  for (const BesidePoint& point : line) {
    const Eigen::Vector2d at = place(view, point.s_m, point.t_m);
    double least_m = 1e9;
    for (std::size_t i = 1; i < border.points.size(); ++i) {
      const Eigen::Vector2d a = border.points[i - 1].head<2>(), b = border.points[i].head<2>();
      const double share = std::clamp((at - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
      least_m = std::min(least_m, (a + share * (b - a) - at).norm());
    }
    EXPECT_LT(least_m, 1e-3) << point.s_m;
  }
  EXPECT_EQ(faults.back_m, 0.0);
  EXPECT_NEAR(faults.missing_m, 1.0, 1e-9);  // goes on behind both ends, and nobody has that
}

TEST(BesideLine, MeasuresWhatIsWrongWithABorder) {
  const geometry::PlanView view({{0.0, 50.0, {0.0, 0.0, 0.0}, geometry::LineCurve{}}});
  BesideFaults faults;
  static_cast<void>(line_beside(table(view), border_at(view, {{2, 4}, {30, 4}, {27, 5}, {45, 5}}),
                                0.0, 50.0, faults));
  EXPECT_NEAR(faults.back_m, 3.0, 1e-9);
  EXPECT_NEAR(faults.missing_m, 5.0, 1e-9);
  EXPECT_NEAR(faults.sideways_m, 1.0, 1e-9);
}

TEST(BesideLine, SeesABendShortBesideALongChord) {
  // The reference line sways beside the straight border in the first of 40 m.
  std::vector<geometry::PlanPiece> pieces;
  geometry::Pose2 pose{0.0, 0.0, 0.0};
  double s_m = 0.0;
  for (const auto& [length_m, curvature_per_m] :
       {std::pair{0.25, 0.5}, {0.5, -0.5}, {0.25, 0.5}, {39.0, 0.0}}) {
    pieces.push_back({s_m, length_m, pose, geometry::ArcCurve{curvature_per_m}});
    s_m += length_m;
    pose = geometry::plan_point(pieces.back(), s_m).pose;
  }
  RoadBorder border;
  border.points = {{0.0, 0.0, 0.0}, {pose.x_m, 0.0, 0.0}};
  border.own_to = 1;
  BesideFaults faults;
  const ReferenceTable reference(pieces);
  const BesideLine line = line_beside(reference, border, 0.0, 40.0, faults).line;
  std::size_t hint = 0;
  for (double at_m = 0.01; at_m < 40.0; at_m += 0.01) {
    EXPECT_LT(std::abs(reference.at(at_m).beside(point_at(line, at_m, hint).t_m).y()), 1e-3)
        << at_m;
  }
}

TEST(BesideLine, TellsBetweenWhichStationsThereIsABorder) {
  const geometry::PlanView view({{0.0, 50.0, {0.0, 0.0, 0.0}, geometry::LineCurve{}}});
  const RoadBorder border = border_at(view, {{2, 4}, {30, 4}, {47.5, 5}});
  BesideFaults faults;
  const BesideOptions options{.may_end = {false, true}};
  const PlacedBorder placed = line_beside(table(view), border, 0.0, 50.0, faults, options);
  EXPECT_NEAR(placed.from_m, 2.0, 1e-9);
  EXPECT_NEAR(placed.to_m, 47.5, 1e-9);
  EXPECT_NEAR(faults.missing_m, 2.0, 1e-9);  // at the end it may be missing
}

TEST(BesideLine, EndsWhereTheBorderEndsThoughItGoesOnSideways) {
  // Rounding puts both ends of the border just inside of the road.
  const geometry::PlanView view({{0.0, 0.2, {5.0, -3.0, 0.4}, geometry::LineCurve{}}});
  RoadBorder border = border_at(view, {{-1e-8, 9}, {1e-8, 5}, {0.2 - 1e-8, 5}, {0.2 + 1e-8, -4}});
  border.own_from = 1;
  border.own_to = 2;
  BesideFaults faults;
  const BesideLine line = line_beside(table(view), border, 0.0, 0.2, faults).line;
  for (const BesidePoint& point : line) {
    EXPECT_NEAR(point.t_m, 5.0, 1e-6);
  }
}

}  // namespace
}  // namespace roadbed::map::opendrive
