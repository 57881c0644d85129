#include "roadbed/tests/support/two_way_oracle.h"

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <limits>
#include <vector>

namespace roadbed::tests {
namespace {

using Length = boost::property<boost::edge_weight_t, double>;
using TwoWayGraph =
    boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS, boost::no_property, Length>;

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kSame_m = 0.05, kWidth_m = 0.1;

bool is_user(const map::Lane& lane, map::Participant user) {
  const bool road_lane = map::is_drivable(lane.type) || lane.type == map::LaneType::bus ||
                         lane.type == map::LaneType::taxi;
  return lane.participants.has(user) && (road_lane || !map::Participants::vehicles().has(user));
}

// Node 2i is lane i, node 2i + 1 the same one against its direction.
struct Ends {
  Eigen::Vector2d first_left, first_right, last_left, last_right;
};

Ends ends_of(const map::Lane& lane, bool against) {
  const auto &left = lane.left.in_map.points(), &right = lane.right.in_map.points();
  if (!against) return {left.front(), right.front(), left.back(), right.back()};
  return {right.back(), left.back(), right.front(), left.front()};
}

bool near(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return (a - b).norm() <= kSame_m; }

bool linked(const map::RoadMap& road_map, map::LaneId lane, map::LaneId next) {
  const auto& after = road_map.graph().of(lane).successors;
  return std::find(after.begin(), after.end(), next) != after.end();
}

}  // namespace

bool leads_to(const map::RoadMap& road_map, map::LaneId lane, bool against, map::LaneId next,
              bool next_against) {
  if (against == next_against) {
    return against ? linked(road_map, next, lane) : linked(road_map, lane, next);
  }
  if (lane == next) return false;
  const Ends a = ends_of(road_map.lane(lane), against);
  const Ends b = ends_of(road_map.lane(next), next_against);
  return (a.last_left - a.last_right).norm() > kWidth_m && near(a.last_left, b.first_left) &&
         near(a.last_right, b.first_right);
}

struct TwoWayOracle::Impl {
  const map::RoadMap& road_map;
  TwoWayGraph graph;
  std::vector<bool> open;

  Impl(const map::RoadMap& of, map::Participant user)
      : road_map(of), graph(2 * of.lanes().size()), open(2 * of.lanes().size(), false) {
    for (const map::Lane& lane : of.lanes()) {
      const bool walks =
          user == map::Participant::pedestrian && lane.road && lane.type == map::LaneType::sidewalk;
      const bool both = !lane.one_way || walks;
      open[2 * lane.id.index] = is_user(lane, user);
      open[2 * lane.id.index + 1] = is_user(lane, user) && both;
    }
    for (std::size_t i = 0; i < open.size(); ++i) {
      for (std::size_t j = 0; j < open.size(); ++j) {
        if (open[i] && open[j] && leads_to(of, lane(i).id, i % 2 == 1, lane(j).id, j % 2 == 1)) {
          boost::add_edge(i, j, Length(lane(i).length_m()), graph);
        }
      }
    }
  }

  const map::Lane& lane(std::size_t node) const {
    return road_map.lane({static_cast<std::uint32_t>(node / 2)});
  }

  // From the start of one direction to the start of another one.
  std::vector<double> lengths_from(std::size_t node) {
    std::vector<double> lengths(open.size(), kNone);
    boost::dijkstra_shortest_paths(
        graph, node,
        boost::distance_map(
            boost::make_iterator_property_map(lengths.begin(), get(boost::vertex_index, graph)))
            .distance_inf(kNone));
    return lengths;
  }
};

TwoWayOracle::TwoWayOracle(const map::RoadMap& road_map, map::Participant user)
    : impl_(std::make_unique<Impl>(road_map, user)) {}

TwoWayOracle::~TwoWayOracle() = default;

double TwoWayOracle::length_m(const map::LanePlace& from, const map::LanePlace& to) {
  double least_m = kNone;
  const auto driven = [&](const map::LanePlace& place, std::size_t against) {
    return against == 1 ? impl_->road_map.lane(place.lane).length_m() - place.s_m : place.s_m;
  };
  for (const std::size_t against : {0U, 1U}) {
    const std::size_t start = 2 * from.lane.index + against;
    if (!impl_->open[start]) continue;
    const double begun_m = driven(from, against);
    const std::vector<double> lengths_m = impl_->lengths_from(start);
    for (const std::size_t goal_against : {0U, 1U}) {
      const std::size_t goal = 2 * to.lane.index + goal_against;
      if (!impl_->open[goal]) continue;
      const double ended_m = driven(to, goal_against);
      if (goal != start || begun_m <= ended_m) {
        least_m = std::min(least_m, lengths_m[goal] + ended_m - begun_m);
        continue;
      }
      // Round a loop: out of the lane, and into it again.
      for (auto [edge, end] = boost::out_edges(start, impl_->graph); edge != end; ++edge) {
        const double back_m = impl_->lengths_from(boost::target(*edge, impl_->graph))[goal];
        least_m = std::min(least_m, impl_->lane(start).length_m() + back_m + ended_m - begun_m);
      }
    }
  }
  return least_m;
}

}  // namespace roadbed::tests
