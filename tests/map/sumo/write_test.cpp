#include "roadbed/map/sumo/write.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "roadbed/map/derived/conflicts.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/sumo/traffic_lights.h"
#include "roadbed/tests/support/mirrored_map.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map::sumo {
namespace {

RoadMap town() { return load_map(tests::data_folder() / "town.xodr"); }

TEST(WriteSumo, SameMapSameBytes) {
  const SumoFiles once = write_sumo(town(), {"a", "", {}}),
                  again = write_sumo(town(), {"a", "", {}});
  EXPECT_EQ(once.nodes, again.nodes);
  EXPECT_EQ(once.edges, again.edges);
  EXPECT_EQ(once.connections, again.connections);
  EXPECT_EQ(once.traffic_lights, again.traffic_lights);
  EXPECT_EQ(once.configuration, again.configuration);
}

// Every lane of an edge has the map's centreline, its name, and its least speed limit.
TEST(WriteSumo, LanesAreThoseOfTheMapInTheSourcesCoordinates) {
  for (const char* name : {"town.xodr", "crossing.osm"}) {
    const RoadMap road_map = load_map(tests::data_folder() / name);
    const XmlDocument edges(write_sumo(road_map, {"a", "", {}}).edges, "edges");
    int lanes = 0;
    for (const pugi::xml_node edge : edges.root().children("edge")) {
      for (const pugi::xml_node lane : edge.children("lane")) {
        const auto id = road_map.find_lane(lane.child("param").attribute("value").value());
        ASSERT_TRUE(id);
        const Lane& of_map = road_map.lane(*id);
        const std::string shape = std::string(lane.attribute("shape").value());
        double x = 0.0, y = 0.0;
        ASSERT_EQ(std::sscanf(shape.c_str(), "%lf,%lf", &x, &y), 2);
        const Eigen::Vector2d at = road_map.to_map({x, y});
        EXPECT_LT(std::abs(of_map.centre.in_map.project(at).d_m), 0.1) << of_map.name;
        const double speed = std::stod(std::string(lane.attribute("speed").value()));
        EXPECT_NEAR(speed, of_map.least_speed_limit_mps().value_or(50.0 / 3.6), 1e-3);
        ++lanes;
      }
    }
    EXPECT_GT(lanes, 5);
  }
}

TEST(WriteSumo, NoTwoLinksThatMeetAreGreenWithoutOneOfThemWaiting) {
  const RoadMap road_map = town();
  const DirectedLanes ways(road_map);
  const auto conflicts = find_conflicts(road_map);
  const Net net = build_net(road_map, ways, conflicts);
  const ConnectionConflicts meeting(net, conflicts);
  const auto lights = make_traffic_lights(road_map, net, meeting);
  ASSERT_FALSE(lights.empty());
  for (const TrafficLight& light : lights) {
    std::set<std::size_t> served;
    for (const LightPhase& phase : light.phases) {
      ASSERT_EQ(phase.state.size(), light.connections.size());
      EXPECT_GT(phase.duration_s, 0);
      for (std::size_t a = 0; a < phase.state.size(); ++a) {
        if (phase.state[a] == 'G' || phase.state[a] == 'g') served.insert(a);
        for (std::size_t b = 0; b < a; ++b) {
          if (phase.state[a] != 'G' || phase.state[b] != 'G') continue;
          EXPECT_FALSE(meeting.meet(light.connections[a], light.connections[b]));
        }
      }
    }
    EXPECT_EQ(served.size(), light.connections.size()) << "every link has its green";
    for (std::size_t i = 0; i < light.phases.size(); ++i) {
      const std::string& now = light.phases[i].state;
      const std::string& next = light.phases[(i + 1) % light.phases.size()].state;
      for (std::size_t link = 0; link < now.size(); ++link) {
        EXPECT_FALSE((now[link] == 'G' || now[link] == 'g') && next[link] == 'r') << "no yellow";
      }
    }
  }
}

// The map in a mirror. On which side of the reference line lanes lie is in their ids.
RoadMap mirror_image(const RoadMap& road_map) {
  RoadMapParts parts = road_map.parts();
  for (Lane& lane : parts.lanes) {
    std::string& id = lane.origin.source_id;
    if (lane.road) id = id.starts_with('-') ? id.substr(1) : "-" + id;
  }
  return tests::mirrored(std::move(parts));
}

std::string without_shapes(std::string text) {
  const std::string name = " shape=\"";
  for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos;) {
    text.erase(at, text.find('"', at + name.size()) + 1 - at);
  }
  return text;
}

Eigen::Vector2d first_point(const RoadMap& road_map, pugi::xml_node node) {
  double x = 0.0, y = 0.0;
  EXPECT_EQ(std::sscanf(std::string(node.attribute("shape").value()).c_str(), "%lf,%lf", &x, &y),
            2);
  return road_map.to_map({x, y});
}

// In a mirror SUMO's lanes have the same indices: in left-hand traffic 0 is the leftmost.
TEST(WriteSumo, LeftHandTrafficIsRightHandTrafficInAMirror) {
  for (const char* name : {"town.xodr", "crossing.osm", "motorway.xodr"}) {
    const RoadMap road_map = load_map(tests::data_folder() / name);
    const RoadMap mirror = mirror_image(road_map);
    const SumoFiles plain = write_sumo(road_map, {"a", "", {}});
    const SumoFiles mirrored = write_sumo(mirror, {"a", "", {}});
    EXPECT_EQ(plain.configuration.find("lefthand"), std::string::npos);
    EXPECT_NE(mirrored.configuration.find("<lefthand value=\"true\"/>"), std::string::npos);
    EXPECT_EQ(without_shapes(mirrored.edges), without_shapes(plain.edges));
    EXPECT_EQ(without_shapes(mirrored.connections), without_shapes(plain.connections));
    EXPECT_EQ(mirrored.traffic_lights, plain.traffic_lights);
    const XmlDocument one(plain.edges, "edges"), other(mirrored.edges, "edges");
    pugi::xml_node image = other.root().child("edge");
    for (const pugi::xml_node edge : one.root().children("edge")) {
      const Eigen::Vector2d at = first_point(road_map, edge);
      const Eigen::Vector2d seen = first_point(mirror, image);
      EXPECT_NEAR((Eigen::Vector2d(seen.x(), -seen.y()) - at).norm(), 0.0, 2e-3);
      image = image.next_sibling("edge");
    }
  }
}

TEST(WriteSumo, SaysWhatIsNotThere) {
  const RoadMap road_map = town();
  const SumoFiles files = write_sumo(road_map, {"a", "", {}});
  const auto lost = [&](const std::string& what) {
    for (const auto& [name, count] : files.lost) {
      if (name == what) return count;
    }
    return std::size_t{0};
  };
  const auto of_type = [&](LaneType type) {
    return static_cast<std::size_t>(
        std::count_if(road_map.lanes().begin(), road_map.lanes().end(),
                      [&](const Lane& lane) { return lane.type == type; }));
  };
  EXPECT_EQ(lost("lanes of type shoulder"), of_type(LaneType::shoulder));
  EXPECT_EQ(lost("lanes of type border"), of_type(LaneType::border));
  EXPECT_EQ(lost("lanes of type driving"), 0u);
  EXPECT_EQ(lost("signs"), 16u);
  EXPECT_EQ(lost("stop lines"), road_map.stop_lines().size());
}

TEST(WriteSumo, NamesTheSystemAndTheOffsetInIt) {
  const SumoFiles plain = write_sumo(town(), {"a", "", {}});
  EXPECT_NE(plain.nodes.find("netOffset=\"0.00,0.00\""), std::string::npos);
  EXPECT_NE(plain.nodes.find("projParameter=\"!\""), std::string::npos);
  const SumoFiles placed = write_sumo(town(), {"a", "EPSG:32632", {.x_m = 500000, .y_m = 5400000}});
  EXPECT_NE(placed.nodes.find("netOffset=\"-500000.00,-5400000.00\""), std::string::npos);
  EXPECT_NE(placed.nodes.find("projParameter=\"+proj=utm +zone=32 +datum=WGS84"),
            std::string::npos);
  EXPECT_TRUE(placed.notes.empty());
  const SumoFiles turned = write_sumo(town(), {"a", "EPSG:32632", {.heading_rad = 0.1}});
  EXPECT_NE(turned.nodes.find("projParameter=\"!\""), std::string::npos);
  EXPECT_EQ(turned.notes.size(), 1u);
}

}  // namespace
}  // namespace roadbed::map::sumo
