#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "roadbed/planning/route/change_span.h"
#include "roadbed/planning/route/route_network.h"
#include "roadbed/planning/route/routing_cost_model.h"

namespace roadbed::planning::inline route {

/// Cost of an arc in ticks: 0.1 ms or 1 mm. Whole numbers, so that every way of adding them up
/// gives the same sum.
using Ticks = std::uint32_t;

/// No way. Routes have to cost less: 29 hours, or 1073 km. Two of them can be added as int32.
inline constexpr Ticks kNever = (1U << 30) - 1;

inline constexpr std::uint32_t kNoNode = 0xffffffffU;

double ticks_per_unit(RouteCost cost);

/// Rounded; kNever for what is too much.
Ticks to_ticks(double cost, RouteCost measure);

/// A network as a plain directed graph, forward and backward, in compressed rows.
///
/// A node is "in this lane, at the start of its lane group". A lane that can be changed to has two:
/// at the entry of the lane group changes are still possible, at its exit they are made. Arcs are
/// changes, from the entry of a lane to the exit of each lane of the lane group that its neighbours
/// lead to (of itself, too), and advances, from the exit of a lane to the entries of its
/// successors. So the number of changes in a lane group is known to the arc that pays for them. A
/// change that takes several lane groups is an arc of its own, from the entry of the first to the
/// exit of the last one, and pays for the way between.
struct RouteGraph {
  std::vector<std::uint32_t> lane_of_node;
  std::vector<std::uint32_t> entry_of_lane, exit_of_lane;  ///< the same node where one will do
  std::vector<std::uint32_t> first_out;      ///< arcs of a node: first_out[n] … first_out[n + 1]
  std::vector<std::uint32_t> first_advance;  ///< of a node: its changes come first
  std::vector<std::uint32_t> head, tail;     ///< of an arc
  std::vector<std::uint32_t> first_in, in_arc;                      ///< arcs that lead to a node
  std::vector<std::uint32_t> span_arcs;                             ///< those of spans, ascending
  std::vector<ChangeSpan> spans;                                    ///< of each of them
  std::vector<std::pair<std::uint32_t, std::uint32_t>> spans_over;  ///< lane, arc; ascending

  std::size_t nodes() const { return lane_of_node.size(); }
  std::size_t arcs() const { return head.size(); }
  bool is_advance(std::uint32_t arc) const { return arc >= first_advance[tail[arc]]; }
  /// The change that an arc stands for if it takes several lane groups, else null. O(log spans).
  const ChangeSpan* span_of(std::uint32_t arc) const;
};

/// O(lanes + links); lane groups are as wide as neighbours lead.
/// @param enough_m  length from which on more room for a lane change does not help.
RouteGraph make_route_graph(const RouteNetwork& network,
                            double enough_m = enough_room_m(RouteOptions{}));

/// What one arc costs by the rules.
Ticks weigh(const RouteGraph& graph, const RoutingCostModel& model, std::uint32_t arc);

/// What each arc costs by the rules.
std::vector<Ticks> weigh_all(const RouteGraph& graph, const RoutingCostModel& model);

/// Arcs whose cost depends on whether the lane is closed.
std::vector<std::uint32_t> arcs_of_lane(const RouteGraph& graph, std::uint32_t lane);

}  // namespace roadbed::planning::route
