#include "roadbed/map/edit/transforming/transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "roadbed/geometry/primitives/cross.h"
#include "roadbed/map/edit/refuse_format.h"
#include "roadbed/map/files/coordinate_limits.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/projection.h"
#include "roadbed/map/load_map.h"

namespace roadbed::map::inline edit::inline transforming {

Eigen::Vector2d RigidMotion::operator()(const Eigen::Vector2d& point) const {
  const double c = std::cos(turn_rad), s = std::sin(turn_rad);
  return {c * point.x() - s * point.y() + shift_m.x(), s * point.x() + c * point.y() + shift_m.y()};
}

RigidMotion turn_about(const Eigen::Vector2d& place, double turn_rad) {
  RigidMotion motion{.turn_rad = turn_rad};
  motion.shift_m.head<2>() = place - motion(place);
  return motion;
}

Alignment align(std::span<const PointPair> pairs) {
  if (pairs.size() < 2) throw std::invalid_argument("align: needs two pairs of points");
  Eigen::Vector2d from_mean(0, 0), to_mean(0, 0);
  for (const PointPair& pair : pairs) from_mean += pair.from, to_mean += pair.to;
  from_mean /= static_cast<double>(pairs.size());
  to_mean /= static_cast<double>(pairs.size());
  double along = 0.0, across = 0.0, spread = 0.0;
  for (const PointPair& pair : pairs) {
    along += (pair.from - from_mean).dot(pair.to - to_mean);
    across += geometry::cross(pair.from - from_mean, pair.to - to_mean);
    spread += (pair.from - from_mean).squaredNorm();
  }
  if (!(spread > 0.0)) throw std::invalid_argument("align: all points are at one place");
  Alignment found;
  found.motion.turn_rad = std::atan2(across, along);
  found.motion.shift_m.head<2>() = to_mean - found.motion(from_mean);
  double sum = 0.0;
  for (const PointPair& pair : pairs) {
    const double off_m = (found.motion(pair.from) - pair.to).norm();
    sum += off_m * off_m;
    found.worst_m = std::max(found.worst_m, off_m);
  }
  found.rms_m = std::sqrt(sum / static_cast<double>(pairs.size()));
  return found;
}

void require_places(std::span<const Eigen::Vector2d> points, const std::string& name) {
  const auto lost = std::ranges::find_if(points, [](const Eigen::Vector2d& point) {
    return !(point.cwiseAbs().maxCoeff() <= kFarthestM);
  });
  if (lost != points.end()) refuse_place(*lost, "|x|, |y| ≤ 1e8 m", name);
}

void refuse_place(const Eigen::Vector2d& point, const std::string& needed,
                  const std::string& name) {
  throw InputError(
      {.file = name,
       .found = fmt::format("a place that would come to ({:.0f}, {:.0f})", point.x(), point.y()),
       .needed = needed,
       .remedy = "shift it less far, or turn it about a place in it (--about)"});
}

Edited transform(std::string bytes, const std::string& name, const TransformOptions& options) {
  if (options.to) require_metres(*options.to);
  MapBytes map = map_bytes(std::move(bytes), name);
  if (map.format.name == "OpenDRIVE") {
    return transform_open_drive(std::move(map.bytes), name, options);
  }
  if (map.format.name == "Lanelet2") return transform_lanelet2(std::move(map.bytes), name, options);
  if (map.format.name == "CommonRoad") {
    return transform_common_road(std::move(map.bytes), name, options);
  }
  refuse_format(map.format, name, "OpenDRIVE, Lanelet2 or CommonRoad");
}

}  // namespace roadbed::map::edit::transforming
