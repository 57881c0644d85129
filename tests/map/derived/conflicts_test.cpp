#include "roadbed/map/derived/conflicts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "roadbed/tests/support/bent_lanes.h"

namespace roadbed::map {
namespace {

using Eigen::Vector2d;

struct Sampled {
  double area_m2 = 0.0;
  StationRange on_one{1e300, -1e300}, on_other{1e300, -1e300};
};

void add(StationRange& range, double s_m) {
  range = {std::min(range.from_s_m, s_m), std::max(range.to_s_m, s_m)};
}

constexpr double kRaster_m = 0.04;

/// Overlaps of all pairs by sampling the plane.
std::map<std::pair<LaneId, LaneId>, Sampled> sampled_overlaps(const RoadMap& road_map,
                                                              double extent_m) {
  std::map<std::pair<LaneId, LaneId>, Sampled> overlaps;
  for (double x = -extent_m; x < extent_m; x += kRaster_m) {
    for (double y = -extent_m; y < extent_m; y += kRaster_m) {
      const auto here = road_map.locate({x, y}, 0.0, true);
      for (const LaneMatch& one : here) {
        for (const LaneMatch& other : here) {
          if (one.place.lane >= other.place.lane) continue;
          Sampled& overlap = overlaps[{one.place.lane, other.place.lane}];
          overlap.area_m2 += kRaster_m * kRaster_m;
          add(overlap.on_one, one.place.s_m);
          add(overlap.on_other, other.place.s_m);
        }
      }
    }
  }
  return overlaps;
}

TEST(Conflicts, OfRandomLanesAreWhereSamplingFindsThem) {
  std::mt19937 random(20261121);
  const RoadMap road_map = tests::random_arc_lanes(random, 8, 8.0).build();
  const auto expected = sampled_overlaps(road_map, 52.0);
  std::map<std::pair<LaneId, LaneId>, Sampled> found;
  for (const Conflict& conflict : find_conflicts(road_map, {.least_width_m = 0.0})) {
    Sampled& sum = found[{conflict.one, conflict.other}];
    sum.area_m2 += conflict.area_m2;
    add(sum.on_one, conflict.on_one.from_s_m);
    add(sum.on_one, conflict.on_one.to_s_m);
    add(sum.on_other, conflict.on_other.from_s_m);
    add(sum.on_other, conflict.on_other.to_s_m);
    EXPECT_EQ(conflict.kind, ConflictKind::crossing);
  }
  EXPECT_GT(expected.size(), 5u);
  for (const auto& [pair, overlap] : expected) {
    if (overlap.area_m2 < 0.5) continue;
    const Sampled& got = found[pair];
    EXPECT_NEAR(got.area_m2, overlap.area_m2, 0.02 * overlap.area_m2 + 0.2);
    for (const auto& [a, b] :
         {std::pair(got.on_one, overlap.on_one), std::pair(got.on_other, overlap.on_other)}) {
      EXPECT_NEAR(a.from_s_m, b.from_s_m, 0.3);  // sampling misses sharp corners by some steps
      EXPECT_NEAR(a.to_s_m, b.to_s_m, 0.3);
    }
  }
  for (const auto& [pair, overlap] : found) {
    EXPECT_TRUE(overlap.area_m2 <= 0.5 || expected.contains(pair));
  }
}

TEST(Conflicts, OfOneLaneAreThoseOfAllThatItIsIn) {
  std::mt19937 random(20261122);
  const RoadMap road_map = tests::random_arc_lanes(random, 12, 8.0).build();
  const std::vector<Conflict> all = find_conflicts(road_map);
  std::size_t found = 0;
  for (const Lane& lane : road_map.lanes()) {
    std::vector<Conflict> expected;
    std::ranges::copy_if(all, std::back_inserter(expected), [&](const Conflict& conflict) {
      return conflict.one == lane.id || conflict.other == lane.id;
    });
    const std::vector<Conflict> of_lane = find_conflicts_of(road_map, lane.id);
    ASSERT_EQ(of_lane.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(of_lane[i].one, expected[i].one);
      EXPECT_EQ(of_lane[i].other, expected[i].other);
      EXPECT_EQ(of_lane[i].on_one, expected[i].on_one);
      EXPECT_EQ(of_lane[i].on_other, expected[i].on_other);
      EXPECT_NEAR(of_lane[i].area_m2, expected[i].area_m2, 1e-9);
    }
    found += of_lane.size();
  }
  EXPECT_EQ(found, 2 * all.size());
  EXPECT_GT(found, 10U);
}

/// Lanes 3 m wide along the x and y axes, both 40 m, that cross in the middle.
tests::MadeMap crossroads(double height_of_second_m) {
  tests::MadeMap made;
  const RoadId road = made.add_road("1");
  made.add_lane(road, "-1", {{-20, 1.5}, {20, 1.5}}, {{-20, -1.5}, {20, -1.5}});
  const LaneId up = made.add_lane(road, "-2", {{-1.5, -20}, {-1.5, 20}}, {{1.5, -20}, {1.5, 20}});
  for (auto* line : {&made.lane(up).left, &made.lane(up).centre, &made.lane(up).right}) {
    line->z_m.assign(2, height_of_second_m);
  }
  return made;
}

TEST(Conflicts, OfCrossingLanesHaveTheirOverlapOnBoth) {
  const auto conflicts = find_conflicts(crossroads(0.0).build());
  ASSERT_EQ(conflicts.size(), 1u);
  EXPECT_NEAR(conflicts[0].on_one.from_s_m, 18.5, 1e-9);
  EXPECT_NEAR(conflicts[0].on_one.to_s_m, 21.5, 1e-9);
  EXPECT_NEAR(conflicts[0].on_other.from_s_m, 18.5, 1e-9);
  EXPECT_NEAR(conflicts[0].on_other.to_s_m, 21.5, 1e-9);
  EXPECT_NEAR(conflicts[0].area_m2, 9.0, 1e-9);
}

TEST(Conflicts, DoNotArisePassingOverEachOther) {
  EXPECT_EQ(find_conflicts(crossroads(2.4).build()).size(), 1u);
  EXPECT_TRUE(find_conflicts(crossroads(5.0).build()).empty());
}

TEST(Conflicts, DoNotAriseBetweenNeighboursAndSuccessors) {
  tests::MadeMap made = crossroads(0.0);
  made.put_beside(LaneId{0}, LaneId{1});
  EXPECT_TRUE(find_conflicts(made.build()).empty());
  tests::MadeMap linked = crossroads(0.0);
  linked.link(LaneId{1}, LaneId{0});
  EXPECT_TRUE(find_conflicts(linked.build()).empty());
}

TEST(Conflicts, DoNotAriseBetweenLanesThatOnlyTouch) {
  tests::MadeMap made;
  const RoadId road = made.add_road("1");
  made.add_lane(road, "-1", {{0, 3}, {50, 3}}, {{0, -0.01}, {50, -0.01}});
  made.add_lane(road, "-2", {{0, 0}, {50, 0}}, {{0, -3}, {50, -3}});
  made.add_lane(road, "-3", {{49.99, 1}, {90, 1}}, {{49.99, -2}, {90, -2}});
  EXPECT_TRUE(find_conflicts(made.build()).empty());
}

TEST(Conflicts, SayWhetherLanesMergeOrDiverge) {
  for (const bool merge : {true, false}) {
    tests::MadeMap made = crossroads(0.0);
    const LaneId shared = made.add_lane(RoadId{0}, "-3", {{60, 3}, {90, 3}}, {{60, 0}, {90, 0}});
    for (const LaneId id : {LaneId{0}, LaneId{1}})
      merge ? made.link(id, shared) : made.link(shared, id);
    const auto conflicts = find_conflicts(made.build());
    ASSERT_EQ(conflicts.size(), 1u);
    EXPECT_EQ(conflicts[0].kind, merge ? ConflictKind::merging : ConflictKind::diverging);
  }
}

TEST(Conflicts, AreTwoWhereALoopMeetsALaneTwice) {
  tests::MadeMap made;
  const RoadId road = made.add_road("1");
  made.add_lane(road, "-1", {{-40, 1.5}, {40, 1.5}}, {{-40, -1.5}, {40, -1.5}});
  tests::add_arc_lane(made, road, "-2", {-15, -10, 1.5707963267948966}, -1.0 / 15.0, 60.0, 3.0);
  const auto conflicts = find_conflicts(made.build());
  ASSERT_EQ(conflicts.size(), 2u);
  EXPECT_LT(conflicts[0].on_one.to_s_m, 40.0);
  EXPECT_GT(conflicts[1].on_one.from_s_m, 40.0);
  EXPECT_LT(conflicts[0].on_other.to_s_m, conflicts[1].on_other.from_s_m);
}

}  // namespace
}  // namespace roadbed::map
