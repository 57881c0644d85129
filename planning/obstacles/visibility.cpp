#include "roadbed/planning/obstacles/visibility.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace roadbed::planning::inline obstacles {
namespace {

using geometry::Rectangle;

constexpr std::size_t kNobody = std::numeric_limits<std::size_t>::max();
constexpr double kMirrors = 0.5;  // from the middle to the front
constexpr double kBesideBody_m = 0.5;
constexpr double kOwnCells_m = 0.5;  // beside a body, that are its own

/// A rectangle without a width.
Rectangle line_of_sight(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const Eigen::Vector2d along = to - from;
  const double length_m = along.norm();
  return {.centre = 0.5 * (from + to),
          .axis = length_m > 0.0 ? Eigen::Vector2d(along / length_m) : Eigen::Vector2d(1, 0),
          .half_length_m = 0.5 * length_m};
}

/// Whether the circle around a rectangle touches a line of sight.
bool is_near(const Rectangle& body, const Rectangle& sight) {
  const Eigen::Vector2d to = body.centre - sight.centre;
  const double along_m = std::abs(to.dot(sight.axis)) - sight.half_length_m;
  const double beside_m = std::abs(sight.axis.x() * to.y() - sight.axis.y() * to.x());
  const double radius_m = body.radius_m();
  return along_m <= radius_m && beside_m <= radius_m;
}

}  // namespace

Visibility::Visibility(const Rectangle& vehicle, double range_m, std::vector<Rectangle> others,
                       std::shared_ptr<const map::ClearanceField> field,
                       const map::RoadMap& road_map)
    : range_m_(range_m), others_(std::move(others)), field_(std::move(field)), road_map_(road_map) {
  const Eigen::Vector2d mirrors = vehicle.centre + kMirrors * vehicle.half_length_m * vehicle.axis;
  const Eigen::Vector2d left(-vehicle.axis.y(), vehicle.axis.x());
  eyes_ = {mirrors + vehicle.half_width_m * left, mirrors - vehicle.half_width_m * left};
}

bool Visibility::sees(const Eigen::Vector2d& point) const { return is_seen(point, kNobody); }

bool Visibility::is_on_body(const Eigen::Vector2d& point) const {
  return std::ranges::any_of(others_, [&](const Rectangle& other) {
    return geometry::distance_m(other, point) <= kBesideBody_m;
  });
}

bool Visibility::sees_other(std::size_t other) const {
  const auto [a, b, c, d] = others_[other].corners();
  const auto points = {a, b, c, d, others_[other].centre};
  return std::ranges::any_of(points,
                             [&](const Eigen::Vector2d& point) { return is_seen(point, other); });
}

bool Visibility::is_seen(const Eigen::Vector2d& point, std::size_t but) const {
  const double own_m = but == kNobody ? 0.0 : 2.0 * others_[but].radius_m() + kOwnCells_m;
  return std::ranges::any_of(eyes_, [&](const Eigen::Vector2d& eye) {
    const Rectangle sight = line_of_sight(eye, point);
    if (2.0 * sight.half_length_m > range_m_) return false;
    for (std::size_t i = 0; i < others_.size(); ++i) {
      if (i == but || !is_near(others_[i], sight)) continue;
      if (geometry::distance_m(others_[i], sight) <= 0.0) return false;
    }
    return !is_hidden_by_cells(sight, own_m);
  });
}

/// Piece by piece, as the field answers for bodies; past its region nothing is known to hide.
bool Visibility::is_hidden_by_cells(const Rectangle& sight, double but_last_m) const {
  constexpr double piece_m = 4.0;
  if (!field_) return false;
  const double length_m = 2.0 * sight.half_length_m - but_last_m;
  const Eigen::Vector2d from = sight.centre - sight.half_length_m * sight.axis;
  for (double at_m = 0.0; at_m < length_m; at_m += piece_m) {
    const double to_m = std::min(length_m, at_m + piece_m);
    const Rectangle piece = line_of_sight(road_map_.to_source(from + at_m * sight.axis),
                                          road_map_.to_source(from + to_m * sight.axis));
    if (field_->is_made_for(piece) && field_->nearest(piece, 0.0)) return true;
  }
  return false;
}

}  // namespace roadbed::planning::obstacles
