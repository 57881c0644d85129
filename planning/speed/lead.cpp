#include "roadbed/planning/speed/lead.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace roadbed::planning::inline speed {
namespace {

using geometry::Rectangle;

constexpr double kStep_m = 0.5;
constexpr double kSeenFor_s = 0.3;        // a lead's acceleration is taken over the last moments
constexpr double kMostStretch = 1.5;      // of a path against its line, outside of a bend
constexpr double kLeastAlongLine = 0.8;   // cosine, of who follows
constexpr double kMovesAcross_mps = 0.5;  // less is standing
constexpr int kHalvings = 8;              // 0.5 m to 2 mm

/// Distances from the body at stations of the path to one obstacle.
class Sweep {
 public:
  Sweep(const PlannedPath& path, const geometry::VehicleShape& vehicle, const Rectangle& obstacle,
        double margin_m)
      : path_(path), vehicle_(vehicle), obstacle_(obstacle), margin_m_(margin_m) {}

  bool touches(double s_m) const {
    const Rectangle body = geometry::body_at(path_.pose_at(s_m), vehicle_);
    const double reach = body.radius_m() + obstacle_.radius_m() + margin_m_;
    if ((body.centre - obstacle_.centre).squaredNorm() > reach * reach) return false;
    return geometry::distance_m(body, obstacle_) <= margin_m_;
  }

  /// First station in [from, to] that touches, given that `to` does.
  double first_touch_m(double from_m, double to_m) const {
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (from_m + to_m);
      (touches(middle) ? to_m : from_m) = middle;
    }
    return to_m;
  }

 private:
  const PlannedPath& path_;
  const geometry::VehicleShape& vehicle_;
  const Rectangle& obstacle_;
  double margin_m_;
};

double speed_along(const Obstacle& obstacle, double t_s, double heading_rad) {
  if (obstacle.is_static()) return 0.0;
  const geometry::TrajectoryPoint at = obstacle.motion.at(t_s);
  return at.speed_mps * std::cos(at.heading_rad - heading_rad);
}

std::optional<double> first_touch_m(const Sweep& sweep, double s_m, double look_ahead_m) {
  if (sweep.touches(s_m)) return s_m;
  for (double ahead = kStep_m; ahead <= look_ahead_m; ahead += kStep_m) {
    if (sweep.touches(s_m + ahead)) return sweep.first_touch_m(s_m + ahead - kStep_m, s_m + ahead);
  }
  return std::nullopt;
}

double stopping_mps2(double speed_mps, double within_m) {
  constexpr double kLeast_m = 0.1;
  return 0.5 * speed_mps * speed_mps / std::max(kLeast_m, within_m);
}

}  // namespace

std::string lead_text(const std::string& name, double gap_m, double speed_mps) {
  constexpr double kShownAsZero_mps = 0.05;
  const double shown_mps = std::abs(speed_mps) < kShownAsZero_mps ? 0.0 : speed_mps;
  return fmt::format("{} is {:.1f} m ahead at {:.1f} m/s", name, gap_m, shown_mps);
}

std::optional<Lead> find_lead(const PlannedPath& path, double s_m, double look_ahead_m,
                              std::span<const Obstacle> obstacles, double t_s,
                              const geometry::VehicleShape& vehicle, double side_margin_m,
                              const std::vector<bool>& ignored) {
  std::optional<Lead> nearest;
  double within_m = look_ahead_m;
  const Eigen::Vector2d here = path.pose_at(s_m).position();
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    if ((!ignored.empty() && ignored[i]) || !obstacles[i].is_there(t_s)) continue;
    const Rectangle body = rectangle_at(obstacles[i], t_s);
    const double far = within_m + vehicle.reach_m() + body.radius_m() + side_margin_m;
    if ((body.centre - here).norm() > kMostStretch * far) continue;
    const Sweep sweep(path, vehicle, body, side_margin_m);
    const std::optional<double> touch = first_touch_m(sweep, s_m, within_m);
    if (!touch) continue;
    const double heading = path.pose_at(*touch).heading_rad;
    within_m = *touch - s_m;
    const double speed = speed_along(obstacles[i], t_s, heading);
    nearest = {.obstacle = i,
               .gap_m = within_m,
               .speed_mps = speed,
               .acceleration_mps2 =
                   (speed - speed_along(obstacles[i], t_s - kSeenFor_s, heading)) / kSeenFor_s};
  }
  return nearest;
}

bool is_following(const Obstacle& obstacle, double t_s, const VehicleOnLine& vehicle) {
  const geometry::TrajectoryPoint now = obstacle.motion.at(t_s);
  const Eigen::Vector2d place = now.pose().position();
  const ReferencePoint foot = vehicle.line.at(vehicle.line.project(place).s_m);
  const Eigen::Vector2d along(std::cos(foot.heading_rad), std::sin(foot.heading_rad));
  const Eigen::Vector2d beyond = place - foot.in_map;  // along: before the line's first point
  const double d_m = along.x() * beyond.y() - along.y() * beyond.x();
  return foot.s_m + along.dot(beyond) < vehicle.s_m &&
         std::abs(d_m - vehicle.d_m) < 0.5 * (vehicle.width_m + obstacle.width_m) &&
         std::cos(now.heading_rad - foot.heading_rad) > kLeastAlongLine;
}

bool comes_behind(const Obstacle& obstacle, double t_s, const VehicleOnLine& vehicle,
                  double speed_mps, const geometry::VehicleShape& shape) {
  constexpr double kWithin_s = 10.0, kStepOfMotion_s = 0.5, kInLane_m = 1.2, kBrakes_mps2 = 4.0;
  std::optional<double> near_s_m;  // where it was before
  const auto on_line_m = [&](double at_s) -> std::optional<double> {
    const geometry::TrajectoryPoint at = obstacle.motion.at(at_s);
    const geometry::LinePosition place = vehicle.line.project(at.pose().position(), near_s_m);
    near_s_m = place.s_m;
    const ReferencePoint foot = vehicle.line.at(place.s_m);
    const bool is_there = (foot.in_map - at.pose().position()).norm() < kInLane_m &&
                          std::cos(at.heading_rad - foot.heading_rad) > kLeastAlongLine;
    return is_there ? std::optional(place.s_m) : std::nullopt;
  };
  if (on_line_m(t_s)) return false;
  for (double ahead_s = kStepOfMotion_s; ahead_s <= kWithin_s; ahead_s += kStepOfMotion_s) {
    const auto s_m = on_line_m(t_s + ahead_s);
    if (!s_m) continue;
    const double gap_m =
        vehicle.s_m + speed_mps * ahead_s - shape.rear_overhang_m - *s_m - 0.5 * obstacle.length_m;
    const double closing_mps =
        std::max(0.0, obstacle.motion.at(t_s + ahead_s).speed_mps - speed_mps);
    return gap_m > 0.0 && closing_mps * closing_mps <= 2.0 * kBrakes_mps2 * gap_m;
  }
  return false;
}

bool is_crossing(const Obstacle& obstacle, double t_s, const ReferenceLine& line) {
  if (obstacle.is_static()) return false;
  const geometry::TrajectoryPoint now = obstacle.motion.at(t_s);
  if (now.speed_mps < kMovesAcross_mps) return false;
  const ReferencePoint foot = line.at(line.project(now.pose().position()).s_m);
  return std::abs(std::cos(now.heading_rad - foot.heading_rad)) < kLeastAlongLine;
}

std::optional<double> emergency_deceleration_mps2(double speed_mps, const Lead& lead,
                                                  const SafetyOptions& options) {
  const double closing = speed_mps - lead.speed_mps;
  if (closing <= 0.0 || speed_mps <= 0.0) return std::nullopt;
  const double room_m = lead.gap_m - options.standoff_m;
  double needed = stopping_mps2(closing, room_m - closing * options.reaction_s);
  if (lead.acceleration_mps2 < -options.lead_brakes_mps2 && lead.speed_mps > 0.0) {
    const double stands_m = 0.5 * lead.speed_mps * lead.speed_mps / -lead.acceleration_mps2;
    needed = std::max(needed,
                      stopping_mps2(speed_mps, room_m + stands_m - speed_mps * options.reaction_s));
  }
  if (needed <= options.cruise_limit_mps2) return std::nullopt;
  return std::min(needed, options.most_mps2);
}

std::optional<double> emergency_stop_mps2(double speed_mps, double distance_m,
                                          const SafetyOptions& options) {
  if (speed_mps <= 0.0) return std::nullopt;
  return std::min(stopping_mps2(speed_mps, distance_m), options.most_mps2);
}

}  // namespace roadbed::planning::speed
