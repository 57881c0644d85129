#include "roadbed/planning/audit/moving_probe.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "roadbed/geometry/motion/rectangle.h"

namespace roadbed::planning::inline audit {
namespace {

map::Box2 box_around(const geometry::Rectangle& rectangle) {
  const auto corners = rectangle.corners();
  map::Box2 box{corners[0], corners[0]};
  for (const Eigen::Vector2d& corner : corners) {
    box.min_in_source = box.min_in_source.cwiseMin(corner);
    box.max_in_source = box.max_in_source.cwiseMax(corner);
  }
  return box;
}

// No point of the obstacle moves farther between two of its samples.
std::vector<double> ways_m(const geometry::Trajectory& motion, double radius_m) {
  std::vector<double> ways{0.0};
  const auto& samples = motion.points();
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double way_m =
        std::hypot(samples[i].x_m - samples[i - 1].x_m, samples[i].y_m - samples[i - 1].y_m);
    const double turn_rad = std::abs(samples[i].heading_rad - samples[i - 1].heading_rad);
    ways.push_back(ways.back() + way_m + radius_m * turn_rad);
  }
  return ways;
}

}  // namespace

// So that along a whole segment the same obstacles are there.
geometry::Trajectory with_samples_at_changes(const geometry::Trajectory& drive,
                                             std::span<const ObstacleInSource> obstacles) {
  if (drive.empty()) return drive;
  std::vector<geometry::TrajectoryPoint> samples = drive.points();
  for (const ObstacleInSource& obstacle : obstacles) {
    for (const double t_s : {obstacle.validity.from_s, obstacle.validity.to_s}) {
      if (!(drive.start_s() < t_s && t_s < drive.end_s())) continue;
      samples.push_back(drive.at(t_s));
      samples.back().t_s = t_s;
    }
  }
  std::ranges::sort(samples, {}, &geometry::TrajectoryPoint::t_s);
  const auto is_at_once = [](const auto& a, const auto& b) { return a.t_s == b.t_s; };
  samples.erase(std::unique(samples.begin(), samples.end(), is_at_once), samples.end());
  return geometry::Trajectory(std::move(samples));
}

MovingProbe::MovingProbe(const geometry::Trajectory& drive, const geometry::BodyPart& part,
                         std::span<const ObstacleInSource> obstacles, double horizon_m)
    : ClearanceProbe(drive, part.reach_m()),
      part_(part),
      horizon_m_(horizon_m),
      body_radius_m_(part.circumradius_m()) {
  for (const ObstacleInSource& from : obstacles) {
    const double radius_m = 0.5 * std::hypot(from.length_m, from.width_m);
    movers_.push_back({&from, radius_m, ways_m(from.motion, radius_m)});
  }
  std::vector<std::size_t> all(movers_.size());
  std::iota(all.begin(), all.end(), 0);
  near_.resize(segments());
  find_near({.segment = 0, .segments = segments()}, all);
}

// An obstacle that appears where a segment ends counts from the next one on; the ends of the drive
// belong to its first and last segment.
bool MovingProbe::is_there(const Mover& mover, std::size_t segment) const {
  const double start_s = state_at(segment, 0.0).t_s, end_s = state_at(segment, 1.0).t_s;
  const TimeSpan& there = mover.from->validity;
  const bool before_end =
      there.from_s < end_s || (segment + 1 == segments() && there.from_s <= end_s);
  const bool after_start = there.to_s > start_s || (segment == 0 && there.to_s >= start_s);
  return before_end && after_start;
}

double MovingProbe::way_until_m(const Mover& mover, double t_s) {
  const auto& samples = mover.from->motion.points();
  if (t_s <= samples.front().t_s) return 0.0;
  if (t_s >= samples.back().t_s) return mover.way_m.back();
  const auto after = std::ranges::upper_bound(samples, t_s, {}, &geometry::TrajectoryPoint::t_s);
  const auto i = static_cast<std::size_t>(after - samples.begin());
  const double fraction = (t_s - samples[i - 1].t_s) / (samples[i].t_s - samples[i - 1].t_s);
  return mover.way_m[i - 1] + fraction * (mover.way_m[i] - mover.way_m[i - 1]);
}

// Of the circles around the body and the obstacle in the middle of the span.
double MovingProbe::apart_m(const Mover& mover, const Span& span) const {
  const geometry::TrajectoryPoint middle = middle_of(span);
  const Eigen::Vector2d centre = part_.core_at(middle.pose()).centre;
  const Eigen::Vector2d place = mover.from->motion.at(middle.t_s).pose().position();
  return (place - centre).norm() - body_radius_m_ - mover.radius_m;
}

// Between two times the distance of two bodies changes by at most what both move. An obstacle that
// is farther than that in the middle of a segment stays beyond the horizon all along it.
bool MovingProbe::is_near(const Mover& mover, std::size_t segment) const {
  if (!is_there(mover, segment)) return false;
  const Span whole{segment, 0.0, 1.0};
  const double moved_m = ClearanceProbe::motion_bound_m(whole) +
                         way_until_m(mover, state_at(segment, 1.0).t_s) -
                         way_until_m(mover, state_at(segment, 0.0).t_s);
  return apart_m(mover, whole) - moved_m < horizon_m_;
}

// False only where it is near none of the segments. Both move by no more than once these bounds up
// to the middle of a segment, and within it by no more than once more.
bool MovingProbe::may_be_near(const Mover& mover, const Span& span) const {
  constexpr double kRoundingM = 1e-6;
  const double start_s = state_at(span.segment, 0.0).t_s;
  const double end_s = state_at(span.segment + span.segments - 1, 1.0).t_s;
  const TimeSpan& there = mover.from->validity;
  if (there.from_s > end_s || there.to_s < start_s) return false;
  const double moved_m = ClearanceProbe::motion_bound_m(span) + way_until_m(mover, end_s) -
                         way_until_m(mover, start_s);
  return apart_m(mover, span) - 2.0 * moved_m - kRoundingM < horizon_m_;
}

void MovingProbe::find_near(const Span& span, const std::vector<std::size_t>& candidates) {
  std::vector<std::size_t> near;
  for (const std::size_t i : candidates) {
    const bool is_kept =
        span.segments == 1 ? is_near(movers_[i], span.segment) : may_be_near(movers_[i], span);
    if (is_kept) near.push_back(i);
  }
  if (span.segments == 1) {
    near_[span.segment] = std::move(near);
  } else if (!near.empty()) {
    find_near(span.first_half(), near);
    find_near(span.second_half(), near);
  }
}

double MovingProbe::motion_bound_m(const Span& span) const {
  const double from_s = state_at(span.segment, span.from).t_s;
  const double middle_s = state_at(span.segment, span.middle()).t_s;
  const double to_s = state_at(span.segment, span.to).t_s;
  double most_m = 0.0;
  for (const std::size_t i : near_[span.segment]) {
    const double half_m = way_until_m(movers_[i], middle_s);
    most_m = std::max(
        {most_m, half_m - way_until_m(movers_[i], from_s), way_until_m(movers_[i], to_s) - half_m});
  }
  return ClearanceProbe::motion_bound_m(span) + most_m;
}

double MovingProbe::lower_bound_m(const Span& span, double /*enough_m*/) const {
  const geometry::TrajectoryPoint state = middle_of(span);
  const Eigen::Vector2d centre = part_.core_at(state.pose()).centre;
  double least_m = horizon_m_;
  for (const std::size_t i : near_[span.segment]) {
    const auto place = movers_[i].from->motion.at(state.t_s).pose().position();
    least_m = std::min(least_m, (place - centre).norm() - body_radius_m_ - movers_[i].radius_m);
  }
  return std::max(0.0, least_m);
}

// Of obstacles equally near the first counts, so that reports do not depend on the search's order.
std::optional<ClearanceProbe::Near> MovingProbe::nearest(const Span& span, double within_m) const {
  const geometry::TrajectoryPoint state = middle_of(span);
  const geometry::Rectangle body = part_.core_at(state.pose());
  double least_m = std::min(within_m, horizon_m_);
  const ObstacleInSource* nearest = nullptr;
  for (const std::size_t i : near_[span.segment]) {
    const geometry::Rectangle thing = rectangle_at(*movers_[i].from, state.t_s);
    if ((thing.centre - body.centre).norm() - body_radius_m_ - movers_[i].radius_m > least_m) {
      continue;
    }
    const double distance_m = std::max(0.0, geometry::distance_m(body, thing) - part_.radius_m);
    if (distance_m > least_m || (distance_m == least_m && nearest != nullptr)) continue;
    least_m = distance_m;
    nearest = movers_[i].from;
  }
  if (nearest == nullptr) return std::nullopt;
  return Near{least_m, box_around(rectangle_at(*nearest, state.t_s)), nearest->id};
}

}  // namespace roadbed::planning::audit
