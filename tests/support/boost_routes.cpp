#include "roadbed/tests/support/boost_routes.h"

#include <boost/graph/astar_search.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <limits>

namespace roadbed::tests {
namespace {

using planning::kNever;
using planning::Ticks;

struct Arc {
  Ticks weight = 0;
};
using Graph = boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, Arc,
                                                 boost::no_property, std::uint32_t, std::uint32_t>;

struct Reached {};

template <typename T>
auto by_node(std::vector<T>& values) {
  return boost::make_iterator_property_map(values.data(),
                                           boost::typed_identity_property_map<std::uint32_t>());
}

// Closed arcs lead nowhere: sums stop at kNever.
struct Sum {
  Ticks operator()(Ticks a, Ticks b) const { return std::min(kNever, a + b); }
};

struct StopAt : boost::default_dijkstra_visitor {
  std::uint32_t goal;
  explicit StopAt(std::uint32_t node) : goal(node) {}
  template <class G>
  void examine_vertex(std::uint32_t node, const G&) const {
    if (node == goal) throw Reached{};
  }
};

struct StopAStarAt : boost::default_astar_visitor {
  std::uint32_t goal;
  explicit StopAStarAt(std::uint32_t node) : goal(node) {}
  template <class G>
  void examine_vertex(std::uint32_t node, const G&) const {
    if (node == goal) throw Reached{};
  }
};

struct Ahead : boost::astar_heuristic<Graph, Ticks> {
  const planning::Guide* guide;
  Eigen::Vector2d goal;
  Ticks operator()(std::uint32_t node) const {
    return static_cast<Ticks>((guide->place_in_map[node] - goal).norm() * guide->ticks_per_m);
  }
};

}  // namespace

struct BoostRoutes::Impl {
  Graph graph;
  std::vector<Ticks> cost, estimate;
  std::vector<std::uint32_t> parent;
  std::vector<boost::default_color_type> colour;
};

BoostRoutes::BoostRoutes(const planning::RouteGraph& graph, std::vector<Ticks> weights)
    : impl_(std::make_unique<Impl>()) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;
  std::vector<Arc> arcs;
  for (std::size_t arc = 0; arc < graph.arcs(); ++arc) {
    ends.emplace_back(graph.tail[arc], graph.head[arc]);
    arcs.push_back({weights[arc]});
  }
  impl_->graph = Graph(boost::edges_are_sorted, ends.begin(), ends.end(), arcs.begin(),
                       static_cast<std::uint32_t>(graph.nodes()));
  impl_->cost.resize(graph.nodes());
  impl_->estimate.resize(graph.nodes());
  impl_->parent.resize(graph.nodes());
  impl_->colour.resize(graph.nodes());
}

BoostRoutes::~BoostRoutes() = default;

void BoostRoutes::set_weight(std::uint32_t arc, Ticks weight) {
  const auto edge = boost::edge_from_index(arc, impl_->graph);
  impl_->graph[edge].weight = weight;
}

const std::vector<Ticks>& BoostRoutes::costs_from(std::uint32_t node) {
  boost::dijkstra_shortest_paths(impl_->graph, node,
                                 boost::weight_map(boost::get(&Arc::weight, impl_->graph))
                                     .distance_map(by_node(impl_->cost))
                                     .distance_inf(kNever)
                                     .distance_combine(Sum{}));
  return impl_->cost;
}

Ticks BoostRoutes::dijkstra(std::uint32_t from, std::uint32_t to) {
  try {
    boost::dijkstra_shortest_paths(impl_->graph, from,
                                   boost::weight_map(boost::get(&Arc::weight, impl_->graph))
                                       .distance_map(by_node(impl_->cost))
                                       .predecessor_map(by_node(impl_->parent))
                                       .color_map(by_node(impl_->colour))
                                       .distance_inf(kNever)
                                       .distance_combine(Sum{})
                                       .visitor(StopAt(to)));
  } catch (const Reached&) {
    return impl_->cost[to];
  }
  return impl_->cost[to];
}

Ticks BoostRoutes::a_star(std::uint32_t from, std::uint32_t to, const planning::Guide& guide) {
  Ahead ahead;
  ahead.guide = &guide;
  ahead.goal = guide.place_in_map[to];
  try {
    boost::astar_search(impl_->graph, from, ahead,
                        boost::weight_map(boost::get(&Arc::weight, impl_->graph))
                            .distance_map(by_node(impl_->cost))
                            .predecessor_map(by_node(impl_->parent))
                            .rank_map(by_node(impl_->estimate))
                            .color_map(by_node(impl_->colour))
                            .distance_inf(kNever)
                            .distance_combine(Sum{})
                            .visitor(StopAStarAt(to)));
  } catch (const Reached&) {
    return impl_->cost[to];
  }
  return impl_->cost[to];
}

}  // namespace roadbed::tests
