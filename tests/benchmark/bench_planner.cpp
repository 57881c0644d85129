// bench_planner --path F --points N --reps R --json [--dump F]: times one planning cycle of 5,396
// candidates and twelve terms on one core, so that it can be run in turn with other planners.
#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "roadbed/map/input_error.h"
#include "roadbed/tests/benchmark/planner_scene.h"
#include "roadbed/tools/support/output_file.h"

namespace {

using namespace roadbed;
using nlohmann::ordered_json;

struct Options {
  std::string path_file, dump_file;
  int points = 31;
  int repetitions = 51;
  bool json = false, exhaustive = false, blocked = false;
};

struct Timing {
  double median_ms, least_ms, worst_ms;
  std::size_t evaluated, colliding;
};

planning::PlanOptions plan_options_of(const Options& options) {
  planning::PlanOptions plan_options = benchmark_scene::options_with(options.points);
  plan_options.exhaustive = options.exhaustive;
  return plan_options;
}

Timing time_cycles(const benchmark_scene::PlannerScene& scene, const Options& options) {
  using Clock = std::chrono::steady_clock;
  const planning::PlanInput input = scene.input();
  const planning::PlanOptions plan_options = plan_options_of(options);
  planning::Plan plan;
  std::vector<double> times_ms;
  for (int i = -2; i < options.repetitions; ++i) {  // two to warm up
    const auto begin = Clock::now();
    plan = planning::plan_path(input, geometry::VehicleShape{}, plan_options);
    const std::chrono::duration<double, std::milli> taken = Clock::now() - begin;
    if (i >= 0) times_ms.push_back(taken.count());
  }
  std::ranges::sort(times_ms);
  return {times_ms[times_ms.size() / 2], times_ms.front(), times_ms.back(), plan.evaluated,
          plan.rejected[static_cast<std::size_t>(planning::Rejection::collision)]};
}

ordered_json terms_json(const planning::CostTerms& terms) {
  ordered_json json = ordered_json::object();
  for (int i = 0; i < planning::kCostTerms; ++i) {
    const auto term = static_cast<planning::CostTerm>(i);
    json[std::string(planning::name(term))] = planning::of(terms, term);
  }
  return json;
}

ordered_json candidate_json(const planning::Candidate& candidate) {
  return {{"d_e_m", candidate.end_d_m},
          {"l_e_m", candidate.end_l_m},
          {"terms", terms_json(candidate.terms)},
          {"cost", candidate.cost},
          {"rejection", std::string(planning::name(candidate.rejection))}};
}

ordered_json line_json(const planning::LineView& line, double from_s_m, double to_s_m) {
  ordered_json rows = ordered_json::array();
  for (int i = 0; from_s_m + 0.1 * i <= to_s_m + 1e-9; ++i) {
    const planning::ReferencePoint p = line.at(from_s_m + 0.1 * i);
    rows.push_back({p.s_m, p.in_map.x(), p.in_map.y(), p.heading_rad, p.curvature_per_m,
                    p.curvature_d1_per_m2, p.curvature_d2_per_m3, p.curvature_d3_per_m4,
                    p.curvature_d4_per_m5});
  }
  return rows;
}

// Everything that another program needs to compute the same again.
std::string dump(const benchmark_scene::PlannerScene& scene, const Options& options) {
  planning::PlanOptions plan_options = benchmark_scene::options_with(options.points);
  plan_options.keep_candidates = true;
  const planning::PlanInput input = scene.input();
  const planning::Plan plan = planning::plan_path(input, geometry::VehicleShape{}, plan_options);
  ordered_json json = {
      {"points", options.points},
      {"start",
       {{"s_m", input.start.s_m},
        {"d_m", input.start.d_m},
        {"d_slope", input.start.d_slope},
        {"d_curvature_per_m", input.start.d_curvature_per_m}}},
      {"speed",
       {{"speed_mps", input.speed.speed_mps},
        {"acceleration_mps2", input.speed.acceleration_mps2},
        {"target_mps", input.speed.target_mps}}},
      {"weights", terms_json(plan_options.weights)},
      {"line_columns",
       {"s_m", "x_m", "y_m", "heading_rad", "k_per_m", "k1_per_m2", "k2_per_m3", "k3_per_m4",
        "k4_per_m5"}},
      {"line", line_json(input.line, input.start.s_m, input.start.s_m + plan_options.max_l_m)}};
  json["candidates"] = ordered_json::array();
  for (const auto& candidate : plan.candidates) {
    json["candidates"].push_back(candidate_json(candidate));
  }
  json["winner"] = plan.chosen ? candidate_json(*plan.chosen) : ordered_json();
  return json.dump() + "\n";
}

// Of the whole program, the reference line included.
double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void run(const Options& options) {
  if (!options.dump_file.empty()) tools::check_writable(options.dump_file, true);
  const benchmark_scene::PlannerScene scene(benchmark_scene::read_way_points(options.path_file),
                                            options.blocked);
  const Timing timing = time_cycles(scene, options);
  if (!options.dump_file.empty()) tools::write_output(options.dump_file, dump(scene, options));
  if (options.json) {
    const ordered_json json = {{"candidates", 5396},
                               {"terms", planning::kCostTerms},
                               {"points", options.points},
                               {"median_ms", timing.median_ms},
                               {"least_ms", timing.least_ms},
                               {"worst_ms", timing.worst_ms},
                               {"evaluated", timing.evaluated},
                               {"colliding", timing.colliding},
                               {"peak_memory_mb", peak_memory_mb()},
                               {"repetitions", options.repetitions}};
    fmt::print("{}\n", json.dump());
  } else {
    fmt::print(
        "5396 candidates, {} terms, {} points: median {:.3f} ms, least {:.3f}, worst {:.3f}; {} "
        "evaluated, {} cheaper ones collide; {:.1f} MB\n",
        planning::kCostTerms, options.points, timing.median_ms, timing.least_ms, timing.worst_ms,
        timing.evaluated, timing.colliding, peak_memory_mb());
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Times one planning cycle on one core");
  app.add_option("--path", options.path_file, "Way-points, x,y per row [m]")->required();
  app.add_option("--points", options.points, "Points per candidate")
      ->check(CLI::Range(2, 1001))
      ->capture_default_str();
  app.add_option("--reps", options.repetitions, "Timed cycles")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_flag("--exhaustive", options.exhaustive, "Evaluate even what cannot be the cheapest");
  app.add_flag("--blocked", options.blocked, "Ten slow cars on the line: the cheapest collide");
  app.add_flag("--json", options.json, "One JSON document on stdout");
  app.add_option("--dump", options.dump_file, "Writes every candidate and the winner as JSON");
  app.footer("Example: bench_planner --path path.csv --points 31 --reps 51 --json");
  try {
    app.parse(argc, argv);
    run(options);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_planner: {}\n", error.what());
    return 1;
  }
  return 0;
}
