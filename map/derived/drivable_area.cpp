#include "roadbed/map/derived/drivable_area.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadbed/geometry/primitives/polyline.h"

namespace roadbed::map::inline derived {
namespace {

using Eigen::Vector2d;

constexpr double kFar_m = std::numeric_limits<double>::infinity();

double distance_to_m(const Vector2d& from, const Vector2d& to, const Vector2d& point) {
  const Vector2d along = to - from;
  const double fraction = std::clamp((point - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (point - from - fraction * along).norm();
}

}  // namespace

DrivableArea::DrivableArea(const RoadMap& road_map, const SurfaceOptions& options)
    : DrivableArea(drivable_surface(road_map, options)) {}

DrivableArea::DrivableArea(std::vector<geometry::Polygon> polygons)
    : polygons_(std::move(polygons)) {
  for (const geometry::Polygon& polygon : polygons_) {
    add_edges(polygon.outer);
    for (const geometry::Ring& hole : polygon.holes) add_edges(hole);
  }
  std::vector<geometry::Box> boxes;
  boxes.reserve(edges_.size());
  for (const Edge& edge : edges_) {
    boxes.emplace_back(edge.from.cwiseMin(edge.to), edge.from.cwiseMax(edge.to));
    extent_.extend(boxes.back());
  }
  tree_ = geometry::BoxTree(boxes);
}

void DrivableArea::add_edges(const geometry::Ring& ring) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    edges_.push_back({ring[i], ring[(i + 1) % ring.size()]});
  }
}

/// Counts the edges to the right of the point: outer rings and holes alike, since a point of the
/// surface is within one more outer ring than holes.
bool DrivableArea::contains(const Vector2d& point_in_map) const {
  if (extent_.isEmpty() || !extent_.contains(point_in_map)) return false;
  bool inside = false, on_edge = false;
  const Vector2d right_end(extent_.max().x(), point_in_map.y());
  tree_.visit(geometry::Box(point_in_map, right_end), [&](std::size_t index) {
    switch (geometry::crossing(edges_[index].from, edges_[index].to, point_in_map)) {
      case geometry::RayCrossing::on_edge:
        on_edge = true;
        break;
      case geometry::RayCrossing::crosses:
        inside = !inside;
        break;
      case geometry::RayCrossing::misses:
        break;
    }
  });
  return inside || on_edge;
}

double DrivableArea::signed_distance_m(const Vector2d& point_in_map) const {
  const auto distance_m = [&](std::size_t index) {
    return distance_to_m(edges_[index].from, edges_[index].to, point_in_map);
  };
  const std::size_t nearest = tree_.nearest(point_in_map, kFar_m, distance_m);
  if (nearest == edges_.size()) return -kFar_m;
  return contains(point_in_map) ? distance_m(nearest) : -distance_m(nearest);
}

}  // namespace roadbed::map::derived
