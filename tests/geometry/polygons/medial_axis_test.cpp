#include "roadbed/geometry/polygons/medial_axis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "roadbed/tests/geometry/polygons/ring_distance.h"

namespace roadbed::geometry {
namespace {

using Eigen::Vector2d;
using testing::SizeIs;

double distance_to_boundary_m(const Polygon& polygon, const Vector2d& point) {
  double least = distance_to_ring_m(polygon.outer, point);
  for (const Ring& hole : polygon.holes) least = std::min(least, distance_to_ring_m(hole, point));
  return least;
}

Polygon rectangle(double length, double width) {
  return {{{0, 0}, {length, 0}, {length, width}, {0, width}}, {}};
}

Ring circle(const Vector2d& centre, double radius, int corners, bool clockwise = false) {
  Ring ring;
  for (int i = 0; i < corners; ++i) {
    const double angle = (clockwise ? -2.0 : 2.0) * M_PI * i / corners;
    ring.emplace_back(centre + radius * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return ring;
}

// A road of the given width along a sine, its sides sampled every metre.
Polygon winding_road(double length, double width) {
  Ring left, right;
  for (double x = 0.0; x <= length; x += 1.0) {
    const Vector2d at(x, 8.0 * std::sin(0.05 * x));
    const Vector2d normal = Vector2d(-0.4 * std::cos(0.05 * x), 1.0).normalized();
    left.emplace_back(at + 0.5 * width * normal);
    right.emplace_back(at - 0.5 * width * normal);
  }
  right.insert(right.end(), left.rbegin(), left.rend());
  return {right, {}};
}

TEST(MedialAxis, OfARectangleIsItsMiddleFromHalfAWidthToHalfAWidth) {
  const auto branches = medial_axis(rectangle(100, 8));
  ASSERT_THAT(branches, SizeIs(1));
  EXPECT_NEAR((branches[0].line.points().front() - Vector2d(4, 4)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((branches[0].line.points().back() - Vector2d(96, 4)).norm(), 0.0, 1e-9);
  for (const double width_m : branches[0].width_m) EXPECT_NEAR(width_m, 8.0, 1e-9);
}

TEST(MedialAxis, FollowsAWindingRoadAndKnowsItsWidth) {
  const auto branches = medial_axis(winding_road(200, 7));
  ASSERT_THAT(branches, SizeIs(1));
  EXPECT_GT(branches[0].line.length_m(), 190.0);
  for (std::size_t i = 0; i < branches[0].width_m.size(); ++i) {
    const Vector2d at = branches[0].line.points()[i];
    if (at.x() < 10.0 || at.x() > 190.0) continue;
    EXPECT_NEAR(branches[0].width_m[i], 7.0, 0.05);
    EXPECT_NEAR(at.y(), 8.0 * std::sin(0.05 * at.x()), 0.05);
  }
}

TEST(MedialAxis, OfARingRoadIsAClosedCircle) {
  const Polygon ring{circle({5, 5}, 20, 90), {circle({5, 5}, 14, 90, true)}};
  const auto branches = medial_axis(ring);
  ASSERT_THAT(branches, SizeIs(1));
  EXPECT_TRUE(branches[0].closed);
  EXPECT_NEAR(branches[0].line.length_m(), 2.0 * M_PI * 17.0, 0.2);
  for (const Vector2d& at : branches[0].line.points()) {
    EXPECT_NEAR((at - Vector2d(5, 5)).norm(), 17.0, 0.02);
  }
}

TEST(MedialAxis, OfACrossroadsHasFourArms) {
  const Polygon cross{{{-4, -50},
                       {4, -50},
                       {4, -4},
                       {50, -4},
                       {50, 4},
                       {4, 4},
                       {4, 50},
                       {-4, 50},
                       {-4, 4},
                       {-50, 4},
                       {-50, -4},
                       {-4, -4}},
                      {}};
  EXPECT_THAT(medial_axis(cross), SizeIs(4));
}

TEST(MedialAxis, ABayShorterThanTheRoadIsWideIsPrunedAndASideRoadIsNot) {
  const auto with_bay = [](double depth) {
    return Polygon{
        {{0, 0}, {100, 0}, {100, 8}, {52, 8}, {52, 8 + depth}, {48, 8 + depth}, {48, 8}, {0, 8}},
        {}};
  };
  EXPECT_THAT(medial_axis(with_bay(3)), SizeIs(1));
  EXPECT_THAT(medial_axis(with_bay(30)), SizeIs(3));
}

TEST(MedialAxis, RunsThroughThePlacesBetweenFourPosts) {
  Polygon field{{{0, 0}, {47, 0}, {47, 47}, {0, 47}}, {}};
  for (int x = 0; x < 5; ++x) {
    for (int y = 0; y < 5; ++y) {
      const Vector2d at(9.0 * x + 3.0, 9.0 * y + 3.0);
      field.holes.push_back({at, at + Vector2d(0, 4), at + Vector2d(4, 4), at + Vector2d(4, 0)});
    }
  }
  const VoronoiGraph graph = interior_voronoi(field);
  int between = 0;  // nearest to corners only
  for (const auto& node : graph.nodes) {
    EXPECT_TRUE(contains(field, node.at)) << node.at.transpose();
    between += std::abs(node.clearance_m - 2.5 * std::sqrt(2.0)) < 1e-6;
  }
  EXPECT_EQ(between, 16);
}

TEST(MedialAxis, EveryPlaceIsHalfItsWidthFromTheBoundary) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> radius(8.0, 20.0);
  for (int round = 0; round < 20; ++round) {
    Polygon star{{}, {circle({1, 0}, 3, 7, true)}};
    for (int i = 0; i < 24; ++i) {
      const double angle = 2.0 * M_PI * i / 24.0;
      star.outer.emplace_back(radius(random) * Vector2d(std::cos(angle), std::sin(angle)));
    }
    const VoronoiGraph graph = interior_voronoi(star);
    EXPECT_GT(graph.nodes.size(), 20U);
    for (const auto& node : graph.nodes) {
      EXPECT_TRUE(contains(star, node.at));
      EXPECT_NEAR(node.clearance_m, distance_to_boundary_m(star, node.at), 1e-7);
    }
    for (const MedialBranch& branch : medial_axis(star, {.max_error_m = 0.001})) {
      for (std::size_t i = 0; i < branch.width_m.size(); ++i) {
        const double clearance_m = distance_to_boundary_m(star, branch.line.points()[i]);
        EXPECT_NEAR(0.5 * branch.width_m[i], clearance_m, 1e-6);
      }
    }
  }
}

TEST(MedialAxis, OfARingRoadBeginsAtTheSamePlaceWhereverItsRingsBegin) {
  const Polygon ring{circle({5, 5}, 20, 90), {circle({5.5, 5.3}, 14, 90, true)}};
  const Polyline first = medial_axis(ring).front().line;
  for (const int turned : {1, 17, 40, 71}) {
    Polygon other = ring;
    std::rotate(other.outer.begin(), other.outer.begin() + turned, other.outer.end());
    std::rotate(other.holes[0].begin(), other.holes[0].begin() + 2 * turned % 90,
                other.holes[0].end());
    const Polyline line = medial_axis(other).front().line;
    ASSERT_EQ(line.points().size(), first.points().size()) << turned;
    for (std::size_t i = 0; i < line.points().size(); ++i) {
      ASSERT_LT((line.points()[i] - first.points()[i]).norm(), 1e-6) << turned << ", point " << i;
    }
  }
}

// Its bisectors all meet in the middle, as near to each other as rounding lets them.
TEST(MedialAxis, OfACircleOfTenThousandCornersIsAPlaceAndNoLine) {
  for (const int corners : {100, 1000, 10'000}) {
    EXPECT_THAT(medial_axis({circle({700, 50}, 100.0, corners), {}}), SizeIs(0));
  }
}

TEST(MedialAxis, OfARoundaboutOfTenThousandCornersIsAClosedCircle) {
  const auto branches =
      medial_axis({circle({0, 0}, 20.0, 5000), {circle({0, 0}, 14.0, 5000, true)}});
  ASSERT_THAT(branches, SizeIs(1));
  EXPECT_TRUE(branches[0].closed);
  EXPECT_NEAR(branches[0].line.length_m(), 2.0 * M_PI * 17.0, 1e-3);
  for (const double width_m : branches[0].width_m) EXPECT_NEAR(width_m, 6.0, 1e-4);
}

TEST(MedialAxis, IsTheSameFromRunToRun) {
  const auto one = medial_axis(winding_road(100, 6)), two = medial_axis(winding_road(100, 6));
  ASSERT_EQ(one.size(), two.size());
  EXPECT_EQ(one[0].line.points(), two[0].line.points());
}

}  // namespace
}  // namespace roadbed::geometry
