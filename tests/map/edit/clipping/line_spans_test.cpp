#include "roadbed/map/edit/clipping/line_spans.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "roadbed/geometry/polygons/polygon.h"

namespace roadbed::map {
namespace {

using Eigen::Vector2d;

const Region kBox({geometry::box_ring({0, 0}, {10, 10})});

TEST(LineSpans, EndOnTheEdge) {
  const std::vector<Vector2d> line = {{-5, 5}, {5, 5}, {20, 5}};
  const auto spans = spans_inside(line, kBox);
  ASSERT_EQ(spans.size(), 1u);
  EXPECT_DOUBLE_EQ(spans[0].from, 0.5);
  EXPECT_DOUBLE_EQ(spans[0].to, 1.0 + 1.0 / 3.0);
}

TEST(LineSpans, AreAllPlacesInsideAndNoOther) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-6.0, 16.0);
  for (int i = 0; i < 200; ++i) {
    std::vector<Vector2d> line;
    for (int k = 0; k < 6; ++k) line.emplace_back(place(random), place(random));
    const auto spans = spans_inside(line, kBox);
    for (double at = 0.013; at < 5.0; at += 0.0317) {
      const auto k = static_cast<std::size_t>(at);
      const Vector2d point = line[k] + (at - std::floor(at)) * (line[k + 1] - line[k]);
      bool inside = false;
      for (const LineSpan& span : spans) inside = inside || (span.from <= at && at <= span.to);
      EXPECT_EQ(inside, kBox.contains(point)) << at;
    }
  }
}

TEST(LineSpans, SnapToAPointOnTheEdge) {
  const std::vector<Vector2d> line = {{-5, 5}, {1e-8, 5}, {5, 5}};
  EXPECT_EQ(spans_inside(line, kBox), (std::vector<LineSpan>{{1.0, 2.0}}));
}

TEST(LineSpans, TurnAroundWithTheLine) {
  const std::vector<LineSpan> spans = {{0.0, 1.5}, {2.25, 3.0}};
  EXPECT_EQ(reversed(spans, 4), (std::vector<LineSpan>{{0.0, 0.75}, {1.5, 3.0}}));
  EXPECT_EQ(reversed(reversed(spans, 4), 4), spans);
}

TEST(LineSpans, CorrespondWhereBothGoOutAlike) {
  EXPECT_TRUE(correspond({{0.0, 1.5}}, 4, {{0.0, 7.25}}, 10));
  EXPECT_FALSE(correspond({{0.0, 1.5}}, 4, {{0.0, 9.0}}, 10)) << "one goes on to its end";
  EXPECT_FALSE(correspond({{0.0, 1.5}}, 4, {{0.0, 1.0}, {2.0, 3.5}}, 10)) << "one comes back";
}

}  // namespace
}  // namespace roadbed::map
