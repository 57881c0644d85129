#include "roadbed/geometry/polygons/polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "roadbed/geometry/polygons/ring.h"
#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/geometry/primitives/work_limit.h"

namespace roadbed::geometry {
namespace {

using Eigen::Vector2d;

const Ring kSquare = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
const Ring kBowTie = {{0, 0}, {4, 4}, {4, 0}, {0, 4}};

Ring box(double x, double y, double width, double height) {
  return {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
}

/// Oracle: turns of the ring around the point, from summed angles.
int turns_around(const Ring& ring, const Vector2d& point) {
  double angle_rad = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d a = ring[i] - point, b = ring[(i + 1) % ring.size()] - point;
    angle_rad += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  }
  return static_cast<int>(std::lround(angle_rad / (2.0 * std::numbers::pi)));
}

/// Oracle: edges of rings with small whole coordinates meet, by exact 64-bit integers.
bool edges_meet(const Ring& ring, std::size_t i, std::size_t j) {
  using Whole = long long;
  const auto at = [&](std::size_t k) { return ring[k % ring.size()]; };
  const auto side = [](const Vector2d& a, const Vector2d& b, const Vector2d& c) {
    const Whole cross =
        Whole(b.x() - a.x()) * Whole(c.y() - a.y()) - Whole(b.y() - a.y()) * Whole(c.x() - a.x());
    return cross > 0 ? 1 : cross < 0 ? -1 : 0;
  };
  const auto covers = [&](const Vector2d& a, const Vector2d& b, const Vector2d& c) {
    return side(a, b, c) == 0 && (c.array() >= a.cwiseMin(b).array()).all() &&
           (c.array() <= a.cwiseMax(b).array()).all();
  };
  const Vector2d a = at(i), b = at(i + 1), c = at(j), d = at(j + 1);
  if (j == i + 1) return covers(a, b, d) || covers(c, d, a);
  if (i == 0 && j + 1 == ring.size()) return covers(a, b, c) || covers(c, d, b);
  if (side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0) return true;
  return covers(a, b, c) || covers(a, b, d) || covers(c, d, a) || covers(c, d, b);
}

bool is_simple_by_pairs(const Ring& ring) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    for (std::size_t j = i + 1; j < ring.size(); ++j) {
      if (edges_meet(ring, i, j)) return false;
    }
  }
  return true;
}

Ring random_whole_ring(std::mt19937& random, int corners, int size) {
  std::uniform_int_distribution<int> coordinate(0, size);
  Ring ring;
  while (static_cast<int>(ring.size()) < corners) {
    const Vector2d point(coordinate(random), coordinate(random));
    if (ring.empty() || (point != ring.back() && point != ring.front())) ring.push_back(point);
  }
  return ring;
}

Vector2d random_point(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> coordinate(-0.1 * size, 1.1 * size);
  return {coordinate(random), coordinate(random)};
}

bool any_contains(const std::vector<Polygon>& polygons, const Vector2d& point) {
  return std::any_of(polygons.begin(), polygons.end(),
                     [&](const Polygon& polygon) { return contains(polygon, point); });
}

double total_area_m2(const std::vector<Polygon>& polygons) {
  double sum_m2 = 0.0;
  for (const Polygon& polygon : polygons) sum_m2 += area_m2(polygon);
  return sum_m2;
}

void expect_valid(const std::vector<Polygon>& polygons) {
  for (const Polygon& polygon : polygons) {
    EXPECT_TRUE(is_simple(polygon.outer));
    EXPECT_GT(signed_area_m2(polygon.outer), 0.0);
    for (const Ring& hole : polygon.holes) {
      EXPECT_TRUE(is_simple(hole));
      EXPECT_LT(signed_area_m2(hole), 0.0);
      for (const Vector2d& point : hole) EXPECT_TRUE(contains(polygon.outer, point));
    }
  }
}

TEST(RingArea, IsPositiveCounterClockwiseAndNegativeClockwise) {
  EXPECT_DOUBLE_EQ(signed_area_m2(kSquare), 16.0);
  EXPECT_DOUBLE_EQ(signed_area_m2(Ring(kSquare.rbegin(), kSquare.rend())), -16.0);
  EXPECT_DOUBLE_EQ(signed_area_m2({}), 0.0);
}

TEST(RingArea, KeepsMillimetresAtUtmMagnitude) {
  Ring ring = box(0, 0, 1e-3, 1e-3);
  for (Vector2d& point : ring) point += Vector2d(691000.0, 5335000.0);
  EXPECT_NEAR(signed_area_m2(ring), 1e-6, 2e-12);  // coordinates there are 9e-10 m apart
}

TEST(PolygonArea, LeavesHolesOut) {
  EXPECT_DOUBLE_EQ(area_m2({kSquare, {{{1, 1}, {1, 2}, {2, 2}, {2, 1}}}}), 15.0);
}

TEST(RingPerimeter, ClosesTheRing) { EXPECT_DOUBLE_EQ(perimeter_m(kSquare), 16.0); }

TEST(Contains, CountsTheBoundaryAsInside) {
  for (const Vector2d& point : {Vector2d(0, 0), Vector2d(2, 0), Vector2d(4, 1.5), Vector2d(0, 4)}) {
    EXPECT_TRUE(contains(kSquare, point));
  }
  EXPECT_FALSE(contains(kSquare, Vector2d(std::nextafter(4.0, 5.0), 1.0)));
  EXPECT_FALSE(contains(kSquare, Vector2d(5, 0)));  // beside a horizontal edge
  EXPECT_FALSE(contains(kSquare, Vector2d(-1, 4)));
}

TEST(Contains, LeavesTheInsideOfAHoleOutButNotItsEdge) {
  const Polygon polygon{kSquare, {{{1, 1}, {1, 2}, {2, 2}, {2, 1}}}};
  EXPECT_FALSE(contains(polygon, Vector2d(1.5, 1.5)));
  EXPECT_TRUE(contains(polygon, Vector2d(1.0, 1.5)));
  EXPECT_TRUE(contains(polygon, Vector2d(3.0, 3.0)));
  EXPECT_FALSE(contains(polygon, Vector2d(5.0, 3.0)));
}

TEST(Contains, AgreesWithSummedAnglesOnRandomSimpleRings) {
  std::mt19937 random(20261121);
  int rings = 0;
  while (rings < 100) {
    const Ring ring = random_whole_ring(random, 6, 12);
    if (!is_simple_by_pairs(ring)) continue;
    ++rings;
    for (int i = 0; i < 50; ++i) {
      const Vector2d point = random_point(random, 12.0);
      EXPECT_EQ(contains(ring, point), turns_around(ring, point) != 0);
    }
  }
}

TEST(IsSimple, AgreesWithAllPairsOfEdgesInWholeNumbers) {
  std::mt19937 random(20261122);
  int simple = 0;
  for (int i = 0; i < 5000; ++i) {
    const Ring ring = random_whole_ring(random, 3 + i % 5, 4);
    ASSERT_EQ(is_simple(ring), is_simple_by_pairs(ring)) << "ring " << i;
    simple += is_simple(ring);
  }
  EXPECT_GT(simple, 500);
  EXPECT_LT(simple, 4500);
}

TEST(IsSimple, RefusesRepeatedPointsAndTooFewAndWhatIsNotANumber) {
  EXPECT_FALSE(is_simple({{0, 0}, {1, 0}, {1, 0}, {1, 1}}));
  EXPECT_FALSE(is_simple({{0, 0}, {1, 0}}));
  EXPECT_FALSE(is_simple({{0, 0}, {1, 0}, {1, std::numeric_limits<double>::quiet_NaN()}}));
}

TEST(MakeSimple, OnlyTurnsASimpleRingCounterClockwise) {
  const auto polygons = make_simple(Ring(kSquare.rbegin(), kSquare.rend()));
  ASSERT_EQ(polygons.size(), 1u);
  EXPECT_EQ(polygons[0].outer, kSquare);
}

TEST(MakeSimple, SplitsABowTieIntoItsTwoTriangles) {
  const auto polygons = make_simple(kBowTie);
  ASSERT_EQ(polygons.size(), 2u);
  expect_valid(polygons);
  for (const Polygon& polygon : polygons) EXPECT_NEAR(area_m2(polygon), 4.0, 1e-12);
}

TEST(MakeSimple, DropsSpikesRepeatedPointsAndRingsWithoutArea) {
  const auto polygons =
      make_simple({{0, 0}, {4, 0}, {4, 0}, {9, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}});
  ASSERT_EQ(polygons.size(), 1u);
  EXPECT_EQ(polygons[0].outer, kSquare);
  EXPECT_TRUE(make_simple({{0, 0}, {1, 1}, {2, 2}, {1, 1}}).empty());
  EXPECT_TRUE(make_simple({{0, 0}, {1, 1}}).empty());
  EXPECT_TRUE(make_simple({}).empty());
}

/// Up and down across the square from 0 to `lines`, then to and fro: lines² crossings of straight
/// strokes, 4 · lines points.
Ring woven(int lines) {
  Ring ring;
  const double far = lines;
  for (int i = 0; i < lines; ++i) {
    const double at = i + 0.5;
    ring.emplace_back(at, i % 2 == 0 ? -1.0 : far + 1.0);
    ring.emplace_back(at, i % 2 == 0 ? far + 1.0 : -1.0);
  }
  for (int i = 0; i < lines; ++i) {
    const double at = i + 0.25;
    ring.emplace_back(i % 2 == 0 ? far + 2.0 : -2.0, at);
    ring.emplace_back(i % 2 == 0 ? -2.0 : far + 2.0, at);
  }
  return ring;
}

TEST(MakeSimple, TakesApartARingThatCrossesItselfOftenButNotOneThatDoesEndlessly) {
  expect_valid(make_simple(woven(8)));
  EXPECT_TRUE(has_few_crossings(woven(8)));
  EXPECT_GT(make_simple(woven(8)).size(), 0u);
  EXPECT_FALSE(has_few_crossings(woven(60)));  // 15 crossings per point
  EXPECT_TRUE(make_simple(woven(60)).empty());
  EXPECT_TRUE(make_simple(woven(3000)).empty());  // exact repair would take gigabytes
}

TEST(MakeSimple, KeepsTheHoleOfAKeyholeRing) {
  const auto polygons = make_simple({{0, 0},
                                     {9, 0},
                                     {9, 9},
                                     {0, 9},
                                     {0, 0},  //
                                     {3, 3},
                                     {3, 6},
                                     {6, 6},
                                     {6, 3},
                                     {3, 3}});
  ASSERT_EQ(polygons.size(), 1u);
  ASSERT_EQ(polygons[0].holes.size(), 1u);
  expect_valid(polygons);
  EXPECT_NEAR(total_area_m2(polygons), 72.0, 1e-12);
}

TEST(MakeSimple, KeepsWhatARandomRingWindsAround) {
  std::mt19937 random(20261123);
  for (int i = 0; i < 300; ++i) {
    const Ring ring = random_whole_ring(random, 4 + i % 9, 9);
    const auto polygons = make_simple(ring);
    expect_valid(polygons);
    for (int k = 0; k < 40; ++k) {
      const Vector2d point = random_point(random, 9.0);
      ASSERT_EQ(any_contains(polygons, point), turns_around(ring, point) != 0)
          << "ring " << i << ", point " << point.transpose();
    }
  }
}

TEST(MakeSimple, TakesTheFoldsOutOfATightBendsInnerBorder) {
  // A 6 m wide strip right of a circle of radius 4 m: the inner border turns inside out, 2 m beyond
  // the centre. What it winds around lies within the circle.
  Ring strip;
  for (int i = 0; i <= 30; ++i) strip.emplace_back(4 * std::cos(i * 0.1), 4 * std::sin(i * 0.1));
  for (int i = 30; i >= 0; --i) strip.emplace_back(-2 * std::cos(i * 0.1), -2 * std::sin(i * 0.1));
  ASSERT_FALSE(is_simple(strip));
  const auto polygons = make_simple(strip);
  expect_valid(polygons);
  std::mt19937 random(20261124);
  for (int k = 0; k < 1000; ++k) {
    const Vector2d point = random_point(random, 8.0) - Vector2d(4, 4);
    EXPECT_EQ(any_contains(polygons, point), turns_around(strip, point) != 0);
  }
}

TEST(MakeSimple, RefusesWhatIsNotANumber) {
  EXPECT_THROW(make_simple({{0, 0}, {1, 0}, {1, std::nan("")}}), std::invalid_argument);
}

TEST(Unite, JoinsNeighboursAcrossTheirSharedEdge) {
  const std::vector<Polygon> squares = {{kSquare, {}}, {box(4, 0, 4, 4), {}}};
  const auto united = unite(squares, 0.0);
  ASSERT_EQ(united.size(), 1u);
  EXPECT_EQ(united[0].outer, box(0, 0, 8, 4));
}

TEST(Unite, KeepsPiecesApartThatMeetAtAPoint) {
  const std::vector<Polygon> squares = {{kSquare, {}}, {box(4, 4, 4, 4), {}}};
  const auto united = unite(squares, 1e-3);
  ASSERT_EQ(united.size(), 2u);
  expect_valid(united);
}

TEST(Unite, SurroundsAYardWithAHole) {
  const std::vector<Polygon> frame = {
      {box(0, 0, 9, 1), {}}, {box(0, 8, 9, 1), {}}, {box(0, 0, 1, 9), {}}, {box(8, 0, 1, 9), {}}};
  const auto united = unite(frame, 1e-3);
  ASSERT_EQ(united.size(), 1u);
  expect_valid(united);
  ASSERT_EQ(united[0].holes.size(), 1u);
  EXPECT_NEAR(total_area_m2(united), 81.0 - 49.0, 1e-12);
}

TEST(Unite, FillsAHoleWithWhatLiesInIt) {
  Ring hole = box(1, 1, 2, 2);
  std::reverse(hole.begin(), hole.end());
  const std::vector<Polygon> regions = {{kSquare, {hole}}, {box(1, 1, 1, 2), {}}};
  EXPECT_NEAR(total_area_m2(unite(regions, 0.0)), 14.0, 1e-12);
}

TEST(Unite, ClosesGapsUpToTheWeldDistanceAndNoOthers) {
  const auto pieces = [](double gap_m, double weld_m) {
    const std::vector<Polygon> roads = {{box(0, 0, 50, 7), {}}, {box(50 + gap_m, 0, 50, 7), {}}};
    return unite(roads, weld_m).size();
  };
  EXPECT_EQ(pieces(0.9e-3, 1e-3), 1u);
  EXPECT_EQ(pieces(1.1e-3, 1e-3), 2u);
  EXPECT_EQ(pieces(1e-13, 0.0), 2u);
}

TEST(Unite, ClosesTheGapBesideACornerThatMeetsAnEdge) {
  // A narrow road ends 0.5 mm before the side of a wide one: no corner is near another.
  const std::vector<Polygon> roads = {{box(0, 0, 7, 90), {}}, {box(7.0005, 40, 30, 3), {}}};
  const auto united = unite(roads, 1e-3);
  ASSERT_EQ(united.size(), 1u);
  EXPECT_TRUE(united[0].holes.empty());
  EXPECT_NEAR(total_area_m2(united), 7 * 90 + 30 * 3, 0.05);
}

TEST(Unite, CoversWhatRandomBoxesCover) {
  std::mt19937 random(20261125);
  std::uniform_real_distribution<double> place(0.0, 90.0), extent(1.0, 30.0), angle(0.0, 3.0);
  for (int i = 0; i < 20; ++i) {
    std::vector<Polygon> boxes;
    for (int k = 0; k < 30; ++k) {
      const Pose2 pose{place(random), place(random), angle(random)};
      Ring ring = box(0, 0, extent(random), extent(random));
      for (Vector2d& corner : ring) corner = pose * corner;
      boxes.push_back({ring, {}});
    }
    const auto united = unite(boxes, 0.0);
    expect_valid(united);
    for (int k = 0; k < 300; ++k) {
      const Vector2d point = random_point(random, 100.0);
      const bool covered = std::any_of(boxes.begin(), boxes.end(), [&](const Polygon& polygon) {
        return turns_around(polygon.outer, point) != 0;
      });
      ASSERT_EQ(any_contains(united, point), covered);
    }
  }
}

TEST(Unite, AreaAgreesWithCountingPointsOfAGrid) {
  std::mt19937 random(20261126);
  std::uniform_real_distribution<double> place(0.0, 8.0);
  std::vector<Polygon> boxes;
  for (int k = 0; k < 12; ++k) boxes.push_back({box(place(random), place(random), 2, 2), {}});
  constexpr double kStep = 0.01;
  long inside = 0;
  for (double x = 0.5 * kStep; x < 10; x += kStep) {
    for (double y = 0.5 * kStep; y < 10; y += kStep) {
      inside += std::any_of(boxes.begin(), boxes.end(), [&](const Polygon& b) {
        const Vector2d low = b.outer[0];
        return x >= low.x() && x <= low.x() + 2 && y >= low.y() && y <= low.y() + 2;
      });
    }
  }
  // Each of the 48 box sides of 2 m can miscount at most half a step along its length.
  EXPECT_NEAR(total_area_m2(unite(boxes, 0.0)), double(inside) * kStep * kStep, 48 * 2 * kStep / 2);
}

TEST(Unite, DoesNotDependOnTheOrderOfItsInput) {
  std::mt19937 random(20261127);
  std::vector<Polygon> regions;
  for (int k = 0; k < 40; ++k) {
    for (const Polygon& piece : make_simple(random_whole_ring(random, 5, 50))) {
      regions.push_back(piece);
    }
  }
  const auto first = unite(regions, 1e-3);
  std::shuffle(regions.begin(), regions.end(), random);
  const auto second = unite(regions, 1e-3);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].outer, second[i].outer);
    EXPECT_EQ(first[i].holes, second[i].holes);
  }
}

TEST(Unite, GivesSimpleRingsWhereBordersNearlyCoincide) {
  // Strips that differ by a few units in the last place cross again and again.
  std::mt19937 random(20261128);
  std::uniform_real_distribution<double> noise(-1e-12, 1e-12);
  std::vector<Polygon> strips;
  for (int k = 0; k < 20; ++k) {
    Ring ring;
    for (int i = 0; i <= 40; ++i) ring.emplace_back(i + noise(random), 0.1 * i + noise(random));
    for (int i = 40; i >= 0; --i) ring.emplace_back(i + noise(random), 0.1 * i + 3 + noise(random));
    strips.push_back({ring, {}});
  }
  for (const double weld_m : {0.0, 1e-9, 1e-3}) {
    const auto united = unite(strips, weld_m);
    expect_valid(united);
    EXPECT_NEAR(total_area_m2(united), 120.0, 0.01) << "weld " << weld_m << " m";
  }
}

TEST(Unite, OfTwoThousandCopiesIsOneOfThem) {
  const std::vector<Polygon> copies(2000, Polygon{{{0, 0}, {30, 0}, {30, 4}, {0, 4}}, {}});
  const auto united = unite(copies, 1e-3);
  ASSERT_EQ(united.size(), 1u);
  EXPECT_EQ(united[0].outer, copies[0].outer);
}

// Each reaches 0.01 m farther than the one before, and 0.001 m higher.
TEST(Unite, OfTwoThousandShiftedCopiesCoversWhatTheyCover) {
  std::vector<Polygon> copies;
  for (int i = 0; i < 2000; ++i) {
    copies.push_back({box_ring({0.01 * i, 0.001 * i}, {30 + 0.01 * i, 4 + 0.001 * i}), {}});
  }
  const auto united = unite(copies, 1e-4);
  ASSERT_EQ(united.size(), 1u);
  // The first one and, for each of the others, what it adds: a column and a row.
  const double added_m2 = 0.01 * 4.0 + 0.001 * 30.0 - 0.01 * 0.001;
  constexpr double welded_m2 = 1e-4 * 120.0;  // edges move by the weld distance, at most
  EXPECT_NEAR(area_m2(united[0]), 120.0 + 1999 * added_m2, welded_m2);
}

TEST(Unite, RefusesAFabricOfRoads) {
  std::vector<Polygon> roads;
  for (int i = 0; i < 400; ++i) {
    const double at = 2.0 * i;
    roads.push_back({box_ring({0.0, at}, {800.0, at + 1.0}), {}});
    roads.push_back({box_ring({at, 0.0}, {at + 1.0, 800.0}), {}});
  }
  EXPECT_THROW(unite(roads, 1e-3), TooMuchWork);
}

TEST(Unite, OfNothingIsNothing) { EXPECT_TRUE(unite({}, 1e-3).empty()); }

TEST(Unite, RefusesWhatIsNotANumberAndNegativeDistances) {
  const std::vector<Polygon> bad = {{{{0, 0}, {1, 0}, {1, std::nan("")}}, {}}};
  const std::vector<Polygon> good = {{kSquare, {}}};
  EXPECT_THROW(unite(bad, 0.0), std::invalid_argument);
  EXPECT_THROW(unite(good, -1.0), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::geometry
