// Times routing in turn with Boost.Graph on the same graph and weights, one core, medians in µs:
//   bench_routes [--grid COLUMNS]... [--pairs N] [MAP]...
// Every cost that is measured is compared, too: `differ` counts the pairs that do not agree.

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "roadbed/map/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/planning/dissection.h"
#include "roadbed/planning/hierarchy_search.h"
#include "roadbed/planning/route.h"
#include "roadbed/planning/route_solver.h"
#include "roadbed/tests/support/boost_routes.h"
#include "roadbed/tests/support/lane_grid.h"

namespace roadbed::tests {
namespace {

using planning::Ticks;
using Clock = std::chrono::steady_clock;

double us_since(Clock::time_point start) {
  return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

template <typename Work>
auto timed(std::vector<double>& times_us, const Work& work) {
  const auto start = Clock::now();
  auto result = work();
  times_us.push_back(us_since(start));
  return result;
}

double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void print_peak() { fmt::print("  peak memory so far {:.0f} MB\n", peak_mb()); }

void race(const planning::RouteNetwork& network, int pairs) {
  const planning::RouteOptions options;
  planning::TravelRules rules(network, options);
  auto start = Clock::now();
  const planning::RouteGraph graph = planning::make_route_graph(network);
  std::vector<Ticks> weights = planning::weigh_all(graph, rules);
  const planning::Guide guide = planning::make_guide(graph, network, weights);
  fmt::print("  {} lanes, {} nodes, {} arcs; graph {:.1f} ms\n", network.lanes.size(),
             graph.nodes(), graph.arcs(), us_since(start) / 1e3);
  start = Clock::now();
  const auto order = planning::dissection_order(graph, guide.place_in_map);
  const double order_s = us_since(start) / 1e6;
  start = Clock::now();
  const planning::Hierarchy hierarchy = planning::make_hierarchy(graph, order);
  const double build_s = us_since(start) / 1e6;
  start = Clock::now();
  planning::HierarchyMetric metric(graph, hierarchy, weights);
  fmt::print("  hierarchy of {} arcs: order {:.3f} s, build {:.3f} s, customise {:.3f} s\n",
             hierarchy.arcs, order_s, build_s, us_since(start) / 1e6);
  print_peak();
  planning::GraphSearch a_star(graph);
  planning::HierarchySearch search(metric);
  BoostRoutes boost(graph, weights);
  std::mt19937 random(20261121);
  std::vector<double> boost_us, boost_star_us, star_us, cost_us, find_us, close_us, touched;
  int found = 0, differ = 0;
  for (int i = 0; i < pairs; ++i) {
    const planning::Seed from{static_cast<std::uint32_t>(random() % graph.nodes()), 0};
    const planning::Seed to{static_cast<std::uint32_t>(random() % graph.nodes()), 0};
    const Ticks expected = timed(boost_us, [&] { return boost.dijkstra(from.node, to.node); });
    if (expected == planning::kNever) {
      boost_us.pop_back();
      differ += search.cost({&from, 1}, {&to, 1}) != expected ? 1 : 0;
      continue;
    }
    ++found;
    const Ticks costs[] = {
        timed(boost_star_us, [&] { return boost.a_star(from.node, to.node, guide); }),
        timed(star_us,
              [&] {
                return a_star.find(weights, guide, {&from, 1}, {&to, 1}).cost;
              }),
        timed(cost_us,
              [&] {
                return search.cost({&from, 1}, {&to, 1});
              }),
        timed(find_us, [&] {
          return search.find({&from, 1}, {&to, 1}).cost;
        })};
    for (const Ticks cost : costs) differ += cost != expected ? 1 : 0;
  }
  for (int i = 0; i < 100; ++i) {
    const auto lane = static_cast<std::uint32_t>(random() % network.lanes.size());
    const auto arcs = planning::arcs_of_lane(graph, lane);
    for (const bool closed : {true, false}) {
      rules.close(lane, closed);
      const auto now = Clock::now();
      std::vector<Ticks> changed;
      for (const std::uint32_t arc : arcs) changed.push_back(planning::weigh(graph, rules, arc));
      const std::size_t computed = metric.change(arcs, changed);
      if (!closed) continue;
      close_us.push_back(us_since(now));
      touched.push_back(static_cast<double>(computed));
    }
  }
  fmt::print("  {} pairs, {} connected, {} differ\n", pairs, found, differ);
  fmt::print("  {:<36}{:>10}\n", "median us", "");
  const auto row = [&](const char* name, const std::vector<double>& times_us) {
    fmt::print("  {:<36}{:>10.1f}\n", name, median(times_us));
  };
  row("Boost Dijkstra, stopped at the goal", boost_us);
  row("Boost A*", boost_star_us);
  row("A*", star_us);
  row("hierarchy, cost", cost_us);
  row("hierarchy, with the way", find_us);
  row("close one lane", close_us);
  fmt::print("  {:<36}{:>10.0f}\n", "  its arcs of the hierarchy, median", median(touched));
}

// Questions as a user of the library asks them, with the route laid out.
void race_on_map(const std::filesystem::path& file, int pairs) {
  const map::RoadMap road_map = map::load_map(file);
  auto start = Clock::now();
  const planning::RouteNetwork network = planning::make_route_network(road_map);
  fmt::print("{}\n  network {:.1f} ms\n", file.filename().string(), us_since(start) / 1e3);
  race(network, pairs);
  planning::Router router(road_map);
  planning::Router prepared(road_map);
  start = Clock::now();
  prepared.prepare();
  fmt::print("  Router::prepare {:.1f} ms\n", us_since(start) / 1e3);
  std::mt19937 random(20261121);
  std::vector<double> solve_us, find_us, tree_us;
  for (int i = 0; i < pairs; ++i) {
    const auto place = [&] {
      for (;;) {
        const auto& lane = road_map.lanes()[random() % road_map.lanes().size()];
        if (planning::may_use(lane, map::Participant::car)) {
          return map::LanePlace{lane.id, 0.5 * lane.length_m(), 0.0};
        }
      }
    };
    const map::LanePlace from = place(), to = place();
    if (!router.solver().solve(from, to)) continue;
    timed(solve_us, [&] { return router.solver().solve(from, to)->cost; });
    timed(find_us, [&] { return router.find(from, to).route->cost_s; });
    timed(tree_us, [&] { return prepared.find(from, to).route->cost_s; });
  }
  fmt::print("  {:<36}{:>10.1f}\n", "lane to lane, A*: the way", median(solve_us));
  fmt::print("  {:<36}{:>10.1f}\n", "lane to lane, A*: the route's legs", median(find_us));
  fmt::print("  {:<36}{:>10.1f}\n", "lane to lane, hierarchy: its legs", median(tree_us));
}

int run(int argc, char** argv) {
  int pairs = 1000;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--pairs") == 0 && i + 1 < argc) {
      pairs = std::stoi(argv[++i]);
    } else if (std::strcmp(argv[i], "--grid") == 0 && i + 1 < argc) {
      const int columns = std::stoi(argv[++i]);
      fmt::print("grid of {} x {} crossings\n", columns, columns);
      race(lane_grid(columns, columns), pairs);
    } else {
      race_on_map(argv[i], pairs);
    }
  }
  return 0;
}

}  // namespace
}  // namespace roadbed::tests

int main(int argc, char** argv) {
  try {
    return roadbed::tests::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_routes: {}\n", error.what());
    return 1;
  }
}
