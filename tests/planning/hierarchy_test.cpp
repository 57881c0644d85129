// Searches of a graph, held to Boost.Graph's Dijkstra: not one cost may differ.

#include "roadbed/planning/hierarchy_search.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <set>

#include "roadbed/map/load_map.h"
#include "roadbed/planning/dissection.h"
#include "roadbed/tests/support/boost_routes.h"
#include "roadbed/tests/support/lane_grid.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::planning {
namespace {

// A campaign asks for more by ROADBED_ROUTE_QUERIES; the figure is per map and measure.
int query_count(int otherwise) {
  const char* named = std::getenv("ROADBED_ROUTE_QUERIES");
  return named != nullptr ? std::atoi(named) : otherwise;
}

// A path's arcs follow each other from its seed to its goal, and cost what it says.
void expect_whole(const RouteGraph& graph, std::span<const Ticks> weights, const GraphPath& path,
                  std::uint32_t from, std::uint32_t to) {
  Ticks cost = 0;
  std::uint32_t at = from;
  for (const std::uint32_t arc : path.arcs) {
    ASSERT_EQ(graph.tail[arc], at);
    ASSERT_NE(weights[arc], kNever);
    at = graph.head[arc];
    cost += weights[arc];
  }
  ASSERT_EQ(at, to);
  ASSERT_EQ(cost, path.cost);
}

struct Tally {
  long found = 0, none = 0;
};

// Random pairs; every few of them, random lanes are closed and opened.
void compare(const RouteNetwork& network, RouteCost measure, int queries, std::mt19937& random,
             Tally& tally) {
  RouteOptions options;
  options.cost = measure;
  TravelRules rules(network, options);
  const RouteGraph graph = make_route_graph(network);
  std::vector<Ticks> weights = weigh_all(graph, rules);
  const Guide guide = make_guide(graph, network, weights);
  const Hierarchy hierarchy = make_hierarchy(graph, dissection_order(graph, guide.place_in_map));
  HierarchyMetric metric(graph, hierarchy, weights);
  HierarchySearch by_hierarchy(metric);
  GraphSearch by_a_star(graph);
  tests::BoostRoutes oracle(graph, weights);
  std::uniform_int_distribution<std::uint32_t> any_node(
      0, static_cast<std::uint32_t>(graph.nodes()) - 1);
  std::uniform_int_distribution<std::uint32_t> any_lane(
      0, static_cast<std::uint32_t>(network.lanes.size()) - 1);
  constexpr int kPerSource = 50;
  std::vector<std::uint32_t> closed;
  for (int i = 0; i < queries; i += kPerSource) {
    closed.push_back(any_lane(random));
    rules.close(closed.back());
    if (closed.size() > 5) {
      rules.close(closed.front(), false);
      for (const std::uint32_t arc : arcs_of_lane(graph, closed.front())) {
        weights[arc] = weigh(graph, rules, arc);
        oracle.set_weight(arc, weights[arc]);
      }
      std::vector<std::uint32_t> arcs = arcs_of_lane(graph, closed.front());
      std::vector<Ticks> now;
      for (const std::uint32_t arc : arcs) now.push_back(weights[arc]);
      metric.change(arcs, now);
      closed.erase(closed.begin());
    }
    const std::vector<std::uint32_t> arcs = arcs_of_lane(graph, closed.back());
    std::vector<Ticks> now;
    for (const std::uint32_t arc : arcs) {
      weights[arc] = weigh(graph, rules, arc);
      oracle.set_weight(arc, weights[arc]);
      now.push_back(weights[arc]);
    }
    metric.change(arcs, now);
    const std::uint32_t from = any_node(random);
    const std::vector<Ticks>& expected = oracle.costs_from(from);
    for (int j = 0; j < kPerSource; ++j) {
      const std::uint32_t to = any_node(random);
      const Seed start{from, 0}, goal{to, 0};
      const GraphPath by_tree = by_hierarchy.find({&start, 1}, {&goal, 1});
      const GraphPath by_star = by_a_star.find(weights, guide, {&start, 1}, {&goal, 1});
      ASSERT_EQ(by_tree.cost, expected[to]) << from << " to " << to;
      ASSERT_EQ(by_star.cost, expected[to]) << from << " to " << to;
      if (expected[to] == kNever) {
        ++tally.none;
        continue;
      }
      ++tally.found;
      expect_whole(graph, weights, by_tree, from, to);
      expect_whole(graph, weights, by_star, from, to);
    }
  }
}

TEST(GraphSearches, CostWhatDijkstraOfAnotherLibraryFindsOnLaneGrids) {
  std::mt19937 random(20261121);
  Tally tally;
  for (const auto& [columns, rows] : {std::pair{2, 2}, {3, 7}, {9, 8}, {14, 14}}) {
    for (const RouteCost measure : {RouteCost::time, RouteCost::distance}) {
      compare(tests::lane_grid(columns, rows), measure, query_count(500), random, tally);
    }
  }
  EXPECT_GT(tally.found, 1000);
  EXPECT_GT(tally.none, 10);
}

TEST(GraphSearches, CostWhatDijkstraOfAnotherLibraryFindsOnRealMaps) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  std::mt19937 random(20261121);
  Tally tally;
  for (const char* file :
       {"BerkeleyLearnVerify+Scenic/Town04.xodr", "BerkeleyLearnVerify+Scenic/Town10HD.xodr",
        "esmini+esmini/multi_intersections.xodr", "esmini+esmini/soderleden.xodr",
        "huawei-noah+SMARTS/od_newmarket.xodr", "maliput+maliput_malidrive/cloverleaf.xodr"}) {
    const auto road_map = map::load_map(folder / "opendrive" / file);
    for (const RouteCost measure : {RouteCost::time, RouteCost::distance}) {
      compare(make_route_network(road_map), measure, query_count(500), random, tally);
    }
  }
  EXPECT_GT(tally.found, 1000);
  EXPECT_GT(tally.none, 1000);
}

TEST(Hierarchy, AClosureLeavesWhatCustomisingAfreshGives) {
  const RouteNetwork network = tests::lane_grid(6, 6);
  const RouteOptions options;
  TravelRules rules(network, options);
  const RouteGraph graph = make_route_graph(network);
  std::vector<Ticks> weights = weigh_all(graph, rules);
  const Guide guide = make_guide(graph, network, weights);
  const Hierarchy hierarchy = make_hierarchy(graph, dissection_order(graph, guide.place_in_map));
  HierarchyMetric metric(graph, hierarchy, weights);
  std::mt19937 random(20261121);
  for (int i = 0; i < 60; ++i) {
    const auto lane = static_cast<std::uint32_t>(random() % network.lanes.size());
    rules.close(lane, random() % 3 != 0);
    const auto arcs = arcs_of_lane(graph, lane);
    std::vector<Ticks> now;
    for (const std::uint32_t arc : arcs) now.push_back(weights[arc] = weigh(graph, rules, arc));
    EXPECT_LT(metric.change(arcs, now), hierarchy.arcs / 2);
    ASSERT_EQ(weights, weigh_all(graph, rules)) << "arcs_of_lane leaves none out";
    const HierarchyMetric afresh(graph, hierarchy, weights);
    ASSERT_EQ(metric.up(), afresh.up());
    ASSERT_EQ(metric.down(), afresh.down());
  }
}

TEST(Hierarchy, OfSeveralSeedsTakesTheCheapestPair) {
  const RouteNetwork network = tests::lane_grid(5, 4);
  const RouteOptions options;
  const TravelRules rules(network, options);
  const RouteGraph graph = make_route_graph(network);
  const std::vector<Ticks> weights = weigh_all(graph, rules);
  const Guide guide = make_guide(graph, network, weights);
  const Hierarchy hierarchy = make_hierarchy(graph, dissection_order(graph, guide.place_in_map));
  const HierarchyMetric metric(graph, hierarchy, weights);
  HierarchySearch search(metric);
  GraphSearch a_star(graph);
  std::mt19937 random(20261121);
  for (int i = 0; i < 300; ++i) {
    std::vector<Seed> from, to;
    for (unsigned j = 0; j < 1 + random() % 4; ++j) {
      from.push_back({static_cast<std::uint32_t>(random() % graph.nodes()),
                      static_cast<Ticks>(random() % 200000)});
      to.push_back({static_cast<std::uint32_t>(random() % graph.nodes()),
                    static_cast<Ticks>(random() % 200000)});
    }
    Ticks expected = kNever;
    for (const Seed& a : from) {
      for (const Seed& b : to) {
        const Seed start{a.node, 0}, goal{b.node, 0};
        expected = std::min(expected, search.cost({&start, 1}, {&goal, 1}) + a.cost + b.cost);
      }
    }
    const GraphPath path = search.find(from, to);
    ASSERT_EQ(path.cost, expected);
    ASSERT_EQ(a_star.find(weights, guide, from, to).cost, expected);
    ASSERT_EQ(cost_between(search.climb(from, false), search.climb(to, true)), expected);
    if (path.cost == kNever) continue;
    Ticks cost = from[path.from_seed].cost + to[path.to_seed].cost;
    for (const std::uint32_t arc : path.arcs) cost += weights[arc];
    ASSERT_EQ(cost, expected);
  }
}

TEST(DissectionOrder, NamesEveryNodeOnce) {
  for (const int size : {1, 2, 5}) {
    const RouteNetwork network = tests::lane_grid(size, size);
    const RouteGraph graph = make_route_graph(network);
    std::vector<Eigen::Vector2d> places;
    for (const auto lane : graph.lane_of_node) places.push_back(network.lanes[lane].start_in_map);
    const auto order = dissection_order(graph, places);
    EXPECT_EQ(order.size(), graph.nodes());
    EXPECT_EQ(std::set<std::uint32_t>(order.begin(), order.end()).size(), graph.nodes());
  }
}

}  // namespace
}  // namespace roadbed::planning
