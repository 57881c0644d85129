// Searches of a graph, held to Boost.Graph's Dijkstra: not one cost may differ.

#include "roadbed/planning/route/hierarchy_search.h"
#include "roadbed/planning/route/route_network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/planning/route/hierarchy.h"
#include "roadbed/tests/support/boost_routes.h"
#include "roadbed/tests/support/lane_grid.h"
#include "roadbed/tests/support/made_maps.h"
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

/// All that searches of a network need.
struct Prepared {
  RouteNetwork network;
  RouteOptions options;
  RoutingCostModel rules;
  RouteGraph graph;
  std::vector<Ticks> weights;
  Guide guide;
  Hierarchy hierarchy;
  HierarchyMetric metric;

  explicit Prepared(RouteNetwork of, const RouteOptions& by = {})
      : network(std::move(of)),
        options(by),
        rules(network, options),
        graph(make_route_graph(network)),
        weights(weigh_all(graph, rules)),
        guide(make_guide(graph, network, weights)),
        hierarchy(make_hierarchy(graph, dissection_order(graph, guide.place_in_map))),
        metric(graph, hierarchy, weights) {}
  Prepared(const Prepared&) = delete;

  /// Closes or opens a lane, and gives the arcs whose weights depend on that.
  std::vector<std::uint32_t> close(std::uint32_t lane, bool closed,
                                   std::size_t* computed = nullptr) {
    rules.close(lane, closed);
    std::vector<std::uint32_t> arcs = arcs_of_lane(graph, lane);
    std::vector<Ticks> now;
    for (const std::uint32_t arc : arcs) now.push_back(weights[arc] = weigh(graph, rules, arc));
    const std::size_t count = metric.change(arcs, now);
    if (computed != nullptr) *computed = count;
    return arcs;
  }

  std::uint32_t any_node(std::mt19937& random) const {
    return static_cast<std::uint32_t>(random() % graph.nodes());
  }
  std::uint32_t any_lane(std::mt19937& random) const {
    return static_cast<std::uint32_t>(random() % network.lanes.size());
  }
};

// By either measure, and for road users who walk both ways.
std::vector<RouteOptions> three_kinds() {
  std::vector<RouteOptions> kinds(3);
  kinds[1].cost = kinds[2].cost = RouteCost::distance;
  kinds[2].participant = map::Participant::pedestrian;
  return kinds;
}

struct Tally {
  long found = 0, none = 0;
};

// Random pairs; every few of them, a random lane is closed and an earlier one opened.
void compare(const RouteNetwork& network, const RouteOptions& options, int queries,
             std::mt19937& random, Tally& tally) {
  Prepared prepared(network, options);
  const RouteGraph& graph = prepared.graph;
  const std::vector<Ticks>& weights = prepared.weights;
  HierarchySearch by_hierarchy(prepared.metric);
  GraphSearch by_a_star(graph);
  tests::BoostRoutes oracle(graph, weights);
  const auto set = [&](std::uint32_t lane, bool closed) {
    for (const std::uint32_t arc : prepared.close(lane, closed)) {
      oracle.set_weight(arc, weights[arc]);
    }
  };
  constexpr int kPerSource = 50;
  std::vector<std::uint32_t> closed;
  for (int i = 0; i < queries; i += kPerSource) {
    closed.push_back(prepared.any_lane(random));
    set(closed.back(), true);
    if (closed.size() > 5) {
      set(closed.front(), false);
      closed.erase(closed.begin());
    }
    const std::uint32_t from = prepared.any_node(random);
    const std::vector<Ticks>& expected = oracle.costs_from(from);
    for (int j = 0; j < kPerSource; ++j) {
      const std::uint32_t to = prepared.any_node(random);
      const Seed start{from, 0}, goal{to, 0};
      const GraphPath by_tree = by_hierarchy.find({&start, 1}, {&goal, 1});
      const GraphPath by_star = by_a_star.find(weights, prepared.guide, {&start, 1}, {&goal, 1});
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
      RouteOptions options;
      options.cost = measure;
      compare(tests::lane_grid(columns, rows), options, query_count(500), random, tally);
    }
  }
  RecordProperty("routes", std::to_string(tally.found));
  RecordProperty("pairs_without", std::to_string(tally.none));
  EXPECT_GT(tally.found, 1000);
  EXPECT_GT(tally.none, 10);
}

// Every map that has lanes, whatever its format; files that nobody could read are left out.
TEST(GraphSearches, CostWhatDijkstraOfAnotherLibraryFindsOnRealMaps) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  std::vector<std::filesystem::path> files;
  for (const char* format : {"opendrive", "lanelet2", "commonroad"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / format)) {
      const auto suffix = entry.path().extension();
      if (suffix == ".xodr" || suffix == ".osm" || suffix == ".xml") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  std::mt19937 random(20261121);
  Tally tally;
  int maps = 0;
  for (const std::filesystem::path& file : files) {
    SCOPED_TRACE(file.filename().string());
    RouteNetwork network;
    try {
      network = make_route_network(map::load_map(file));
    } catch (const map::InputError&) {
      continue;
    }
    if (network.lanes.empty()) continue;
    ++maps;
    for (const RouteOptions& options : three_kinds()) {
      compare(network, options, query_count(50), random, tally);
    }
  }
  RecordProperty("maps", maps);
  RecordProperty("routes", std::to_string(tally.found));
  RecordProperty("pairs_without", std::to_string(tally.none));
  EXPECT_GT(maps, 50);
  EXPECT_GT(tally.found, 1000);
  EXPECT_GT(tally.none, 1000);
}

TEST(Hierarchy, AClosureLeavesWhatCustomisingAfreshGives) {
  // The second one has changes that take several lane groups.
  const tests::ShortSections road(std::vector<double>(30, 7.0));
  for (const bool in_grid : {true, false}) {
    Prepared prepared(in_grid ? tests::lane_grid(6, 6) : make_route_network(road.made.build()));
    EXPECT_EQ(prepared.graph.spans.empty(), in_grid);
    std::mt19937 random(20261121);
    for (int i = 0; i < 60; ++i) {
      std::size_t computed = 0;
      prepared.close(prepared.any_lane(random), random() % 3 != 0, &computed);
      EXPECT_LT(computed, prepared.hierarchy.arcs / 2);
      ASSERT_EQ(prepared.weights, weigh_all(prepared.graph, prepared.rules))
          << "arcs_of_lane leaves none out";
      const HierarchyMetric afresh(prepared.graph, prepared.hierarchy, prepared.weights);
      ASSERT_EQ(prepared.metric.up(), afresh.up());
      ASSERT_EQ(prepared.metric.down(), afresh.down());
    }
  }
}

TEST(Hierarchy, ArcsThatGetDearerAndCheaperAtOnceLeaveWhatCustomisingAfreshGives) {
  Prepared prepared(tests::lane_grid(6, 6));
  std::mt19937 random(20261122);
  for (int round = 0; round < 60; ++round) {
    std::vector<std::uint32_t> arcs;
    std::vector<Ticks> now;
    for (std::uint32_t arc = 0; arc < prepared.weights.size(); ++arc) {
      if (random() % 8 != 0) continue;
      arcs.push_back(arc);
      now.push_back(prepared.weights[arc] = 1 + static_cast<Ticks>(random() % 400'000));
    }
    prepared.metric.change(arcs, now);
    const HierarchyMetric afresh(prepared.graph, prepared.hierarchy, prepared.weights);
    ASSERT_EQ(prepared.metric.up(), afresh.up());
    ASSERT_EQ(prepared.metric.down(), afresh.down());
  }
}

TEST(Hierarchy, OfSeveralSeedsTakesTheCheapestPair) {
  const Prepared prepared(tests::lane_grid(5, 4));
  HierarchySearch search(prepared.metric);
  GraphSearch a_star(prepared.graph);
  std::mt19937 random(20261121);
  for (int i = 0; i < 300; ++i) {
    std::vector<Seed> from, to;
    for (unsigned j = 0; j < 1 + random() % 4; ++j) {
      from.push_back({prepared.any_node(random), static_cast<Ticks>(random() % 200000)});
      to.push_back({prepared.any_node(random), static_cast<Ticks>(random() % 200000)});
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
    ASSERT_EQ(a_star.find(prepared.weights, prepared.guide, from, to).cost, expected);
    ASSERT_EQ(cost_between(search.climb(from, false), search.climb(to, true)), expected);
    if (path.cost == kNever) continue;
    Ticks cost = from[path.from_seed].cost + to[path.to_seed].cost;
    for (const std::uint32_t arc : path.arcs) cost += prepared.weights[arc];
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
