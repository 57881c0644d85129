#include "roadbed/geometry/polygons/medial_axis.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

namespace roadbed::geometry::inline polygons {
namespace {

using Eigen::Vector2d;

/// Points between two nodes of a parabolic edge, ends left out, so that chords are at most
/// `max_error_m` off. In coordinates along and across the directrix, with the focus at (0, d), the
/// parabola is y = (t² + d²) / 2d: its second derivative is 1/d, a chord over h is h²/8d off.
std::vector<VoronoiGraph::Node> between(const VoronoiGraph::Node& from,
                                        const VoronoiGraph::Node& to,
                                        const VoronoiGraph::Edge::Parabola& parabola,
                                        double max_error_m) {
  const Vector2d along = (parabola.line_b - parabola.line_a).normalized();
  Vector2d across(-along.y(), along.x());
  if (across.dot(parabola.focus - parabola.line_a) < 0.0) across = -across;
  const double focal_m = across.dot(parabola.focus - parabola.line_a);
  if (!(focal_m > 0.0)) return {};
  const Vector2d foot = parabola.focus - focal_m * across;
  const double from_t = along.dot(from.at - foot), to_t = along.dot(to.at - foot);
  const double steps = std::ceil(std::abs(to_t - from_t) / std::sqrt(8.0 * focal_m * max_error_m));
  constexpr double most_steps = 1000.0;
  const int count = static_cast<int>(std::min(steps, most_steps));
  std::vector<VoronoiGraph::Node> points;
  for (int i = 1; i < count; ++i) {
    const double t = from_t + (to_t - from_t) * i / count;
    const double height_m = (t * t + focal_m * focal_m) / (2.0 * focal_m);
    points.push_back({foot + t * along + height_m * across, height_m});
  }
  return points;
}

/// A chain of edges between two forks or ends.
struct Chain {
  std::size_t first = 0, last = 0;  ///< nodes
  std::vector<std::size_t> edges;   ///< in order from first to last
  double length_m = 0.0;
};

class Pruner {
 public:
  explicit Pruner(const VoronoiGraph& graph)
      : graph_(graph),
        edges_at_(graph.nodes.size()),
        branches_at_(graph.nodes.size()),
        kept_(graph.edges.size(), true) {
    for (std::size_t i = 0; i < graph.edges.size(); ++i) {
      edges_at_[graph.edges[i].from].push_back(i);
      edges_at_[graph.edges[i].to].push_back(i);
    }
  }

  /// Takes out branches that are shorter than the area is wide at their fork, all at once, then
  /// those that are left, until there are none. A fork with no other branches keeps its own. O(N):
  /// after the first round only forks that lost something are looked at.
  void prune() {
    std::vector<std::size_t> forks;
    for (std::size_t node = 0; node < graph_.nodes.size(); ++node) {
      if (degree(node) == 1) add_branch(branch_from(node), forks);
    }
    while (!forks.empty()) {
      std::vector<std::size_t> losers;
      for (const std::size_t fork : forks) {
        if (has_lost_short_branches(fork)) losers.push_back(fork);
      }
      forks.clear();
      for (const std::size_t fork : losers) follow_on(fork, forks);
    }
  }

  /// All that is left, each edge once.
  std::vector<Chain> chains() const {
    std::vector<Chain> found;
    std::vector<bool> taken(graph_.edges.size(), false);
    for (const bool only_ends : {true, false}) {  // the second pass: rings without a fork
      for (std::size_t node = 0; node < graph_.nodes.size(); ++node) {
        if (only_ends == (degree(node) == 2)) continue;
        for (const std::size_t edge : edges_at_[node]) {
          if (!kept_[edge] || taken[edge]) continue;
          found.push_back(walk({node, node, {}, 0.0}, edge));
          for (const std::size_t used : found.back().edges) taken[used] = true;
        }
      }
    }
    return found;
  }

 private:
  /// Notes a branch at the fork where it ends, and the fork as one to look at.
  void add_branch(Chain branch, std::vector<std::size_t>& forks) {
    if (degree(branch.last) < 3) return;
    forks.push_back(branch.last);
    branches_at_[branch.last].push_back(std::move(branch));
  }

  bool has_lost_short_branches(std::size_t fork) {
    std::vector<Chain>& branches = branches_at_[fork];
    const auto is_long = [&](const Chain& branch) {
      return !(branch.length_m < 2.0 * graph_.nodes[fork].clearance_m);
    };
    const auto first_short = std::stable_partition(branches.begin(), branches.end(), is_long);
    const auto count = static_cast<std::size_t>(branches.end() - first_short);
    if (count == 0 || count == degree(fork)) return false;
    for (auto branch = first_short; branch != branches.end(); ++branch) {
      for (const std::size_t edge : branch->edges) kept_[edge] = false;
    }
    branches.erase(first_short, branches.end());
    return true;
  }

  /// What has lost branches may be no fork any more: then its other branches lead on, or one
  /// begins.
  void follow_on(std::size_t fork, std::vector<std::size_t>& forks) {
    const std::size_t left = degree(fork);
    if (left > 2) return;
    std::vector<Chain> branches = std::move(branches_at_[fork]);
    branches_at_[fork].clear();
    if (left == 1 && branches.empty()) branches.push_back({fork, fork, {}, 0.0});
    for (Chain& branch : branches) {
      if (const auto onward = other_edge(fork, branch))
        add_branch(walk(std::move(branch), *onward), forks);
    }
  }

  /// The edge by which a chain's end is left.
  std::optional<std::size_t> other_edge(std::size_t node, const Chain& chain) const {
    for (const std::size_t edge : edges_at_[node]) {
      if (kept_[edge] && (chain.edges.empty() || edge != chain.edges.back())) return edge;
    }
    return {};
  }

  std::size_t degree(std::size_t node) const {
    return static_cast<std::size_t>(std::count_if(edges_at_[node].begin(), edges_at_[node].end(),
                                                  [&](std::size_t edge) { return kept_[edge]; }));
  }

  std::size_t other_end(std::size_t edge, std::size_t node) const {
    return graph_.edges[edge].from == node ? graph_.edges[edge].to : graph_.edges[edge].from;
  }

  Chain branch_from(std::size_t end) const {
    const Chain none{end, end, {}, 0.0};
    const auto edge = other_edge(end, none);
    return edge ? walk(none, *edge) : none;
  }

  /// Goes on along an edge to the next fork or end, or round to where it began.
  Chain walk(Chain chain, std::size_t edge) const {
    while (true) {
      const std::size_t next = other_end(edge, chain.last);
      chain.edges.push_back(edge);
      chain.length_m += (graph_.nodes[next].at - graph_.nodes[chain.last].at).norm();
      chain.last = next;
      if (next == chain.first || degree(next) != 2) return chain;
      edge = other_edge(next, chain).value();
    }
  }

  const VoronoiGraph& graph_;
  std::vector<std::vector<std::size_t>> edges_at_;
  std::vector<std::vector<Chain>> branches_at_;  // that end at a fork
  std::vector<bool> kept_;
};

MedialBranch branch_of(const VoronoiGraph& graph, const Chain& chain, double max_error_m) {
  std::vector<Vector2d> points{graph.nodes[chain.first].at};
  MedialBranch branch;
  branch.width_m = {2.0 * graph.nodes[chain.first].clearance_m};
  branch.closed = chain.first == chain.last;
  const auto add = [&](const VoronoiGraph::Node& node) {
    if (node.at == points.back()) return;
    points.push_back(node.at);
    branch.width_m.push_back(2.0 * node.clearance_m);
  };
  std::size_t at = chain.first;
  for (const std::size_t index : chain.edges) {
    const VoronoiGraph::Edge& edge = graph.edges[index];
    const std::size_t next = edge.from == at ? edge.to : edge.from;
    if (edge.parabola) {
      for (const auto& node :
           between(graph.nodes[at], graph.nodes[next], *edge.parabola, max_error_m)) {
        add(node);
      }
    }
    add(graph.nodes[next]);
    at = next;
  }
  if (points.size() < 2) return {};
  branch.line = Polyline(std::move(points));
  return branch;
}

/// The same whichever end the search began at.
void turn_to_smaller_end(MedialBranch& branch) {
  std::vector<Vector2d> points = branch.line.points();
  const auto key = [](const Vector2d& p) { return std::pair(p.x(), p.y()); };
  if (key(points.front()) <= key(points.back())) return;
  std::reverse(points.begin(), points.end());
  std::reverse(branch.width_m.begin(), branch.width_m.end());
  branch.line = Polyline(std::move(points));
}

}  // namespace

std::vector<MedialBranch> medial_axis(const Polygon& polygon, const MedialAxisOptions& options) {
  const VoronoiGraph graph = interior_voronoi(polygon);
  Pruner pruner(graph);
  pruner.prune();
  std::vector<MedialBranch> branches;
  for (const Chain& chain : pruner.chains()) {
    MedialBranch branch = branch_of(graph, chain, options.max_error_m);
    constexpr double kOnePlace_m = 1e-6;  // where bisectors meet in one place but for rounding
    if (branch.line.points().empty() || branch.line.length_m() < kOnePlace_m) continue;
    turn_to_smaller_end(branch);
    branches.push_back(std::move(branch));
  }
  std::sort(branches.begin(), branches.end(), [](const MedialBranch& a, const MedialBranch& b) {
    const Vector2d &p = a.line.points().front(), &q = b.line.points().front();
    const Vector2d &r = a.line.points().back(), &s = b.line.points().back();
    return std::tuple(p.x(), p.y(), r.x(), r.y()) < std::tuple(q.x(), q.y(), s.x(), s.y());
  });
  return branches;
}

}  // namespace roadbed::geometry::polygons
