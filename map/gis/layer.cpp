#include "roadbed/map/gis/layer.h"

namespace roadbed::map::inline gis {

Eigen::AlignedBox2d box_of(const Shape& shape) {
  Eigen::AlignedBox2d box;
  for (const auto& rings : shape) {
    // Holes are inside the first ring.
    for (const Eigen::Vector3d& point : rings[0]) box.extend(Eigen::Vector2d(point.head<2>()));
  }
  return box;
}

}  // namespace roadbed::map::gis
