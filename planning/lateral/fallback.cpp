#include "roadbed/planning/lateral/fallback.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "roadbed/planning/lateral/collision.h"
#include "roadbed/planning/lateral/plan_cycle.h"

namespace roadbed::planning::inline lateral {
namespace {

using geometry::Trajectory;
using geometry::VehicleShape;

bool all_positive(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double v) { return v > 0.0 && std::isfinite(v); });
}

void check(const FallbackOptions& options) {
  const auto demand = [](bool kept, const char* rule) {
    if (!kept) throw std::invalid_argument(fmt::format("plan: {}", rule));
  };
  demand(options.wider >= 1.0 && std::isfinite(options.wider), "wider must be at least 1");
  demand(options.shorter > 0.0 && options.shorter <= 1.0, "shorter must be over 0 and at most 1");
  demand(all_positive(options.beyond_the_edge_m), "beyond_the_edge_m must be positive");
  demand(!options.decelerations_mps2.empty() && all_positive(options.decelerations_mps2) &&
             std::ranges::is_sorted(options.decelerations_mps2),
         "the decelerations of a stop must be positive and ascending, one at least");
}

PlanOptions widened(const PlanOptions& options, const FallbackOptions& fallback) {
  PlanOptions wide = options;
  wide.min_d_m *= fallback.wider;
  wide.max_d_m *= fallback.wider;
  wide.min_l_m *= fallback.shorter;
  return wide;
}

struct StopQuestion {
  const PlanInput& input;
  LateralPath path;
  const VehicleShape& vehicle;
  double until_s;  // after the start; it stands from its stop until then
};

double speed_now_mps(const PlanInput& input) {
  return input.speed_profile.empty() ? input.speed.speed_mps
                                     : PlannedSpeed(input.speed_profile).at(0.0).speed_mps;
}

ControlledStop choose_stop(const StopQuestion& question, const PlanOptions& options,
                           const std::vector<double>& decelerations_mps2) {
  const PlanInput& input = question.input;
  const PathCourse course{.line = input.line,
                          .path = question.path,
                          .vehicle = question.vehicle,
                          .start_s_m = input.start.s_m,
                          .start_t_s = input.start_t_s};
  const double speed_mps = speed_now_mps(input);
  const auto stop_at = [&](double deceleration_mps2) {
    return stopping_drive(course, speed_mps, deceleration_mps2, question.until_s);
  };
  for (const double clearance_m : {options.clearance_m, 0.0}) {
    // Touching is a clearance below the checker's tolerance.
    const CollisionChecker checker({.obstacles = input.obstacles,
                                    .field = input.static_field,
                                    .origin_in_source = input.origin_in_source,
                                    .start_t_s = input.start_t_s,
                                    .predicted = input.predicted},
                                   question.vehicle,
                                   {.circles = options.circles,
                                    .clearance_m = clearance_m,
                                    .recovery_m = options.recovery_m,
                                    .horizon_s = options.horizon_s});
    for (const double deceleration_mps2 : decelerations_mps2) {
      Trajectory drive = stop_at(deceleration_mps2);
      if (checker.is_free(drive.points())) {
        return {deceleration_mps2, clearance_m, std::move(drive)};
      }
    }
  }
  const double hardest = decelerations_mps2.back();
  return {hardest, std::nullopt, stop_at(hardest)};
}

LateralPath path_of(const PlanInput& input, const LateralPath& previous, double settle_m) {
  if (previous) return previous;
  const LateralState start = input.start;
  const geometry::Quintic quintic = QuinticFamily(start, settle_m).member(start.d_m);
  return [start, quintic](double s_m) {
    const auto d = quintic.at(std::clamp(s_m - start.s_m, 0.0, quintic.length()));
    return LateralState{.s_m = s_m, .d_m = d[0], .d_slope = d[1], .d_curvature_per_m = d[2]};
  };
}

std::string words_for(const PlanOrStop& answer) {
  switch (answer.resort) {
    case Resort::none:
      return {};
    case Resort::wider_grid:
      return "nothing can be driven on the grid as asked; a wider one holds a way";
    case Resort::beyond_the_edge:
      return fmt::format(
          "nothing can be driven inside the road; {:.1f} m beyond its edge there is a way",
          answer.beyond_the_edge_m);
    case Resort::stop:
      break;
  }
  const ControlledStop& stop = *answer.stop;
  const std::string manner =
      !stop.clearance_m ? "and touches something all the same"
                        : fmt::format("at a clearance of {:.2f} m or more", *stop.clearance_m);
  return fmt::format("{}; stopping at {:.1f} m/s² along the previous path, {}", answer.plan.reason,
                     stop.deceleration_mps2, manner);
}

// Whether a grid holds a way, in one room after the other.
bool look_at(PlanCycle& cycle, Resort resort, const std::vector<double>& beyond_m, double margin_m,
             double clearance_m, PlanOrStop& answer) {
  std::vector<Room> rooms;
  for (const double out_m : beyond_m) rooms.push_back({margin_m - out_m, clearance_m});
  std::vector<Plan> plans = plan_in_rooms(cycle, rooms);
  for (std::size_t i = 0; i < plans.size(); ++i) {
    answer.resort = beyond_m[i] > 0.0 ? Resort::beyond_the_edge : resort;
    answer.beyond_the_edge_m = beyond_m[i];
    answer.attempts.push_back({answer.resort, beyond_m[i], plans[i].rejected});
  }
  answer.plan = std::move(plans.back());
  return answer.plan.chosen.has_value();
}

// Whether any of the grids holds a way.
bool look_at_grids(const PlanInput& input, const VehicleShape& vehicle, const PlanOptions& options,
                   const FallbackOptions& fallback, PlanOrStop& answer) {
  const double margin_m = options.border_margin_m, clearance_m = options.clearance_m;
  PlanCycle as_asked(input, vehicle, options);
  if (look_at(as_asked, Resort::none, {0.0}, margin_m, clearance_m, answer)) return true;
  PlanCycle wide(input, vehicle, widened(options, fallback));
  std::vector<double> beyond_m{0.0};
  std::ranges::copy(fallback.beyond_the_edge_m, std::back_inserter(beyond_m));
  return look_at(wide, Resort::wider_grid, beyond_m, margin_m, clearance_m, answer);
}

}  // namespace

std::string_view name(Resort resort) {
  constexpr std::array<std::string_view, 4> kNames = {"none", "wider_grid", "beyond_the_edge",
                                                      "stop"};
  return kNames.at(static_cast<std::size_t>(resort));
}

PlanOrStop plan_or_stop(const PlanInput& input, const LateralPath& previous,
                        const VehicleShape& vehicle, const PlanOptions& options,
                        const FallbackOptions& fallback) {
  check(fallback);
  PlanOrStop answer;
  if (!look_at_grids(input, vehicle, options, fallback, answer)) {
    answer.resort = Resort::stop;
    answer.beyond_the_edge_m = 0.0;
    answer.stop = choose_stop({.input = input,
                               .path = path_of(input, previous, options.min_l_m),
                               .vehicle = vehicle,
                               .until_s = options.horizon_s},
                              options, fallback.decelerations_mps2);
  }
  answer.reason = words_for(answer);
  return answer;
}

}  // namespace roadbed::planning::lateral
