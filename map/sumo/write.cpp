#include "roadbed/map/sumo/write.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "roadbed/map/derived/conflicts.h"
#include "roadbed/map/derived/crossings.h"
#include "roadbed/map/files/projection.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/map/sumo/lane_users.h"
#include "roadbed/map/sumo/net_text.h"

namespace roadbed::map::sumo {
namespace {

constexpr const char* kDeclaration = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";

// Where the net's coordinates are in its system; "!" stands for none.
std::string location_text(const RoadMap& road_map, const Net& net, const SumoOptions& options) {
  Eigen::Vector2d low(1e300, 1e300), high(-1e300, -1e300);
  for (const NetNode& node : net.nodes) {
    const Eigen::Vector2d at = road_map.to_source(node.in_map.head<2>());
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  if (net.nodes.empty()) low = high = Eigen::Vector2d::Zero();
  const CrsOffset& offset = options.offset_in_crs;
  const bool has_system = !options.crs.empty() && offset.heading_rad == 0.0;
  const auto number = [](double value) { return fmt::format("{:.2f}", value + 0.0); };
  return fmt::format(
      "<location netOffset=\"{},{}\" convBoundary=\"{},{},{},{}\" "
      "origBoundary=\"-10000000000.00,-10000000000.00,10000000000.00,10000000000.00\" "
      "projParameter=\"{}\"/>\n",
      number(has_system ? 0.0 - offset.x_m : 0.0), number(has_system ? 0.0 - offset.y_m : 0.0),
      number(low.x()), number(low.y()), number(high.x()), number(high.y()),
      has_system ? xml_text(proj_string(options.crs)) : "!");
}

std::string configuration_text(const std::string& name, bool left_hand) {
  std::string text = std::string(kDeclaration) + "<configuration>\n<input>\n";
  for (const auto& [option, suffix] :
       {std::pair{"node", "nod"}, {"edge", "edg"}, {"connection", "con"}, {"tllogic", "tll"}}) {
    text += fmt::format("<{}-files value=\"{}.{}.xml\"/>\n", option, xml_text(name), suffix);
  }
  text += fmt::format(
      "</input>\n<output><output-file value=\"{}.net.xml\"/>"
      "<precision value=\"3\"/></output>\n<processing>"
      "<offset.disable-normalization value=\"true\"/>"
      // Heights are those of the map, however steep.
      "<geometry.max-grade value=\"1000\"/>",
      xml_text(name));
  if (left_hand) text += "<lefthand value=\"true\"/>";
  // Of the programs that netconvert looks at before it takes ours.
  return text +
         "</processing>\n<tls_building><tls.layout value=\"incoming\"/></tls_building>\n"
         "</configuration>\n";
}

class LossCounter {
 public:
  LossCounter(const RoadMap& road_map, const DirectedLanes& ways, const Net& net,
              const std::vector<TrafficLight>& lights)
      : road_map_(road_map), ways_(ways), net_(net) {
    for (const TrafficLight& light : lights) {
      for (const auto& signals : light.signals) used_.insert(signals.begin(), signals.end());
    }
  }

  std::vector<std::pair<std::string, std::size_t>> count() {
    count_lanes();
    std::size_t lights = 0, signs = 0;
    for (std::size_t i = 0; i < road_map_.signals().size(); ++i) {
      const bool is_light = road_map_.signals().at(i).dynamic;
      if (!is_light) ++signs;
      if (is_light && !used_.contains(i)) ++lights;
    }
    lose("signs", signs);
    lose("traffic lights that speak to no connection", lights);
    lose("stop lines", road_map_.stop_lines().size());
    lose("objects", road_map_.objects().size());
    lose("areas", road_map_.areas().size());
    lose("regulations but for right of way and traffic lights", regulations());
    return std::move(lost_);
  }

 private:
  void lose(const std::string& what, std::size_t count) {
    if (count > 0) lost_.emplace_back(what, count);
  }

  void count_lanes() {
    std::set<LaneId> written;
    for (const NetEdge& edge : net_.edges) {
      for (const DirectedLane way : edge.lanes) written.insert(way.lane);
    }
    for (const NetConnection& connection : net_.connections) {
      for (const DirectedLane way : connection.across) written.insert(way.lane);
    }
    std::map<std::string, std::size_t> others;
    std::size_t crosswalks = 0, unused = 0, slivers = 0, slowing = 0;
    for (const Lane& lane : road_map_.lanes()) {
      if (written.contains(lane.id)) {
        slowing += lane.speed_limits.size() > 1 ? 1 : 0;
      } else if (is_crosswalk(lane)) {
        ++crosswalks;
      } else if (users_of(lane).empty()) {
        ++others[std::string(to_string(lane.type))];
      } else if (ways_.has({lane.id, false})) {
        ++unused;
      } else {
        ++slivers;
      }
    }
    lose("crosswalks", crosswalks);
    for (const auto& [type, number] : others) lose("lanes of type " + type, number);
    lose("lanes without length or width", slivers);
    lose("lanes in junctions beside a shorter way", unused);
    lose("changes of the speed limit along a lane, which has the least", slowing);
  }

  std::size_t regulations() const {
    std::size_t count = 0;
    for (const Regulation& one : road_map_.regulations()) {
      const bool is_said = one.type == "right_of_way" || one.type == "traffic_light" ||
                           one.type == "speed_limit" || one.type == "intersection";
      count += is_said ? 0 : 1;
    }
    return count;
  }

  const RoadMap& road_map_;
  const DirectedLanes& ways_;
  const Net& net_;
  std::set<std::size_t> used_;
  std::vector<std::pair<std::string, std::size_t>> lost_;
};

}  // namespace

SumoFiles write_sumo(const RoadMap& road_map, const SumoOptions& options) {
  const DirectedLanes ways(road_map);
  const std::vector<Conflict> conflicts = find_conflicts(road_map);
  const Net net = build_net(road_map, ways, conflicts);
  const LaneLines lines(road_map, net);
  const ConnectionConflicts meeting(net, conflicts);
  const std::vector<TrafficLight> lights = make_traffic_lights(road_map, net, meeting);
  const std::vector<Prohibition> prohibitions = find_prohibitions(road_map, net, lines, meeting);
  SumoFiles files;
  files.nodes =
      kDeclaration + nodes_text(road_map, net, lights, location_text(road_map, net, options));
  files.edges = kDeclaration + edges_text(road_map, net, lines);
  files.connections = kDeclaration + connections_text(road_map, net, lines, lights, prohibitions);
  files.traffic_lights = kDeclaration + traffic_lights_text(road_map, net, lights);
  files.configuration = configuration_text(options.name, net.left_hand);
  files.lost = LossCounter(road_map, ways, net, lights).count();
  if (options.offset_in_crs.heading_rad != 0.0) {
    files.notes.emplace_back(
        "the net has no coordinate system: the map is turned in its own, which SUMO cannot say");
  }
  return files;
}

}  // namespace roadbed::map::sumo
