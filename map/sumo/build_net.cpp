#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>

#include "roadbed/geometry/primitives/disjoint_sets.h"
#include "roadbed/map/derived/lane_relations.h"
#include "roadbed/map/sumo/inner_lanes.h"
#include "roadbed/map/sumo/lane_lines.h"
#include "roadbed/map/sumo/net.h"

namespace roadbed::map::sumo {
namespace {

constexpr double kLateStart_m = 1.0;  // how far from a junction a lane begins that nothing leads to

class NetBuilder {
 public:
  NetBuilder(const RoadMap& road_map, const DirectedLanes& ways,
             const std::vector<Conflict>& conflicts)
      : road_map_(road_map), inner_(find_inner_lanes(road_map, ways, conflicts)) {
    net_.left_hand = drives_on_the_left(road_map);
    net_.edges = make_edges(road_map, ways, inner_, net_.left_hand);
    net_.connections = make_connections(road_map, ways, inner_, net_.edges);
  }

  Net build() {
    join_ends();
    mark_zippers();
    split_loops();
    open_late();
    sort_connections();
    place_nodes();
    return std::move(net_);
  }

 private:
  // Ends are 2 · edge, + 1 where it ends; crossings come after them.
  void join_ends() {
    std::uint32_t crossings = 0;
    for (const auto& number : inner_) crossings = std::max(crossings, number ? *number + 1 : 0U);
    const auto ends = static_cast<std::uint32_t>(2 * net_.edges.size());
    geometry::DisjointSets sets(ends + crossings);
    for (const NetConnection& connection : net_.connections) {
      sets.join(2 * connection.from + 1, 2 * connection.to);
      for (const DirectedLane way : connection.across) {
        sets.join(2 * connection.from + 1, ends + *inner_[way.lane.index]);
      }
    }
    name_nodes(sets, ends, crossings);
  }

  // By the junction of the map where there is one, else by an edge that begins or ends there.
  void name_nodes(geometry::DisjointSets& sets, std::uint32_t ends, std::uint32_t crossings) {
    std::map<std::size_t, std::string> names;
    const auto junctions = static_cast<std::uint32_t>(road_map_.junctions().size());
    for (std::uint32_t i = 0; i < std::min(crossings, junctions); ++i) {
      names.emplace(sets.of(ends + i), road_map_.junctions().at(i).source_id);
    }
    std::map<std::size_t, std::uint32_t> nodes;
    const auto node = [&](std::uint32_t end) {
      const std::size_t set = sets.of(end);
      const auto [found, is_new] =
          nodes.emplace(set, static_cast<std::uint32_t>(net_.nodes.size()));
      if (is_new) {
        const auto name = names.find(set);
        const std::string& edge = net_.edges[end / 2].id;
        net_.nodes.push_back(
            {ids_.give(name != names.end() ? name->second
                                           : fmt::format("{}.{}", edge, end % 2 ? "to" : "from")),
             {0, 0, 0}});
      }
      return found->second;
    };
    for (std::uint32_t edge = 0; edge < net_.edges.size(); ++edge) {
      net_.edges[edge].from = node(2 * edge);
      net_.edges[edge].to = node(2 * edge + 1);
    }
  }

  // Where two lanes of an edge end in one of the next, and nothing crosses, they take turns.
  void mark_zippers() {
    std::set<std::uint32_t> crossed;
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, int> into;
    for (const NetConnection& connection : net_.connections) {
      if (!connection.across.empty()) crossed.insert(net_.edges[connection.to].from);
      ++into[{connection.from, connection.to, connection.to_lane}];
    }
    for (const auto& [key, count] : into) {
      const std::uint32_t node = net_.edges[std::get<1>(key)].from;
      if (count > 1 && !crossed.contains(node)) net_.nodes[node].is_zipper = true;
    }
  }

  void sort_connections() {
    std::stable_sort(net_.connections.begin(), net_.connections.end(),
                     [](const NetConnection& a, const NetConnection& b) {
                       return std::tie(a.from, a.from_lane, a.to, a.to_lane) <
                              std::tie(b.from, b.from_lane, b.to, b.to_lane);
                     });
  }

  // SUMO has no edge that ends at the node where it begins: it is two.
  void split_loops() {
    const auto count = static_cast<std::uint32_t>(net_.edges.size());
    for (std::uint32_t edge = 0; edge < count; ++edge) {
      if (net_.edges[edge].from == net_.edges[edge].to) split(edge, 0.5);
    }
  }

  // Where several edges end at a node, netconvert asks of each lane that begins there that one of
  // them leads to it. Lanes without begin a little behind.
  void open_late() {
    std::vector<int> ending(net_.nodes.size());
    std::vector<std::set<std::uint32_t>> entered(net_.edges.size());
    for (const NetEdge& edge : net_.edges) ++ending[edge.to];
    for (const NetConnection& connection : net_.connections) {
      entered[connection.to].insert(connection.to_lane);
    }
    const auto count = static_cast<std::uint32_t>(net_.edges.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      const NetEdge& edge = net_.edges[i];
      const bool is_late = !entered[i].empty() && entered[i].size() < edge.lanes.size();
      if (!is_late || ending[edge.from] < 2) continue;
      const double length_m =
          (edge.to_share - edge.from_share) * road_map_.lane(edge.lanes.front().lane).length_m();
      split(i, std::min(0.5, kLateStart_m / length_m));
      keep_lanes(i, entered[i]);
    }
  }

  // Cuts an edge in two: it keeps this share, what it led to follows the rest.
  void split(std::uint32_t edge, double share) {
    const auto node = static_cast<std::uint32_t>(net_.nodes.size());
    const auto second = static_cast<std::uint32_t>(net_.edges.size());
    NetEdge& first = net_.edges[edge];
    NetEdge rest = first;
    net_.nodes.push_back({ids_.give(first.id + ".cut"), {0, 0, 0}});
    rest.id = edge_ids().give(first.id + ".rest");
    first.to = rest.from = node;
    first.to_share = rest.from_share =
        first.from_share + share * (first.to_share - first.from_share);
    for (NetConnection& connection : net_.connections) {
      if (connection.from == edge) connection.from = second;
    }
    for (std::uint32_t lane = 0; lane < first.lanes.size(); ++lane) {
      net_.connections.push_back(
          {edge, second, lane, lane, {}, false, Participants::from_bits(0xffff)});
    }
    net_.edges.push_back(std::move(rest));
  }

  // Takes all other lanes out of an edge.
  void keep_lanes(std::uint32_t edge, const std::set<std::uint32_t>& kept) {
    std::vector<DirectedLane> lanes;
    std::map<std::uint32_t, std::uint32_t> place;
    for (const std::uint32_t lane : kept) {
      place.emplace(lane, static_cast<std::uint32_t>(lanes.size()));
      lanes.push_back(net_.edges[edge].lanes[lane]);
    }
    net_.edges[edge].lanes = std::move(lanes);
    std::erase_if(net_.connections, [&](NetConnection& connection) {
      if (connection.from == edge && !place.contains(connection.from_lane)) return true;
      if (connection.from == edge) connection.from_lane = place.at(connection.from_lane);
      if (connection.to == edge) connection.to_lane = place.at(connection.to_lane);
      return false;
    });
  }

  NetIds& edge_ids() {
    if (!edge_ids_) {
      edge_ids_.emplace();
      for (const NetEdge& edge : net_.edges) edge_ids_->give(edge.id);
    }
    return *edge_ids_;
  }

  void place_nodes() {
    std::vector<int> counts(net_.nodes.size());
    const auto add = [&](std::uint32_t node, const Eigen::Vector3d& at) {
      net_.nodes[node].in_map += at;
      ++counts[node];
    };
    for (const NetEdge& edge : net_.edges) {
      for (const DirectedLane way : edge.lanes) {
        const Points points =
            line_of(road_map_, way, LineOf::centre, edge.from_share, edge.to_share);
        add(edge.from, points.front());
        add(edge.to, points.back());
      }
    }
    for (std::size_t i = 0; i < net_.nodes.size(); ++i) net_.nodes[i].in_map /= counts[i];
  }

  const RoadMap& road_map_;
  std::vector<std::optional<std::uint32_t>> inner_;
  Net net_;
  NetIds ids_;
  std::optional<NetIds> edge_ids_;
};

}  // namespace

Net build_net(const RoadMap& road_map, const DirectedLanes& ways,
              const std::vector<Conflict>& conflicts) {
  return NetBuilder(road_map, ways, conflicts).build();
}

}  // namespace roadbed::map::sumo
