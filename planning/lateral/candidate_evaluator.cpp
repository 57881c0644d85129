#include "roadbed/planning/lateral/candidate_evaluator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace roadbed::planning::inline lateral {
namespace {

using geometry::VehicleShape;

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

PlannedSpeed planned_speed(const PlanInput& input) {
  return input.speed_profile.empty() ? PlannedSpeed(input.speed)
                                     : PlannedSpeed(input.speed_profile);
}

// A station's place and directions in the map.
struct Frame {
  explicit Frame(const ReferencePoint& line)
      : in_map(line.in_map),
        tangent(std::cos(line.heading_rad), std::sin(line.heading_rad)),
        normal(-tangent.y(), tangent.x()) {}

  // The body of a candidate: p′ = along · tangent + across · normal.
  geometry::Rectangle body(double d_m, double along, double across,
                           const VehicleShape& vehicle) const {
    const double per_stretch = 1.0 / std::sqrt(along * along + across * across);
    const Eigen::Vector2d axis = per_stretch * (along * tangent + across * normal);
    const double half_length_m = 0.5 * vehicle.length_m;
    return {in_map + d_m * normal + (half_length_m - vehicle.rear_overhang_m) * axis, axis,
            half_length_m, 0.5 * vehicle.width_m};
  }

  Eigen::Vector2d in_map, tangent, normal;
};

// A place among equally spaced stations.
struct Between {
  std::size_t station;  // the last one that is not farther
  double fraction;      // of the way to the next
};

// The nearest to a length, of the stations and of what divides the ways between them into parts.
Between nearest(const std::vector<Station>& stations, double l_m, int parts) {
  const double last = static_cast<double>(stations.size() - 1);
  const double fraction = std::clamp(l_m / stations.back().l_m, 0.0, 1.0);
  const long part = std::lround(fraction * last * parts);
  return {static_cast<std::size_t>(part / parts), static_cast<double>(part % parts) / parts};
}

// As a drive goes from one of its points to the next: position and heading are linear.
CandidateBody interpolate(const CandidateBody& a, const CandidateBody& b, double fraction,
                          const VehicleShape& vehicle) {
  const auto between = [&](const auto& from, const auto& to) {
    return from + fraction * (to - from);
  };
  const double axle_m = a.body.half_length_m - vehicle.rear_overhang_m;
  const Eigen::Vector2d &from = a.body.axis, &to = b.body.axis;
  const double turn_rad =
      fraction * std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
  CandidateBody at = a;
  at.body.axis =
      std::cos(turn_rad) * from + std::sin(turn_rad) * Eigen::Vector2d(-from.y(), from.x());
  at.body.centre =
      between((a.body.centre - axle_m * from).eval(), (b.body.centre - axle_m * to).eval()) +
      axle_m * at.body.axis;
  at.s_m = between(a.s_m, b.s_m);
  at.l_m = between(a.l_m, b.l_m);
  at.t_s = between(a.t_s, b.t_s);
  at.driven_m = between(a.driven_m, b.driven_m);
  at.is_there = a.is_there && b.is_there;
  return at;
}

// From a candidate's last station past its end, beside the line at d_e, over those of the stations
// that are farther than `from_m`.
void go_on(const Station& last, std::span<const Station> stations, double from_m, double end_d_m,
           CandidateBody& at) {
  const auto stretch_at = [&](const Station& station) {
    return 1.0 - station.line.curvature_per_m * end_d_m;
  };
  const Station* before = &last;
  for (const Station& station : stations) {
    if (!(station.l_m > from_m)) continue;
    at.is_there = at.is_there && stretch_at(station) > kLeastUnfolded;
    const double length_m =
        0.5 * (stretch_at(*before) + stretch_at(station)) * (station.l_m - before->l_m);
    at.driven_m += length_m;
    at.t_s += length_m / mean_speed_mps(*before, station);
    before = &station;
  }
}

}  // namespace

CandidateEvaluator::CandidateEvaluator(const PlanInput& input, const VehicleShape& vehicle,
                                       const PlanOptions& options)
    : input_(input),
      vehicle_(vehicle),
      options_(options),
      margins_{options.border_margin_m, options.clearance_m},
      grid_(grid_of(options)),
      border_(input.line, input.start.s_m - vehicle.length_m,
              input.start.s_m + grid_.max_l_m() + vehicle.length_m),
      scene_{.obstacles = input.obstacles,
             .field = input.static_field,
             .origin_in_source = input.origin_in_source,
             .start_t_s = input.start_t_s,
             .predicted = input.predicted},
      collision_(scene_, vehicle,
                 {.circles = options.circles,
                  .clearance_m = options.clearance_m,
                  .recovery_m = options.recovery_m,
                  .horizon_s = options.horizon_s}),
      context_{.line = input.line,
               .start = input.start,
               .speed = planned_speed(input),
               .previous_d_m = input.previous_d_m,
               .recovery_m = options.recovery_m},
      stations_(grid_.length_count()),
      linear_(grid_.length_count()) {
  for (const double end_l_m : grid_.end_l_m()) families_.emplace_back(input.start, end_l_m);
  set_margins(margins_);
}

void CandidateEvaluator::set_margins(const SafetyMargins& margins) {
  margins_ = margins;
  collision_.set_clearance(margins.clearance_m);
  context_.half_width_m = 0.5 * vehicle_.width_m + margins.border_margin_m;
  context_.start_excess_m = start_excess_m();
  for (std::vector<Station>& batch : stations_) {
    for (Station& station : batch) {
      const OffsetRange range = offsets_on_road(context_, station.l_m);
      station.min_d_m = range.min_d_m;
      station.max_d_m = range.max_d_m;
    }
  }
}

// How far the vehicle's body, or the full width at its rear axle, is outside the corridor now.
double CandidateEvaluator::start_excess_m() const {
  const Corridor corridor = input_.line.corridor_at(input_.start.s_m);
  const double axle_m = context_.half_width_m + std::max(input_.start.d_m - corridor.left_m,
                                                         -input_.start.d_m - corridor.right_m);
  const geometry::Rectangle body =
      geometry::body_at(start_pose(input_.line, input_.start), vehicle_);
  const double body_m = border_.excess_m(body, vehicle_.rear_overhang_m, input_.start.s_m);
  return std::max({0.0, axle_m, body_m + margins_.border_margin_m});
}

std::string CandidateEvaluator::fault_of_start() const {
  const Corridor corridor = input_.line.corridor_at(input_.start.s_m);
  const double width_m = corridor.left_m + corridor.right_m;
  if (vehicle_.width_m > width_m) {
    return fmt::format("the vehicle is {:.2f} m wide and the road {:.2f} m: ", vehicle_.width_m,
                       width_m);
  }
  if (context_.start_excess_m > 0.0) {
    return fmt::format("the start is {:.2f} m off the road: ", context_.start_excess_m);
  }
  return {};
}

CostFrame CandidateEvaluator::frame(std::size_t batch) const {
  return {.end_l_m = grid_.end_l_m()[batch],
          .max_l_m = grid_.max_l_m(),
          .start_speed_mps = context_.speed.at(0.0).speed_mps};
}

geometry::Quintic CandidateEvaluator::quintic(std::size_t index) const {
  return families_[index / grid_.offset_count()].member(grid_.end_d_m(index));
}

std::vector<Station> CandidateEvaluator::make_stations(std::size_t batch) const {
  return stations_over(context_, grid_.end_l_m()[batch], options_.points);
}

const std::vector<Station>& CandidateEvaluator::stations(std::size_t batch) {
  if (stations_[batch].empty()) stations_[batch] = make_stations(batch);
  return stations_[batch];
}

// Stations of the longest batch that are nearer to the end of a shorter one say nothing new.
double CandidateEvaluator::past_end_from_m(double end_l_m) const {
  return end_l_m * (1.0 + 0.25 / (options_.points - 1));
}

CandidateDrive CandidateEvaluator::drive(std::size_t index) {
  const std::size_t batch = index / grid_.offset_count();
  const std::vector<Station>& longest = stations(grid_.length_count() - 1);
  CandidateDrive drive;
  drive.stations.reserve(2 * longest.size());
  drive.stations = stations(batch);
  for (const Station& station : longest) {
    if (station.l_m > past_end_from_m(grid_.end_l_m(index))) drive.stations.push_back(station);
  }
  drive.points =
      drive_along(drive.stations, quintic(index), input_.start_t_s, vehicle_.wheelbase_m);
  return drive;
}

double CandidateEvaluator::excess_m(const CandidateBody& at) const {
  return border_.excess_m(at.body, vehicle_.rear_overhang_m, at.s_m) + margins_.border_margin_m -
         allowed_excess_m(context_, at.l_m);
}

double CandidateEvaluator::excess_m(const CandidateDrive& drive, std::size_t point) const {
  const Station& station = drive.stations[point];
  return excess_m({.body = geometry::body_at(drive.points[point].pose(), vehicle_),
                   .s_m = station.line.s_m,
                   .l_m = station.l_m});
}

const std::vector<LinearPoint>& CandidateEvaluator::linear(std::size_t batch) {
  if (linear_[batch].empty()) linear_[batch] = linear_points(stations(batch), families_[batch]);
  return linear_[batch];
}

std::vector<CandidateBody> CandidateEvaluator::bodies(std::size_t batch,
                                                      std::span<const double> end_d_m, double l_m,
                                                      const BodyQuestion& asked) {
  const bool is_past_end = l_m > grid_.end_l_m()[batch];
  const auto bodies_of = [&](std::size_t station) {
    return is_past_end ? bodies_past_end(batch, station, end_d_m, asked.with_lengths)
                       : bodies_at(batch, station, end_d_m, asked.with_lengths);
  };
  const Between at =
      nearest(stations(is_past_end ? grid_.length_count() - 1 : batch), l_m, asked.parts);
  if (at.fraction == 0.0) return bodies_of(at.station);
  std::vector<CandidateBody> bodies = bodies_of(at.station);
  const std::vector<CandidateBody> next = bodies_of(at.station + 1);
  if (bodies.empty()) return next;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    bodies[i] = interpolate(bodies[i], next[i], at.fraction, vehicle_);
  }
  return bodies;
}

std::vector<CandidateBody> CandidateEvaluator::bodies_at(std::size_t batch, std::size_t station,
                                                         std::span<const double> end_d_m,
                                                         bool with_lengths) {
  const std::span points = std::span(linear(batch)).first(station + 1);
  const PartialArcLengths lengths =
      with_lengths ? partial_arc_lengths(points, end_d_m) : PartialArcLengths{};
  const Station& at = stations(batch)[station];
  const Frame frame(at.line);
  const LinearPoint& p = points.back();
  std::vector<CandidateBody> bodies;
  bodies.reserve(end_d_m.size());
  for (std::size_t offset = 0; offset < end_d_m.size(); ++offset) {
    const auto of_offset = [e = end_d_m[offset]](const double(&linear)[2]) {
      return linear[0] + e * linear[1];
    };
    bodies.push_back(
        {.body = frame.body(of_offset(p.d_m), of_offset(p.along), of_offset(p.across), vehicle_),
         .s_m = at.line.s_m,
         .l_m = at.l_m,
         .t_s = input_.start_t_s + lengths.duration_s[offset],
         .driven_m = lengths.driven_m[offset]});
  }
  return bodies;
}

std::vector<CandidateBody> CandidateEvaluator::bodies_past_end(std::size_t batch,
                                                               std::size_t station,
                                                               std::span<const double> end_d_m,
                                                               bool with_lengths) {
  const std::vector<Station>& longest = stations(grid_.length_count() - 1);
  const double from_m = past_end_from_m(grid_.end_l_m()[batch]);
  const std::span ahead(longest.data(), station + 1);
  std::vector<CandidateBody> bodies;
  if (!(ahead.back().l_m > from_m)) return bodies;
  const Frame frame(ahead.back().line);
  const PartialArcLengths lengths =
      with_lengths ? partial_arc_lengths(linear(batch), end_d_m) : PartialArcLengths{};
  for (std::size_t offset = 0; offset < end_d_m.size(); ++offset) {
    CandidateBody at{.body = frame.body(end_d_m[offset], 1.0, 0.0, vehicle_),
                     .s_m = ahead.back().line.s_m,
                     .l_m = ahead.back().l_m,
                     .t_s = input_.start_t_s + lengths.duration_s[offset],
                     .driven_m = lengths.driven_m[offset]};
    go_on(stations(batch).back(), ahead, from_m, end_d_m[offset], at);
    bodies.push_back(at);
  }
  return bodies;
}

}  // namespace roadbed::planning::lateral
