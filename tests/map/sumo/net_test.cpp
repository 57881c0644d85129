#include "roadbed/map/sumo/net.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <queue>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/derived/conflicts.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/sumo/inner_lanes.h"
#include "roadbed/map/sumo/lane_lines.h"
#include "roadbed/map/sumo/lane_users.h"
#include "roadbed/tests/support/made_lanelet2.h"
#include "roadbed/tests/support/made_road.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map::sumo {
namespace {

/// A map with all that a net is made of.
struct Made {
  explicit Made(RoadMap map)
      : road_map(std::move(map)),
        ways(road_map),
        conflicts(find_conflicts(road_map)),
        net(build_net(road_map, ways, conflicts)) {}

  RoadMap road_map;
  DirectedLanes ways;
  std::vector<Conflict> conflicts;
  Net net;
};

std::vector<RoadMap> maps() {
  std::vector<RoadMap> all;
  for (const char* name : {"town.xodr", "crossing.osm", "ramp.xodr", "country.xodr"}) {
    all.push_back(load_map(tests::data_folder() / name));
  }
  return all;
}

// Every lane that one gets to, by the map's links alone.
std::set<LaneId> reached(const RoadMap& road_map, LaneId from) {
  std::set<LaneId> seen;
  std::queue<LaneId> open({from});
  while (!open.empty()) {
    for (const LaneId next : road_map.graph().of(open.front()).successors) {
      if (!users_of(road_map.lane(next)).has(Participant::car)) continue;
      if (seen.insert(next).second) open.push(next);
    }
    open.pop();
  }
  return seen;
}

// The same by the net's connections for cars, without lane changes.
std::set<LaneId> reached(const Net& net, LaneId from) {
  std::set<LaneId> seen;
  std::queue<LaneId> open({from});
  while (!open.empty()) {
    for (const NetConnection& connection : net.connections) {
      if (net.from_lane(connection) != DirectedLane{open.front(), false}) continue;
      if (!connection.users.has(Participant::car) || connection.has_change) continue;
      for (const DirectedLane way : connection.across) seen.insert(way.lane);
      const LaneId next = net.to_lane(connection).lane;
      if (next != open.front() && seen.insert(next).second) open.push(next);
    }
    open.pop();
  }
  return seen;
}

TEST(SumoNet, HasEveryLaneOnceAsAnEdgeOrInsideAJunction) {
  for (RoadMap& road_map : maps()) {
    const Made made(std::move(road_map));
    std::set<DirectedLane> inside, outside;
    for (const NetConnection& connection : made.net.connections) {
      inside.insert(connection.across.begin(), connection.across.end());
    }
    for (const NetEdge& edge : made.net.edges) {
      if (edge.from_share == 0.0 && edge.to_share == 1.0) {
        for (const DirectedLane way : edge.lanes) EXPECT_TRUE(outside.insert(way).second);
      } else {
        outside.insert(edge.lanes.begin(), edge.lanes.end());
      }
    }
    for (const Lane& lane : made.road_map.lanes()) {
      const DirectedLane way{lane.id, false};
      EXPECT_EQ(made.ways.has(way), inside.contains(way) || outside.contains(way)) << lane.name;
    }
  }
}

TEST(SumoNet, LeadsWhereTheMapLeads) {
  for (RoadMap& road_map : maps()) {
    const Made made(std::move(road_map));
    std::set<LaneId> inner;
    for (const NetConnection& connection : made.net.connections) {
      for (const DirectedLane way : connection.across) inner.insert(way.lane);
    }
    int compared = 0;
    for (const Lane& lane : made.road_map.lanes()) {
      if (!made.ways.has({lane.id, false}) || inner.contains(lane.id)) continue;
      if (!users_of(lane).has(Participant::car) || ++compared > 40) continue;
      std::set<LaneId> by_map = reached(made.road_map, lane.id);
      std::set<LaneId> by_net = reached(made.net, lane.id);
      // What a shorter way passes by inside a junction is not looked at.
      std::erase_if(by_map, [&](LaneId id) { return inner.contains(id) || id == lane.id; });
      std::erase_if(by_net, [&](LaneId id) { return inner.contains(id) || id == lane.id; });
      std::string only_by_one;
      for (const Lane& other : made.road_map.lanes()) {
        if (by_map.contains(other.id) != by_net.contains(other.id)) only_by_one += other.name + " ";
      }
      EXPECT_EQ(only_by_one, "") << lane.name;
    }
    EXPECT_GT(compared, 4);
  }
}

TEST(SumoNet, ConnectionsGoAcrossTheNodeWhereTheirEdgesMeet) {
  for (RoadMap& road_map : maps()) {
    const Made made(std::move(road_map));
    for (const NetConnection& connection : made.net.connections) {
      EXPECT_EQ(made.net.edges[connection.from].to, made.net.edges[connection.to].from);
    }
    for (const NetEdge& edge : made.net.edges) EXPECT_NE(edge.from, edge.to) << edge.id;
  }
}

TEST(SumoNet, LanesOfAnEdgeLieFromRightToLeft) {
  int pairs = 0;
  for (RoadMap& road_map : maps()) {
    const Made made(std::move(road_map));
    for (const NetEdge& edge : made.net.edges) {
      for (std::size_t i = 1; i < edge.lanes.size(); ++i) {
        const Lane& right = made.road_map.lane(edge.lanes[i - 1].lane);
        const Lane& left = made.road_map.lane(edge.lanes[i].lane);
        const double side = edge.lanes[i].against ? -1.0 : 1.0;
        const auto place =
            right.centre.in_map.project(left.pose_at(0.5 * left.length_m()).position());
        EXPECT_GT(side * place.d_m, 0.0) << edge.id;
        ++pairs;
      }
    }
  }
  EXPECT_GT(pairs, 20);
}

TEST(SumoNet, LanesOfAnEdgeCountFromTheLeftInLeftHandTraffic) {
  tests::MadeRoad road;
  road.attributes = R"(rule="LHT")";
  road.lanes = tests::made_section(0.0, tests::made_lane(2) + tests::made_lane(1),
                                   tests::made_lane(-1) + tests::made_lane(-2));
  const Made made(tests::made_map(tests::made_road(road)));
  EXPECT_TRUE(made.net.left_hand);
  ASSERT_EQ(made.net.edges.size(), 2u);
  for (const NetEdge& edge : made.net.edges) {
    ASSERT_EQ(edge.lanes.size(), 2u);
    const Lane& kerb = made.road_map.lane(edge.lanes[0].lane);
    const Lane& middle = made.road_map.lane(edge.lanes[1].lane);
    EXPECT_NEAR(kerb.centre.in_map.project(middle.pose_at(50.0).position()).d_m, -3.5, 1e-9);
    EXPECT_EQ(made.net.leftmost(edge), edge.lanes[0]);
    EXPECT_EQ(made.net.rightmost(edge), edge.lanes[1]);
  }
}

TEST(SumoNet, IdsAreTheirOwnAndOfLettersThatSumoTakes) {
  for (RoadMap& road_map : maps()) {
    const Made made(std::move(road_map));
    std::set<std::string> edges, nodes;
    for (const NetEdge& edge : made.net.edges) EXPECT_TRUE(edges.insert(edge.id).second) << edge.id;
    for (const NetNode& node : made.net.nodes) EXPECT_TRUE(nodes.insert(node.id).second) << node.id;
  }
  NetIds ids;
  EXPECT_EQ(ids.give("a b:c_\xC3\xA4|"), "a-b-c----");
  EXPECT_EQ(ids.give("12/0"), "12/0");
  EXPECT_EQ(ids.give("12/0"), "12/0.2");
  EXPECT_EQ(ids.give("12/0.2"), "12/0.2.2");
  EXPECT_EQ(ids.give(""), "-");
}

// Four lanes to a junction whose middle the file says nothing of:
//
//             │ c
//     a ──────┼────── b       inner: ab and cd, which cross
//             │ d
class FourArms {
 public:
  RoadMap map(bool one_way) {
    add({{-60, 0}, {-10, 0}, {10, 0}, {60, 0}}, one_way);
    add({{0, -60}, {0, -12}, {0, 12}, {0, 60}}, true);
    return parse_map(file_.text(), "made.osm");
  }

 private:
  // Lanelets from point to point, 4 m wide.
  void add(const std::vector<std::pair<double, double>>& points, bool one_way) {
    std::vector<std::int64_t> left, right;
    for (const auto& [x, y] : points) {
      const bool along_x = points.front().second == 0.0;
      left.push_back(file_.node({along_x ? x : x - 2.0, along_x ? y + 2.0 : y}));
      right.push_back(file_.node({along_x ? x : x + 2.0, along_x ? y - 2.0 : y}));
    }
    for (std::size_t i = 1; i < points.size(); ++i) {
      file_.lanelet(file_.way({left[i - 1], left[i]}), file_.way({right[i - 1], right[i]}),
                    tags(one_way));
    }
  }

  static tests::MadeLanelet2::Tags tags(bool one_way) {
    return {{"subtype", "road"}, {"location", "urban"}, {"one_way", one_way ? "yes" : "no"}};
  }
  tests::MadeLanelet2 file_;
};

TEST(SumoNet, ALaneOfTenCentimetresIsPassed) {
  tests::MadeLanelet2 made;
  std::vector<std::int64_t> left, right;
  for (const double x_m : {0.0, 30.0, 30.1, 60.0}) {
    left.push_back(made.node({x_m, 3.5}));
    right.push_back(made.node({x_m, 0.0}));
  }
  for (std::size_t i = 1; i < left.size(); ++i) {
    made.lanelet(made.way({left[i - 1], left[i]}), made.way({right[i - 1], right[i]}));
  }
  const Made lanes(parse_map(made.text(), "made.osm"));
  const LaneId first = lanes.road_map.lanes().front().id;
  EXPECT_EQ(reached(lanes.net, first), reached(lanes.road_map, first));
  EXPECT_EQ(reached(lanes.net, first).size(), 2u);
}

TEST(SumoNet, LanesThatCrossAreInsideOneJunction) {
  const Made made(FourArms().map(true));
  const auto inner = find_inner_lanes(made.road_map, made.ways, made.conflicts);
  EXPECT_EQ(
      std::count_if(inner.begin(), inner.end(), [](const auto& one) { return one.has_value(); }),
      2);
  EXPECT_EQ(made.net.edges.size(), 4u);
  EXPECT_EQ(made.net.connections.size(), 2u);
  std::set<std::uint32_t> nodes;
  for (const NetConnection& connection : made.net.connections) {
    EXPECT_EQ(connection.across.size(), 1u);
    nodes.insert(made.net.edges[connection.from].to);
  }
  EXPECT_EQ(nodes.size(), 1u);
}

TEST(SumoNet, LanesThatAreOpenBothWaysAreEdgesBothWays) {
  const Made one(FourArms().map(true)), both(FourArms().map(false));
  EXPECT_EQ(both.net.edges.size(), one.net.edges.size() + 2);
  EXPECT_EQ(both.net.connections.size(), one.net.connections.size() + 1);
  for (const NetEdge& edge : both.net.edges) {
    for (const DirectedLane way : edge.lanes) {
      const Points line = line_of(both.road_map, way, LineOf::centre);
      const Lane& lane = both.road_map.lane(way.lane);
      EXPECT_NEAR(
          (line.front().head<2>() - lane.pose_at(way.against ? lane.length_m() : 0.0).position())
              .norm(),
          0.0, 1e-9);
    }
  }
}

}  // namespace
}  // namespace roadbed::map::sumo
