#include <gtest/gtest.h>

#include <optional>
#include <random>

#include "roadbed/map/load_map.h"
#include "roadbed/planning/route/match_place.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::planning {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// Two roads that merge on a stretch that both of them have, lane "3" of the first, "4" of the
/// second, and part again behind it.
struct Merge {
  tests::MadeMap made;
  map::LaneId first, second, of_first, of_second, after_first, after_second;

  Merge() {
    const auto add = [this](const std::string& road, const Points& left, const Points& right) {
      return made.add_lane(made.add_road(road), "-1", left, right);
    };
    first = add("1", {{0, 23}, {50, 3}}, {{0, 20}, {50, 0}});
    second = add("2", {{0, -17}, {50, 3}}, {{0, -20}, {50, 0}});
    of_first = add("3", {{50, 3}, {80, 3}}, {{50, 0}, {80, 0}});
    of_second = add("4", {{50, 3}, {80, 3}}, {{50, 0}, {80, 0}});
    after_first = add("5", {{80, 3}, {120, 23}}, {{80, 0}, {120, 20}});
    after_second = add("6", {{80, 3}, {120, -17}}, {{80, 0}, {120, -20}});
    made.link(first, of_first);
    made.link(second, of_second);
    made.link(of_first, after_first);
    made.link(of_second, after_second);
  }
};

TEST(CoincidentLanes, AreOnePlace) {
  const map::RoadMap road_map = Merge().made.build();
  const RoutePlace place = route_place_of(match_place(road_map, {60.0, 1.5}, 0.0));
  ASSERT_EQ(place.or_on.size(), 1U);
  EXPECT_NE(place.lane, place.or_on.front().lane);
  EXPECT_NEAR(place.s_m, 10.0, 1e-9);
  EXPECT_NEAR(place.or_on.front().s_m, 10.0, 1e-9);
}

TEST(CoincidentLanes, LeadToAndFromWhereEitherOfThemDoes) {
  const Merge merge;
  const map::RoadMap road_map = merge.made.build();
  Router router(road_map);
  const RoutePlace there = route_place_of(match_place(road_map, {60.0, 1.5}, 0.0));
  for (const bool by_first : {true, false}) {
    const RoutePlace from(by_first ? merge.first : merge.second, 5.0);
    const RoutePlace to(by_first ? merge.after_first : merge.after_second, 5.0);
    const RouteAnswer into = router.find(from, there), out = router.find(there, to);
    ASSERT_TRUE(into.route) << into.reason;
    ASSERT_TRUE(out.route) << out.reason;
    EXPECT_EQ(into.route->legs.back().lane, by_first ? merge.of_first : merge.of_second);
    EXPECT_EQ(out.route->legs.front().lane, into.route->legs.back().lane);
  }
}

/// Whoever passes it comes and goes on the same of them.
TEST(CoincidentLanes, AreNoJunction) {
  const Merge merge;
  const map::RoadMap road_map = merge.made.build();
  Router router(road_map);
  const RoutePlace there = route_place_of(match_place(road_map, {60.0, 1.5}, 0.0));
  const RoutePlace from(merge.second, 5.0);
  const RoutePlace straight[] = {from, there, RoutePlace(merge.after_second, 5.0)};
  const RoutePlace across[] = {from, there, RoutePlace(merge.after_first, 5.0)};
  EXPECT_TRUE(router.find(straight).route);
  EXPECT_FALSE(router.find(across).route);
}

TEST(CoincidentLanes, AreLeftOutWhereTheyAreClosed) {
  const Merge merge;
  const map::RoadMap road_map = merge.made.build();
  RouteOptions options;
  options.avoid = {merge.of_first};
  Router router(road_map, options);
  const RoutePlace there = route_place_of(match_place(road_map, {60.0, 1.5}, 0.0));
  EXPECT_TRUE(router.is_fit(there));
  EXPECT_TRUE(router.find(RoutePlace(merge.second, 5.0), there).route);
  EXPECT_FALSE(router.find(RoutePlace(merge.first, 5.0), there).route);
}

/// The least of what each of the lanes costs by itself, on the crossings of a town.
TEST(CoincidentLanes, CostWhatTheCheapestOfThemDoes) {
  const map::RoadMap road_map = map::load_map(tests::data_folder() / "town.xodr");
  Router router(road_map);
  std::mt19937 random(25);
  const auto any_place = [&] {
    for (;;) {
      const auto index = static_cast<std::uint32_t>(random() % road_map.lanes().size());
      const map::Lane& lane = road_map.lane(map::LaneId{index});
      if (!lane.junction || !map::is_drivable(lane.type)) continue;
      const bool near_end = random() % 2 == 0;
      const geometry::Pose2 pose = lane.pose_at(lane.length_m() * (near_end ? 0.999 : 0.001));
      return route_place_of(match_place(road_map, pose.position(), pose.heading_rad));
    }
  };
  int several = 0;
  for (int i = 0; i < 300; ++i) {
    const RoutePlace from = any_place(), to = any_place();
    several += from.or_on.empty() && to.or_on.empty() ? 0 : 1;
    std::optional<double> least_s;
    for (const RoutePlace& start : each_lane_of(from)) {
      for (const RoutePlace& goal : each_lane_of(to)) {
        const RouteAnswer alone = router.find(start, goal);
        if (!alone.route || (least_s && *least_s <= alone.route->cost_s)) continue;
        least_s = alone.route->cost_s;
      }
    }
    const RouteAnswer answer = router.find(from, to);
    ASSERT_EQ(answer.route.has_value(), least_s.has_value());
    if (least_s) {
      EXPECT_NEAR(answer.route->cost_s, *least_s, 1e-3);
    }
  }
  EXPECT_GT(several, 100);
}

}  // namespace
}  // namespace roadbed::planning
