#include "roadbed/map/occupancy/octree/free_space_rays.h"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace roadbed::map::inline occupancy::inline octree {
namespace {

constexpr std::uint32_t kPageSide = 32;
constexpr std::size_t kFirstSlots = 4096;  // a power of two

// 11 bits an axis.
std::uint64_t page_code(const CellKey& key) {
  return std::uint64_t{key[2]} / kPageSide << 22 | std::uint64_t{key[1]} / kPageSide << 11 |
         key[0] / kPageSide;
}

std::uint32_t cell_in_page(const CellKey& key) {
  return morton(key[0] % kPageSide, key[1] % kPageSide, key[2] % kPageSide);
}

// A block's place in its page along an axis: 0 … 3.
std::uint32_t block_axis(std::uint32_t block, unsigned axis) {
  return (block >> axis & 1u) | (block >> (axis + 3) & 1u) << 1;
}

}  // namespace

/// Where a ray comes to the next border across each axis.
struct FreeSpaceRays::Ray {
  std::array<double, 3> next_m, apart_m{};  // along the ray; and between borders
  std::array<int, 3> sign{};
  double length_m = 0.0;

  Ray(const Eigen::Vector3f& origin, const CellKey& from, const Eigen::Vector3f& end,
      double resolution_m) {
    const Eigen::Vector3f way = end - origin;
    const auto length = static_cast<float>(
        std::sqrt(static_cast<double>(way.x() * way.x() + way.y() * way.y() + way.z() * way.z())));
    length_m = static_cast<double>(length);
    next_m.fill(std::numeric_limits<double>::max());
    for (unsigned axis = 0; axis < 3; ++axis) {
      const float direction = way[axis] / length;
      if (!(direction > 0.0f) && !(direction < 0.0f)) continue;
      sign[axis] = direction > 0.0f ? 1 : -1;
      double border_m = (static_cast<double>(from[axis]) - kHalfRange + 0.5) * resolution_m;
      border_m += static_cast<double>(static_cast<float>(sign[axis] * resolution_m * 0.5));
      next_m[axis] =
          (border_m - static_cast<double>(origin[axis])) / static_cast<double>(direction);
      apart_m[axis] = resolution_m / std::abs(static_cast<double>(direction));
    }
  }

  // Goes on to the next border, and says across which axis that is.
  unsigned step() {
    const bool x_first = next_m[0] < next_m[1];
    const bool z_is_next = !((x_first ? next_m[0] : next_m[1]) < next_m[2]);
    const unsigned axis = z_is_next ? 2u : x_first ? 0u : 1u;
    next_m[axis] += apart_m[axis];
    return axis;
  }

  // Whether it comes to its last cell by crossing just the borders between that and the first one,
  // all of them within its length, with room for what adding up may round off.
  bool is_sure_to_reach(const std::array<int, 3>& cells, double resolution_m) const {
    double last_m = 0.0, beyond_m = std::numeric_limits<double>::max();
    for (unsigned axis = 0; axis < 3; ++axis) {
      if (cells[axis] * sign[axis] < 0 || (cells[axis] != 0 && sign[axis] == 0)) return false;
      const int crossed = std::abs(cells[axis]);
      const double after_m = next_m[axis] + crossed * apart_m[axis];
      beyond_m = std::min(beyond_m, after_m);
      if (crossed > 0) last_m = std::max(last_m, after_m - apart_m[axis]);
    }
    return last_m + 1e-3 * resolution_m < std::min(beyond_m, length_m);
  }
};

FreeSpaceRays::FreeSpaceRays(double resolution_m)
    : resolution_m_(resolution_m), slots_(kFirstSlots) {}

CellKey FreeSpaceRays::first_cell(std::uint64_t code, std::uint32_t block) {
  CellKey key;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const auto page = static_cast<std::uint32_t>(code >> 11 * axis & 0x7ffu);
    key[axis] = static_cast<std::uint16_t>(kPageSide * page + 8 * block_axis(block, axis));
  }
  return key;
}

// The slot of a page, or the empty one where it would be.
FreeSpaceRays::Slot& FreeSpaceRays::slot_of(std::uint64_t code) {
  constexpr std::uint64_t golden = 0x9e3779b97f4a7c15u;
  const std::size_t last = slots_.size() - 1;
  std::size_t at = code * golden >> (64 - std::bit_width(last));
  while (slots_[at].code != code && slots_[at].code != kNoPage) at = (at + 1) & last;
  return slots_[at];
}

FreeSpaceRays::Page& FreeSpaceRays::page_of(std::uint64_t code) {
  const Slot& slot = slot_of(code);
  return slot.code == code ? *slot.page : add_page(code);
}

FreeSpaceRays::Page& FreeSpaceRays::add_page(std::uint64_t code) {
  if (2 * codes_.size() >= slots_.size()) {
    slots_.assign(2 * slots_.size(), {});
    for (std::size_t i = 0; i < codes_.size(); ++i) slot_of(codes_[i]) = {codes_[i], &page_at(i)};
  }
  if (codes_.size() == chunks_.size() * kChunk) {
    chunks_.push_back(std::make_unique<Page[]>(kChunk));
  }
  codes_.push_back(code);
  Page& page = page_at(codes_.size() - 1);
  slot_of(code) = {code, &page};
  return page;
}

// The last one first: what it was put behind is still there.
void FreeSpaceRays::forget() {
  for (; !codes_.empty(); codes_.pop_back()) slot_of(codes_.back()) = {};
}

void FreeSpaceRays::mark(const CellKey& key) {
  const std::uint32_t cell = cell_in_page(key);
  page_of(page_code(key)).blocks[cell >> 9][cell >> 6 & 7u] |= std::uint64_t{1} << (cell & 63u);
}

void FreeSpaceRays::carve(const Eigen::Vector3f& origin, const CellKey& from,
                          const Eigen::Vector3f& end, const CellKey& to) {
  if (from == to) return;
  const Ray ray(origin, from, end, resolution_m_);
  std::array<int, 3> cells;
  for (unsigned axis = 0; axis < 3; ++axis) cells[axis] = int{to[axis]} - int{from[axis]};
  if (ray.is_sure_to_reach(cells, resolution_m_)) {
    walk(ray, from,
         static_cast<std::uint32_t>(std::abs(cells[0]) + std::abs(cells[1]) + std::abs(cells[2])));
  } else {
    walk_warily(ray, from, to);
  }
}

// A place counts up along every axis: on those that the ray goes down along, its bits are flipped.
void FreeSpaceRays::walk(const Ray& ray, const CellKey& from, std::uint32_t steps) {
  constexpr std::array<std::uint32_t, 3> axis_bits{0x1249, 0x2492, 0x4924};
  std::uint32_t flipped = 0;
  std::array<std::uint64_t, 3> page_steps;
  for (unsigned axis = 0; axis < 3; ++axis) {
    if (ray.sign[axis] < 0) flipped |= axis_bits[axis];
    const std::uint64_t one = std::uint64_t{1} << 11 * axis;
    page_steps[axis] = ray.sign[axis] > 0 ? one : ~one + 1;
  }
  std::uint64_t code = page_code(from);
  std::uint64_t* words = page_of(code).blocks.front().data();
  std::uint32_t place = cell_in_page(from) ^ flipped;
  double x_m = ray.next_m[0], y_m = ray.next_m[1], z_m = ray.next_m[2];
  for (;;) {
    const std::uint32_t cell = place ^ flipped;
    words[cell >> 6] |= std::uint64_t{1} << (cell & 63u);
    if (--steps == 0) return;
    // As Ray::step.
    const bool x_first = x_m < y_m;
    const bool z_is_next = !((x_first ? x_m : y_m) < z_m);
    x_m += x_first && !z_is_next ? ray.apart_m[0] : 0.0;
    y_m += !x_first && !z_is_next ? ray.apart_m[1] : 0.0;
    z_m += z_is_next ? ray.apart_m[2] : 0.0;
    const unsigned axis = z_is_next ? 2u : x_first ? 0u : 1u;
    const std::uint32_t bits = axis_bits[axis];
    const std::uint32_t moved = ((place | ~bits) + 1u) & bits;  // a carry runs over other axes
    place = (place & ~bits) | moved;
    if (moved == 0) [[unlikely]] {
      code += page_steps[axis];
      words = page_of(code).blocks.front().data();
    }
  }
}

// Rounding may lead past the last cell: then it ends with the ray's length.
void FreeSpaceRays::walk_warily(Ray ray, CellKey key, const CellKey& to) {
  for (;;) {
    mark(key);
    const unsigned axis = ray.step();
    key[axis] = static_cast<std::uint16_t>(key[axis] + ray.sign[axis]);
    if (key == to || *std::ranges::min_element(ray.next_m) > ray.length_m) return;
  }
}

}  // namespace roadbed::map::occupancy::octree
