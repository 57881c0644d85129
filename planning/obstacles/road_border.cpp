#include "roadbed/planning/obstacles/road_border.h"

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/primitives/cross.h"

namespace roadbed::planning::inline obstacles {
namespace {

constexpr double kStep_m = 0.25;

}  // namespace

RoadBorder::RoadBorder(const LineView& line, double from_s_m, double to_s_m) : from_s_m_(from_s_m) {
  const int count = static_cast<int>(std::ceil((to_s_m - from_s_m) / kStep_m)) + 2;
  samples_.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double s_m = from_s_m + i * kStep_m;
    const ReferencePoint point = line.at(s_m);
    const Corridor corridor = line.corridor_at(s_m);
    samples_.push_back({point.in_map,
                        {std::cos(point.heading_rad), std::sin(point.heading_rad)},
                        corridor.left_m,
                        corridor.right_m,
                        point.curvature_per_m});
  }
}

double RoadBorder::excess_m(const geometry::Rectangle& body, double rear_overhang_m,
                            double near_s_m) const {
  const Eigen::Vector2d left(-body.axis.y(), body.axis.x());
  const double middle_s_m = near_s_m + body.half_length_m - rear_overhang_m;
  double excess_m = -1e300;
  for (const double ahead_m : {-body.half_length_m, body.half_length_m}) {
    for (const double side_m : {-body.half_width_m, body.half_width_m}) {
      const Eigen::Vector2d corner = body.centre + ahead_m * body.axis + side_m * left;
      excess_m = std::max(excess_m, excess_of_point_m(corner, middle_s_m + ahead_m));
    }
  }
  return excess_m;
}

RoadBorder::Room RoadBorder::least_room(double from_s_m, double to_s_m) const {
  const double last = static_cast<double>(samples_.size() - 1);
  const auto index = [&](double s_m) {
    return static_cast<std::size_t>(std::clamp((s_m - from_s_m_) / kStep_m, 0.0, last));
  };
  const std::size_t end = std::min(index(to_s_m) + 2, samples_.size());
  Room room{1e300, 1e300, 1e300, -1e300};
  for (std::size_t i = index(from_s_m); i < end; ++i) {
    room.left_m = std::min(room.left_m, samples_[i].left_m);
    room.right_m = std::min(room.right_m, samples_[i].right_m);
    room.least_curvature_per_m = std::min(room.least_curvature_per_m, samples_[i].curvature_per_m);
    room.most_curvature_per_m = std::max(room.most_curvature_per_m, samples_[i].curvature_per_m);
  }
  return room;
}

// The last sample whose normal the point has passed, searched from a first guess.
std::size_t RoadBorder::sample_before(const Eigen::Vector2d& point, double near_s_m) const {
  const auto passed = [&](std::size_t i) {
    return (point - samples_[i].in_map).dot(samples_[i].tangent) >= 0.0;
  };
  const double guess = std::floor((near_s_m - from_s_m_) / kStep_m);
  const std::size_t last = samples_.size() - 2;
  auto i = static_cast<std::size_t>(std::clamp(guess, 0.0, static_cast<double>(last)));
  while (i > 0 && !passed(i)) --i;
  while (i < last && passed(i + 1)) ++i;
  return i;
}

double RoadBorder::excess_of_point_m(const Eigen::Vector2d& point, double near_s_m) const {
  const std::size_t i = sample_before(point, near_s_m);
  const Sample &a = samples_[i], &b = samples_[i + 1];
  const Eigen::Vector2d from_a = point - a.in_map, from_b = point - b.in_map;
  const double along_a = from_a.dot(a.tangent), along_b = -from_b.dot(b.tangent);
  const double fraction =
      along_a + along_b > 0.0 ? std::clamp(along_a / (along_a + along_b), 0.0, 1.0) : 0.0;
  const auto between = [&](double at_a, double at_b) { return at_a + fraction * (at_b - at_a); };
  const double d_m =
      between(geometry::cross(a.tangent, from_a), geometry::cross(b.tangent, from_b));
  return std::max(d_m - between(a.left_m, b.left_m), -d_m - between(a.right_m, b.right_m));
}

}  // namespace roadbed::planning::obstacles
