#include "roadbed/geometry/polygons/exact.h"

#include <CGAL/Arr_curve_data_traits_2.h>
#include <CGAL/Arr_extended_dcel.h>
#include <CGAL/Arr_observer.h>
#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2_algorithms.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>

namespace roadbed::geometry::inline polygons::exact {
namespace {

using Eigen::Vector2d;
using Predicates = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;

// Every edge of the arrangement knows by how much the winding number grows from its lower to its
// upper side: +1 per ring edge that runs from left to right, −1 per one from right to left.
using SegmentTraits = CGAL::Arr_segment_traits_2<Exact>;
using Traits = CGAL::Arr_curve_data_traits_2<SegmentTraits, int, std::plus<int>>;

struct FaceState {
  bool reached = false;
  int winding = 0;
  int part = -1;  ///< connected part of the region that the face belongs to
};
struct HalfedgeState {
  bool traced = false;
};
struct VertexState {};
using Dcel = CGAL::Arr_extended_dcel<Traits, VertexState, HalfedgeState, FaceState>;
using Arrangement = CGAL::Arrangement_2<Traits, Dcel>;
using Face = Arrangement::Face_handle;
using Halfedge = Arrangement::Halfedge_handle;

Predicates::Point_2 to_predicates(const Vector2d& point) { return {point.x(), point.y()}; }
Exact::Point_2 to_exact(const Vector2d& point) { return {point.x(), point.y()}; }

/// An edge from its left end to its right one.
struct Edge {
  Vector2d left, right;
  int change;  ///< of the winding number, upwards
};

std::vector<Edge> edges_of(const std::vector<Ring>& rings) {
  std::vector<Edge> edges;
  for (const Ring& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vector2d &from = ring[i], &to = ring[(i + 1) % ring.size()];
      const bool is_forward = std::pair(from.x(), from.y()) < std::pair(to.x(), to.y());
      edges.push_back(is_forward ? Edge{from, to, 1} : Edge{to, from, -1});
    }
  }
  return edges;
}

/// Edges that are the same become one, whose change is the sum. What lanes beside each other share
/// is gone then: the winding number is as large on either side of it.
std::vector<Edge> summed(std::vector<Edge> edges) {
  const auto ends = [](const Edge& edge) {
    return std::tuple(edge.left.x(), edge.left.y(), edge.right.x(), edge.right.y());
  };
  std::ranges::sort(edges, {}, ends);
  std::vector<Edge> sums;
  for (const Edge& edge : edges) {
    if (!sums.empty() && ends(sums.back()) == ends(edge)) {
      sums.back().change += edge.change;
    } else {
      sums.push_back(edge);
    }
  }
  std::erase_if(sums, [](const Edge& edge) { return edge.change == 0; });
  return sums;
}

constexpr int kLastEdge = std::numeric_limits<int>::max();  // in place of a change

/// An edge beyond all others, which a sweep comes to last.
Edge last_edge(const std::vector<Edge>& edges) {
  double most_x_m = 0.0;
  for (const Edge& edge : edges) most_x_m = std::max(most_x_m, edge.right.x());
  const double x_m = std::nextafter(most_x_m, std::numeric_limits<double>::max());
  return {{x_m, 0.0}, {x_m, 1.0}, kLastEdge};
}

/// Where a sweep joins components, halfedges of the older one come to the newer one by one link
/// more. At its end CGAL walks these links from each halfedge, the oldest first, in a time that is
/// quadratic in the steps of a border; the newest first, no walk has more than two, as each
/// shortens the next. (An observer of Arrangement_2 would be cast to one of its base, which it is
/// not, and compilers leave its calls out.)
class LinkShortener : public CGAL::Arr_observer<Arrangement::Base> {
 public:
  using CGAL::Arr_observer<Arrangement::Base>::Arr_observer;

  void after_create_edge(Halfedge edge) override {
    if (edge->curve().data() != kLastEdge) return;
    for (auto it = arrangement()->halfedges_end(); it != arrangement()->halfedges_begin();) {
      (--it)->face();
    }
  }
};

/// By how much the winding number grows from the right of a halfedge to its left.
int winding_change(Halfedge halfedge) {
  const int upwards = halfedge->curve().data();
  return halfedge->direction() == CGAL::ARR_LEFT_TO_RIGHT ? upwards : -upwards;
}

template <typename Visit>
void for_each_halfedge(Face face, const Visit& visit) {
  const auto walk = [&](Arrangement::Ccb_halfedge_circulator first) {
    auto current = first;
    do visit(Halfedge(current));
    while (++current != first);
  };
  for (auto ccb = face->outer_ccbs_begin(); ccb != face->outer_ccbs_end(); ++ccb) walk(*ccb);
  for (auto ccb = face->inner_ccbs_begin(); ccb != face->inner_ccbs_end(); ++ccb) walk(*ccb);
}

void number_windings(Arrangement& arrangement) {
  std::vector<Face> open{arrangement.unbounded_face()};
  open.front()->data().reached = true;
  while (!open.empty()) {
    const Face face = open.back();
    open.pop_back();
    for_each_halfedge(face, [&](Halfedge halfedge) {
      const Face other = halfedge->twin()->face();
      if (other->data().reached) return;
      other->data().reached = true;
      other->data().winding = face->data().winding - winding_change(halfedge);
      open.push_back(other);
    });
  }
}

bool is_inside(Face face) { return face->data().winding != 0; }

bool is_boundary(Halfedge halfedge) {
  return is_inside(halfedge->face()) && !is_inside(halfedge->twin()->face());
}

/// Numbers the part of the region around `start`: faces that meet along edges.
void number_part(Face start, int part) {
  std::vector<Face> open{start};
  start->data().part = part;
  while (!open.empty()) {
    const Face face = open.back();
    open.pop_back();
    for_each_halfedge(face, [&](Halfedge halfedge) {
      const Face other = halfedge->twin()->face();
      if (!is_inside(other) || other->data().part >= 0) return;
      other->data().part = part;
      open.push_back(other);
    });
  }
}

int number_parts(Arrangement& arrangement) {
  int parts = 0;
  for (auto face = arrangement.faces_begin(); face != arrangement.faces_end(); ++face) {
    if (is_inside(face) && face->data().part < 0) number_part(face, parts++);
  }
  return parts;
}

Vector2d rounded(const Exact::Point_2& point) {
  return {CGAL::to_double(point.x()), CGAL::to_double(point.y())};
}

/// The region's boundary from a boundary halfedge on, region to the left.
Ring trace(Halfedge first) {
  Ring ring;
  Halfedge current = first;
  do {
    current->data().traced = true;
    ring.push_back(rounded(current->target()->point()));
    current = current->next();
    while (!is_boundary(current)) current = current->twin()->next();
  } while (current != first);
  return ring;
}

}  // namespace

int turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return static_cast<int>(CGAL::orientation(to_predicates(a), to_predicates(b), to_predicates(c)));
}

bool has_simple_edges(const Ring& ring) {
  std::vector<Predicates::Point_2> points;
  points.reserve(ring.size());
  for (const Vector2d& point : ring) points.push_back(to_predicates(point));
  return CGAL::is_simple_2(points.begin(), points.end(), Predicates());
}

std::vector<Boundaries> wound_region(const std::vector<Ring>& rings) {
  std::vector<Edge> swept = summed(edges_of(rings));
  swept.push_back(last_edge(swept));
  std::vector<Traits::X_monotone_curve_2> edges;
  for (const Edge& edge : swept) {
    edges.emplace_back(SegmentTraits::X_monotone_curve_2(to_exact(edge.left), to_exact(edge.right)),
                       edge.change);
  }
  Arrangement arrangement;
  const LinkShortener shortener(arrangement);
  CGAL::insert(arrangement, edges.begin(), edges.end());
  number_windings(arrangement);
  std::vector<Boundaries> parts(static_cast<std::size_t>(number_parts(arrangement)));
  for (auto it = arrangement.halfedges_begin(); it != arrangement.halfedges_end(); ++it) {
    if (it->data().traced || !is_boundary(it)) continue;
    parts[static_cast<std::size_t>(it->face()->data().part)].push_back(trace(it));
  }
  return parts;
}

}  // namespace roadbed::geometry::polygons::exact
