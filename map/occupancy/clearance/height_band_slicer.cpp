#include "roadbed/map/occupancy/clearance/height_band_slicer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadbed/map/occupancy/ground/ground.h"

namespace roadbed::map::inline occupancy::inline clearance {
namespace {

constexpr double kTouchesBand_m = 1e-6;     // cells that overlap the band by less only touch it
constexpr double kHeightRounding_m = 5e-5;  // of some dozens of heights added up

// Layers of a column whose whole height in the band was measured.
constexpr std::int64_t kGroundRelativeLayers = 1000;

/// What leaves fill of a band that follows the ground, column by column: the ground is level over a
/// column, at its height in the middle. Cells that are alike and beside each other share a slab.
/// @param range  what matters, in cells from the origin.
/// @pre `band.ground` is there.
class BandColumns {
 public:
  BandColumns(const HeightBand& band, const Eigen::Vector3d& origin, double cell_m,
              const CellRange& range)
      : band_(band), origin_(origin), cell_m_(cell_m), range_(range) {
    ground_m_.assign(range.count(), std::numeric_limits<double>::quiet_NaN());
    measured_m_.assign(range.count(), 0.0f);
  }

  void add(const OccupancyCell& leaf) {
    const double low_m = leaf.centre_in_source.z() - 0.5 * leaf.size_m;
    const bool is_hit = leaf.state == CellState::occupied;
    const CellRange cells = cells_of(leaf).cut(range_);
    for (std::int64_t y = cells.from_y; y < cells.to_y; ++y) {
      for (std::int64_t x = cells.from_x; x < cells.to_x; ++x) {
        const std::size_t at = range_.index(x, y);
        const double above_m = low_m - ground_at(x, y, at);
        const double overlap_m =
            std::min(above_m + leaf.size_m, band_.to_m) - std::max(above_m, band_.from_m);
        if (overlap_m <= kTouchesBand_m) continue;
        measured_m_[at] = is_hit ? kHit : measured_m_[at] + static_cast<float>(overlap_m);
      }
    }
  }

  std::vector<Slab> slabs() const {
    std::vector<Slab> slabs;
    for (std::int64_t y = range_.from_y; y < range_.to_y; ++y) {
      for (std::int64_t x = range_.from_x; x < range_.to_x; ++x) {
        const float measured_m = measured_m_[range_.index(x, y)];
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

HeightBandSlicer::HeightBandSlicer(const OccupancySource& source, const HeightBand& band)
    : source_(source),
      band_(band),
      origin_(source.origin_in_source()),
      cell_m_(source.resolution_m()),
      per_cell_(1.0 / cell_m_) {
  from_layer_ = to_cells(band.from_m + kTouchesBand_m - origin_.z());
  to_layer_ = to_cells(band.to_m - kTouchesBand_m - origin_.z()) + 1;
}

std::int64_t HeightBandSlicer::layers() const {
  return band_.ground != nullptr ? kGroundRelativeLayers : to_layer_ - from_layer_;
}

std::int64_t HeightBandSlicer::to_cells(double metres) const {
  return static_cast<std::int64_t>(std::floor(metres / cell_m_));
}

// In cells it begins at whole numbers: from the middle of its first cell, rounding does not matter.
std::optional<Slab> HeightBandSlicer::slab_of(const OccupancyCell& leaf) const {
  const Eigen::Array3d first =
      ((leaf.centre_in_source - origin_).array() - 0.5 * (leaf.size_m - cell_m_)) * per_cell_;
  const auto side = static_cast<std::int64_t>(leaf.size_m * per_cell_ + 0.5);
  const std::int64_t x = whole_below(first.x()), y = whole_below(first.y()),
                     z = whole_below(first.z());
  const std::int64_t layers = std::min(z + side, to_layer_) - std::max(z, from_layer_);
  if (layers <= 0) return std::nullopt;
  return Slab{{x, y, x + side, y + side}, layers, leaf.state == CellState::occupied};
}

CellRange HeightBandSlicer::range(const Box2& box, double margin_m) const {
  const auto from = [&](double at, double origin) { return to_cells(at - margin_m - origin); };
  const auto to = [&](double at, double origin) { return to_cells(at + margin_m - origin) + 1; };
  return {from(box.min_in_source.x(), origin_.x()), from(box.min_in_source.y(), origin_.y()),
          to(box.max_in_source.x(), origin_.x()), to(box.max_in_source.y(), origin_.y())};
}

std::vector<Slab> HeightBandSlicer::slabs() const {
  std::vector<Slab> slabs;
  source_.for_each_cell([&](const OccupancyCell& leaf) {
    if (const std::optional<Slab> slab = slab_of(leaf)) slabs.push_back(*slab);
  });
  return slabs;
}

void HeightBandSlicer::for_each_slab_in(const CellRange& range, const UseSlab& use) const {
  const auto at = [&](std::int64_t x, std::int64_t y, std::int64_t layer) -> Eigen::Vector3d {
    return origin_ + cell_m_ * Eigen::Vector3d(static_cast<double>(x), static_cast<double>(y),
                                               static_cast<double>(layer));
  };
  Box3 box{at(range.from_x - 1, range.from_y - 1, from_layer_ - 1),
           at(range.to_x + 1, range.to_y + 1, to_layer_ + 1)};
  if (band_.ground == nullptr) {
    source_.for_each_in(box, [&](const OccupancyCell& leaf) {
      if (const std::optional<Slab> slab = slab_of(leaf)) use(*slab);
    });
    return;
  }
  // Over ground that is not level every column has layers of its own.
  constexpr double farthest_m = 1e6;
  box.min_in_source.z() = -farthest_m;
  box.max_in_source.z() = farthest_m;
  BandColumns columns(band_, origin_, cell_m_, range);
  source_.for_each_in(box, [&](const OccupancyCell& leaf) { columns.add(leaf); });
  for (const Slab& slab : columns.slabs()) use(slab);
}

}  // namespace roadbed::map::occupancy::clearance
