#include "roadbed/geometry/index/hilbert.h"

#include <algorithm>
#include <utility>

namespace roadbed::geometry::inline index {

std::uint32_t hilbert_index(std::uint32_t x, std::uint32_t y) {
  constexpr std::uint32_t kLast = (1U << 16U) - 1;
  std::uint32_t index = 0;
  for (std::uint32_t side = 1U << 15U; side > 0; side /= 2) {
    const std::uint32_t right = (x & side) != 0 ? 1 : 0;
    const std::uint32_t upper = (y & side) != 0 ? 1 : 0;
    index += side * side * ((3 * right) ^ upper);
    if (upper == 1) continue;
    if (right == 1) {  // the curve runs the other way round in the lower right quarter
      x = kLast - x;
      y = kLast - y;
    }
    std::swap(x, y);
  }
  return index;
}

std::uint32_t hilbert_key(const Eigen::AlignedBox2d& all, const Eigen::Vector2d& point) {
  const auto cell = [](double offset, double size) {
    const double share = size > 0.0 ? offset / size : 0.0;
    return static_cast<std::uint32_t>(std::clamp(share, 0.0, 1.0) * 65535.0);
  };
  const Eigen::Vector2d offset = point - all.min(), size = all.sizes();
  return hilbert_index(cell(offset.x(), size.x()), cell(offset.y(), size.y()));
}

}  // namespace roadbed::geometry::index
