// bench_planner --path F --points N --reps R --json [--dump F]: times one planning cycle of 5,396
// candidates and twelve terms on one core, so that it can be run in turn with other planners. With
// every candidate evaluated it also says what share of the core's peak that is.
#include <fmt/format.h>
#include <sys/resource.h>
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/planning/lateral/batch_cost_kernel.h"
#include "roadbed/tests/benchmark/peak_flops.h"
#include "roadbed/tests/benchmark/planner_scene.h"

namespace {

using namespace roadbed;
using nlohmann::ordered_json;

struct Options {
  std::string path_file, dump_file;
  int points = 31;
  int repetitions = 51;
  bool json = false, exhaustive = false, blocked = false, cold = false;
};

struct Timing {
  double median_ms, least_ms, worst_ms;
  double median_cpu_ms;  // of this thread: others on the core do not count
  std::size_t evaluated;
};

constexpr double kCandidates = 5396.0;
// Of the kernel per candidate and point: 101 additions, multiplications, divisions and roots, and 3
// maxima (planning/lateral/batch_cost_kernel.cpp).
constexpr double kFlopsPerPoint = 104.0;

planning::PlanOptions plan_options_of(const Options& options) {
  planning::PlanOptions plan_options = benchmark_scene::options_with(options.points);
  plan_options.exhaustive = options.exhaustive;
  return plan_options;
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

double thread_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// Nothing of the planner's is in any cache after this.
void evict_caches() {
  static std::vector<unsigned char> memory(96UL << 20U);
  for (std::size_t i = 0; i < memory.size(); i += 64) ++memory[i];
}

Timing time_cycles(const benchmark_scene::PlannerScene& scene, const Options& options) {
  using Clock = std::chrono::steady_clock;
  const planning::PlanInput input = scene.input();
  const planning::PlanOptions plan_options = plan_options_of(options);
  planning::Plan plan;
  std::vector<double> times_ms, cpu_ms;
  for (int i = -2; i < options.repetitions; ++i) {  // two to warm up
    if (options.cold) evict_caches();
    const double cpu_begin_ms = thread_ms();
    const auto begin = Clock::now();
    plan = planning::plan_path(input, geometry::VehicleShape{}, plan_options);
    const std::chrono::duration<double, std::milli> taken = Clock::now() - begin;
    const double cpu_taken_ms = thread_ms() - cpu_begin_ms;
    if (i < 0) continue;
    times_ms.push_back(taken.count());
    cpu_ms.push_back(cpu_taken_ms);
  }
  const auto [least, worst] = std::ranges::minmax(times_ms);
  return {median(times_ms), least, worst, median(cpu_ms), plan.evaluated};
}

// Candidates that collide and cost less than the chosen one.
std::ptrdiff_t colliding(const benchmark_scene::PlannerScene& scene, const Options& options) {
  planning::PlanOptions plan_options = plan_options_of(options);
  plan_options.keep_candidates = true;
  const planning::PlanInput input = scene.input();
  const planning::Plan plan = planning::plan_path(input, geometry::VehicleShape{}, plan_options);
  return std::ranges::count_if(plan.candidates, [&](const planning::Candidate& candidate) {
    return candidate.rejection == planning::Rejection::collision && plan.chosen &&
           candidate.cost < plan.chosen->cost;
  });
}

// What evaluating every candidate comes to, beside what the core can do.
struct Work {
  double gflop, kernel_mb, peak_gflops;
};

Work work_of(const Options& options) {
  const double points = kCandidates * options.points;
  const double point_bytes = sizeof(planning::KernelPoint);
  return {1e-9 * kFlopsPerPoint * points,
          1e-6 * point_bytes * points / static_cast<double>(planning::kSimdWidth),
          benchmark_scene::peak_gflops()};
}

ordered_json terms_json(const planning::CostTerms& terms) {
  ordered_json json = ordered_json::object();
  for (int i = 0; i < planning::kCostTerms; ++i) {
    const auto term = static_cast<planning::CostTerm>(i);
    json[std::string(planning::to_string(term))] = planning::of(terms, term);
  }
  return json;
}

ordered_json candidate_json(const planning::Candidate& candidate) {
  return {{"d_e_m", candidate.end_d_m},
          {"l_e_m", candidate.end_l_m},
          {"terms", terms_json(candidate.terms)},
          {"cost", candidate.cost},
          {"rejection", std::string(planning::to_string(candidate.rejection))}};
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
  if (!options.dump_file.empty()) map::check_writable(options.dump_file, true);
  const benchmark_scene::PlannerScene scene(benchmark_scene::read_way_points(options.path_file),
                                            options.blocked);
  const Timing timing = time_cycles(scene, options);
  const std::ptrdiff_t cheaper = colliding(scene, options);
  const Work work = work_of(options);
  const double gflops = 1e3 * work.gflop / timing.median_cpu_ms;
  if (!options.dump_file.empty()) map::write_output(options.dump_file, dump(scene, options), true);
  if (options.json) {
    const ordered_json json = {{"candidates", 5396},
                               {"terms", planning::kCostTerms},
                               {"points", options.points},
                               {"median_ms", timing.median_ms},
                               {"least_ms", timing.least_ms},
                               {"worst_ms", timing.worst_ms},
                               {"evaluated", timing.evaluated},
                               {"median_cpu_ms", timing.median_cpu_ms},
                               {"colliding", cheaper},
                               {"gflop", work.gflop},
                               {"kernel_mb", work.kernel_mb},
                               {"peak_gflops", work.peak_gflops},
                               {"peak_memory_mb", peak_memory_mb()},
                               {"repetitions", options.repetitions}};
    fmt::print("{}\n", json.dump());
  } else {
    fmt::print(
        "5396 candidates, {} terms, {} points: median {:.3f} ms ({:.3f} ms of processor time), "
        "least {:.3f}, worst {:.3f}; {} evaluated, {} cheaper ones collide; {:.1f} MB\n",
        planning::kCostTerms, options.points, timing.median_ms, timing.median_cpu_ms,
        timing.least_ms, timing.worst_ms, timing.evaluated, cheaper, peak_memory_mb());
    if (options.exhaustive) {
      fmt::print(
          "{:.1f} Mflop on {:.1f} MB of shared points: {:.1f} Gflop/s with all else, {:.0f} % of "
          "{:.1f}\n",
          1e3 * work.gflop, work.kernel_mb, gflops, 100.0 * gflops / work.peak_gflops,
          work.peak_gflops);
    }
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
  app.add_flag("--blocked", options.blocked, "Ten slow cars ahead: the cheapest collide");
  app.add_flag("--cold", options.cold, "Nothing is in a cache before a cycle");
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
