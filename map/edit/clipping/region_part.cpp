#include "roadbed/map/edit/clipping/region_part.h"

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/polygons/exact.h"
#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/geometry/primitives/cross.h"

namespace roadbed::map::inline edit::inline clipping {
namespace {

using Eigen::Vector2d;

// Whether an edge may come near a box.
bool may_meet(const RegionEdge& edge, const geometry::Box& box) {
  constexpr double kNear_m = 1e-6;  // more than rounding, of the coordinates of any map
  const geometry::Box around(edge.from.cwiseMin(edge.to), edge.from.cwiseMax(edge.to));
  if (!box.intersects(around)) return false;
  const Vector2d along = edge.to - edge.from, half = 0.5 * box.sizes();
  const double reach = std::abs(along.x()) * half.y() + std::abs(along.y()) * half.x();
  const double beside = std::abs(geometry::cross(along, box.center() - edge.from));
  return beside <= reach + kNear_m * along.norm();
}

// Whether the way from one point to another, neither of them on the edge, crosses it. Exact: an end
// of the edge on the way counts as one to its right, so that of two edges that share it and go on
// to the other side just one is crossed.
bool crosses(const Vector2d& from, const Vector2d& to, const RegionEdge& edge) {
  using geometry::exact::turn;
  if ((turn(from, to, edge.from) > 0) == (turn(from, to, edge.to) > 0)) return false;
  return turn(edge.from, edge.to, from) != turn(edge.from, edge.to, to);
}

/// Halves a run of points, the first of which is point `first` of all.
void find_inside(const RegionPart& part, std::span<const Vector2d> points, std::size_t first,
                 std::vector<bool>& inside) {
  if (points.size() == 1 || part.is_simple()) {
    for (std::size_t i = 0; i < points.size(); ++i) inside[first + i] = part.contains(points[i]);
    return;
  }
  const std::size_t middle = points.size() / 2;
  const auto take = [&](std::span<const Vector2d> half, std::size_t from) {
    find_inside(part.within(geometry::box_around(half)), half, first + from, inside);
  };
  take(points.first(middle), 0);
  take(points.subspan(middle), middle);
}

}  // namespace

RegionPart RegionPart::within(const geometry::Box& box) const {
  RegionPart part(*region_);
  part.is_whole_ = false;
  const auto take = [&](std::size_t i) {
    if (may_meet(region_->edges_[i], box)) part.edges_.push_back(static_cast<std::uint32_t>(i));
  };
  if (is_whole_) {
    region_->tree_.visit(box, take);
  } else {
    std::ranges::for_each(edges_, take);
  }
  for (const double fraction : {0.5, 0.37, 0.71, 0.13}) {
    part.known_ = box.min() + fraction * box.sizes();
    if (part.is_on_edge(part.known_)) continue;
    part.is_inside_ = contains(part.known_);
    return part;
  }
  return *this;
}

bool RegionPart::is_on_edge(const Vector2d& point) const {
  return std::any_of(edges_.begin(), edges_.end(), [&](std::uint32_t i) {
    const RegionEdge& edge = region_->edges_[i];
    return geometry::crossing(edge.from, edge.to, point) == geometry::RayCrossing::on_edge;
  });
}

bool RegionPart::contains(const Vector2d& point) const {
  if (is_whole_) return region_->contains(point);
  if (is_on_edge(point)) return true;
  bool inside = is_inside_;
  for (const std::uint32_t i : edges_) {
    if (crosses(known_, point, region_->edges_[i])) inside = !inside;
  }
  return inside;
}

bool RegionPart::touches(const Vector2d& from, const Vector2d& to) const {
  if (is_whole_) return region_->touches(from, to);
  return contains(from) || std::any_of(edges_.begin(), edges_.end(), [&](std::uint32_t i) {
           return region_->edges_[i].meeting(from, to).has_value();
         });
}

Region::Side RegionPart::side_of_disc(const Vector2d& centre, double radius_m) const {
  if (is_whole_) return region_->side_of_disc(centre, radius_m);
  const bool met = std::any_of(edges_.begin(), edges_.end(), [&](std::uint32_t i) {
    return region_->edges_[i].distance_m(centre) <= radius_m;
  });
  if (met) return Region::Side::border;
  return contains(centre) ? Region::Side::inside : Region::Side::outside;
}

bool RegionPart::is_simple() const {
  constexpr std::size_t kFew = 8;
  return !is_whole_ && edges_.size() <= kFew;
}

Region::Side RegionDescent::side_of_disc(const Vector2d& centre, double radius_m) {
  const Vector2d reach = Vector2d::Constant(radius_m);
  const geometry::Box around(centre - reach, centre + reach);
  while (!levels_.empty() && !levels_.back().box.contains(around)) levels_.pop_back();
  const RegionPart& above = levels_.empty() ? whole_ : levels_.back().part;
  if (above.is_simple()) return above.side_of_disc(centre, radius_m);
  levels_.push_back({around, above.within(around)});
  return levels_.back().part.side_of_disc(centre, radius_m);
}

std::vector<bool> contains_each(const Region& region, std::span<const Vector2d> points) {
  std::vector<bool> inside(points.size());
  if (!points.empty()) {
    find_inside(RegionPart(region).within(geometry::box_around(points)), points, 0, inside);
  }
  return inside;
}

}  // namespace roadbed::map::edit::clipping
