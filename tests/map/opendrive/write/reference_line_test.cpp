#include "roadbed/map/opendrive/write/reference_line.h"

#include <gtest/gtest.h>

#include <cmath>

#include "roadbed/geometry/primitives/angle.h"

namespace roadbed::map::opendrive {
namespace {

struct Curvatures {
  double from_per_m, to_per_m;
};

Curvatures curvatures(const geometry::PlanCurve& curve) {
  if (const auto* arc = std::get_if<geometry::ArcCurve>(&curve)) {
    return {arc->curvature_per_m, arc->curvature_per_m};
  }
  if (const auto* spiral = std::get_if<geometry::SpiralCurve>(&curve)) {
    return {spiral->start_curvature_per_m, spiral->end_curvature_per_m};
  }
  return {0.0, 0.0};
}

// The heading integrated by the midpoint rule.
geometry::Pose2 end_of(const geometry::PlanPiece& piece) {
  constexpr int steps = 4000;
  const Curvatures k = curvatures(piece.curve);
  const double step_m = piece.length_m / steps;
  const auto heading_rad = [&](double s_m) {
    return piece.start.heading_rad +
           s_m * (k.from_per_m + 0.5 * (k.to_per_m - k.from_per_m) * s_m / piece.length_m);
  };
  geometry::Pose2 at = piece.start;
  for (int i = 0; i < steps; ++i) {
    at.x_m += step_m * std::cos(heading_rad(step_m * (i + 0.5)));
    at.y_m += step_m * std::sin(heading_rad(step_m * (i + 0.5)));
  }
  at.heading_rad = heading_rad(piece.length_m);
  return at;
}

void expect_one_line(const ReferenceTarget& target,
                     const std::vector<geometry::PlanPiece>& pieces) {
  ASSERT_FALSE(pieces.empty());
  const auto expect_meets = [](const geometry::Pose2& end, const geometry::Pose2& next) {
    EXPECT_NEAR((end.position() - next.position()).norm(), 0.0, 1e-6);
    EXPECT_NEAR(geometry::wrap_angle(end.heading_rad - next.heading_rad), 0.0, 1e-9);
  };
  const Eigen::Vector2d &first = target.in_map.front(), &last = target.in_map.back();
  expect_meets({first.x(), first.y(), target.start_heading_rad}, pieces.front().start);
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    SCOPED_TRACE(i);
    expect_meets(end_of(pieces[i - 1]), pieces[i].start);
    EXPECT_NEAR(pieces[i].s_m, pieces[i - 1].s_m + pieces[i - 1].length_m, 1e-9);
  }
  expect_meets(end_of(pieces.back()), {last.x(), last.y(), target.end_heading_rad});
}

TEST(ReferenceLines, AreOneLineAlongABend) {
  ReferenceTarget target{.in_map = {}, .start_heading_rad = 0.0, .end_heading_rad = 1.5};
  for (int i = 0; i <= 30; ++i) {
    target.in_map.emplace_back(40.0 * std::sin(0.05 * i), 40.0 * (1.0 - std::cos(0.05 * i)));
  }
  const auto pieces = fit_reference_line(target, 0.7, 0.004);
  expect_one_line(target, pieces);
  EXPECT_LE(pieces.size(), 8U);
}

// As on a border whose first half metre leads back.
TEST(ReferenceLines, AreOneLineWhereTheTargetLeadsBackAtAnEnd) {
  const std::vector<Eigen::Vector2d> hooked{{0.0, 0.0}, {-0.5, 0.05}, {2.0, 0.2}, {8.0, 0.0}};
  const ReferenceTarget at_start{
      .in_map = hooked, .start_heading_rad = 0.0, .end_heading_rad = 0.0, .step_m = 0.08};
  expect_one_line(at_start, fit_reference_line(at_start, 0.02, 0.004));
  const ReferenceTarget at_end{.in_map = {hooked.rbegin(), hooked.rend()},
                               .start_heading_rad = 3.14159,
                               .end_heading_rad = 3.14159,
                               .step_m = 0.08};
  expect_one_line(at_end, fit_reference_line(at_end, 0.02, 0.004));
}

}  // namespace
}  // namespace roadbed::map::opendrive
