#include "roadbed/planning/lateral/maneuver_completion.h"

#include <algorithm>
#include <cmath>

namespace roadbed::planning::inline lateral {
namespace {

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
