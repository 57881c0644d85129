#include "roadbed/planning/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "roadbed/planning/candidate_search.h"
#include "roadbed/planning/collision.h"
#include "roadbed/planning/road_border.h"
#include "roadbed/planning/row.h"
#include "roadbed/planning/way_on.h"

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
  demand(options.way_on_horizon_s >= 0.0, "way_on_horizon must not be negative");
  demand(options.way_on_deceleration_mps2 > 0.0, "way_on_deceleration must be positive");
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
        scene{.obstacles = input.obstacles,
              .field = input.static_field,
              .origin_in_source = input.origin_in_source,
              .start_t_s = input.start_t_s,
              .predicted = input.predicted},
        collision(scene, vehicle,
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
  CollisionScene scene;
  CollisionChecker collision;
  Course course;
  std::vector<std::vector<Station>> rows;  // stations, one list per l_e
};

CandidateSearch search_of(const Cycle& cycle, const PlanOptions& options) {
  RowQuestion question{
      .end_d_m = cycle.grid.end_d_m(),
      .weights = options.weights,
      .frame = {},
      .limits = driving_limits(cycle.vehicle, options.max_lateral_acceleration_mps2)};
  if (options.limit_steering_rate) {
    question.limits.max_steering_rate_radps = cycle.vehicle.max_steering_rate_radps;
  }
  // One block for all rows: the allocator keeps it from cycle to cycle, where it would give many
  // small ones back, and have their pages cleared again.
  const std::size_t count = cycle.rows.front().size();
  std::vector<KernelPoint> points(cycle.rows.size() * count);
  std::vector<Row> rows;
  rows.reserve(cycle.rows.size());
  for (std::size_t row = 0; row < cycle.rows.size(); ++row) {
    question.frame = cycle.frame(cycle.grid.end_l_m()[row]);
    const QuinticFamily family(cycle.input.start, question.frame.end_l_m);
    rows.emplace_back(cycle.rows[row], family, question,
                      std::span(points).subspan(row * count, count));
  }
  return {std::move(rows), std::move(points), cycle.grid.lanes(),
          options.exhaustive || options.keep_candidates};
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

// What is too dear to ask of every candidate. Candidates that are looked at one after the other
// are much alike, so the last contacts are tried first.
class CloserLook {
 public:
  CloserLook(const Cycle& cycle, const PlanOptions& options)
      : cycle_(cycle),
        way_on_(cycle.course, cycle.scene, cycle.vehicle,
                {.horizon_s = options.way_on_horizon_s,
                 .deceleration_mps2 = options.way_on_deceleration_mps2,
                 .clearance_m = options.clearance_m,
                 .recovery_m = options.recovery_m,
                 .circles = options.circles}) {}

  Rejection at(std::size_t index) {
    const CandidateDrive drive = drive_of(cycle_, index);
    if (!keeps_to_the_road(cycle_, drive)) return Rejection::off_road;
    const auto contact = cycle_.collision.first_contact(drive.points);
    if (!contact) {
      const bool leads_on = way_on_.exists(cycle_.grid.end_d_m(index), cycle_.grid.end_l_m(index));
      return leads_on ? Rejection::none : Rejection::collision;
    }
    const std::size_t deeper = std::min(contact->leg + kDeeper, drive.points.size() - 1);
    remember({*contact, drive.stations[deeper].l_m});
    return Rejection::collision;
  }

  /// Whether a candidate cannot pass, for a reason that is not told apart.
  bool surely_fails(std::size_t index) const {
    const geometry::Quintic quintic = cycle_.quintic(index);
    return std::ranges::any_of(contacts_, [&](const Place& place) {
      if (place.l_m > quintic.length()) return false;
      const auto& stations = cycle_.stations(index);
      const double share = place.l_m / quintic.length();
      const auto nearest =
          static_cast<std::size_t>(std::lround(share * static_cast<double>(stations.size() - 1)));
      const auto point = drive_point(stations, nearest, quintic, cycle_.input.start_t_s);
      return point &&
             cycle_.collision.surely_hits(place.contact, point->pose, point->t_s, point->driven_m);
    });
  }

 private:
  struct Place {
    Contact contact;
    double l_m;
  };
  static constexpr std::size_t kRemembered = 3;
  static constexpr std::size_t kDeeper = 2;  // stations on from where the clearance is lost

  void remember(const Place& place) {
    contacts_.insert(contacts_.begin(), place);
    if (contacts_.size() > kRemembered) contacts_.pop_back();
  }

  const Cycle& cycle_;
  WayOn way_on_;
  std::vector<Place> contacts_;  // the last one first
};

Candidate candidate_at(const Cycle& cycle, const CandidateSearch& search, std::size_t index) {
  return {.end_d_m = cycle.grid.end_d_m(index),
          .end_l_m = cycle.grid.end_l_m(index),
          .terms = {},
          .cost = search.cost(index),
          .rejection = search.rejections()[index]};
}

Candidate candidate_with_terms(const Cycle& cycle, const CandidateSearch& search,
                               std::size_t index) {
  Candidate candidate = candidate_at(cycle, search, index);
  const auto points = cost_points(cycle.stations(index), cycle.quintic(index));
  if (!points.empty()) candidate.terms = cost_terms(points, cycle.frame(candidate.end_l_m));
  return candidate;
}

// The first one, cheapest first, that keeps to the road and collides with nothing. Only if there
// is none, it is told apart why each of them fails.
std::optional<std::size_t> choose_lazily(const Cycle& cycle, CandidateSearch& search,
                                         const PlanOptions& options) {
  CloserLook look(cycle, options);
  std::vector<std::size_t> failed;
  for (auto equals = search.pop_equals(); !equals.empty(); equals = search.pop_equals()) {
    std::ranges::sort(equals, [&](std::size_t a, std::size_t b) {
      return is_preferred(candidate_at(cycle, search, a), candidate_at(cycle, search, b));
    });
    for (const std::size_t index : equals) {
      if (look.surely_fails(index)) {
        search.reject(index, Rejection::collision);
        failed.push_back(index);
        continue;
      }
      search.reject(index, look.at(index));
      if (search.rejections()[index] == Rejection::none) return index;
    }
  }
  for (const std::size_t index : failed) search.reject(index, look.at(index));
  return std::nullopt;
}

std::vector<Candidate> all_candidates(const Cycle& cycle, CandidateSearch& search,
                                      const PlanOptions& options) {
  CloserLook look(cycle, options);
  std::vector<Candidate> candidates;
  candidates.reserve(cycle.grid.size());
  for (std::size_t index = 0; index < cycle.grid.size(); ++index) {
    const Rejection found = search.rejections()[index];
    if (found == Rejection::none || found == Rejection::collision) {
      search.reject(index, look.at(index));
    }
    candidates.push_back(candidate_with_terms(cycle, search, index));
  }
  return candidates;
}

RejectionCounts count(const std::vector<Rejection>& rejections) {
  RejectionCounts counts{};
  for (const Rejection rejection : rejections) ++counts[static_cast<std::size_t>(rejection)];
  counts[static_cast<std::size_t>(Rejection::none)] = 0;
  return counts;
}

// What is wrong with the start, that none of the candidates can help.
std::string fault_of_start(const Cycle& cycle) {
  const Corridor room = cycle.input.line.corridor_at(cycle.input.start.s_m);
  const double width_m = room.left_m + room.right_m;
  if (cycle.vehicle.width_m > width_m) {
    return fmt::format(
        "the vehicle is {:.2f} m wide and the road {:.2f} m: ", cycle.vehicle.width_m, width_m);
  }
  if (cycle.course.start_excess_m > 0.0) {
    return fmt::format("the start is {:.2f} m off the road: ", cycle.course.start_excess_m);
  }
  return {};
}

std::string reason_for_none(const Cycle& cycle, const RejectionCounts& rejected) {
  const auto of = [&](Rejection cause) { return rejected[static_cast<std::size_t>(cause)]; };
  return fmt::format(
      "{}none of {} candidates can be driven: {} leave the road, {} are beyond the curvature that "
      "can be steered, {} are beyond the lateral acceleration, {} are beyond the steering rate, {} "
      "collide",
      fault_of_start(cycle), cycle.grid.size(), of(Rejection::off_road),
      of(Rejection::beyond_curvature), of(Rejection::lateral_acceleration),
      of(Rejection::steering_rate), of(Rejection::collision));
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
  CandidateSearch search = search_of(cycle, options);
  const std::optional<std::size_t> choice = choose_lazily(cycle, search, options);

  Plan plan;
  plan.evaluated = search.evaluated();
  plan.start = input.start;
  plan.rejected = count(search.rejections());
  if (choice) {
    plan.chosen = candidate_with_terms(cycle, search, *choice);
    plan.trajectory = geometry::Trajectory(drive_of(cycle, *choice).points);
  } else {
    plan.reason = reason_for_none(cycle, plan.rejected);
  }
  if (options.keep_candidates) plan.candidates = all_candidates(cycle, search, options);
  return plan;
}

}  // namespace roadbed::planning
