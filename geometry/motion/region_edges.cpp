#include "roadbed/geometry/motion/region_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "roadbed/geometry/index/hilbert.h"
#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/geometry/primitives/cross.h"

namespace roadbed::geometry::inline motion {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kChildren = 8, kDeepest = 12;  // of a packed tree of 32-bit numbers

/// Nearest points of a rectangle, in its own frame, and a segment.
struct Approach {
  double squared_m2;
  Vector2d on_shape, on_edge;
};

Vector2d clamped(const Vector2d& point, const Vector2d& half) {
  return point.cwiseMax(-half).cwiseMin(half);
}

Vector2d nearest_on(const Vector2d& from, const Vector2d& to, const Vector2d& point) {
  const Vector2d along = to - from;
  const double length_m2 = along.squaredNorm();
  const double fraction = length_m2 > 0.0 ? (point - from).dot(along) / length_m2 : 0.0;
  if (fraction >= 1.0) return to;
  return fraction > 0.0 ? Vector2d(from + fraction * along) : from;
}

/// Where a segment first is in the box of half sides `half` around the origin [Liang and Barsky
/// 1984, doi:10.1145/357332.357333].
std::optional<Vector2d> first_inside(const Vector2d& from, const Vector2d& to,
                                     const Vector2d& half) {
  const Vector2d along = to - from;
  double enters = 0.0, leaves = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    if (along[axis] == 0.0) {
      if (std::abs(from[axis]) > half[axis]) return std::nullopt;
      continue;
    }
    const double a = (-half[axis] - from[axis]) / along[axis];
    const double b = (half[axis] - from[axis]) / along[axis];
    enters = std::max(enters, std::min(a, b));
    leaves = std::min(leaves, std::max(a, b));
  }
  if (enters > leaves) return std::nullopt;
  return from + enters * along;
}

Approach approach(const Vector2d& from, const Vector2d& to, const Vector2d& half) {
  if (const auto inside = first_inside(from, to, half)) return {0.0, *inside, *inside};
  Approach best{(from - clamped(from, half)).squaredNorm(), clamped(from, half), from};
  const auto take = [&](const Vector2d& on_shape, const Vector2d& on_edge) {
    const double squared_m2 = (on_edge - on_shape).squaredNorm();
    if (squared_m2 < best.squared_m2) best = {squared_m2, on_shape, on_edge};
  };
  take(clamped(to, half), to);
  for (const Vector2d& sign :
       {Vector2d(1, 1), Vector2d(1, -1), Vector2d(-1, 1), Vector2d(-1, -1)}) {
    const Vector2d corner = sign.cwiseProduct(half);
    take(corner, nearest_on(from, to, corner));
  }
  return best;
}

}  // namespace

RegionEdges::RegionEdges(const std::vector<Polygon>& polygons) {
  for (const Polygon& polygon : polygons) {
    add(polygon.outer);
    for (const Ring& hole : polygon.holes) add(hole);
  }
  if (edges_.empty()) return;
  const auto box_of = [&](const Edge& edge) {
    return Box(edge.from.cwiseMin(edge.to), edge.from.cwiseMax(edge.to));
  };
  for (const Edge& edge : edges_) extent_.extend(box_of(edge));
  std::vector<std::uint32_t> keys;
  for (const Edge& edge : edges_) keys.push_back(hilbert_key(extent_, box_of(edge).center()));
  order_ = order_of_keys(keys);
  std::vector<Box> leaves;
  for (const std::uint32_t index : order_) leaves.push_back(box_of(edges_[index]));
  levels_ = packed_levels(std::move(leaves), kChildren);
  mark_shared_points();
}

/// Visits edges whose boxes have a bound less than `most_m2`, which is then what the visit returns,
/// about the least bound first.
template <typename Bound, typename Visit>
void RegionEdges::descend(double most_m2, const Bound& bound_m2, const Visit& visit) const {
  struct Open {
    double bound_m2;
    std::uint32_t level, index;
  };
  if (levels_.empty()) return;
  std::array<Open, kDeepest * kChildren> stack;
  std::size_t open = 1;
  stack[0] = {0.0, static_cast<std::uint32_t>(levels_.size() - 1), 0};
  while (open > 0) {
    const Open next = stack[--open];
    if (next.bound_m2 >= most_m2) continue;
    if (next.level == 0) {
      most_m2 = visit(order_[next.index]);
      continue;
    }
    const std::vector<Box>& children = levels_[next.level - 1];
    const std::size_t first = open, from = next.index * kChildren;
    for (std::size_t i = from; i < std::min(children.size(), from + kChildren); ++i) {
      const double child_m2 = bound_m2(children[i]);
      if (child_m2 >= most_m2) continue;
      std::size_t at = open++;
      for (; at > first && stack[at - 1].bound_m2 < child_m2; --at) stack[at] = stack[at - 1];
      stack[at] = {child_m2, next.level - 1, static_cast<std::uint32_t>(i)};
    }
  }
}

void RegionEdges::add(const Ring& ring) {
  const std::size_t first = edges_.size(), count = ring.size();
  for (std::size_t i = 0; i < count; ++i) {
    edges_.push_back({ring[i], ring[(i + 1) % count],
                      static_cast<std::uint32_t>(first + (i + count - 1) % count),
                      static_cast<std::uint32_t>(first + (i + 1) % count)});
  }
}

void RegionEdges::mark_shared_points() {
  is_shared_.assign(edges_.size(), 0);
  std::vector<std::uint32_t> order(edges_.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto key = [this](std::uint32_t i) {
    return std::pair(edges_[i].from.x(), edges_[i].from.y());
  };
  std::ranges::sort(order, {}, key);
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (key(order[i]) != key(order[i - 1])) continue;
    is_shared_[order[i]] = is_shared_[order[i - 1]] = 1;
  }
}

/// Counts the edges to the right of the point: outer rings and holes alike, since a point of the
/// region is within one more outer ring than holes.
bool RegionEdges::contains(const Vector2d& point) const {
  if (extent_.isEmpty() || !extent_.contains(point)) return false;
  bool inside = false, on_edge = false;
  const Vector2d right_end(extent_.max().x(), point.y());
  const Box ray(point, right_end);
  constexpr double never = std::numeric_limits<double>::infinity();
  const auto bound = [&](const Box& box) { return box.intersects(ray) ? 0.0 : never; };
  descend(never, bound, [&](std::size_t index) {
    switch (crossing(edges_[index].from, edges_[index].to, point)) {
      case RayCrossing::on_edge:
        on_edge = true;
        break;
      case RayCrossing::crosses:
        inside = !inside;
        break;
      case RayCrossing::misses:
        break;
    }
    return never;
  });
  return inside || on_edge;
}

/// The region is to the left of its edges. Of two edges at a corner the one counts that the point
/// is farther beside: the other one may seem to pass on the wrong side of it.
bool RegionEdges::is_left_of(std::size_t edge, const Vector2d& point,
                             const Vector2d& on_edge) const {
  const auto beside_m = [&](std::size_t of) {
    const Vector2d along = edges_[of].to - edges_[of].from;
    return cross(along, point - on_edge) / along.norm();
  };
  const bool is_start = on_edge == edges_[edge].from, is_end = on_edge == edges_[edge].to;
  const double own_m = beside_m(edge);
  if (!is_start && !is_end) return own_m > 0.0;
  if (is_shared_[is_start ? edge : edges_[edge].next] != 0) return contains(point);
  const double other_m = beside_m(is_start ? edges_[edge].previous : edges_[edge].next);
  return (std::abs(own_m) >= std::abs(other_m) ? own_m : other_m) > 0.0;
}

std::optional<RegionEdges::Nearest> RegionEdges::nearest(const Rectangle& shape,
                                                         double within_m) const {
  const Vector2d half(shape.half_length_m, shape.half_width_m);
  const Vector2d ahead = shape.axis, left(-ahead.y(), ahead.x());
  const auto local = [&](const Vector2d& point) {
    const Vector2d offset = point - shape.centre;
    return Vector2d(offset.dot(ahead), offset.dot(left));
  };
  // From the rectangle to the one that holds a box, turned as it is.
  const Vector2d slant = ahead.cwiseAbs();
  const auto bound_m2 = [&](const Box& box) {
    const Vector2d extent = 0.5 * box.sizes();
    const Vector2d around(extent.dot(slant), extent.dot(slant.reverse()));
    return (local(box.center()).cwiseAbs() - half - around).cwiseMax(0.0).squaredNorm();
  };
  double least_m2 = within_m * within_m;
  Approach best{};
  std::size_t found = edges_.size();
  descend(least_m2, bound_m2, [&](std::size_t index) {
    const Vector2d from = local(edges_[index].from), to = local(edges_[index].to);
    // All of it is beyond one side of the rectangle, farther than the nearest so far.
    const Vector2d beyond = from.cwiseMin(to).cwiseMax(-from.cwiseMax(to)) - half;
    const double beyond_m = beyond.maxCoeff();
    if (beyond_m > 0.0 && beyond_m * beyond_m >= least_m2) return least_m2;
    const Approach at = approach(from, to, half);
    if (at.squared_m2 < least_m2) {
      least_m2 = at.squared_m2;
      best = at;
      found = index;
    }
    return least_m2;
  });
  if (found == edges_.size()) return std::nullopt;
  const auto in_plane = [&](const Vector2d& point) -> Vector2d {
    return shape.centre + point.x() * ahead + point.y() * left;
  };
  Nearest nearest{.distance_m = std::sqrt(best.squared_m2),
                  .on_edge = in_plane(best.on_edge),
                  .on_shape = in_plane(best.on_shape)};
  if (nearest.distance_m == 0.0) return nearest;
  const Edge& edge = edges_[found];
  // A corner is told by its own coordinates, not by those that went there and back.
  for (const Vector2d& corner : {edge.from, edge.to}) {
    if (best.on_edge == local(corner)) nearest.on_edge = corner;
  }
  nearest.is_inside = is_left_of(found, nearest.on_shape, nearest.on_edge);
  return nearest;
}

}  // namespace roadbed::geometry::motion
