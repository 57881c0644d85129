#include "roadbed/control/course.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "roadbed/geometry/primitives/angle.h"

namespace roadbed::control {

Course::Course(std::vector<geometry::Pose2> poses) : poses_(std::move(poses)), stations_m_{0.0} {
  if (poses_.size() < 2) throw std::invalid_argument("Course: needs at least two poses");
  for (std::size_t i = 1; i < poses_.size(); ++i) {
    const double step_m = (poses_[i].position() - poses_[i - 1].position()).norm();
    if (!(step_m > 0.0)) throw std::invalid_argument("Course: neighbouring poses coincide");
    stations_m_.push_back(stations_m_.back() + step_m);
    const double before = poses_[i - 1].heading_rad;
    poses_[i].heading_rad = before + geometry::wrap_angle(poses_[i].heading_rad - before);
  }
}

geometry::Pose2 Course::at(double s_m) const {
  const double inside_m = std::clamp(s_m, 0.0, length_m());
  const auto after = std::upper_bound(stations_m_.begin() + 1, stations_m_.end() - 1, inside_m);
  const auto i = static_cast<std::size_t>(after - stations_m_.begin());
  const double share = (inside_m - stations_m_[i - 1]) / (stations_m_[i] - stations_m_[i - 1]);
  const geometry::Pose2 &a = poses_[i - 1], &b = poses_[i];
  const double heading = a.heading_rad + share * (b.heading_rad - a.heading_rad);
  const double beyond_m = s_m - inside_m;
  return {a.x_m + share * (b.x_m - a.x_m) + beyond_m * std::cos(heading),
          a.y_m + share * (b.y_m - a.y_m) + beyond_m * std::sin(heading), heading};
}

double Course::nearest_s_m(const Eigen::Vector2d& point, double near_s_m, double window_m) const {
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

}  // namespace roadbed::control
