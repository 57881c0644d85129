#include "roadbed/geometry/index/hilbert.h"

#include <algorithm>
#include <utility>

namespace roadbed::geometry::inline index {

std::uint32_t hilbert_index(std::uint32_t x, std::uint32_t y) {
  std::uint32_t index = 0;
  for (std::uint32_t side = 1U << 15U; side > 0; side >>= 1U) {
    const std::uint32_t right = (x & side) != 0 ? 1 : 0, upper = (y & side) != 0 ? 1 : 0;
    index = index << 2U | ((3 * right) ^ upper);
    if (upper == 1) continue;
    if (right == 1) {  // the curve runs the other way round in the lower right quarter
      x = ~x;
      y = ~y;
    }
    std::swap(x, y);
  }
  return index;
}

std::uint32_t hilbert_key(const Eigen::AlignedBox2d& all, const Eigen::Vector2d& point) {
  const auto cell = [](double offset, double size) {
    const double fraction = size > 0.0 ? offset / size : 0.0;
    return static_cast<std::uint32_t>(std::clamp(fraction, 0.0, 1.0) * 65535.0);
  };
  const Eigen::Vector2d offset = point - all.min(), size = all.sizes();
  return hilbert_index(cell(offset.x(), size.x()), cell(offset.y(), size.y()));
}

std::vector<std::uint32_t> order_of_keys(std::span<const std::uint32_t> keys) {
  std::vector<std::uint64_t> keys_and_places;
  keys_and_places.reserve(keys.size());
  for (const std::uint32_t key : keys) {
    keys_and_places.push_back(std::uint64_t{key} << 32U | keys_and_places.size());
  }
  std::sort(keys_and_places.begin(), keys_and_places.end());
  std::vector<std::uint32_t> order;
  order.reserve(keys.size());
  for (const std::uint64_t both : keys_and_places) {
    order.push_back(static_cast<std::uint32_t>(both));
  }
  return order;
}

}  // namespace roadbed::geometry::index
