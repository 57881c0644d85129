#include "roadbed/control/paper_courses.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "roadbed/geometry/curves/quintic_bezier.h"

namespace roadbed::control {
namespace {

using Eigen::Vector2d;
using geometry::Pose2;

constexpr double kMostLateral_mps2 = 3.0;
constexpr double kSample_m = 0.05;
constexpr double kBefore_s = 1.0, kAfter_s = 3.0;

Vector2d direction(double heading_rad) { return {std::cos(heading_rad), std::sin(heading_rad)}; }

/// Corners in a chain, each turning by an angle, with legs of `leg_m` to either side.
std::vector<geometry::QuinticBezier> corners(const std::vector<double>& turns_rad, double leg_m) {
  std::vector<geometry::QuinticBezier> chain;
  Vector2d from{0.0, 0.0};
  double heading = 0.0;
  for (const double turn : turns_rad) {
    const Vector2d corner = from + leg_m * direction(heading);
    const Vector2d to = corner + leg_m * direction(heading + turn);
    const auto gaps = geometry::scaled_to(geometry::kGentleGaps, leg_m * (1.0 - 1e-9));
    chain.push_back(geometry::QuinticBezier::corner(from, corner, to, gaps));
    from = to;
    heading += turn;
  }
  return chain;
}

double peak_curvature_per_m(const std::vector<geometry::QuinticBezier>& chain) {
  double peak = 0.0;
  for (const geometry::QuinticBezier& corner : chain) {
    for (int i = 0; i <= 200; ++i) {
      peak = std::max(peak, std::abs(corner.curvature_per_m(i / 200.0)));
    }
  }
  return peak;
}

void add_straight(std::vector<Pose2>& poses, double length_m) {
  const Pose2 from = poses.back();
  const int count = std::max(1, static_cast<int>(length_m / 0.5));
  for (int i = 1; i <= count; ++i) {
    const Vector2d at = from.position() + length_m * i / count * direction(from.heading_rad);
    poses.push_back({at.x(), at.y(), from.heading_rad});
  }
}

void add_corner(std::vector<Pose2>& poses, const geometry::QuinticBezier& corner) {
  const int count = std::max(100, static_cast<int>(corner.length_m() / kSample_m));
  for (int i = 1; i <= count; ++i) {
    const double t = static_cast<double>(i) / count;
    const Vector2d at = corner.at(t), along = corner.derivative(t, 1);
    poses.push_back({at.x(), at.y(), std::atan2(along.y(), along.x())});
  }
}

Course course_of(const std::vector<double>& turns_rad, double speed_mps) {
  if (!(speed_mps > 0.0)) throw std::invalid_argument("the courses' speed must be positive");
  const double leg_m = geometry::kGentleGaps.total_m();
  const double lateral_mps2 =
      speed_mps * speed_mps * peak_curvature_per_m(corners(turns_rad, leg_m));
  const double scale = std::max(1.0, lateral_mps2 / kMostLateral_mps2);
  std::vector<Pose2> poses{{-kBefore_s * speed_mps, 0.0, 0.0}};
  add_straight(poses, kBefore_s * speed_mps);
  for (const auto& corner : corners(turns_rad, scale * leg_m)) add_corner(poses, corner);
  add_straight(poses, kAfter_s * speed_mps);
  return Course(std::move(poses));
}

}  // namespace

Course right_turn_course(double speed_mps) {
  return course_of({-0.5 * std::numbers::pi}, speed_mps);
}

Course zig_zag_course(double speed_mps) {
  const double half = std::numbers::pi / 9.0, whole = 2.0 * half;
  return course_of({half, -whole, whole, -whole, whole, -half}, speed_mps);
}

}  // namespace roadbed::control
