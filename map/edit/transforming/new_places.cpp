#include "roadbed/map/edit/transforming/new_places.h"

#include <fmt/format.h>

#include <algorithm>

#include "roadbed/map/files/coordinate_limits.h"
#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline edit::inline transforming {

void require_places(std::span<const Eigen::Vector2d> points, const std::string& file) {
  const auto lost = std::ranges::find_if(points, [](const Eigen::Vector2d& point) {
    return !(point.cwiseAbs().maxCoeff() <= kFarthestM);
  });
  if (lost != points.end()) refuse_place(*lost, "|x|, |y| ≤ 1e8 m", file);
}

void refuse_place(const Eigen::Vector2d& point, const std::string& needed,
                  const std::string& file) {
  throw InputError(
      {.file = file,
       .found = fmt::format("a place that would come to ({:.0f}, {:.0f})", point.x(), point.y()),
       .needed = needed,
       .remedy = "shift it less far"});
}

}  // namespace roadbed::map::edit::transforming
