#include "roadbed/map/occupancy/clearance/ground_relative_columns.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "roadbed/map/occupancy/ground/ground.h"

namespace roadbed::map::inline occupancy::inline clearance {
namespace {

constexpr double kTouchesOver_m = 1e-6;     // cells that overlap the band by less only touch it
constexpr double kHeightRounding_m = 5e-5;  // of some dozens of heights added up

class BandColumns {
 public:
  BandColumns(const HeightBand& band, const Eigen::Vector3d& origin, double cell_m,
              const CellRange& range)
      : band_(band), origin_(origin), cell_m_(cell_m), range_(range) {
    const auto count = static_cast<std::size_t>(std::max<std::int64_t>(0, range.width()) *
                                                std::max<std::int64_t>(0, range.height()));
    ground_m_.assign(count, std::numeric_limits<double>::quiet_NaN());
    measured_m_.assign(count, 0.0f);
  }

  void add(const OccupancyCell& leaf) {
    const double low_m = leaf.centre_in_source.z() - 0.5 * leaf.size_m;
    const bool is_hit = leaf.state == CellState::occupied;
    const CellRange cells = cells_of(leaf).cut(range_);
    for (std::int64_t y = cells.from_y; y < cells.to_y; ++y) {
      for (std::int64_t x = cells.from_x; x < cells.to_x; ++x) {
        const std::size_t at = index(x, y);
        const double above_m = low_m - ground_at(x, y, at);
        const double overlap_m =
            std::min(above_m + leaf.size_m, band_.to_m) - std::max(above_m, band_.from_m);
        if (overlap_m <= kTouchesOver_m) continue;
        measured_m_[at] = is_hit ? kHit : measured_m_[at] + static_cast<float>(overlap_m);
      }
    }
  }

  std::vector<Slab> slabs() const {
    std::vector<Slab> slabs;
    for (std::int64_t y = range_.from_y; y < range_.to_y; ++y) {
      for (std::int64_t x = range_.from_x; x < range_.to_x; ++x) {
        const float measured_m = measured_m_[index(x, y)];
        if (measured_m == 0.0f) continue;
        const Slab next{{x, y, x + 1, y + 1}, layers(measured_m), measured_m == kHit};
        if (!slabs.empty() && goes_on(slabs.back(), next)) {
          ++slabs.back().cells.to_x;
        } else {
          slabs.push_back(next);
        }
      }
    }
    return slabs;
  }

 private:
  static constexpr float kHit = std::numeric_limits<float>::infinity();

  static bool goes_on(const Slab& slab, const Slab& next) {
    return slab.cells.from_y == next.cells.from_y && slab.cells.to_x == next.cells.from_x &&
           slab.layers == next.layers && slab.occupied == next.occupied;
  }

  CellRange cells_of(const OccupancyCell& leaf) const {
    const auto cell = [this](double at_m) {
      return static_cast<std::int64_t>(std::llround(at_m / cell_m_));
    };
    const Eigen::Vector3d least = (leaf.centre_in_source - origin_).array() - 0.5 * leaf.size_m;
    const std::int64_t x = cell(least.x()), y = cell(least.y()), side = cell(leaf.size_m);
    return {x, y, x + side, y + side};
  }

  std::size_t index(std::int64_t x, std::int64_t y) const {
    return static_cast<std::size_t>((y - range_.from_y) * range_.width() + x - range_.from_x);
  }

  double ground_at(std::int64_t x, std::int64_t y, std::size_t at) {
    if (std::isnan(ground_m_[at])) {
      const Eigen::Vector2d middle(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5);
      ground_m_[at] = band_.ground->height_m(origin_.head<2>() + cell_m_ * middle);
    }
    return ground_m_[at];
  }

  std::int64_t layers(float measured_m) const {
    const double fraction = static_cast<double>(measured_m) / (band_.to_m - band_.from_m);
    if (static_cast<double>(measured_m) >= band_.to_m - band_.from_m - kHeightRounding_m) {
      return kGroundRelativeLayers;
    }
    return std::min(
        kGroundRelativeLayers - 1,
        static_cast<std::int64_t>(fraction * static_cast<double>(kGroundRelativeLayers)));
  }

  const HeightBand& band_;
  Eigen::Vector3d origin_;
  double cell_m_;
  CellRange range_;
  std::vector<double> ground_m_;   // of each column; NaN until it is asked for
  std::vector<float> measured_m_;  // of its band; infinite where there is a hit
};

}  // namespace

std::vector<Slab> ground_relative_columns(const std::vector<OccupancyCell>& leaves,
                                          const HeightBand& band,
                                          const Eigen::Vector3d& origin_in_source, double cell_m,
                                          const CellRange& range) {
  BandColumns columns(band, origin_in_source, cell_m, range);
  for (const OccupancyCell& leaf : leaves) columns.add(leaf);
  return columns.slabs();
}

}  // namespace roadbed::map::occupancy::clearance
