#include "roadbed/map/validation/lane_folds.h"

namespace roadbed::map::validation {
namespace {

using Eigen::Vector2d;

Fold fold_of(const Lane& lane, const LaneLine& border) {
  Fold fold;
  const auto& points = border.in_map.points();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double middle_m = 0.5 * (border.station_m[i - 1] + border.station_m[i]);
    const double forward_m = (points[i] - points[i - 1]).dot(direction_at(lane, middle_m));
    if (forward_m >= 0.0) continue;
    if (fold.length_m == 0.0) fold.in_map = points[i];
    fold.length_m -= forward_m;
  }
  return fold;
}

}  // namespace

Vector2d direction_at(const Lane& lane, double s_m) {
  constexpr double kReach = 0.5;  // [m]
  const Vector2d along = lane.centre.in_map.at(s_m + kReach) - lane.centre.in_map.at(s_m - kReach);
  return along.norm() > 0.0 ? Vector2d(along.normalized()) : Vector2d(0.0, 0.0);
}

double signed_width_m(const Lane& lane, double s_m) {
  const Vector2d across = Lane::point_at(lane.left, s_m) - Lane::point_at(lane.right, s_m);
  const Vector2d direction = direction_at(lane, s_m);
  return across.dot(Vector2d(-direction.y(), direction.x()));
}

std::vector<double> border_stations_m(const Lane& lane) {
  std::vector<double> stations_m = lane.left.station_m;
  stations_m.insert(stations_m.end(), lane.right.station_m.begin(), lane.right.station_m.end());
  return stations_m;
}

Fold longer_fold(const Lane& lane) {
  const Fold left = fold_of(lane, lane.left), right = fold_of(lane, lane.right);
  return left.length_m >= right.length_m ? left : right;
}

std::optional<Swap> most_swapped(const Lane& lane) {
  std::optional<Swap> worst;
  for (const double s_m : border_stations_m(lane)) {
    const double width_m = signed_width_m(lane, s_m);
    if (width_m < (worst ? worst->width_m : -kWidthTolerance)) worst = Swap{s_m, width_m};
  }
  return worst;
}

bool is_folded(const Lane& lane) {
  return longer_fold(lane).length_m > kFold || most_swapped(lane).has_value();
}

}  // namespace roadbed::map::validation
