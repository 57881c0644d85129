#include "roadbed/map/lanelet2/write/autoware/regulation_users.h"

#include <algorithm>

namespace roadbed::map::lanelet2 {
namespace {

OsmMember naming(std::uint32_t regulation) {
  return {MemberKind::relation, regulation, "regulatory_element"};
}

bool is_naming(const OsmMember& member, std::uint32_t regulation) {
  return member.kind == MemberKind::relation && member.index == regulation &&
         member.role == "regulatory_element";
}

LaneletEdge edge_of(const LaneletMap& made, LaneId lane, bool at_end) {
  const auto corner = [&](const Border& border) {
    const std::vector<std::uint32_t>& nodes = made.osm.ways[border.way].nodes;
    return made.osm.nodes[border.reversed == at_end ? nodes.front() : nodes.back()].in_map;
  };
  const auto& [left, right] = made.borders[lane.index];
  return {corner(left), corner(right)};
}

}  // namespace

std::map<std::uint32_t, std::vector<LaneId>> users_of_regulations(const LaneletMap& made) {
  std::map<std::uint32_t, std::vector<LaneId>> users;
  for (std::uint32_t lane = 0; lane < made.lanelets.size(); ++lane) {
    if (!made.lanelets[lane]) continue;
    for (const OsmMember& member : made.osm.relations[*made.lanelets[lane]].members) {
      if (member.kind != MemberKind::relation || member.role != "regulatory_element") continue;
      users[member.index].push_back(LaneId{lane});
    }
  }
  return users;
}

void name_regulation(LaneletMap& made, LaneId lane, std::uint32_t regulation) {
  auto& members = made.osm.relations[*made.lanelets[lane.index]].members;
  const bool names = std::ranges::any_of(
      members, [&](const OsmMember& member) { return is_naming(member, regulation); });
  if (!names) members.push_back(naming(regulation));
}

void forget_regulation(LaneletMap& made, LaneId lane, std::uint32_t regulation) {
  std::erase_if(made.osm.relations[*made.lanelets[lane.index]].members,
                [&](const OsmMember& member) { return is_naming(member, regulation); });
}

LaneletEdge start_edge(const LaneletMap& made, LaneId lane) { return edge_of(made, lane, false); }

LaneletEdge end_edge(const LaneletMap& made, LaneId lane) { return edge_of(made, lane, true); }

std::uint32_t add_stop_line(LaneletMap& made, const std::vector<LaneletEdge>& edges) {
  constexpr double kBeside_m = 30.0;
  const auto across = [](const LaneletEdge& edge) {
    return Eigen::Vector2d((edge.right - edge.left).head<2>().normalized());
  };
  const Eigen::Vector2d axis = across(edges.front());
  const Eigen::Vector3d origin = edges.front().left;
  const auto place = [&](const Eigen::Vector3d& point) {
    return axis.dot((point - origin).head<2>());
  };
  Eigen::Vector3d left = edges.front().left, right = edges.front().right;
  for (const LaneletEdge& edge : edges) {
    const bool runs_alike = axis.dot(across(edge)) > 0.7;
    if (!runs_alike || (edge.left - origin).norm() > kBeside_m) continue;
    if (place(edge.left) < place(left)) left = edge.left;
    if (place(edge.right) > place(right)) right = edge.right;
  }
  const std::uint32_t from = made.osm.add_node(left), to = made.osm.add_node(right);
  return made.osm.add_way({from, to}, {{"type", "stop_line"}, {"subtype", "solid"}});
}

}  // namespace roadbed::map::lanelet2
