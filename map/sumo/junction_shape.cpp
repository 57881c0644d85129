#include "roadbed/map/sumo/junction_shape.h"

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/primitives/angle.h"

namespace roadbed::map::sumo {
namespace {

// How far a node reaches into its edges: the lanes cross its ring whatever rounding does, and where
// edges meet end to end there are more than SUMO's POSITION_EPS of 0.1 m between them.
constexpr double kInset_m = 0.06;

/// The outer corners of an edge's end, as its driver sees them.
struct End {
  Eigen::Vector2d left, right;
  bool is_entry;  // of the node: the edge ends there
};

Eigen::Vector2d border_point(const RoadMap& road_map, DirectedLane way, bool left, double share) {
  const Lane& lane = road_map.lane(way.lane);
  return Lane::point_at(left != way.against ? lane.left : lane.right,
                        (way.against ? 1.0 - share : share) * lane.length_m());
}

geometry::Ring ring_around(const Eigen::Vector2d& middle, std::vector<End> ends) {
  const auto angle_rad = [&](const End& end) {
    const Eigen::Vector2d arm = 0.5 * (end.left + end.right) - middle;
    return std::atan2(arm.y(), arm.x());
  };
  std::stable_sort(ends.begin(), ends.end(),
                   [&](const End& a, const End& b) { return angle_rad(a) < angle_rad(b); });
  geometry::Ring ring;
  for (const End& end : ends) {
    // Who drives in has the node's middle ahead and what comes next around it to the right.
    ring.push_back(end.is_entry ? end.left : end.right);
    ring.push_back(end.is_entry ? end.right : end.left);
  }
  return ring;
}

}  // namespace

std::vector<geometry::Ring> junction_shapes(const RoadMap& road_map, const Net& net) {
  std::vector<std::vector<End>> ends(net.nodes.size());
  std::vector<bool> is_entered(net.nodes.size()), is_left(net.nodes.size());
  for (const NetEdge& edge : net.edges) {
    const double length_m = road_map.lane(edge.lanes.front().lane).length_m();
    const double inset = std::min(kInset_m / length_m, 0.1 * (edge.to_share - edge.from_share));
    const auto add = [&](std::uint32_t node, double share, bool is_entry) {
      ends[node].push_back({border_point(road_map, net.leftmost(edge), true, share),
                            border_point(road_map, net.rightmost(edge), false, share), is_entry});
    };
    add(edge.from, edge.from_share + inset, false);
    add(edge.to, edge.to_share - inset, true);
    is_left[edge.from] = is_entered[edge.to] = true;
  }
  std::vector<geometry::Ring> shapes(net.nodes.size());
  for (std::size_t i = 0; i < net.nodes.size(); ++i) {
    if (!is_entered[i] || !is_left[i]) continue;
    shapes[i] = ring_around(net.nodes[i].in_map.head<2>(), std::move(ends[i]));
  }
  return shapes;
}

}  // namespace roadbed::map::sumo
