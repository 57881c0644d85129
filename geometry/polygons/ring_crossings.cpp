#include "roadbed/geometry/polygons/ring_crossings.h"

#include <algorithm>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/geometry/primitives/cross.h"
#include "roadbed/geometry/primitives/work_limit.h"

namespace roadbed::geometry::inline polygons {
namespace {

using Eigen::Vector2d;

/// An edge of one of several rings.
struct RingEdge {
  std::size_t ring;
  Vector2d from, to;
};

std::vector<RingEdge> edges_of_rings(const std::vector<Ring>& rings) {
  std::vector<RingEdge> edges;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    for (std::size_t i = 0; i < rings[r].size(); ++i) {
      edges.push_back({r, rings[r][i], rings[r][(i + 1) % rings[r].size()]});
    }
  }
  return edges;
}

bool are_beside(const RingEdge& edge, const Vector2d& a, const Vector2d& b) {
  const Vector2d along = edge.to - edge.from;
  return cross(along, a - edge.from) * cross(along, b - edge.from) > 0.0;
}

/// Whether two edges cross, or touch otherwise than by a common end.
bool meet(const RingEdge& a, const RingEdge& b) {
  if (a.from == b.from || a.from == b.to || a.to == b.from || a.to == b.to) return false;
  return !are_beside(a, b.from, b.to) && !are_beside(b, a.from, a.to);
}

/// Some edges of a ring in a row.
struct EdgeRun {
  std::size_t ring, edges;
};

/// Whether runs of edges meet others so seldom that these cannot cross often: an eighth of the work
/// of looking at each edge.
bool meet_seldom(const std::vector<Ring>& rings) {
  constexpr std::size_t kRun = 8, kSeldom = 50'000, kSeldomEach = 64;
  std::size_t edges = 0;
  std::vector<EdgeRun> runs;
  std::vector<Box> boxes;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const Ring& ring = rings[r];
    edges += ring.size();
    for (std::size_t from = 0; from < ring.size(); from += kRun) {
      const std::size_t to = std::min(from + kRun, ring.size());
      runs.push_back({r, to - from});
      boxes.emplace_back(ring[to % ring.size()]);
      for (std::size_t i = from; i < to; ++i) boxes.back().extend(ring[i]);
    }
  }
  WorkBudget pairs(kSeldom + kSeldomEach * edges);
  const BoxTree tree(boxes);
  for (std::size_t i = 0; i < runs.size() && !pairs.is_spent(); ++i) {
    tree.visit(boxes[i], [&](std::size_t k) {
      if (k > i && runs[k].ring != runs[i].ring) pairs.spend(runs[i].edges * runs[k].edges);
    });
  }
  return !pairs.is_spent();
}

}  // namespace

bool have_few_crossings(const std::vector<Ring>& rings) {
  if (meet_seldom(rings)) return true;
  const std::vector<RingEdge> edges = edges_of_rings(rings);
  std::vector<Box> boxes;
  for (const RingEdge& edge : edges) boxes.push_back(Box(edge.from).extend(edge.to));
  const BoxTree tree(boxes);
  constexpr std::size_t kFew = 50'000 / kLimitDivisor, kFewEach = 16;
  WorkBudget crossings(kFew + kFewEach * edges.size()), tests(most_steps(edges.size()));
  for (std::size_t i = 0; i < edges.size() && !tests.is_spent() && !crossings.is_spent(); ++i) {
    tree.visit(boxes[i], [&](std::size_t k) {
      if (k <= i || edges[k].ring == edges[i].ring || !tests.spend(1)) return;
      if (meet(edges[i], edges[k])) crossings.spend(1);
    });
  }
  return !tests.is_spent() && !crossings.is_spent();
}

}  // namespace roadbed::geometry::polygons
