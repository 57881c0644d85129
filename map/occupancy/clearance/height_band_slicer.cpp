#include "roadbed/map/occupancy/clearance/height_band_slicer.h"

#include <algorithm>
#include <cmath>

#include "roadbed/map/occupancy/clearance/ground_relative_columns.h"

namespace roadbed::map::inline occupancy::inline clearance {
namespace {

constexpr double kTouchesBand_m = 1e-6;  // cells that overlap the band by less only touch it

}  // namespace

HeightBandSlicer::HeightBandSlicer(const OccupancySource& source, const HeightBand& band)
    : source_(source),
      band_(band),
      origin_(source.origin_in_source()),
      cell_m_(source.resolution_m()) {
  from_layer_ = to_cells(band.from_m + kTouchesBand_m - origin_.z());
  to_layer_ = to_cells(band.to_m - kTouchesBand_m - origin_.z()) + 1;
}

std::int64_t HeightBandSlicer::layers() const {
  return band_.ground != nullptr ? kGroundRelativeLayers : to_layer_ - from_layer_;
}

std::int64_t HeightBandSlicer::to_cells(double metres) const {
  return static_cast<std::int64_t>(std::floor(metres / cell_m_));
}

std::optional<Slab> HeightBandSlicer::slab_of(const OccupancyCell& leaf) const {
  const Eigen::Vector3d corner =
      (leaf.centre_in_source - origin_).array() - 0.5 * (leaf.size_m - cell_m_);
  const auto side = static_cast<std::int64_t>(std::llround(leaf.size_m / cell_m_));
  const std::int64_t x = to_cells(corner.x()), y = to_cells(corner.y()), z = to_cells(corner.z());
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

std::vector<Slab> HeightBandSlicer::slabs_of(const std::vector<OccupancyCell>& leaves) const {
  std::vector<Slab> slabs;
  for (const OccupancyCell& leaf : leaves) {
    if (const std::optional<Slab> slab = slab_of(leaf)) slabs.push_back(*slab);
  }
  return slabs;
}

std::vector<Slab> HeightBandSlicer::slabs() const { return slabs_of(source_.cells()); }

std::vector<Slab> HeightBandSlicer::slabs_in(const CellRange& range) const {
  const auto at = [&](std::int64_t x, std::int64_t y, std::int64_t layer) -> Eigen::Vector3d {
    return origin_ + cell_m_ * Eigen::Vector3d(static_cast<double>(x), static_cast<double>(y),
                                               static_cast<double>(layer));
  };
  Box3 box{at(range.from_x - 1, range.from_y - 1, from_layer_ - 1),
           at(range.to_x + 1, range.to_y + 1, to_layer_ + 1)};
  if (band_.ground == nullptr) return slabs_of(source_.cells_in(box));
  // Over ground that is not level every column has layers of its own.
  constexpr double farthest_m = 1e6;
  box.min_in_source.z() = -farthest_m;
  box.max_in_source.z() = farthest_m;
  return ground_relative_columns(source_.cells_in(box), band_, origin_, cell_m_, range);
}

}  // namespace roadbed::map::occupancy::clearance
