#include "roadbed/planning/lateral/maneuver_completion.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace roadbed::planning::inline lateral {
namespace {

using geometry::Trajectory;
using geometry::TrajectoryPoint;

constexpr double kStopStep_s = 0.05;
constexpr double kLeastStretch = 0.05;  // of a path that is all but folded
constexpr double kLeastSpeed_mps = 0.05;

// The vehicle on a path, and how far it drives per metre of station.
struct PlaceOnPath {
  TrajectoryPoint point;
  double stretch;
};

PlaceOnPath place_on(const DrivenPath& driven, double s_m) {
  LateralState at = driven.path(s_m);
  const ReferencePoint on_line = driven.line.at(s_m);
  const double cos = std::cos(on_line.heading_rad), sin = std::sin(on_line.heading_rad);
  const double along = 1.0 - on_line.curvature_per_m * at.d_m;
  const auto curve = geometry::offset_curve(
      curvatures(on_line), {at.d_m, at.d_slope, at.d_curvature_per_m, 0.0, 0.0, 0.0},
      kLeastUnfolded);
  const double curvature = curve ? curve->curvature_per_m : 0.0;
  return {{.x_m = on_line.in_map.x() - at.d_m * sin,
           .y_m = on_line.in_map.y() + at.d_m * cos,
           .heading_rad = on_line.heading_rad + std::atan2(at.d_slope, along),
           .steering_rad = std::atan(driven.vehicle.wheelbase_m * curvature),
           .curvature_per_m = curvature},
          std::max(kLeastStretch, std::hypot(along, at.d_slope))};
}

using geometry::Trajectory;

constexpr double kReachStep_m = 5.0, kLeaveStep_m = 20.0;
constexpr int kLeaveSteps = 5;
constexpr double kSameOffset_m = 0.5;
constexpr double kReturn_m = 30.0;

// Whether a place is not behind the rear axle.
class Ahead {
 public:
  explicit Ahead(const CycleContext& context) {
    const LateralState& start = context.start;
    const ReferencePoint at = context.line.at(start.s_m);
    const double heading_rad =
        at.heading_rad + std::atan2(start.d_slope, 1.0 - at.curvature_per_m * start.d_m);
    axis_ = {std::cos(heading_rad), std::sin(heading_rad)};
    axle_ = at.in_map +
            start.d_m * Eigen::Vector2d(-std::sin(at.heading_rad), std::cos(at.heading_rad));
  }
  bool holds(const geometry::Pose2& centre) const {
    return axis_.dot(centre.position() - axle_) >= 0.0;
  }

 private:
  Eigen::Vector2d axis_, axle_;
};

CollisionScene of_what_moves_ahead(const CollisionScene& scene, const CycleContext& context) {
  CollisionScene moving = scene;
  moving.counts = [ahead = Ahead(context)](const geometry::Pose2& centre) {
    return ahead.holds(centre);
  };
  return moving;
}

double next_multiple(double value, double step) { return step * std::ceil(value / step - 1e-9); }

LateralState on_quintic(const geometry::Quintic& quintic, double s_m, double l_m) {
  const auto d = quintic.at(std::clamp(l_m, 0.0, quintic.length()));
  return {.s_m = s_m, .d_m = d[0], .d_slope = d[1], .d_curvature_per_m = d[2]};
}

}  // namespace

Trajectory stopping_drive(const DrivenPath& driven, double speed_mps, double deceleration_mps2,
                          double until_s) {
  const double stop_s = speed_mps / deceleration_mps2;
  const auto driven_m = [&](double t_s) {
    return t_s * (speed_mps - 0.5 * deceleration_mps2 * t_s);
  };
  const int steps = static_cast<int>(std::ceil(stop_s / kStopStep_s - 1e-6));
  std::vector<TrajectoryPoint> points;
  double s_m = driven.start_s_m, last_t_s = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double t_s = std::min(stop_s, kStopStep_s * i);
    PlaceOnPath place = place_on(driven, s_m);
    place.point.t_s = driven.start_t_s + t_s;
    place.point.speed_mps = std::max(0.0, speed_mps - deceleration_mps2 * t_s);
    place.point.acceleration_mps2 = t_s < stop_s ? -deceleration_mps2 : 0.0;
    points.push_back(place.point);
    const double next_t_s = std::min(stop_s, kStopStep_s * (i + 1));
    s_m += (driven_m(next_t_s) - driven_m(t_s)) / place.stretch;
    last_t_s = t_s;
  }
  TrajectoryPoint standing = points.back();
  standing.speed_mps = standing.acceleration_mps2 = 0.0;
  standing.t_s = driven.start_t_s + std::max(until_s, last_t_s + kStopStep_s);
  points.push_back(standing);
  return Trajectory(std::move(points));
}

Trajectory passing_drive(const DrivenPath& driven, const PlannedSpeed& speed, double end_s_m,
                         double until_s) {
  std::vector<TrajectoryPoint> points;
  double driven_m = 0.0, t_s = 0.0;
  // The sample behind `until_s` ends the segment that leads past it: without it a vehicle that
  // stands would have no segment, and touch nothing.
  bool is_over = false;
  for (double s_m = driven.start_s_m; s_m < end_s_m && !is_over; s_m += kPassStep_m) {
    is_over = t_s > until_s;
    PlaceOnPath place = place_on(driven, s_m);
    const PlannedSpeed::State state = speed.at(driven_m);
    place.point.t_s = driven.start_t_s + t_s;
    place.point.speed_mps = state.speed_mps;
    place.point.acceleration_mps2 = state.acceleration_mps2;
    points.push_back(place.point);
    const double step_m = kPassStep_m * place.stretch;
    const double mean_mps = 0.5 * (state.speed_mps + speed.at(driven_m + step_m).speed_mps);
    t_s += step_m / std::max(mean_mps, kLeastSpeed_mps);
    driven_m += step_m;
  }
  return Trajectory(std::move(points));
}

ManeuverCompletion::ManeuverCompletion(const CycleContext& context, const CollisionScene& scene,
                                       const geometry::VehicleShape& vehicle,
                                       const Options& options)
    : context_(context),
      vehicle_(vehicle),
      options_(options),
      start_t_s_(scene.start_t_s),
      checker_(of_what_moves_ahead(scene, context), vehicle,
               {.circles = options.circles,
                .clearance_m = options.clearance_m,
                .recovery_m = options.recovery_m,
                .horizon_s = options.horizon_s}) {}

std::vector<std::size_t> ManeuverCompletion::things() const {
  return options_.horizon_s == 0.0 ? std::vector<std::size_t>{} : checker_.things();
}

bool ManeuverCompletion::keeps_clear(std::size_t thing,
                                     const std::vector<LineStretch>& stretches) const {
  return std::ranges::all_of(stretches, [&](const LineStretch& stretch) {
    return checker_.keeps_clear(thing, stretch.cover, stretch.from_t_s,
                                start_t_s_ + options_.horizon_s);
  });
}

double ManeuverCompletion::stop_m() const {
  const double speed_mps = context_.speed.at(0.0).speed_mps;
  return 0.5 * speed_mps * speed_mps / options_.deceleration_mps2;
}

ManeuverCompletion::Place ManeuverCompletion::place_of(double end_d_m, double end_l_m) const {
  return {end_d_m, next_multiple(context_.start.s_m + end_l_m, kReachStep_m)};
}

bool ManeuverCompletion::exists(double end_d_m, double end_l_m) {
  if (checker_.is_empty() || options_.horizon_s == 0.0) return true;
  const Place place = place_of(end_d_m, end_l_m);
  const auto known = known_.find(place);
  if (known != known_.end()) return known->second;
  const bool leads_on = find(place.first, place.second);
  some_end_ = some_end_ || !leads_on;
  return known_[place] = leads_on;
}

bool ManeuverCompletion::is_known_to_fail(double end_d_m, double end_l_m) const {
  if (!some_end_) return false;
  const auto known = known_.find(place_of(end_d_m, end_l_m));
  return known != known_.end() && !known->second;
}

DrivenPath ManeuverCompletion::along(const LateralPath& path) const {
  return {.line = context_.line,
          .path = path,
          .vehicle = vehicle_,
          .start_s_m = context_.start.s_m,
          .start_t_s = start_t_s_};
}

bool ManeuverCompletion::is_begun(double end_d_m, double end_s_m) const {
  return context_.previous_d_m &&
         std::abs(context_.previous_d_m(end_s_m) - end_d_m) < kSameOffset_m;
}

bool ManeuverCompletion::passes(const LateralPath& hold, double end_d_m, double back_from_m) const {
  const geometry::Quintic back({.value = end_d_m}, {}, kReturn_m);
  const LateralPath pass = [&](double s_m) {
    return s_m < back_from_m ? hold(s_m) : on_quintic(back, s_m, s_m - back_from_m);
  };
  return checker_.is_free(
      passing_drive(along(pass), context_.speed, back_from_m + kReturn_m, options_.horizon_s)
          .points());
}

// How far the way at the offset is free; whatever goes on to a later station meets the same.
double ManeuverCompletion::free_until_m(const LateralPath& hold, double end_s_m) const {
  const double last_m = end_s_m + (kLeaveSteps + 1) * kLeaveStep_m;
  const Trajectory drive = passing_drive(along(hold), context_.speed, last_m, options_.horizon_s);
  const auto contact = checker_.first_contact(drive.points());
  if (!contact) return last_m;
  return context_.start.s_m + kPassStep_m * static_cast<double>(contact->segment + 1);
}

// To stop at the offset is the simplest way to complete; else to pass what is there and go back.
// A single place to go back at may be a gap that has closed by the next cycle: what is not yet
// begun needs two next to each other.
bool ManeuverCompletion::find(double end_d_m, double end_s_m) const {
  const double start_s_m = context_.start.s_m;
  const geometry::Quintic out = QuinticFamily(context_.start, end_s_m - start_s_m).member(end_d_m);
  const LateralPath hold = [&](double s_m) { return on_quintic(out, s_m, s_m - start_s_m); };
  const double speed_mps = context_.speed.at(0.0).speed_mps;
  const Trajectory stop =
      stopping_drive(along(hold), speed_mps, options_.deceleration_mps2, options_.horizon_s);
  if (checker_.is_free(stop.points())) return true;
  const int enough = is_begun(end_d_m, end_s_m) ? 1 : 2;
  const double free_to_m = free_until_m(hold, end_s_m);
  int in_a_row = 0;
  for (int i = 0; i < kLeaveSteps && in_a_row < enough; ++i) {
    const double back_from_m = next_multiple(end_s_m, kLeaveStep_m) + i * kLeaveStep_m;
    if (back_from_m > free_to_m) break;
    in_a_row = passes(hold, end_d_m, back_from_m) ? in_a_row + 1 : 0;
  }
  return in_a_row >= enough;
}

}  // namespace roadbed::planning::lateral
