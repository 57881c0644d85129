#include "roadbed/planning/lateral/cycle.h"

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

  // The body on a lane: p′ = along · tangent + across · normal.
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

// The station nearest to a length, of equally spaced ones.
std::size_t nearest(const std::vector<Station>& stations, double l_m) {
  const double last = static_cast<double>(stations.size() - 1);
  const double share = std::clamp(l_m / stations.back().l_m, 0.0, 1.0);
  return static_cast<std::size_t>(std::lround(share * last));
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

Cycle::Cycle(const PlanInput& input, const VehicleShape& vehicle, const PlanOptions& options)
    : input_(input),
      vehicle_(vehicle),
      options_(options),
      room_{options.border_margin_m, options.clearance_m},
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
      course_{.line = input.line,
              .start = input.start,
              .speed = planned_speed(input),
              .previous_d_m = input.previous_d_m,
              .recovery_m = options.recovery_m},
      stations_(grid_.rows()),
      linear_(grid_.rows()) {
  for (const double end_l_m : grid_.end_l_m()) families_.emplace_back(input.start, end_l_m);
  set_room(room_);
}

void Cycle::set_room(const Room& room) {
  room_ = room;
  collision_.set_clearance(room.clearance_m);
  course_.half_width_m = 0.5 * vehicle_.width_m + room.border_margin_m;
  course_.start_excess_m = start_excess_m();
}

// How far the vehicle's body, or the full width at its rear axle, is outside the corridor now.
double Cycle::start_excess_m() const {
  const Corridor corridor = input_.line.corridor_at(input_.start.s_m);
  const double axle_m = course_.half_width_m + std::max(input_.start.d_m - corridor.left_m,
                                                        -input_.start.d_m - corridor.right_m);
  const geometry::Rectangle body =
      geometry::body_at(start_pose(input_.line, input_.start), vehicle_);
  const double body_m = border_.excess_m(body, vehicle_.rear_overhang_m, input_.start.s_m);
  return std::max({0.0, axle_m, body_m + room_.border_margin_m});
}

CostFrame Cycle::frame(std::size_t row) const {
  return {.end_l_m = grid_.end_l_m()[row],
          .max_l_m = grid_.max_l_m(),
          .start_speed_mps = course_.speed.at(0.0).speed_mps};
}

geometry::Quintic Cycle::quintic(std::size_t index) const {
  return families_[index / grid_.lanes()].member(grid_.end_d_m(index));
}

std::vector<Station> Cycle::make_stations(std::size_t row) const {
  return stations_over(course_, grid_.end_l_m()[row], options_.points);
}

const std::vector<Station>& Cycle::stations(std::size_t row) {
  if (stations_[row].empty()) stations_[row] = make_stations(row);
  return stations_[row];
}

// Stations of the longest row that are nearer to the end of a shorter one say nothing new.
double Cycle::past_end_from_m(double end_l_m) const {
  return end_l_m * (1.0 + 0.25 / (options_.points - 1));
}

CandidateDrive Cycle::drive(std::size_t index) {
  const std::size_t row = index / grid_.lanes();
  const std::vector<Station>& longest = stations(grid_.rows() - 1);
  CandidateDrive drive;
  drive.stations.reserve(2 * longest.size());
  drive.stations = stations(row);
  for (const Station& station : longest) {
    if (station.l_m > past_end_from_m(grid_.end_l_m(index))) drive.stations.push_back(station);
  }
  drive.points =
      drive_along(drive.stations, quintic(index), input_.start_t_s, vehicle_.wheelbase_m);
  return drive;
}

double Cycle::excess_m(const CandidateBody& at) const {
  return border_.excess_m(at.body, vehicle_.rear_overhang_m, at.s_m) + room_.border_margin_m -
         allowed_excess_m(course_, at.l_m);
}

double Cycle::excess_m(const CandidateDrive& drive, std::size_t point) const {
  const Station& station = drive.stations[point];
  return excess_m({.body = geometry::body_at(drive.points[point].pose(), vehicle_),
                   .s_m = station.line.s_m,
                   .l_m = station.l_m});
}

const std::vector<LinearPoint>& Cycle::linear(std::size_t row) {
  if (linear_[row].empty()) linear_[row] = linear_points(stations(row), families_[row]);
  return linear_[row];
}

std::vector<CandidateBody> Cycle::bodies(std::size_t row, std::span<const double> end_d_m,
                                         double l_m, bool with_way) {
  if (l_m > grid_.end_l_m()[row]) return bodies_past_end(row, end_d_m, l_m, with_way);
  return bodies_at(row, nearest(stations(row), l_m), end_d_m, with_way);
}

std::vector<CandidateBody> Cycle::bodies_at(std::size_t row, std::size_t station,
                                            std::span<const double> end_d_m, bool with_way) {
  const std::span points = std::span(linear(row)).first(station + 1);
  const LaneWays ways = with_way ? lane_ways(points, end_d_m) : LaneWays{};
  const Station& at = stations(row)[station];
  const Frame frame(at.line);
  const LinearPoint& p = points.back();
  std::vector<CandidateBody> bodies;
  bodies.reserve(end_d_m.size());
  for (std::size_t lane = 0; lane < end_d_m.size(); ++lane) {
    const auto of_lane = [e = end_d_m[lane]](const double(&linear)[2]) {
      return linear[0] + e * linear[1];
    };
    bodies.push_back(
        {.body = frame.body(of_lane(p.d_m), of_lane(p.along), of_lane(p.across), vehicle_),
         .s_m = at.line.s_m,
         .l_m = at.l_m,
         .t_s = input_.start_t_s + ways.duration_s[lane],
         .driven_m = ways.driven_m[lane]});
  }
  return bodies;
}

std::vector<CandidateBody> Cycle::bodies_past_end(std::size_t row, std::span<const double> end_d_m,
                                                  double l_m, bool with_way) {
  const std::vector<Station>& longest = stations(grid_.rows() - 1);
  const double from_m = past_end_from_m(grid_.end_l_m()[row]);
  const std::span way(longest.data(), nearest(longest, l_m) + 1);
  std::vector<CandidateBody> bodies;
  if (!(way.back().l_m > from_m)) return bodies;
  const Frame frame(way.back().line);
  const LaneWays ways = with_way ? lane_ways(linear(row), end_d_m) : LaneWays{};
  for (std::size_t lane = 0; lane < end_d_m.size(); ++lane) {
    CandidateBody at{.body = frame.body(end_d_m[lane], 1.0, 0.0, vehicle_),
                     .s_m = way.back().line.s_m,
                     .l_m = way.back().l_m,
                     .t_s = input_.start_t_s + ways.duration_s[lane],
                     .driven_m = ways.driven_m[lane]};
    go_on(stations(row).back(), way, from_m, end_d_m[lane], at);
    bodies.push_back(at);
  }
  return bodies;
}

}  // namespace roadbed::planning::lateral
