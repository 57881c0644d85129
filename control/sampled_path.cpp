#include "roadbed/control/sampled_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "roadbed/geometry/curves/quintic_bezier.h"
#include "roadbed/geometry/primitives/angle.h"

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

SampledPath path_of_turns(const std::vector<double>& turns_rad, double speed_mps) {
  if (!(speed_mps > 0.0)) throw std::invalid_argument("the paths' speed must be positive");
  const double leg_m = geometry::kGentleGaps.total_m();
  const double lateral_mps2 =
      speed_mps * speed_mps * peak_curvature_per_m(corners(turns_rad, leg_m));
  const double scale = std::max(1.0, lateral_mps2 / kMostLateral_mps2);
  std::vector<Pose2> poses{{-kBefore_s * speed_mps, 0.0, 0.0}};
  add_straight(poses, kBefore_s * speed_mps);
  for (const auto& corner : corners(turns_rad, scale * leg_m)) add_corner(poses, corner);
  add_straight(poses, kAfter_s * speed_mps);
  return SampledPath(std::move(poses));
}

}  // namespace

SampledPath::SampledPath(std::vector<geometry::Pose2> poses)
    : poses_(std::move(poses)), stations_m_{0.0} {
  if (poses_.size() < 2) throw std::invalid_argument("SampledPath: needs at least two poses");
  for (std::size_t i = 1; i < poses_.size(); ++i) {
    const double step_m = (poses_[i].position() - poses_[i - 1].position()).norm();
    if (!(step_m > 0.0)) throw std::invalid_argument("SampledPath: neighbouring poses coincide");
    stations_m_.push_back(stations_m_.back() + step_m);
    const double before = poses_[i - 1].heading_rad;
    poses_[i].heading_rad = before + geometry::wrap_angle(poses_[i].heading_rad - before);
  }
}

geometry::Pose2 SampledPath::at(double s_m) const {
  const double inside_m = std::clamp(s_m, 0.0, length_m());
  const auto after = std::upper_bound(stations_m_.begin() + 1, stations_m_.end() - 1, inside_m);
  const auto i = static_cast<std::size_t>(after - stations_m_.begin());
  const double fraction = (inside_m - stations_m_[i - 1]) / (stations_m_[i] - stations_m_[i - 1]);
  const geometry::Pose2 &a = poses_[i - 1], &b = poses_[i];
  const double heading = a.heading_rad + fraction * (b.heading_rad - a.heading_rad);
  const double beyond_m = s_m - inside_m;
  return {a.x_m + fraction * (b.x_m - a.x_m) + beyond_m * std::cos(heading),
          a.y_m + fraction * (b.y_m - a.y_m) + beyond_m * std::sin(heading), heading};
}

double SampledPath::nearest_s_m(const Eigen::Vector2d& point, double near_s_m,
                                double window_m) const {
  double nearest_m = std::numeric_limits<double>::infinity(), found_s_m = near_s_m;
  const auto first =
      std::lower_bound(stations_m_.begin() + 1, stations_m_.end() - 1, near_s_m - window_m);
  for (auto i = static_cast<std::size_t>(first - stations_m_.begin()); i < poses_.size(); ++i) {
    if (stations_m_[i - 1] > near_s_m + window_m && std::isfinite(nearest_m)) break;
    const Eigen::Vector2d from = poses_[i - 1].position();
    const double length_m = stations_m_[i] - stations_m_[i - 1];
    const Eigen::Vector2d along = (poses_[i].position() - from) / length_m;
    const double least = i == 1 ? -std::numeric_limits<double>::infinity() : 0.0;
    const double most = i + 1 == poses_.size() ? std::numeric_limits<double>::infinity() : length_m;
    const double ahead_m = std::clamp((point - from).dot(along), least, most);
    const double distance_m = (from + ahead_m * along - point).norm();
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    found_s_m = stations_m_[i - 1] + ahead_m;
  }
  return found_s_m;
}

SampledPath right_turn_path(double speed_mps) {
  return path_of_turns({-0.5 * std::numbers::pi}, speed_mps);
}

SampledPath zig_zag_path(double speed_mps) {
  const double half = std::numbers::pi / 9.0, whole = 2.0 * half;
  return path_of_turns({half, -whole, whole, -whole, whole, -half}, speed_mps);
}

}  // namespace roadbed::control
