#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "roadbed/map/storage/output_file.h"
#include "roadbed/planning/lateral/planned_path.h"
#include "roadbed/planning/plan.h"
#include "roadbed/tools/commands/commands.h"
#include "roadbed/tools/files/trajectory_csv.h"
#include "roadbed/tools/report/plan_svg.h"
#include "roadbed/tools/report/surroundings.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline commands {
namespace {

using nlohmann::ordered_json;
using planning::Candidate;
using planning::CostTerm;
using planning::CostTerms;
using planning::Plan;

constexpr double kPictureReach_m = 60.0;

planning::PlanOptions options_of(const Scenario& scenario) {
  planning::PlanOptions options;
  options.clearance_m = scenario.options.clearance_m;
  options.keep_candidates = true;
  options.weights = scenario.options.weights;
  return options;
}

// The cycle at t = 0: the vehicle where the scenario puts it, at its speed, wheels straight.
planning::PlanInput input_of(const Scenario& scenario, const World& world) {
  const planning::LateralState start = lateral_state(world.line, world.start, 0.0, 0.0);
  const double limit_mps = world.line.corridor_at(start.s_m).speed_limit_mps;
  return {.line = world.line,
          .start = start,
          .speed = {.speed_mps = scenario.start_speed_mps,
                    .acceleration_mps2 = 0.0,
                    .target_mps = std::min(limit_mps, scenario.options.desired_speed_mps)},
          .obstacles = world.obstacles,
          .static_field = world.field.get(),
          .origin_in_source = world.road_map.origin_in_source()};
}

bool is_chosen(const Plan& plan, const Candidate& candidate) {
  return plan.chosen && plan.chosen->end_d_m == candidate.end_d_m &&
         plan.chosen->end_l_m == candidate.end_l_m;
}

std::string candidates_csv(const Plan& plan) {
  std::string csv = "d_e_m,l_e_m";
  for (int i = 0; i < planning::kCostTerms; ++i) {
    csv += fmt::format(",{}", planning::to_string(static_cast<CostTerm>(i)));
  }
  csv += ",cost,rejection,chosen\n";
  for (const Candidate& candidate : plan.candidates) {
    csv += fmt::format("{},{}", candidate.end_d_m, candidate.end_l_m);
    for (const double term : candidate.terms) csv += fmt::format(",{}", term);
    csv += fmt::format(",{},{},{}\n", candidate.cost, planning::to_string(candidate.rejection),
                       is_chosen(plan, candidate) ? 1 : 0);
  }
  return csv;
}

geometry::Trajectory in_source(const Plan& plan, const Eigen::Vector2d& origin_in_source) {
  std::vector<geometry::TrajectoryPoint> points = plan.trajectory.points();
  for (geometry::TrajectoryPoint& point : points) {
    point.x_m += origin_in_source.x();
    point.y_m += origin_in_source.y();
  }
  return geometry::Trajectory(std::move(points));
}

// The cheapest candidate that could have been driven instead.
std::optional<Candidate> runner_up(const Plan& plan) {
  std::optional<Candidate> best;
  for (const Candidate& candidate : plan.candidates) {
    if (candidate.rejection != planning::Rejection::none || is_chosen(plan, candidate)) continue;
    if (!best || candidate.cost < best->cost) best = candidate;
  }
  return best;
}

std::array<std::size_t, planning::kRejections> verdicts(const Plan& plan) {
  std::array<std::size_t, planning::kRejections> counts{};
  for (const Candidate& candidate : plan.candidates) {
    ++counts[static_cast<std::size_t>(candidate.rejection)];
  }
  return counts;
}

ordered_json plan_json(const Candidate& candidate) {
  ordered_json terms;
  for (int i = 0; i < planning::kCostTerms; ++i) {
    const auto term = static_cast<CostTerm>(i);
    terms[std::string(planning::to_string(term))] = planning::of(candidate.terms, term);
  }
  return {{"d_e_m", candidate.end_d_m},
          {"l_e_m", candidate.end_l_m},
          {"cost", candidate.cost},
          {"terms", terms}};
}

ordered_json plan_json(const Plan& plan) {
  const auto counts = verdicts(plan);
  ordered_json rejected;
  for (int i = 1; i < planning::kRejections; ++i) {
    rejected[std::string(planning::to_string(static_cast<planning::Rejection>(i)))] =
        counts[static_cast<std::size_t>(i)];
  }
  const auto second = runner_up(plan);
  return {{"found", plan.chosen.has_value()},
          {"reason", plan.reason},
          {"candidates", plan.candidates.size()},
          {"feasible", counts[0]},
          {"rejected", rejected},
          {"chosen", plan.chosen ? plan_json(*plan.chosen) : ordered_json()},
          {"runner_up", second ? plan_json(*second) : ordered_json()}};
}

// The weighted terms of a candidate, and with --explain the share of its cost that each one has.
std::string term_columns(const Candidate& candidate, CostTerm term, const CostTerms& weights,
                         bool with_fraction) {
  const double cost = planning::of(weights, term) * planning::of(candidate.terms, term);
  const double fraction = candidate.cost > 0.0 ? 100.0 * cost / candidate.cost : 0.0;
  return with_fraction ? fmt::format("{:>12.6f}{:>7.1f} %", cost, fraction)
                       : fmt::format("{:>12.6f}", cost);
}

void print_terms(std::ostream& out, const Plan& plan, const CostTerms& weights,
                 bool with_fraction) {
  const auto second = runner_up(plan);
  const int width = with_fraction ? 21 : 12;
  fmt::print(out, "{:<26}{:>8}{:>{}}{:>{}}\n", "weighted term", "weight", "chosen", width,
             "runner-up", width);
  for (int i = 0; i < planning::kCostTerms; ++i) {
    const auto term = static_cast<CostTerm>(i);
    fmt::print(out, "{:<26}{:>8g}{}{}\n", planning::to_string(term), planning::of(weights, term),
               term_columns(*plan.chosen, term, weights, with_fraction),
               second ? term_columns(*second, term, weights, with_fraction) : "");
  }
  fmt::print(out, "{:<34}{:>12.6f}{}{:>12}\n", "cost", plan.chosen->cost,
             with_fraction ? "         " : "", second ? fmt::format("{:.6f}", second->cost) : "");
}

void print_plan(std::ostream& out, const Plan& plan, const CostTerms& weights, bool explain) {
  const auto counts = verdicts(plan);
  fmt::print(out,
             "{} candidates: {} feasible, {} leave the road, {} beyond curvature, {} beyond "
             "lateral acceleration, {} beyond the steering rate, {} collide\n",
             plan.candidates.size(), counts[0], counts[1], counts[2], counts[3], counts[4],
             counts[5]);
  if (!plan.chosen) {
    fmt::print(out, "no plan: {}\n", plan.reason);
    return;
  }
  fmt::print(out, "chosen: d_e {:+.1f} m, l_e {:.1f} m, cost {:.6f}\n", plan.chosen->end_d_m,
             plan.chosen->end_l_m, plan.chosen->cost);
  print_terms(out, plan, weights, explain);
  if (!explain) return;
  if (const auto second = runner_up(plan)) {
    fmt::print(out, "runner-up: d_e {:+.1f} m, l_e {:.1f} m\n", second->end_d_m, second->end_l_m);
  }
}

void print_circles(std::ostream& out, const geometry::VehicleShape& vehicle, int count) {
  const geometry::CoveringCircles circles = geometry::covering_circles(vehicle, count);
  fmt::print(out, "{} circles of {:.3f} m cover the vehicle; they stick out by {:.3f} m\n", count,
             circles.radius_m, circles.radius_m - 0.5 * vehicle.width_m);
}

class PlanCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("One planning cycle: every candidate, its cost, and why it was rejected");
    arguments.add("SCENE", scene_file_, "Scenario (.json); the cycle at t = 0 is planned")
        .required();
    arguments.add("-o,--output", folder_, "Folder for candidates.csv, trajectory.csv and plan.svg")
        .required();
    arguments.add(
        "--options", options_file_,
        "How to drive (.json): a style (gentle, normal, sporty), limits, and weights of the "
        "cost, in place of the scenario's");
    arguments.add("--circles", circles_, "Circles that cover the vehicle, for the first look")
        .within(1, 20)
        .with_default();
    arguments.flag("--explain", explain_,
                   "Each term's share of the cost, for the chosen candidate and the runner-up");
    arguments.flag("--json", json_, "One JSON document on stdout");
    arguments.flag("--force", force_, "Replace files in the folder");
    arguments.example("  roadbed plan data/scenarios/parked_car.json -o /tmp/plan --explain");
  }

  Exit run(const Streams& streams, const CommonOptions&) override {
    Scenario scenario = read_scenario(scene_file_);
    if (!options_file_.empty()) read_planner_options(options_file_).apply_to(scenario.options);
    planning::PlanOptions options = options_of(scenario);
    options.circles = circles_;
    const World world = make_world(scenario);
    const planning::PlanInput input = input_of(scenario, world);
    map::make_output_folder(folder_, force_);
    const Plan plan = planning::plan_path(input, scenario.vehicle, options);
    write(scenario, world, input, plan);
    if (json_) {
      fmt::print(streams.out, "{}\n", plan_json(plan).dump(2));
    } else {
      print_plan(streams.out, plan, options.weights, explain_);
      if (explain_) print_circles(streams.out, scenario.vehicle, circles_);
    }
    return plan.chosen ? Exit::ok : Exit::failed;
  }

 private:
  void write(const Scenario& scenario, const World& world, const planning::PlanInput& input,
             const Plan& plan) const {
    const std::filesystem::path folder = folder_;
    map::write_output(folder / "candidates.csv", candidates_csv(plan));
    if (plan.chosen) {
      map::write_output(folder / "trajectory.csv",
                        write_trajectory_csv(in_source(plan, input.origin_in_source)));
    }
    PlanPicture picture{.input = input,
                        .plan = plan,
                        .vehicle = scenario.vehicle,
                        .occupied = {},
                        .title = scenario.name};
    if (world.occupancy) {
      const Eigen::Vector2d start = world.start.position() + input.origin_in_source;
      const Eigen::Vector2d around = Eigen::Vector2d::Constant(kPictureReach_m);
      picture.occupied =
          occupied_in(*world.occupancy, map::HeightBand{}, {start - around, start + around});
    }
    map::write_output(folder / "plan.svg", plan_svg(picture));
  }

  std::string scene_file_, folder_, options_file_;
  int circles_ = planning::PlanOptions{}.circles;
  bool json_ = false, force_ = false, explain_ = false;
};

}  // namespace

std::unique_ptr<Command> make_plan_command() { return std::make_unique<PlanCommand>(); }

}  // namespace roadbed::tools::commands
