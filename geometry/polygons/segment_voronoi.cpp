#include "roadbed/geometry/polygons/medial_axis.h"

#include <CGAL/Segment_Delaunay_graph_2.h>
#include <CGAL/Segment_Delaunay_graph_filtered_traits_2.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace roadbed::geometry::inline polygons {
namespace {

using Eigen::Vector2d;
using Kernel = CGAL::Simple_cartesian<double>;
using VoronoiTraits = CGAL::Segment_Delaunay_graph_filtered_traits_2<Kernel>;
using Graph = CGAL::Segment_Delaunay_graph_2<VoronoiTraits>;
using Site = Graph::Site_2;

Kernel::Point_2 to_cgal(const Vector2d& point) { return {point.x(), point.y()}; }
Vector2d from_cgal(const Kernel::Point_2& point) { return {point.x(), point.y()}; }

double distance_m(const Site& site, const Vector2d& point) {
  if (site.is_point()) return (point - from_cgal(site.point())).norm();
  const Vector2d a = from_cgal(site.source()), b = from_cgal(site.target());
  const double fraction = std::clamp((point - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (point - a - fraction * (b - a)).norm();
}

bool ends_at(const Site& segment, const Site& point) {
  return segment.source() == point.point() || segment.target() == point.point();
}

/// Whether two sites are an edge and its own end: what lies between them is no axis.
bool touch(const Site& a, const Site& b) {
  if (a.is_point() == b.is_point()) return false;
  return a.is_point() ? ends_at(b, a) : ends_at(a, b);
}

std::optional<VoronoiGraph::Edge::Parabola> parabola(const Site& a, const Site& b) {
  if (a.is_point() == b.is_point()) return {};
  const Site& corner = a.is_point() ? a : b;
  const Site& edge = a.is_point() ? b : a;
  return VoronoiGraph::Edge::Parabola{from_cgal(corner.point()), from_cgal(edge.source()),
                                      from_cgal(edge.target())};
}

/// Whether a place is inside, seen from one of its nearest sites: rings keep the inside to their
/// left, and what is nearest to an edge lies beside it.
bool is_inside(Graph::Face_handle face, const Vector2d& at, const Polygon& polygon) {
  for (int i = 0; i < 3; ++i) {
    const Site site = face->vertex(i)->site();
    if (site.is_point()) continue;
    const Vector2d a = from_cgal(site.source()), along = from_cgal(site.target()) - a;
    return along.x() * (at - a).y() - along.y() * (at - a).x() > 0.0;
  }
  return contains(polygon, at);  // between corners only: rare
}

void add_ring(const Ring& ring, std::vector<Kernel::Point_2>& points,
              std::vector<std::pair<std::size_t, std::size_t>>& edges) {
  const std::size_t first = points.size();
  for (const Vector2d& point : ring) points.push_back(to_cgal(point));
  for (std::size_t i = first; i < points.size(); ++i) {
    edges.emplace_back(i, i + 1 < points.size() ? i + 1 : first);
  }
}

Graph graph_of(const Polygon& polygon) {
  std::vector<Kernel::Point_2> points;
  std::vector<std::pair<std::size_t, std::size_t>> edges;
  add_ring(polygon.outer, points, edges);
  for (const Ring& hole : polygon.holes) add_ring(hole, points, edges);
  Graph graph;
  graph.insert_segments(points.begin(), points.end(), edges.begin(), edges.end());
  return graph;
}

// CGAL tells faces and edges in an order that hangs on where they lie in memory, and a ring without
// a fork begins at the first: nodes by place, edges by nodes.
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

}  // namespace

VoronoiGraph interior_voronoi(const Polygon& polygon) {
  const Graph graph = graph_of(polygon);
  VoronoiGraph found;
  std::map<Graph::Face_handle, std::size_t> index;
  for (auto face = graph.finite_faces_begin(); face != graph.finite_faces_end(); ++face) {
    const Vector2d at = from_cgal(graph.primal(face));
    double clearance_m = distance_m(face->vertex(0)->site(), at);
    for (const int i : {1, 2}) {  // equal but for rounding
      clearance_m = std::min(clearance_m, distance_m(face->vertex(i)->site(), at));
    }
    constexpr double corner_m = 1e-9;  // nearer to the boundary than that: a corner of it
    if (clearance_m < corner_m || !is_inside(face, at, polygon)) continue;
    index.emplace(face, found.nodes.size());
    found.nodes.push_back({at, clearance_m});
  }
  for (auto edge = graph.finite_edges_begin(); edge != graph.finite_edges_end(); ++edge) {
    const Graph::Face_handle face = edge->first;
    const auto from = index.find(face), to = index.find(face->neighbor(edge->second));
    if (from == index.end() || to == index.end()) continue;
    const Site a = face->vertex(Graph::cw(edge->second))->site();
    const Site b = face->vertex(Graph::ccw(edge->second))->site();
    if (touch(a, b)) continue;
    found.edges.push_back({from->second, to->second, parabola(a, b)});
  }
  return in_order(std::move(found));
}

}  // namespace roadbed::geometry::polygons
