#include "roadbed/planning/lateral/candidate_fan.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace roadbed::planning::inline lateral {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;
using geometry::VehicleShape;

constexpr double kStretch_m = 2.5;
constexpr double kBetween_m = 0.1;  // how far the line bends away within a stretch
// What a quintic of unit length may add to its ends' offsets for a unit of slope or second
// derivative at its start: 0.2 and 0.02, rounded up.
constexpr double kOvershoot = 0.25, kSecondOvershoot = 0.03;
constexpr double kSteepest = 1.9;  // slope of a quintic, for the mean one, rounded up

// The body of a drive at a point.
struct Posture {
  Vector2d in_map, axis;
};

struct PointOfFan {
  std::array<Posture, 2> ends;
  double least_t_s, most_t_s;
};

double linear(const double (&of)[2], double e) { return of[0] + e * of[1]; }

Posture posture(const BatchDrives& drives, std::size_t i, double e) {
  const Vector2d& tangent = drives.tangents[i];
  const Vector2d normal(-tangent.y(), tangent.x());
  const LinearPoint& at = drives.points[i];
  const double along = std::max(linear(at.along, e), kLeastUnfolded);
  return {drives.stations[i]->line.in_map + linear(at.d_m, e) * normal,
          (along * tangent + linear(at.across, e) * normal).normalized()};
}

std::vector<PointOfFan> points_of(const BatchDrives& drives, double start_t_s,
                                  const OffsetRange& ends, const FanPoints& look_at) {
  std::vector<PointOfFan> points(look_at.last + 1);
  // Until a point, at the outer two drives: along the line alone, and the whole.
  std::array<double, 2> least_s{}, most_s{}, last_along{}, last_stretch{};
  for (std::size_t i = 0; i <= look_at.last; ++i) {
    const LinearPoint& at = drives.points[i];
    for (std::size_t end = 0; end < 2; ++end) {
      const double e = end == 0 ? ends.min_d_m : ends.max_d_m;
      const double along = std::max(linear(at.along, e), 0.0), across = linear(at.across, e);
      const double stretch = std::sqrt(along * along + across * across);
      least_s[end] += i == 0 ? 0.0 : at.seconds_before * (last_along[end] + along);
      most_s[end] += i == 0 ? 0.0 : at.seconds_before * (last_stretch[end] + stretch);
      last_along[end] = along;
      last_stretch[end] = stretch;
      if (i >= look_at.first) points[i].ends[end] = posture(drives, i, e);
    }
    points[i].least_t_s = start_t_s + std::min(least_s[0], least_s[1]);
    points[i].most_t_s = start_t_s + std::max(most_s[0], most_s[1]);
  }
  return points;
}

Vector2d in_frame(const Vector2d& axis, const Vector2d& vector) {
  return {axis.dot(vector), axis.x() * vector.y() - axis.y() * vector.x()};
}

// In the frame of the first point: the box of all positions, grown by that of all directions.
FanSection section_of(const std::vector<PointOfFan>& points, std::size_t first, std::size_t last,
                      const VehicleShape& vehicle) {
  const Posture& frame = points[first].ends[0];
  AlignedBox2d positions, axes;
  for (std::size_t i = first; i <= last; ++i) {
    for (const Posture& end : points[i].ends) {
      positions.extend(in_frame(frame.axis, end.in_map - frame.in_map));
      axes.extend(in_frame(frame.axis, end.axis));
    }
  }
  AlignedBox2d box;
  const double half_width_m = 0.5 * vehicle.width_m;
  const double turn = axes.sizes().norm();
  const double bend_m = 0.125 * vehicle.reach_m() * 1.3 * turn * turn;
  for (const Vector2d& axis : {axes.min(), axes.max(), Vector2d(axes.min().x(), axes.max().y()),
                               Vector2d(axes.max().x(), axes.min().y())}) {
    const Vector2d left(-axis.y(), axis.x());
    for (const double x_m : {vehicle.front_m(), -vehicle.rear_overhang_m}) {
      box.extend(positions.min() + x_m * axis - half_width_m * left);
      box.extend(positions.min() + x_m * axis + half_width_m * left);
      box.extend(positions.max() + x_m * axis - half_width_m * left);
      box.extend(positions.max() + x_m * axis + half_width_m * left);
    }
  }
  const Vector2d centre = box.center(), left(-frame.axis.y(), frame.axis.x());
  return {.first = first,
          .last = last,
          .cover = {frame.in_map + centre.x() * frame.axis + centre.y() * left, frame.axis,
                    0.5 * box.sizes().x() + bend_m, 0.5 * box.sizes().y() + bend_m},
          .from_t_s = points[first].least_t_s,
          .to_t_s = points[last].most_t_s};
}

// How far beside the line a body may reach, to both sides.
OffsetRange most_beside(const CandidateEvaluator& evaluator, const OffsetRange& ends) {
  const LateralState& start = evaluator.context().start;
  const Grid& grid = evaluator.grid();
  const double most_l_m = grid.max_l_m(), slope = std::abs(start.d_slope);
  const double second = std::abs(start.d_curvature_per_m) * most_l_m;
  const double beyond_m = most_l_m * (kOvershoot * slope + kSecondOvershoot * second);
  const double change_m =
      std::max(std::abs(ends.min_d_m - start.d_m), std::abs(ends.max_d_m - start.d_m));
  const double steep =
      kSteepest * (change_m + beyond_m) / grid.end_l_m().front() + slope + 0.2 * second;
  const double body_m = beyond_m + 0.5 * evaluator.vehicle().width_m +
                        evaluator.vehicle().reach_m() * std::min(1.0, steep) + kBetween_m;
  return {std::min(start.d_m, ends.min_d_m) - body_m, std::max(start.d_m, ends.max_d_m) + body_m};
}

}  // namespace

BatchDrives drives_of(CandidateEvaluator& evaluator, std::size_t batch) {
  const std::vector<Station>& longest = evaluator.stations(evaluator.grid().length_count() - 1);
  const double from_m = evaluator.past_end_from_m(evaluator.grid().end_l_m()[batch]);
  BatchDrives drives{.stations = {}, .points = evaluator.linear(batch), .tangents = {}};
  for (const Station& station : evaluator.stations(batch)) drives.stations.push_back(&station);
  for (const Station& station : longest) {
    if (!(station.l_m > from_m)) continue;
    const Station& before = *drives.stations.back();
    const double metres = 0.5 * (station.l_m - before.l_m);
    drives.points.push_back({.d_m = {0.0, 1.0},
                             .along = {1.0, -station.line.curvature_per_m},
                             .across = {0.0, 0.0},
                             .seconds_before = metres / mean_speed_mps(before, station),
                             .metres_before = metres});
    drives.stations.push_back(&station);
  }
  for (const Station* station : drives.stations) {
    const double heading_rad = station->line.heading_rad;
    drives.tangents.emplace_back(std::cos(heading_rad), std::sin(heading_rad));
  }
  return drives;
}

std::vector<FanSection> fan_sections(const CandidateEvaluator& evaluator, const BatchDrives& drives,
                                     const OffsetRange& ends, const FanPoints& look_at) {
  const std::vector<PointOfFan> points =
      points_of(drives, evaluator.input().start_t_s, ends, look_at);
  std::vector<FanSection> sections;
  for (std::size_t first = look_at.first; first < look_at.last; first += look_at.per_section) {
    const std::size_t last = std::min(first + look_at.per_section, look_at.last);
    sections.push_back(section_of(points, first, last, evaluator.vehicle()));
  }
  return sections;
}

double least_stretch(CandidateEvaluator& evaluator, const OffsetRange& ends) {
  const OffsetRange beside = most_beside(evaluator, ends);
  double least = 1.0;
  for (const Station& station : evaluator.stations(evaluator.grid().length_count() - 1)) {
    const double curvature = station.line.curvature_per_m;
    least = std::min({least, 1.0 - curvature * beside.min_d_m, 1.0 - curvature * beside.max_d_m});
  }
  return std::max(kLeastUnfolded, least);
}

std::vector<LineStretch> stretches_ahead(CandidateEvaluator& evaluator, double length_m,
                                         const OffsetRange& ends) {
  const OffsetRange beside = most_beside(evaluator, ends);
  const double most_m = std::max(-beside.min_d_m, beside.max_d_m);
  const double reach_m = evaluator.vehicle().reach_m();
  double most_mps = 0.1;
  for (const Station& station : evaluator.stations(evaluator.grid().length_count() - 1)) {
    most_mps = std::max(most_mps, station.speed.speed_mps);
  }
  const double later_s_per_m = least_stretch(evaluator, ends) / most_mps;
  std::vector<LineStretch> stretches;
  for (double l_m = -reach_m; l_m < length_m + reach_m; l_m += kStretch_m) {
    const ReferencePoint middle =
        evaluator.context().line.at(evaluator.context().start.s_m + l_m + 0.5 * kStretch_m);
    const Vector2d tangent(std::cos(middle.heading_rad), std::sin(middle.heading_rad));
    const Vector2d normal(-tangent.y(), tangent.x());
    // Beside a bend the stretch is longer at its outer side.
    const double half_length_m =
        0.5 * kStretch_m * (1.0 + std::abs(middle.curvature_per_m) * most_m) + kBetween_m;
    stretches.push_back(
        {.cover = {middle.in_map + 0.5 * (beside.min_d_m + beside.max_d_m) * normal, tangent,
                   half_length_m, 0.5 * (beside.max_d_m - beside.min_d_m)},
         .from_t_s = evaluator.input().start_t_s + later_s_per_m * std::max(0.0, l_m - reach_m)});
  }
  return stretches;
}

}  // namespace roadbed::planning::lateral
