#include "roadbed/planning/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "roadbed/planning/candidate_queue.h"
#include "roadbed/planning/collision.h"
#include "roadbed/planning/road_border.h"
#include "roadbed/planning/row.h"

namespace roadbed::planning {
namespace {

using geometry::Quintic;
using geometry::VehicleShape;

void check(const LateralState& start, const PlanOptions& options) {
  const auto demand = [](bool kept, const char* rule) {
    if (!kept) throw std::invalid_argument(fmt::format("plan: {}", rule));
  };
  demand(std::isfinite(start.s_m) && std::isfinite(start.d_m) && std::isfinite(start.d_slope) &&
             std::isfinite(start.d_curvature_per_m),
         "the start must be finite");
  demand(options.points >= 2, "a candidate needs at least 2 points");
  demand(options.clearance_m >= 0.0, "the clearance must not be negative");
  demand(options.max_lateral_acceleration_mps2 > 0.0, "max_lateral_acceleration must be positive");
  demand(options.recovery_m > 0.0, "recovery_m must be positive");
  demand(options.horizon_s >= 0.0, "the horizon must not be negative");
  demand(std::isfinite(options.border_margin_m), "the border margin must be finite");
  check_weights(options.weights);
}

Grid grid_of(const PlanOptions& options) {
  return Grid({.d_step_m = options.d_step_m,
               .min_d_m = options.min_d_m,
               .max_d_m = options.max_d_m,
               .l_step_m = options.l_step_m,
               .min_l_m = options.min_l_m,
               .max_l_m = options.max_l_m});
}

geometry::Pose2 start_pose(const LineView& line, const LateralState& start) {
  const ReferencePoint at = line.at(start.s_m);
  const Eigen::Vector2d normal(-std::sin(at.heading_rad), std::cos(at.heading_rad));
  const Eigen::Vector2d in_map = at.in_map + start.d_m * normal;
  const double along = 1.0 - at.curvature_per_m * start.d_m;
  return {in_map.x(), in_map.y(), at.heading_rad + std::atan2(start.d_slope, along)};
}

// How far the vehicle's body, or the full width at its rear axle, is outside the corridor now.
double start_excess_m(const PlanInput& input, const VehicleShape& vehicle, const RoadBorder& border,
                      double half_width_m) {
  const Corridor corridor = input.line.corridor_at(input.start.s_m);
  const double axle_m = half_width_m + std::max(input.start.d_m - corridor.left_m,
                                                -input.start.d_m - corridor.right_m);
  const double body_m =
      border.excess_m(start_pose(input.line, input.start), vehicle, input.start.s_m);
  return std::max({0.0, axle_m, body_m});
}

PlannedSpeed planned_speed(const PlanInput& input) {
  return input.speed_profile.empty() ? PlannedSpeed(input.speed)
                                     : PlannedSpeed(input.speed_profile);
}

// What all candidates of a cycle are judged against.
struct Cycle {
  Cycle(const PlanInput& of_input, const VehicleShape& of_vehicle, const PlanOptions& options)
      : input(of_input),
        vehicle(of_vehicle),
        grid(grid_of(options)),
        border(input.line, input.start.s_m - vehicle.length_m,
               input.start.s_m + grid.max_l_m() + vehicle.length_m, options.border_margin_m),
        collision({.obstacles = input.obstacles,
                   .field = input.static_field,
                   .origin_in_source = input.origin_in_source,
                   .start_t_s = input.start_t_s,
                   .predicted = input.predicted},
                  vehicle,
                  {.circles = options.circles,
                   .clearance_m = options.clearance_m,
                   .recovery_m = options.recovery_m,
                   .horizon_s = options.horizon_s}),
        course{.line = input.line,
               .start = input.start,
               .speed = planned_speed(input),
               .previous_d_m = input.previous_d_m,
               .half_width_m = 0.5 * vehicle.width_m + options.border_margin_m,
               .recovery_m = options.recovery_m} {
    course.start_excess_m = start_excess_m(input, vehicle, border, course.half_width_m);
    for (const double end_l_m : grid.end_l_m()) {
      rows.push_back(stations_over(course, end_l_m, options.points));
    }
  }

  CostFrame frame(double end_l_m) const {
    return {.end_l_m = end_l_m,
            .max_l_m = grid.max_l_m(),
            .start_speed_mps = course.speed.at(0.0).speed_mps};
  }
  const std::vector<Station>& stations(std::size_t index) const {
    return rows[index / grid.lanes()];
  }
  Quintic quintic(std::size_t index) const {
    return QuinticFamily(input.start, grid.end_l_m(index)).member(grid.end_d_m(index));
  }

  const PlanInput& input;
  const VehicleShape& vehicle;
  Grid grid;
  RoadBorder border;
  CollisionChecker collision;
  Course course;
  std::vector<std::vector<Station>> rows;  // stations, one list per l_e
};

// Cost and verdict so far of every candidate of the grid.
struct PricedGrid {
  std::vector<double> cost;
  std::vector<Rejection> rejection;
};

PricedGrid price_candidates(const Cycle& cycle, const PlanOptions& options) {
  PricedGrid priced;
  RowQuestion question{
      .end_d_m = cycle.grid.end_d_m(),
      .weights = options.weights,
      .frame = {},
      .limits = driving_limits(cycle.vehicle, options.max_lateral_acceleration_mps2)};
  for (std::size_t row = 0; row < cycle.rows.size(); ++row) {
    question.frame = cycle.frame(cycle.grid.end_l_m()[row]);
    const QuinticFamily family(cycle.input.start, question.frame.end_l_m);
    const RowResult result = evaluate_row(cycle.rows[row], family, question);
    priced.cost.insert(priced.cost.end(), result.cost.begin(), result.cost.end());
    priced.rejection.insert(priced.rejection.end(), result.rejection.begin(),
                            result.rejection.end());
  }
  return priced;
}

// A candidate, and on at d_e up to the length of the longest one.
struct CandidateDrive {
  std::vector<Station> stations;
  std::vector<geometry::TrajectoryPoint> points;  // at most one per station
};

CandidateDrive drive_of(const Cycle& cycle, std::size_t index) {
  CandidateDrive drive{.stations = cycle.stations(index), .points = {}};
  const double end_l_m = cycle.grid.end_l_m(index);
  const double apart_m = 0.25 * end_l_m / static_cast<double>(drive.stations.size() - 1);
  for (const Station& station : cycle.rows.back()) {
    if (station.l_m > end_l_m + apart_m) drive.stations.push_back(station);
  }
  drive.points = drive_along(drive.stations, cycle.quintic(index), cycle.input.start_t_s,
                             cycle.vehicle.wheelbase_m);
  return drive;
}

bool keeps_to_the_road(const Cycle& cycle, const CandidateDrive& drive) {
  for (std::size_t i = 0; i < drive.points.size(); ++i) {
    const Station& station = drive.stations[i];
    const double excess_m =
        cycle.border.excess_m(drive.points[i].pose(), cycle.vehicle, station.line.s_m);
    if (excess_m > allowed_excess_m(cycle.course, station.l_m) + kLimitSlack) return false;
  }
  return true;
}

// What is too dear to ask of every candidate.
Rejection look_closer(const Cycle& cycle, std::size_t index) {
  const CandidateDrive drive = drive_of(cycle, index);
  if (!keeps_to_the_road(cycle, drive)) return Rejection::off_road;
  return cycle.collision.is_free(drive.points) ? Rejection::none : Rejection::collision;
}

Candidate candidate_at(const Cycle& cycle, const PricedGrid& priced, std::size_t index) {
  return {.end_d_m = cycle.grid.end_d_m(index),
          .end_l_m = cycle.grid.end_l_m(index),
          .terms = {},
          .cost = priced.cost[index],
          .rejection = priced.rejection[index]};
}

Candidate candidate_with_terms(const Cycle& cycle, const PricedGrid& priced, std::size_t index) {
  Candidate candidate = candidate_at(cycle, priced, index);
  const auto points = cost_points(cycle.stations(index), cycle.quintic(index));
  if (!points.empty()) candidate.terms = cost_terms(points, cycle.frame(candidate.end_l_m));
  return candidate;
}

// The first one, cheapest first, that keeps to the road and collides with nothing.
std::optional<std::size_t> choose_lazily(const Cycle& cycle, PricedGrid& priced) {
  for (CandidateQueue queue(priced.cost, priced.rejection); !queue.empty();) {
    std::vector<std::size_t> equals = queue.pop_equals();
    std::ranges::sort(equals, [&](std::size_t a, std::size_t b) {
      return is_preferred(candidate_at(cycle, priced, a), candidate_at(cycle, priced, b));
    });
    for (const std::size_t index : equals) {
      priced.rejection[index] = look_closer(cycle, index);
      if (priced.rejection[index] == Rejection::none) return index;
    }
  }
  return std::nullopt;
}

std::vector<Candidate> all_candidates(const Cycle& cycle, PricedGrid& priced) {
  std::vector<Candidate> candidates;
  candidates.reserve(cycle.grid.size());
  for (std::size_t index = 0; index < cycle.grid.size(); ++index) {
    Rejection& rejection = priced.rejection[index];
    if (rejection == Rejection::none) rejection = look_closer(cycle, index);
    candidates.push_back(candidate_with_terms(cycle, priced, index));
  }
  return candidates;
}

RejectionCounts count(const std::vector<Rejection>& rejections) {
  RejectionCounts counts{};
  for (const Rejection rejection : rejections) ++counts[static_cast<std::size_t>(rejection)];
  counts[static_cast<std::size_t>(Rejection::none)] = 0;
  return counts;
}

std::string reason_for_none(std::size_t candidates, const RejectionCounts& rejected) {
  const auto of = [&](Rejection cause) { return rejected[static_cast<std::size_t>(cause)]; };
  return fmt::format(
      "none of {} candidates can be driven: {} leave the road, {} are beyond the curvature that "
      "can be steered, {} are beyond the lateral acceleration, {} collide",
      candidates, of(Rejection::off_road), of(Rejection::beyond_curvature),
      of(Rejection::lateral_acceleration), of(Rejection::collision));
}

}  // namespace

bool is_preferred(const Candidate& a, const Candidate& b) {
  const double side_a = std::abs(a.end_d_m), side_b = std::abs(b.end_d_m);
  if (side_a != side_b) return side_a < side_b;
  if (a.end_l_m != b.end_l_m) return a.end_l_m > b.end_l_m;
  return a.end_d_m > b.end_d_m;
}

LateralState Plan::lateral_at(double s_m) const {
  const Quintic quintic = QuinticFamily(start, chosen->end_l_m).member(chosen->end_d_m);
  const double l_m = s_m - start.s_m;
  if (l_m >= quintic.length()) return {.s_m = s_m, .d_m = chosen->end_d_m};
  const auto d = quintic.at(l_m);
  return {.s_m = s_m, .d_m = d[0], .d_slope = d[1], .d_curvature_per_m = d[2]};
}

Plan plan_path(const PlanInput& input, const VehicleShape& vehicle, const PlanOptions& options) {
  check(input.start, options);
  const Cycle cycle(input, vehicle, options);
  PricedGrid priced = price_candidates(cycle, options);
  const std::optional<std::size_t> choice = choose_lazily(cycle, priced);

  Plan plan;
  plan.start = input.start;
  plan.rejected = count(priced.rejection);
  if (choice) {
    plan.chosen = candidate_with_terms(cycle, priced, *choice);
    plan.trajectory = geometry::Trajectory(drive_of(cycle, *choice).points);
  } else {
    plan.reason = reason_for_none(cycle.grid.size(), plan.rejected);
  }
  if (options.keep_candidates) plan.candidates = all_candidates(cycle, priced);
  return plan;
}

}  // namespace roadbed::planning
