#include "roadbed/planning/route/routing_cost_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "roadbed/planning/route/route_network.h"
#include "roadbed/tests/support/made_maps.h"

namespace roadbed::planning {
namespace {

// A lane group of lanes beside each other, each with its windows to the right.
RouteNetwork lane_group(const std::vector<double>& lengths_m,
                        const std::vector<std::vector<map::StationRange>>& windows) {
  RouteNetwork network;
  for (std::uint32_t i = 0; i < lengths_m.size(); ++i) {
    NetworkLane lane;
    lane.length_m = lengths_m[i];
    lane.users = map::Participants::vehicles();
    if (i + 1 < lengths_m.size()) {
      lane.right = i + 1;
      for (const auto& window : windows[i]) network.right_windows.items.push_back(window);
    }
    network.right_windows.end_list();
    network.left_windows.end_list();
    network.successors.end_list();
    network.speeds.items.push_back({lengths_m[i], 10.0, 0.0});
    network.speeds.end_list();
    network.lanes.push_back(lane);
  }
  return network;
}

// Whether changes of that room fit, tried at every start on a fine raster.
bool fits(const RouteNetwork& network, std::size_t change, double fraction, double to,
          double room_m) {
  if (change + 1 == network.lanes.size()) return true;
  const double length_m = network.lanes[change].length_m;
  for (double at = fraction; at <= to; at += 0.002) {
    const double end = at + room_m / length_m;
    if (end > to + 1e-9) return false;
    for (const auto& window : network.right_windows.of(change)) {
      const bool inside =
          at * length_m >= window.from_s_m - 1e-9 && end * length_m <= window.to_s_m + 1e-9;
      if (inside && fits(network, change + 1, end, to, room_m)) return true;
    }
  }
  return false;
}

TEST(PlanChanges, FindsAboutTheRoomThatTryingEveryPlaceFinds) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int planned = 0, refused = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const std::size_t lanes = 2U + static_cast<unsigned>(trial % 2);
    std::vector<std::vector<map::StationRange>> windows(lanes - 1);
    for (auto& of_lane : windows) {
      for (double at = 30.0 * unit(random); at < 90.0; at += 5.0 + 30.0 * unit(random)) {
        const double end = std::min(100.0, at + 5.0 + 25.0 * unit(random));
        of_lane.push_back({at, end});
        at = end;
      }
    }
    const RouteNetwork network = lane_group(std::vector<double>(lanes, 100.0), windows);
    const RouteOptions options;
    const RoutingCostModel rules(network, options);
    std::vector<std::uint32_t> chain;
    for (std::uint32_t i = 0; i < lanes; ++i) chain.push_back(i);
    const FractionRange range{0.3 * unit(random), 0.7 + 0.3 * unit(random)};
    const auto plan = rules.plan_changes(chain, range);
    if (!plan) {
      ++refused;
      EXPECT_FALSE(fits(network, 0, range.from, range.to, options.least_lane_change_m + 0.5));
      continue;
    }
    ++planned;
    EXPECT_GE(plan->room_m, options.least_lane_change_m - 1e-6);
    ASSERT_EQ(plan->ranges.size(), lanes - 1);
    double before = range.from;
    for (std::size_t i = 0; i < plan->ranges.size(); ++i) {
      const FractionRange& at = plan->ranges[i];
      EXPECT_GE(at.from, before - 1e-9);
      EXPECT_LE(at.to, range.to + 1e-9);
      EXPECT_NEAR((at.to - at.from) * 100.0, plan->room_m, 1e-5);
      bool inside = false;
      for (const auto& window : windows[i]) {
        inside = inside || (at.from * 100.0 >= window.from_s_m - 1e-6 &&
                            at.to * 100.0 <= window.to_s_m + 1e-6);
      }
      EXPECT_TRUE(inside);
      before = at.to;
    }
    EXPECT_FALSE(fits(network, 0, range.from, range.to, plan->room_m + 0.5));
  }
  EXPECT_GT(planned, 20);
  EXPECT_GT(refused, 2);
}

// Whether a lane is driven from one fraction to another without meeting what is blocked of it.
bool is_free(const std::vector<BlockedStretch>& blocked, std::size_t lane, double from, double to) {
  return std::ranges::none_of(blocked, [&](const BlockedStretch& stretch) {
    return stretch.lane.index == lane && stretch.stations.from_s_m < 100.0 * to - 1e-9 &&
           stretch.stations.to_s_m > 100.0 * from + 1e-9;
  });
}

// The same past stretches that are blocked, of lanes of 100 m: the lane that is left is driven from
// where it was entered to the end of the change.
bool fits_past(const std::vector<BlockedStretch>& blocked, std::size_t lanes, std::size_t change,
               double entered, double fraction, double to, double room_m) {
  if (change + 1 == lanes) return is_free(blocked, change, entered, to);
  for (double at = fraction; at + 0.01 * room_m <= to + 1e-9; at += 0.005) {
    const double end = at + 0.01 * room_m;
    if (!is_free(blocked, change, entered, end)) return false;
    if (fits_past(blocked, lanes, change + 1, at, end, to, room_m)) return true;
  }
  return false;
}

struct BlockedTally {
  int planned = 0, refused = 0;
};

void plan_past_random_blocks(std::mt19937& random, std::size_t lanes, BlockedTally& tally) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const std::vector<std::vector<map::StationRange>> open(lanes - 1, {{0.0, 100.0}});
  const RouteNetwork network = lane_group(std::vector<double>(lanes, 100.0), open);
  RouteOptions options;
  const std::size_t count = 1 + random() % 3;
  for (std::size_t i = 0; i < count; ++i) {
    const double from_m = 100.0 * unit(random);
    const map::LaneId lane{static_cast<std::uint32_t>(random() % lanes)};
    options.blocked.push_back({lane, {from_m, from_m + 8.0 * unit(random)}});
  }
  const RoutingCostModel rules(network, options);
  std::vector<std::uint32_t> chain;
  for (std::uint32_t i = 0; i < lanes; ++i) chain.push_back(i);
  const FractionRange range{0.3 * unit(random), 0.7 + 0.3 * unit(random)};
  const auto plan = rules.plan_changes(chain, range);
  const auto fits_with = [&](double room_m) {
    return fits_past(options.blocked, lanes, 0, range.from, range.from, range.to, room_m);
  };
  if (!plan) {
    ++tally.refused;
    EXPECT_FALSE(fits_with(options.least_lane_change_m + 1.1));
    return;
  }
  ++tally.planned;
  double entered = range.from;
  for (std::size_t i = 0; i < plan->ranges.size(); ++i) {
    EXPECT_TRUE(is_free(options.blocked, i, entered, plan->ranges[i].to));
    entered = plan->ranges[i].from;
  }
  EXPECT_TRUE(is_free(options.blocked, lanes - 1, entered, range.to));
  EXPECT_FALSE(fits_with(plan->room_m + 1.1));
}

TEST(PlanChanges, LeavesABlockedLaneBeforeAndEntersItBehindAsTryingEveryPlaceDoes) {
  std::mt19937 random(20261123);
  BlockedTally tally;
  for (int trial = 0; trial < 400; ++trial) {
    plan_past_random_blocks(random, 2U + static_cast<unsigned>(trial % 2), tally);
  }
  EXPECT_GT(tally.planned, 200);
  EXPECT_GT(tally.refused, 30);
}

TEST(PlanChanges, ALaneThatIsBlockedIsDrivenBeforeAndBehind) {
  const RouteNetwork network = lane_group({100.0}, {});
  RouteOptions options;
  options.blocked = {{map::LaneId{0}, {40.0, 50.0}}};
  const RoutingCostModel rules(network, options);
  const std::vector<std::uint32_t> chain{0};
  EXPECT_TRUE(rules.plan_changes(chain, {0.0, 0.4}));
  EXPECT_FALSE(rules.plan_changes(chain, {0.0, 0.401}));
  EXPECT_FALSE(rules.plan_changes(chain, {0.499, 1.0}));
  EXPECT_TRUE(rules.plan_changes(chain, {0.5, 1.0}));
}

TEST(PlanChanges, EachOfSeveralChangesHasItsShareOfAPlainPassage) {
  const RouteNetwork network =
      lane_group({90.0, 90.0, 90.0, 90.0}, {{{0, 90}}, {{0, 90}}, {{0, 90}}});
  RouteOptions options;
  const RoutingCostModel rules(network, options);
  const std::vector<std::uint32_t> chain{0, 1, 2, 3};
  const auto plan = rules.plan_changes(chain, {});
  ASSERT_TRUE(plan);
  EXPECT_NEAR(plan->room_m, 30.0, 1e-9);
  EXPECT_NEAR(rules.change_cost(3, 30.0), 3 * 5.0 * 40.0 / 30.0, 1e-9);
  options.least_lane_change_m = 30.5;
  EXPECT_FALSE(RoutingCostModel(network, options).plan_changes(chain, {}));
}

TEST(RoutingCostModel, TimeIsLengthOverTheLeastOfLimitBendAndVehicle) {
  tests::MadeMap made;
  const auto road = made.add_road("1");
  std::vector<Eigen::Vector2d> left, right;
  const double radius_m = 20.0;
  for (int i = 0; i <= 400; ++i) {  // half a circle to the left behind 50 m straight
    const double angle = std::numbers::pi * i / 400.0;
    const Eigen::Vector2d out(std::sin(angle), -std::cos(angle));
    const Eigen::Vector2d centre(50.0, radius_m);
    if (i == 0) {
      for (int j = 0; j < 50; ++j) {
        left.push_back({j * 1.0, 2.0});
        right.push_back({j * 1.0, -2.0});
      }
    }
    left.push_back(centre + (radius_m - 2.0) * out);
    right.push_back(centre + (radius_m + 2.0) * out);
  }
  const map::LaneId lane = made.add_lane(road, "-1", left, right);
  made.lane(lane).speed_limits = {{0.0, 10.0}, {30.0, std::nullopt}};
  const map::RoadMap road_map = made.build();
  const RouteNetwork network = make_route_network(road_map);
  RouteOptions options;
  options.lateral_acceleration_mps2 = 2.0;
  const RoutingCostModel rules(network, options);
  EXPECT_NEAR(rules.travel_cost(0, 0.0, 30.0), 3.0, 1e-9);
  EXPECT_NEAR(rules.travel_cost(0, 30.0, 40.0), 10.0 / (50.0 / 3.6), 1e-9);
  const double bend_mps = std::sqrt(2.0 * radius_m);
  EXPECT_NEAR(rules.travel_cost(0, 60.0, 100.0), 40.0 / bend_mps, 0.02);
  options.max_speed_mps = 4.0;
  EXPECT_NEAR(rules.travel_cost(0, 0.0, 100.0), 25.0, 1e-9);
  const double s_m = rules.station_within(0, 0.0, 12.5);
  EXPECT_NEAR(s_m, 50.0, 1e-6);
}

TEST(RoutingCostModel, ALightIsPaidByWhoPassesIt) {
  RouteNetwork network = lane_group({100.0}, {});
  network.lanes[0].signal_s_m = 60.0;
  RouteOptions options;
  options.prices_s.signal = 7.0;
  const RoutingCostModel rules(network, options);
  EXPECT_NEAR(rules.travel_cost(0, 0.0, 60.0), 6.0, 1e-9);
  EXPECT_NEAR(rules.travel_cost(0, 0.0, 61.0), 13.1, 1e-9);
  EXPECT_NEAR(rules.travel_cost(0, 60.5, 100.0), 3.95, 1e-9);
}

TEST(TurnOfALane, IsByItsAngleWhereThereIsAChoice) {
  tests::MadeMap made;
  const auto road = made.add_road("1");
  const auto junction = made.add_road("2", made.add_junction("7"));
  const map::LaneId in = made.add_lane(road, "-1", {{0, 2}, {50, 2}}, {{0, -2}, {50, -2}});
  const auto left = made.add_lane(junction, "-1", {{50, 2}, {51, 2}, {51, 3}, {51, 9}},
                                  {{50, -2}, {55, -2}, {55, 3}, {55, 9}});
  const auto right = made.add_lane(junction, "-2", {{50, 2}, {55, 2}, {55, -3}, {55, -9}},
                                   {{50, -2}, {51, -2}, {51, -3}, {51, -9}});
  const auto ahead = made.add_lane(junction, "-3", {{50, 2}, {60, 2}}, {{50, -2}, {60, -2}});
  for (const auto next : {left, right, ahead}) made.link(in, next);
  const RouteNetwork network = make_route_network(made.build());
  EXPECT_EQ(network.lanes[in.index].turn, Turn::none);
  EXPECT_EQ(network.lanes[left.index].turn, Turn::left);
  EXPECT_EQ(network.lanes[right.index].turn, Turn::right);
  EXPECT_EQ(network.lanes[ahead.index].turn, Turn::straight);
}

}  // namespace
}  // namespace roadbed::planning
