#include "roadbed/map/edit/clipping/region.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/geometry/primitives/cross.h"
#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/geometry/primitives/segment.h"

namespace roadbed::map::inline edit::inline clipping {
namespace {

using Eigen::Vector2d;

std::vector<geometry::Ring> rings_of(const std::vector<geometry::Polygon>& polygons) {
  std::vector<geometry::Ring> rings;
  for (const geometry::Polygon& polygon : polygons) {
    rings.push_back(polygon.outer);
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  }
  return rings;
}

geometry::Box box_of(const Vector2d& from, const Vector2d& to) {
  return {from.cwiseMin(to), from.cwiseMax(to)};
}

// A segment with round ends, counter-clockwise.
geometry::Polygon capsule(const Vector2d& from, const Vector2d& to, double distance_m) {
  constexpr int corners = 36;  // of each half circle: chords around it stay within 0.1 %
  const double step = std::numbers::pi / corners;
  const double radius_m = distance_m / std::cos(0.5 * step);
  const Vector2d along = to - from;
  const double heading = std::atan2(along.y(), along.x());
  geometry::Polygon polygon;
  for (int i = 0; i < 2 * corners; ++i) {
    const double angle = heading - 0.5 * std::numbers::pi + (i + 0.5) * step;
    const Vector2d out(std::cos(angle), std::sin(angle));
    polygon.outer.emplace_back((i < corners ? to : from) + radius_m * out);
  }
  return polygon;
}

}  // namespace

double RegionEdge::distance_m(const Vector2d& point) const {
  return geometry::distance_to_segment_m(point, from, to);
}

std::optional<double> RegionEdge::meeting(const Vector2d& segment_from,
                                          const Vector2d& segment_to) const {
  const Vector2d along = segment_to - segment_from, edge = to - from, between = from - segment_from;
  const double turn = geometry::cross(along, edge);
  if (turn == 0.0) return {};
  const double at = geometry::cross(between, edge) / turn;
  const double on_edge = geometry::cross(between, along) / turn;
  if (!(at >= 0.0 && at <= 1.0 && on_edge >= 0.0 && on_edge <= 1.0)) return {};
  return at;
}

Region::Region(const std::vector<geometry::Polygon>& polygons) : Region(rings_of(polygons)) {}

Region::Region(std::vector<geometry::Ring> rings) {
  std::vector<geometry::Box> boxes;
  for (const geometry::Ring& ring : rings) {
    if (ring.size() < 3) throw std::invalid_argument("Region: a ring has at least three points");
    corners_.push_back(ring.front());
    for (std::size_t i = 0; i < ring.size(); ++i) {
      edges_.push_back({ring[i], ring[(i + 1) % ring.size()]});
      boxes.push_back(box_of(edges_.back().from, edges_.back().to));
      bounds_.extend(boxes.back());
    }
  }
  if (edges_.empty()) throw std::invalid_argument("Region: no ring");
  tree_ = geometry::BoxTree(boxes);
}

bool Region::contains(const Vector2d& point) const {
  if (!bounds_.contains(point)) return false;
  bool on_edge = false, inside = false;
  tree_.visit(geometry::Box(point, Vector2d(bounds_.max().x(), point.y())), [&](std::size_t i) {
    const auto crossing = geometry::crossing(edges_[i].from, edges_[i].to, point);
    on_edge = on_edge || crossing == geometry::RayCrossing::on_edge;
    inside = inside != (crossing == geometry::RayCrossing::crosses);
  });
  return on_edge || inside;
}

bool Region::touches(const Vector2d& from, const Vector2d& to) const {
  return contains(from) || !crossings(from, to).empty();
}

std::vector<double> Region::crossings(const Vector2d& from, const Vector2d& to) const {
  std::vector<double> found;
  tree_.visit(box_of(from, to), [&](std::size_t i) {
    if (const auto at = edges_[i].meeting(from, to)) found.push_back(*at);
  });
  std::sort(found.begin(), found.end());
  return found;
}

Region::Side Region::side_of_disc(const Vector2d& centre, double radius_m) const {
  const Vector2d reach = Vector2d::Constant(radius_m);
  bool met = false;
  tree_.visit(geometry::Box(centre - reach, centre + reach),
              [&](std::size_t i) { met = met || edges_[i].distance_m(centre) <= radius_m; });
  if (met) return Side::border;
  return contains(centre) ? Side::inside : Side::outside;
}

Region region_around(const std::vector<Vector2d>& line, double distance_m) {
  if (line.empty() || !(distance_m > 0.0) || !std::isfinite(distance_m)) {
    throw std::invalid_argument("region_around: a line, and a positive distance");
  }
  const std::vector<Vector2d> corners =
      line.size() > 2 ? geometry::simplify(line, 1e-3 * distance_m) : line;
  std::vector<geometry::Polygon> parts;
  for (std::size_t i = 0; i + 1 < std::max<std::size_t>(corners.size(), 2); ++i) {
    parts.push_back(capsule(corners[i], corners[std::min(i + 1, corners.size() - 1)], distance_m));
  }
  return Region(geometry::unite(parts, 0.0));
}

}  // namespace roadbed::map::edit::clipping
