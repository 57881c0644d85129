#include "roadbed/map/sumo/net_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>
#include <utility>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/geometry/primitives/cross.h"
#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/map/files/short_number.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/map/sumo/junction_shape.h"
#include "roadbed/map/sumo/lane_users.h"

namespace roadbed::map::sumo {
namespace {

constexpr double kLateral_mps2 = 5.5;  // in bends, as netconvert's junctions.limit-turn-speed
constexpr double kRough_m = 0.05, kStep_m = 0.5;
constexpr double kMostTurn_rad =
    90.0 * geometry::kRadiansPerDegree;           // netconvert's geometry.max-angle is 99°
constexpr const char* kNobodyElse = "emergency";  // may cross a marking that others may not

std::string number(double value) { return number_within(value, 5e-4); }

// "x,y,z x,y,z" in the source's coordinates.
std::string shape_text(const RoadMap& road_map, const Points& points) {
  std::string text;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector2d at = road_map.to_source(point.head<2>());
    fmt::format_to(std::back_inserter(text), "{}{},{},{}", text.empty() ? "" : " ", number(at.x()),
                   number(at.y()), number(point.z()));
  }
  return text;
}

std::string ring_text(const RoadMap& road_map, const geometry::Ring& ring, double z_m) {
  Points points;
  for (const Eigen::Vector2d& point : ring) points.emplace_back(point.x(), point.y(), z_m);
  return points.empty() ? "" : " shape=\"" + shape_text(road_map, points) + "\"";
}

// Whether a lane may be left for the one beside it in its edge, by the map.
bool may_change(const RoadMap& road_map, DirectedLane way, DirectedLane beside, bool to_left) {
  const LaneLinks& links = road_map.graph().of(way.lane);
  const auto& link = to_left != way.against ? links.left : links.right;
  return link && link->lane == beside.lane && link->same_direction && link->change_allowed();
}

double turn_at(const Eigen::Vector3d& from, const Eigen::Vector3d& at, const Eigen::Vector3d& to) {
  const Eigen::Vector2d before = (at - from).head<2>(), after = (to - at).head<2>();
  return geometry::wrap_angle(std::atan2(after.y(), after.x()) -
                              std::atan2(before.y(), before.x()));
}

// An edge's own line is its border amid the road, in steps that netconvert does not take for one
// point, and without what turns back. It looks for sharp turns between the first two steps and the
// last two: these go straight on.
Points edge_line(const Points& border) {
  std::vector<Eigen::Vector2d> plan;
  for (const Eigen::Vector3d& point : border) plan.push_back(point.head<2>());
  Points ahead;
  std::size_t i = 0;
  for (const Eigen::Vector2d& kept : geometry::simplify(plan, kRough_m)) {
    while (plan[i] != kept) ++i;
    ahead.push_back(border[i]);
  }
  std::reverse(ahead.begin(), ahead.end());
  Points points{ahead.back()};
  ahead.pop_back();
  while (ahead.size() > 1) {
    const Eigen::Vector3d at = ahead.back(), next = *(ahead.end() - 2);
    const bool is_short = (points.size() == 1 && (at - points[0]).norm() < kStep_m) ||
                          (ahead.size() == 2 && (next - at).norm() < kStep_m);
    const bool goes = is_short || std::abs(turn_at(points.back(), at, next)) > kMostTurn_rad;
    ahead.pop_back();
    if (!goes) {
      points.push_back(at);
    } else if (points.size() > 1) {  // the one before turns otherwise now
      ahead.push_back(points.back());
      points.pop_back();
    }
  }
  points.insert(points.end(), ahead.begin(), ahead.end());
  points.insert(points.begin() + 1, 0.5 * (points[0] + points[1]));
  points.insert(points.end() - 1, 0.5 * (*(points.end() - 2) + points.back()));
  return points;
}

// How much netconvert cuts off a line at its begin: up to where it last leaves the ring [m].
double cut_off_m(const Points& line, const geometry::Ring& ring) {
  double passed_m = 0.0, cut_m = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Eigen::Vector2d from = line[i - 1].head<2>(), step = (line[i] - line[i - 1]).head<2>();
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Eigen::Vector2d edge = ring[(k + 1) % ring.size()] - ring[k];
      const double across = geometry::cross(step, edge);
      if (across == 0.0) continue;
      const double t = geometry::cross(ring[k] - from, edge) / across;
      const double u = geometry::cross(ring[k] - from, step) / across;
      if (t >= 0.0 && t <= 1.0 && u >= 0.0 && u <= 1.0) {
        cut_m = std::max(cut_m, passed_m + t * step.norm());
      }
    }
    passed_m += step.norm();
  }
  return cut_m;
}

// Whether the lanes that a connection joins keep their ends: its shape would not fit others.
bool keeps_ends(const LaneLines& lines, const NetConnection& connection,
                const geometry::Ring& ring) {
  constexpr double least_m = 0.3;
  Points before = lines.of(connection.from, connection.from_lane);
  std::reverse(before.begin(), before.end());
  return cut_off_m(before, ring) < least_m &&
         cut_off_m(lines.of(connection.to, connection.to_lane), ring) < least_m;
}

// SUMO's changeLeft is to the lane of the next index, on whichever side that is.
void add_lane(const RoadMap& road_map, const Net& net, const NetEdge& edge, std::size_t index,
              bool leads_on, const Points& points, std::string& text) {
  const DirectedLane way = edge.lanes[index];
  const Lane& lane = road_map.lane(way.lane);
  Participants users = users_of(lane);
  if (way.against) users.remove(Participant::pedestrian);
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "<lane index=\"{}\" allow=\"{}\" speed=\"{}\" width=\"{}\"", index,
                 vehicle_classes(users), number(speed_mps(lane)), number(mean_width_m(lane)));
  for (const bool to_next : {true, false}) {
    if (!leads_on || (to_next ? index + 1 == edge.lanes.size() : index == 0)) continue;
    const DirectedLane beside = edge.lanes[to_next ? index + 1 : index - 1];
    if (may_change(road_map, way, beside, to_next != net.left_hand)) continue;
    fmt::format_to(out, " change{}=\"{}\"", to_next ? "Left" : "Right", kNobodyElse);
  }
  fmt::format_to(out, " shape=\"{}\"><param key=\"origId\" value=\"{}\"/>{}</lane>\n",
                 shape_text(road_map, points), xml_text(lane.name),
                 way.against ? "<param key=\"against\" value=\"1\"/>" : "");
}

// Limits along the way, and as fast as its bend lets one drive.
double connection_speed_mps(const RoadMap& road_map, const Net& net,
                            const NetConnection& connection, const Points& path) {
  double least_mps = connection.across.empty()
                         ? std::max(speed_mps(road_map.lane(net.from_lane(connection).lane)),
                                    speed_mps(road_map.lane(net.to_lane(connection).lane)))
                         : 1e3;
  for (const DirectedLane way : connection.across) {
    least_mps = std::min(least_mps, speed_mps(road_map.lane(way.lane)));
  }
  double turned_rad = 0.0, length_m = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    length_m += (path[i] - path[i - 1]).head<2>().norm();
    if (i + 1 < path.size()) turned_rad += turn_at(path[i - 1], path[i], path[i + 1]);
  }
  const double curvature_per_m = std::abs(turned_rad) / std::max(length_m, 1.0);
  if (curvature_per_m < 1e-4) return least_mps;
  return std::min(least_mps, std::sqrt(kLateral_mps2 / curvature_per_m));
}

}  // namespace

std::string nodes_text(const RoadMap& road_map, const Net& net,
                       const std::vector<TrafficLight>& lights, const std::string& location) {
  std::set<std::uint32_t> lit;
  for (const TrafficLight& light : lights) lit.insert(light.node);
  const std::vector<geometry::Ring> shapes = junction_shapes(road_map, net);
  std::string text = "<nodes>\n" + location;
  for (std::uint32_t i = 0; i < net.nodes.size(); ++i) {
    const NetNode& node = net.nodes[i];
    const Eigen::Vector2d at = road_map.to_source(node.in_map.head<2>());
    const std::string type = lit.contains(i)  ? "traffic_light\" tl=\"" + node.id
                             : node.is_zipper ? "zipper"
                                              : "priority";
    fmt::format_to(std::back_inserter(text),
                   "<node id=\"{}\" x=\"{}\" y=\"{}\" z=\"{}\" type=\"{}\"{}/>\n", node.id,
                   number(at.x()), number(at.y()), number(node.in_map.z()), type,
                   ring_text(road_map, shapes[i], node.in_map.z()));
  }
  return text + "</nodes>\n";
}

std::string edges_text(const RoadMap& road_map, const Net& net, const LaneLines& lines) {
  // Of a lane that ends netconvert wants that it may be left.
  std::set<std::pair<std::uint32_t, std::uint32_t>> leading;
  for (const NetConnection& connection : net.connections) {
    leading.emplace(connection.from, connection.from_lane);
  }
  const LineOf middle = net.left_hand ? LineOf::right : LineOf::left;
  std::string text = "<edges>\n";
  for (std::uint32_t i = 0; i < net.edges.size(); ++i) {
    const NetEdge& edge = net.edges[i];
    double speed = 0.0;
    for (const DirectedLane way : edge.lanes) {
      speed = std::max(speed, speed_mps(road_map.lane(way.lane)));
    }
    const Lane& first = road_map.lane(edge.lanes.front().lane);
    const std::string name = first.road ? road_map.road(*first.road).name : "";
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "<edge id=\"{}\" from=\"{}\" to=\"{}\"", edge.id, net.nodes[edge.from].id,
                   net.nodes[edge.to].id);
    if (!name.empty()) fmt::format_to(out, " name=\"{}\"", xml_text(name));
    fmt::format_to(out, " priority=\"1\" numLanes=\"{}\" speed=\"{}\" shape=\"{}\">\n",
                   edge.lanes.size(), number(speed),
                   shape_text(road_map, edge_line(line_of(road_map, edge.lanes.back(), middle,
                                                          edge.from_share, edge.to_share))));
    for (std::uint32_t lane = 0; lane < edge.lanes.size(); ++lane) {
      add_lane(road_map, net, edge, lane, leading.contains({i, lane}), lines.of(i, lane), text);
    }
    text += "</edge>\n";
  }
  return text + "</edges>\n";
}

std::string connections_text(const RoadMap& road_map, const Net& net, const LaneLines& lines,
                             const std::vector<TrafficLight>& lights,
                             const std::vector<Prohibition>& prohibitions) {
  std::set<std::uint32_t> lit, switched;
  for (const TrafficLight& light : lights) {
    lit.insert(light.node);
    switched.insert(light.connections.begin(), light.connections.end());
  }
  const std::vector<geometry::Ring> shapes = junction_shapes(road_map, net);
  std::string text = "<connections>\n";
  const auto out = std::back_inserter(text);
  std::set<std::uint32_t> leading;
  for (std::uint32_t i = 0; i < net.connections.size(); ++i) {
    const NetConnection& connection = net.connections[i];
    const NetEdge &from = net.edges[connection.from], &to = net.edges[connection.to];
    leading.insert(connection.from);
    const Points path = lines.of(connection);
    fmt::format_to(out,
                   "<connection from=\"{}\" to=\"{}\" fromLane=\"{}\" toLane=\"{}\" speed=\"{}\"",
                   from.id, to.id, connection.from_lane, connection.to_lane,
                   number(connection_speed_mps(road_map, net, connection, path)));
    const Participants users = both(users_of(road_map.lane(net.from_lane(connection).lane)),
                                    users_of(road_map.lane(net.to_lane(connection).lane)));
    if (both(users, connection.users) != users) {
      fmt::format_to(out, " allow=\"{}\"", vehicle_classes(both(users, connection.users)));
    }
    if (lit.contains(from.to) && !switched.contains(i)) text += " uncontrolled=\"1\"";
    const bool is_drawn = !connection.across.empty() && !connection.has_change;
    if (is_drawn && keeps_ends(lines, connection, shapes[from.to])) {
      fmt::format_to(out, " shape=\"{}\"", shape_text(road_map, path));
    }
    text += "/>\n";
  }
  for (std::uint32_t edge = 0; edge < net.edges.size(); ++edge) {
    if (leading.contains(edge)) continue;
    fmt::format_to(out, "<connection from=\"{}\"/>\n", net.edges[edge].id);  // a dead end
  }
  for (const Prohibition& one : prohibitions) {
    fmt::format_to(out, "<prohibition prohibitor=\"{}->{}\" prohibited=\"{}->{}\"/>\n",
                   net.edges[one.first_from].id, net.edges[one.first_to].id,
                   net.edges[one.then_from].id, net.edges[one.then_to].id);
  }
  return text + "</connections>\n";
}

std::string traffic_lights_text(const RoadMap& road_map, const Net& net,
                                const std::vector<TrafficLight>& lights) {
  std::string text = "<tlLogics>\n";
  const auto out = std::back_inserter(text);
  for (const TrafficLight& light : lights) {
    fmt::format_to(out, "<tlLogic id=\"{}\" type=\"static\" programID=\"0\" offset=\"0\">\n",
                   net.nodes[light.node].id);
    for (const LightPhase& phase : light.phases) {
      fmt::format_to(out, "<phase duration=\"{}\" state=\"{}\"/>\n", phase.duration_s, phase.state);
    }
    for (std::size_t link = 0; link < light.signals.size(); ++link) {
      std::string signals;
      for (const std::size_t signal : light.signals[link]) {
        if (!signals.empty()) signals += ' ';
        signals += road_map.signals().at(signal).source_id;
      }
      fmt::format_to(out, "<param key=\"linkSignalID:{}\" value=\"{}\"/>\n", link,
                     xml_text(signals));
    }
    text += "</tlLogic>\n";
  }
  for (const TrafficLight& light : lights) {
    for (std::size_t link = 0; link < light.connections.size(); ++link) {
      const NetConnection& connection = net.connections[light.connections[link]];
      fmt::format_to(out,
                     "<connection from=\"{}\" to=\"{}\" fromLane=\"{}\" toLane=\"{}\" tl=\"{}\" "
                     "linkIndex=\"{}\"/>\n",
                     net.edges[connection.from].id, net.edges[connection.to].id,
                     connection.from_lane, connection.to_lane, net.nodes[light.node].id, link);
    }
  }
  return text + "</tlLogics>\n";
}

}  // namespace roadbed::map::sumo
