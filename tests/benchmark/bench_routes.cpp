// Times routing in turn with Boost.Graph on the same graph and weights, one core, medians in µs:
//   bench_routes [--pairs N] [--batch N] [--grid COLUMNS]... [MAP]...
// Every cost that is measured is compared, too: `differ` counts the pairs that do not agree.

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/planning/route/hierarchy.h"
#include "roadbed/planning/route/hierarchy_search.h"
#include "roadbed/planning/route/route_network.h"
#include "roadbed/planning/route/route_solver.h"
#include "roadbed/planning/route/router.h"
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

/// Ways to answer the same questions, in turn: each one a block of them, so that none pays for what
/// another one did to the caches.
class Race {
 public:
  void add(const std::string& name, std::function<Ticks(std::size_t)> answer) {
    runners_.push_back({name, std::move(answer), {}});
  }

  /// @param expected  of each question; `differ` counts answers that are not so.
  void run(std::size_t questions, const std::vector<Ticks>& expected) {
    for (std::size_t first = 0; first < questions; first += kBlock) {
      for (Runner& runner : runners_) {
        for (std::size_t i = first; i < std::min(questions, first + kBlock); ++i) {
          const auto start = Clock::now();
          const Ticks answer = runner.answer(i);
          runner.times_us.push_back(us_since(start));
          if (!expected.empty() && answer != expected[i]) ++differ_;
        }
      }
    }
  }

  int differ() const { return differ_; }

  void print() const {
    for (const Runner& runner : runners_) {
      fmt::print("  {:<36}{:>10.1f}\n", runner.name, median(runner.times_us));
    }
  }

 private:
  static constexpr std::size_t kBlock = 50;
  struct Runner {
    std::string name;
    std::function<Ticks(std::size_t)> answer;
    std::vector<double> times_us;
  };
  std::vector<Runner> runners_;
  int differ_ = 0;
};

double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void print_peak() { fmt::print("  peak memory so far {:.0f} MB\n", peak_mb()); }

void race_on_graph(const planning::RouteGraph& graph, const planning::Guide& guide,
                   const std::vector<Ticks>& weights, const planning::HierarchyMetric& metric,
                   int pairs) {
  planning::GraphSearch a_star(graph);
  planning::HierarchySearch search(metric);
  BoostRoutes boost(graph, weights);
  std::mt19937 random(20261121);
  std::vector<std::pair<planning::Seed, planning::Seed>> asked;
  std::vector<Ticks> expected;
  int differ = 0;
  for (int i = 0; i < pairs; ++i) {
    const planning::Seed from{static_cast<std::uint32_t>(random() % graph.nodes()), 0};
    const planning::Seed to{static_cast<std::uint32_t>(random() % graph.nodes()), 0};
    const Ticks cost = boost.dijkstra(from.node, to.node);
    if (cost == planning::kNever) {
      differ += search.cost({&from, 1}, {&to, 1}) != cost ? 1 : 0;
      continue;
    }
    asked.push_back({from, to});
    expected.push_back(cost);
  }
  Race race;
  race.add("Boost Dijkstra, stopped at the goal", [&](std::size_t i) {
    return boost.dijkstra(asked[i].first.node, asked[i].second.node);
  });
  race.add("Boost A*", [&](std::size_t i) {
    return boost.a_star(asked[i].first.node, asked[i].second.node, guide);
  });
  race.add("A*", [&](std::size_t i) {
    return a_star.find(weights, guide, {&asked[i].first, 1}, {&asked[i].second, 1}).cost;
  });
  race.add("hierarchy, cost", [&](std::size_t i) {
    return search.cost({&asked[i].first, 1}, {&asked[i].second, 1});
  });
  race.add("hierarchy, with the way", [&](std::size_t i) {
    return search.find({&asked[i].first, 1}, {&asked[i].second, 1}).cost;
  });
  race.run(asked.size(), expected);
  fmt::print("  {} pairs, {} connected, {} differ\n", pairs, asked.size(), differ + race.differ());
  fmt::print("  {:<36}{:>10}\n", "median us", "");
  race.print();
}

double thread_cpu_s() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

struct BatchRun {
  std::vector<Ticks> costs;
  double wall_s = 0.0;
  double cpu_s = 0.0;  ///< of all threads
};

// Ways between random pairs, every other one by another thread.
BatchRun batch(const planning::HierarchyMetric& metric, std::size_t pairs, std::size_t threads) {
  const std::size_t nodes = metric.graph().nodes();
  std::mt19937 random(20261121);
  std::vector<std::pair<planning::Seed, planning::Seed>> asked;
  for (std::size_t i = 0; i < pairs; ++i) {
    asked.push_back({{static_cast<std::uint32_t>(random() % nodes), 0},
                     {static_cast<std::uint32_t>(random() % nodes), 0}});
  }
  BatchRun run{std::vector<Ticks>(pairs), 0.0, 0.0};
  std::vector<double> cpu_s(threads);
  const auto work = [&](std::size_t first) {
    const double before_s = thread_cpu_s();
    planning::HierarchySearch search(metric);
    for (std::size_t i = first; i < pairs; i += threads) {
      run.costs[i] = search.find({&asked[i].first, 1}, {&asked[i].second, 1}).cost;
    }
    cpu_s[first] = thread_cpu_s() - before_s;
  };
  const auto start = Clock::now();
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < threads; ++i) others.emplace_back(work, i);
  work(0);
  for (std::thread& other : others) other.join();
  run.wall_s = us_since(start) / 1e6;
  for (const double spent_s : cpu_s) run.cpu_s += spent_s;
  return run;
}

void race_threads(const planning::HierarchyMetric& metric, std::size_t pairs) {
  const BatchRun one = batch(metric, pairs, 1), two = batch(metric, pairs, 2);
  fmt::print(
      "  {} ways: one thread {:.2f} s ({:.2f} s of processor), two {:.2f} s ({:.2f} s): {:.2f} "
      "times as fast, {:.2f} by processor time; {}\n",
      pairs, one.wall_s, one.cpu_s, two.wall_s, two.cpu_s, one.wall_s / two.wall_s,
      2.0 * one.cpu_s / two.cpu_s, one.costs == two.costs ? "same answers" : "answers differ");
}

void race_closures(const planning::RouteNetwork& network, const planning::RouteGraph& graph,
                   planning::RoutingCostModel& rules, planning::HierarchyMetric& metric) {
  std::mt19937 random(20261121);
  std::vector<double> close_us, open_us, touched;
  for (int i = 0; i < 200; ++i) {
    const auto lane = static_cast<std::uint32_t>(random() % network.lanes.size());
    const auto arcs = planning::arcs_of_lane(graph, lane);
    for (const bool closed : {true, false}) {
      rules.close(lane, closed);
      const auto now = Clock::now();
      std::vector<Ticks> changed;
      for (const std::uint32_t arc : arcs) changed.push_back(planning::weigh(graph, rules, arc));
      const std::size_t computed = metric.change(arcs, changed);
      (closed ? close_us : open_us).push_back(us_since(now));
      if (closed) touched.push_back(static_cast<double>(computed));
    }
  }
  const auto row = [](const char* name, const std::vector<double>& values) {
    fmt::print("  {:<36}{:>10.1f}\n", name, median(values));
  };
  row("close one lane", close_us);
  row("open it again", open_us);
  row("  arcs of the hierarchy, closing", touched);
}

void race(const planning::RouteNetwork& network, int pairs, std::size_t batch_pairs) {
  const planning::RouteOptions options;
  planning::RoutingCostModel rules(network, options);
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
  race_on_graph(graph, guide, weights, metric, pairs);
  if (batch_pairs > 0) race_threads(metric, batch_pairs);
  race_closures(network, graph, rules, metric);
}

// Questions as a user of the library asks them, with the route laid out.
void race_on_map(const std::filesystem::path& file, int pairs) {
  const map::RoadMap road_map = map::load_map(file);
  auto start = Clock::now();
  const planning::RouteNetwork network = planning::make_route_network(road_map);
  fmt::print("{}\n  network {:.1f} ms\n", file.filename().string(), us_since(start) / 1e3);
  race(network, pairs, 0);
  planning::Router router(road_map);
  planning::Router prepared(road_map);
  start = Clock::now();
  prepared.prepare();
  fmt::print("  Router::prepare {:.1f} ms\n", us_since(start) / 1e3);
  std::mt19937 random(20261121);
  const auto place = [&] {
    for (;;) {
      const auto& lane = road_map.lanes()[random() % road_map.lanes().size()];
      if (planning::may_use(lane, map::Participant::car)) {
        return map::LanePlace{lane.id, 0.5 * lane.length_m(), 0.0};
      }
    }
  };
  std::vector<std::pair<map::LanePlace, map::LanePlace>> asked;
  for (int i = 0; i < pairs; ++i) {
    const map::LanePlace from = place(), to = place();
    if (router.solver().solve(from, to)) asked.push_back({from, to});
  }
  Race race;
  race.add("lane to lane, A*: the way", [&](std::size_t i) {
    return router.solver().solve(asked[i].first, asked[i].second)->cost;
  });
  race.add("lane to lane, A*: the route's legs", [&](std::size_t i) {
    return static_cast<Ticks>(router.find(asked[i].first, asked[i].second).route->legs.size());
  });
  race.add("lane to lane, hierarchy: its legs", [&](std::size_t i) {
    return static_cast<Ticks>(prepared.find(asked[i].first, asked[i].second).route->legs.size());
  });
  race.run(asked.size(), {});
  fmt::print("  {} of {} pairs of lanes connected, median us\n", asked.size(), pairs);
  race.print();
}

int run(int argc, char** argv) {
  int pairs = 1000;
  std::size_t batch_pairs = 0;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--pairs") == 0 && i + 1 < argc) {
      pairs = std::stoi(argv[++i]);
    } else if (std::strcmp(argv[i], "--batch") == 0 && i + 1 < argc) {
      batch_pairs = std::stoul(argv[++i]);
    } else if (std::strcmp(argv[i], "--grid") == 0 && i + 1 < argc) {
      const int columns = std::stoi(argv[++i]);
      fmt::print("grid of {} x {} crossings\n", columns, columns);
      race(lane_grid(columns, columns), pairs, batch_pairs);
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
