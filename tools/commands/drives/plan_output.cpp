#include "roadbed/tools/commands/drives/plan_output.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <array>
#include <optional>
#include <utility>

#include "roadbed/tools/files/trajectory_csv.h"
#include "roadbed/tools/report/plan_svg.h"
#include "roadbed/tools/report/surroundings.h"

namespace roadbed::tools::inline commands::inline drives {
namespace {

using planning::Candidate;
using planning::CostTerm;
using planning::CostTerms;
using planning::Plan;

constexpr double kPictureReach_m = 60.0;

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

Json candidate_json(const Candidate& candidate) {
  Json terms;
  for (int i = 0; i < planning::kCostTerms; ++i) {
    const auto term = static_cast<CostTerm>(i);
    terms[std::string(planning::to_string(term))] = planning::of(candidate.terms, term);
  }
  return {{"d_e_m", candidate.end_d_m},
          {"l_e_m", candidate.end_l_m},
          {"cost", candidate.cost},
          {"terms", terms}};
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

std::vector<map::Box2> occupied_around(const PlannedCycle& cycle) {
  if (!cycle.world.occupancy) return {};
  const planning::PlanInput& input = cycle.input;
  const Eigen::Vector2d start = input.line.at(input.start.s_m).in_map + input.origin_in_source;
  const Eigen::Vector2d around = Eigen::Vector2d::Constant(kPictureReach_m);
  return occupied_in(*cycle.world.occupancy, map::HeightBand{}, {start - around, start + around});
}

}  // namespace

void write_plan(const PlannedCycle& cycle, map::OutputFolder& folder) {
  folder.write("candidates.csv", candidates_csv(cycle.plan));
  if (cycle.plan.chosen) {
    folder.write("trajectory.csv",
                 write_trajectory_csv(in_source(cycle.plan, cycle.input.origin_in_source)));
  }
  folder.write("plan.svg", plan_svg({.input = cycle.input,
                                     .plan = cycle.plan,
                                     .vehicle = cycle.vehicle,
                                     .obstacles = cycle.world.obstacles,
                                     .occupied = occupied_around(cycle),
                                     .title = cycle.title}));
  folder.commit();
}

Json plan_json(const Plan& plan) {
  const auto counts = verdicts(plan);
  Json rejected;
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
          {"chosen", plan.chosen ? candidate_json(*plan.chosen) : Json()},
          {"runner_up", second ? candidate_json(*second) : Json()}};
}

void print_plan(std::ostream& out, const PlannedCycle& cycle, bool explain) {
  const Plan& plan = cycle.plan;
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
  print_terms(out, plan, cycle.weights, explain);
  if (!explain) return;
  if (const auto second = runner_up(plan)) {
    fmt::print(out, "runner-up: d_e {:+.1f} m, l_e {:.1f} m\n", second->end_d_m, second->end_l_m);
  }
}

void print_decision(std::ostream& out, const ReplayedCycle& replayed) {
  const DriveCycle& cycle = replayed.cycle;
  fmt::print(out, "{:.2f} s, {}: {}\n", cycle.t_s, planning::to_string(cycle.behaviour),
             cycle.reason);
  fmt::print(out, "set speed {:.2f} m/s, desired acceleration {:+.2f} m/s²{}\n",
             replayed.row.set_speed_mps, replayed.row.command_mps2,
             cycle.from_measurement ? ", planned from the measured state" : "");
  for (const planning::HypothesisOutcome& one : cycle.hypotheses) {
    const std::string end =
        one.end_d_m ? fmt::format(", d_e {:+.1f} m, l_e {:.1f} m", *one.end_d_m, *one.end_l_m) : "";
    fmt::print(out, "{}{}: {}\n", planning::to_string(one.maneuver), end,
               one.is_driven ? "driven" : one.reason);
  }
}

}  // namespace roadbed::tools::commands::drives
