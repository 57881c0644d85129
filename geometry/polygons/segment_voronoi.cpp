#include <boost/polygon/voronoi.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/geometry/polygons/exact.h"
#include "roadbed/geometry/polygons/medial_axis.h"
#include "roadbed/geometry/primitives/work_limit.h"

namespace roadbed::geometry::inline polygons {
namespace {

using Eigen::Vector2d;
using Diagram = boost::polygon::voronoi_diagram<double>;
using Cell = Diagram::cell_type;

/// Where a polygon's points lie on the grid of whole numbers that Boost.Polygon works on: exactly,
/// where CGAL's segment Delaunay graph takes 4 ms a point of a circle, whose bisectors all meet.
class Grid {
 public:
  /// @param steps  from the middle of the box to its farthest side, at most 2³⁰.
  Grid(const Box& box, double steps) : middle_(box.center()) {
    const double half_m = 0.5 * box.sizes().maxCoeff();
    cell_m_ = std::exp2(std::ceil(std::log2(half_m / steps)));
  }

  double cell_m() const { return cell_m_; }
  Vector2d on_grid(const Vector2d& point) const {
    return ((point - middle_) / cell_m_).array().round();
  }
  Vector2d off_grid(const Vector2d& cells) const { return middle_ + cell_m_ * cells; }

 private:
  Vector2d middle_;
  double cell_m_ = 1.0;
};

struct GridEdge {
  Vector2d from, to;  ///< whole numbers
};

std::vector<GridEdge> grid_edges_of(const std::vector<Ring>& rings) {
  std::vector<GridEdge> edges;
  for (const Ring& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      edges.push_back({ring[i], ring[(i + 1) % ring.size()]});
    }
  }
  return edges;
}

/// Whether two edges share more than a common end.
bool are_in_conflict(const GridEdge& a, const GridEdge& b) {
  const int from = exact::turn(a.from, a.to, b.from), to = exact::turn(a.from, a.to, b.to);
  const bool share_end = a.from == b.from || a.from == b.to || a.to == b.from || a.to == b.to;
  if (share_end) return false;  // what lies on each other has been split, and is the same edge
  return from * to <= 0 && exact::turn(b.from, b.to, a.from) * exact::turn(b.from, b.to, a.to) <= 0;
}

bool are_apart(const std::vector<GridEdge>& edges) {
  std::vector<Box> boxes;
  for (const GridEdge& edge : edges) boxes.push_back(Box(edge.from).extend(edge.to));
  const BoxTree tree(boxes);
  bool has_conflict = false;
  for (std::size_t i = 0; i < edges.size() && !has_conflict; ++i) {
    tree.visit(boxes[i], [&](std::size_t k) {
      has_conflict = has_conflict || (k > i && are_in_conflict(edges[i], edges[k]));
    });
  }
  return !has_conflict;
}

/// The polygon's edges on a grid. Rounding can push a corner onto an edge beside it: such edges get
/// the corner as a vertex (Hobby 1999, doi:10.1016/S0925-7721(99)00021-8).
std::vector<GridEdge> edges_on_grid(const Polygon& polygon, const Grid& grid) {
  std::vector<Ring> rings{polygon.outer};
  rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  for (Ring& ring : rings) {
    for (Vector2d& point : ring) point = grid.on_grid(point);
  }
  constexpr double kPassed = 0.71;  // [cells] less than from one to the next
  return grid_edges_of(weld(std::move(rings), kPassed).rings);
}

/// Their grid, with it; coarser where they still cross on a finer one.
std::pair<Grid, std::vector<GridEdge>> simple_edges(const Polygon& polygon) {
  constexpr double kFinest = 1 << 30, kCoarsest = 1 << 16, kCoarser = 1 << 4;
  for (double steps = kFinest; steps >= kCoarsest; steps /= kCoarser) {
    const Grid grid(box_around(polygon.outer), steps);
    std::vector<GridEdge> edges = edges_on_grid(polygon, grid);
    if (are_apart(edges)) return {grid, std::move(edges)};
  }
  throw TooMuchWork("an area has so many edges next to each other that its middle is not told");
}

/// What a cell of the diagram lies around.
class Sites {
 public:
  explicit Sites(const std::vector<GridEdge>& edges) : edges_(edges) {
    for (const GridEdge& edge : edges) {
      corners_[key(edge.from)].out.push_back(&edge);
      corners_[key(edge.to)].in.push_back(&edge);
    }
  }

  const GridEdge& edge(const Cell& cell) const { return edges_[cell.source_index()]; }

  Vector2d corner(const Cell& cell) const {
    const bool is_start =
        cell.source_category() == boost::polygon::SOURCE_CATEGORY_SEGMENT_START_POINT;
    return is_start ? edge(cell).from : edge(cell).to;
  }

  double distance(const Cell& cell, const Vector2d& point) const {
    if (cell.contains_point()) return (point - corner(cell)).norm();
    const Vector2d a = edge(cell).from, along = edge(cell).to - a;
    const double fraction = std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (point - a - fraction * along).norm();
  }

  /// Whether the places that are nearest to a corner are inside: where rings, which keep the inside
  /// to their left, turn right. None where several rings meet, or go straight on.
  std::optional<bool> is_inside_around(const Cell& corner_cell) const {
    const Corner& at = corners_.at(key(corner(corner_cell)));
    if (at.in.size() != 1 || at.out.size() != 1) return std::nullopt;
    const GridEdge& out = *at.out.front();
    const int turn = exact::turn(at.in.front()->from, out.from, out.to);
    return turn == 0 ? std::nullopt : std::optional(turn < 0);
  }

 private:
  struct Corner {
    std::vector<const GridEdge*> in, out;
  };
  static std::pair<double, double> key(const Vector2d& at) { return {at.x(), at.y()}; }

  const std::vector<GridEdge>& edges_;
  std::map<std::pair<double, double>, Corner> corners_;
};

/// Calls `see` for the cells around a vertex until it returns true; whether one did.
template <typename See>
bool any_cell_around(const Diagram::vertex_type& vertex, const See& see) {
  const auto* first = vertex.incident_edge();
  const auto* edge = first;
  do {
    if (see(*edge->cell())) return true;
    edge = edge->rot_next();
  } while (edge != first);
  return false;
}

/// Whether a place is inside, seen from one of its nearest sites: rings keep the inside to their
/// left; what is nearest to an edge lies beside it, and between corners only what they turn from.
bool is_inside(const Diagram::vertex_type& vertex, const Sites& sites, const Vector2d& at,
               const std::function<bool()>& is_contained) {
  bool is_left = false;
  const auto beside_edge = [&](const Cell& cell) {
    if (!cell.contains_segment()) return false;
    const Vector2d along = sites.edge(cell).to - sites.edge(cell).from;
    const Vector2d to_place = at - sites.edge(cell).from;
    is_left = along.x() * to_place.y() - along.y() * to_place.x() > 0.0;
    return true;
  };
  if (any_cell_around(vertex, beside_edge)) return is_left;
  std::optional<bool> is_inside;
  const auto tells = [&](const Cell& cell) {
    is_inside = sites.is_inside_around(cell);
    return is_inside.has_value();
  };
  return any_cell_around(vertex, tells) ? *is_inside : is_contained();
}

// A ring without a fork begins at the first node: nodes by place, edges by nodes.
VoronoiGraph in_order(VoronoiGraph graph) {
  std::vector<std::size_t> by_place(graph.nodes.size()), rank(graph.nodes.size());
  std::iota(by_place.begin(), by_place.end(), std::size_t{0});
  std::ranges::stable_sort(by_place, {}, [&](std::size_t node) {
    return std::pair(graph.nodes[node].at.x(), graph.nodes[node].at.y());
  });
  VoronoiGraph ordered;
  for (std::size_t i = 0; i < by_place.size(); ++i) {
    rank[by_place[i]] = i;
    ordered.nodes.push_back(graph.nodes[by_place[i]]);
  }
  for (VoronoiGraph::Edge edge : graph.edges) {
    const auto [from, to] = std::minmax(rank[edge.from], rank[edge.to]);
    edge.from = from;
    edge.to = to;
    ordered.edges.push_back(edge);
  }
  std::ranges::stable_sort(ordered.edges, {}, [](const VoronoiGraph::Edge& edge) {
    return std::pair(edge.from, edge.to);
  });
  return ordered;
}

void construct(const std::vector<GridEdge>& edges, Diagram& diagram) {
  using Whole = std::int32_t;
  boost::polygon::default_voronoi_builder builder;
  for (const GridEdge& edge : edges) {
    builder.insert_segment(static_cast<Whole>(edge.from.x()), static_cast<Whole>(edge.from.y()),
                           static_cast<Whole>(edge.to.x()), static_cast<Whole>(edge.to.y()));
  }
  builder.construct(&diagram);
}

}  // namespace

VoronoiGraph interior_voronoi(const Polygon& polygon) {
  const auto [grid, edges] = simple_edges(polygon);
  Diagram diagram;
  construct(edges, diagram);
  const Sites sites(edges);
  constexpr std::size_t kOutside = ~std::size_t{0};
  std::vector<std::size_t> node_of(diagram.vertices().size(), kOutside);
  const auto index_of = [&](const Diagram::vertex_type* vertex) {
    return vertex == nullptr
               ? kOutside
               : node_of[static_cast<std::size_t>(vertex - diagram.vertices().data())];
  };
  VoronoiGraph found;
  for (std::size_t i = 0; i < diagram.vertices().size(); ++i) {
    const Diagram::vertex_type& vertex = diagram.vertices()[i];
    const Vector2d at(vertex.x(), vertex.y()), in_plane = grid.off_grid(at);
    const double clearance = sites.distance(*vertex.incident_edge()->cell(), at);
    constexpr double kCorner = 1e-3;  // [cells] nearer to the boundary than that: a corner of it
    if (clearance < kCorner) continue;
    if (!is_inside(vertex, sites, at, [&] { return contains(polygon, in_plane); })) continue;
    node_of[i] = found.nodes.size();
    found.nodes.push_back({in_plane, clearance * grid.cell_m()});
  }
  for (const Diagram::edge_type& edge : diagram.edges()) {
    if (&edge > edge.twin() || !edge.is_primary()) continue;
    const std::size_t from = index_of(edge.vertex0()), to = index_of(edge.vertex1());
    if (from == kOutside || to == kOutside) continue;
    found.edges.push_back({from, to, {}});
    if (!edge.is_curved()) continue;
    const Cell *one = edge.cell(), *other = edge.twin()->cell();
    if (one->contains_segment()) std::swap(one, other);
    found.edges.back().parabola = {grid.off_grid(sites.corner(*one)),
                                   grid.off_grid(sites.edge(*other).from),
                                   grid.off_grid(sites.edge(*other).to)};
  }
  return in_order(std::move(found));
}

}  // namespace roadbed::geometry::polygons
