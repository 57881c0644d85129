// Every issue about lanelets and intersections: silent on a map that is as Autoware asks for it,
// and speaking up on the right element where one thing is wrong.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "roadbed/map/lanelet2/autoware/rules.h"
#include "roadbed/map/validate_file.h"
#include "roadbed/tests/support/autoware_cases.h"
#include "roadbed/tests/support/autoware_town.h"

namespace roadbed::tests {
namespace {

using Map = MadeVectorMap;

TEST(AutowareIssues, OfIntersectionAreasAreFound) {
  const std::string tagging = "Intersection.IntersectionAreaTagging-00";
  expect_each_issue_is_found({
      {"Intersection.IntersectionAreaDanglingReference-001", "lane 110",
       [](Map& map) { map.relations[110].tags["intersection_area"] = "77"; }},
      {"Intersection.IntersectionAreaSegmentType-001", "way 500",
       [](Map& map) { map.ways[550].tags["type"] = "line_thin"; }},
      {tagging + "1", "lane 110",
       [](Map& map) { map.relations[110].tags.erase("intersection_area"); }},
      {tagging + "2", "lane 110",
       [](Map& map) { map.relations[110].tags["intersection_area"] = "501"; }},
      {tagging + "3", "lane 101",
       [](Map& map) { map.relations[101].tags["intersection_area"] = "500"; }},
      {tagging + "4", "lane 101",
       [](Map& map) { map.relations[101].tags["turn_direction"] = "left"; }},
      {"Intersection.IntersectionAreaValidity-001", "way 500",
       [](Map& map) { std::swap(map.ways[500].nodes[1], map.ways[500].nodes[2]); }},
      {"Intersection.LaneletDivision-001", "lane 131",
       [](Map& map) { map.relations[133].tags["intersection_area"] = "502"; }},
      {"Intersection.TurnDirectionTagging-001", "lane 110",
       [](Map& map) { map.relations[110].tags.erase("turn_direction"); }},
      {"Intersection.TurnDirectionTagging-002", "lane 110",
       [](Map& map) { map.relations[110].tags["turn_direction"] = "back"; }},
      {"Intersection.TurnSignalDistanceOverlap-001", "lane 182",
       [](Map& map) { map.relations[182].tags["turn_signal_distance"] = "16.5"; }},
      {"Intersection.VirtualBorderType-001", "lane 110",
       [](Map& map) { map.ways[map.border(110, "right")].tags["type"] = "line_thin"; }},
  });
}

TEST(AutowareIssues, OfRightsOfWayAreFound) {
  const std::string lights = "Intersection.RightOfWayWithTrafficLights-00";
  const std::string virtual_lights = "Intersection.RightOfWayForVirtualTrafficLights-00";
  const std::string none = "Intersection.RightOfWayWithoutTrafficLights-00";
  const auto drop_element = [](Map& map, Map::Id lanelet, Map::Id element) {
    std::erase_if(map.relations[lanelet].members,
                  [&](const Map::Member& member) { return member.id == element; });
  };
  // A lanelet that covers 1 dm² of one that leads to the east and ends there.
  const auto add_slight_conflict = [](Map& map, double x_m) {
    map.northwards(904, {x_m - 0.1, x_m + 3}, {3.4, 20}, road_tags());
  };
  expect_each_issue_is_found({
      {lights + "1", "lane 120", [&](Map& map) { drop_element(map, 120, 612); }},
      {lights + "2", "lane 120",
       [](Map& map) {
         map.regulation(905, "right_of_way", {{"relation", 120, "right_of_way"}}, {120});
       }},
      {lights + "3", "regulation 612", [](Map& map) { map.relations[612].members[0].id = 110; }},
      {lights + "4", "regulation 612", [](Map& map) { map.relations[612].drop("yield"); }},
      {lights + "5", "regulation 612",
       [](Map& map) {
         map.relations[612].members.push_back({"relation", 111, "yield"});
       }},
      {lights + "6", "regulation 612", [&](Map& map) { add_slight_conflict(map, 220); }},
      {virtual_lights + "1", "lane 131", [&](Map& map) { drop_element(map, 131, 621); }},
      {virtual_lights + "2", "lane 131",
       [](Map& map) {
         map.regulation(905, "right_of_way", {{"relation", 131, "right_of_way"}}, {131});
       }},
      {virtual_lights + "3", "regulation 621",
       [](Map& map) {
         map.relations[621].members.push_back({"relation", 110, "right_of_way"});
       }},
      {virtual_lights + "4", "regulation 621",
       [](Map& map) { map.relations[621].members[0].id = 110; }},
      {virtual_lights + "5", "regulation 621", [](Map& map) { map.relations[621].drop("yield"); }},
      {virtual_lights + "6", "regulation 621",
       [](Map& map) {
         map.relations[621].members.push_back({"relation", 111, "yield"});
       }},
      {virtual_lights + "7", "regulation 621", [&](Map& map) { add_slight_conflict(map, 420); }},
      {none + "1", "regulation 600", [](Map& map) { map.relations[600].drop("right_of_way"); }},
      {none + "2", "regulation 600", [](Map& map) { map.relations[600].members[0].id = 131; }},
      {none + "3", "regulation 600", [](Map& map) { map.relations[600].drop("yield"); }},
      {none + "4", "regulation 600",
       [](Map& map) {
         map.relations[600].members.push_back({"relation", 121, "yield"});
       }},
      {none + "5", "way 500", [&](Map& map) { drop_element(map, 110, 600); }},
      {none + "6", "regulation 600", [&](Map& map) { add_slight_conflict(map, 60); }},
  });
}

TEST(AutowareIssues, OfVirtualLightsAreFound) {
  const std::string details = "Intersection.RegulatoryElementDetailsForVirtualTrafficLights-00";
  const std::string order = "Intersection.VirtualTrafficLightLineOrder-00";
  const auto move = [](Map& map, Map::Id line, double x_m, double y_m) {
    map.ways[line].nodes = {map.node(x_m, y_m + 3.3), map.node(x_m, y_m)};
  };
  expect_each_issue_is_found({
      {details + "1", "way 730", [](Map& map) { map.ways[730].tags["type"] = "line_thin"; }},
      {details + "2", "regulation 620",
       [](Map& map) {
         map.relations[620].members.push_back({"way", 750, "ref_line"});
       }},
      {details + "3", "way 731", [](Map& map) { map.ways[731].tags["type"] = "line_thin"; }},
      {details + "4", "way 732", [](Map& map) { map.ways[732].tags["type"] = "line_thin"; }},
      {details + "5", "regulation 620", [](Map& map) { map.relations[620].drop("refers"); }},
      {details + "6", "way 733", [](Map& map) { map.ways[733].tags["type"] = "line_thin"; }},
      {details + "7", "regulation 620", [&](Map& map) { move(map, 733, 900, 0); }},
      {order + "1", "way 730", [&](Map& map) { move(map, 730, 385, 50); }},
      {order + "2", "regulation 620", [&](Map& map) { move(map, 732, 430, 0.1); }},
      {order + "3", "way 730", [&](Map& map) { move(map, 730, 402, 0.1); }},
      {order + "4", "regulation 620", [&](Map& map) { move(map, 730, 430, 0.1); }},
      {order + "5", "way 731", [&](Map& map) { move(map, 731, 395, 20); }},
      {order + "6", "regulation 620", [&](Map& map) { move(map, 731, 383, 0.1); }},
      {"Intersection.VirtualTrafficLightSectionOverlap-001", "regulation 906",
       [&](Map& map) {
         map.line(907, {{410, 3.4}, {410, 0.1}}, {{"type", "virtual"}});
         map.line(908, {{418, 3.4}, {418, 0.1}}, {{"type", "stop_line"}});
         map.line(909, {{430, 3.4}, {430, 0.1}}, {{"type", "virtual"}});
         map.regulation(906, "virtual_traffic_light",
                        {{"way", 907, "start_line"},
                         {"way", 908, "ref_line"},
                         {"way", 909, "end_line"},
                         {"way", 733, "refers"}},
                        {133});
       }},
  });
}

TEST(AutowareIssues, OfLaneletsAreFound) {
  expect_each_issue_is_found({
      {"Lane.BorderSharing-001", "lane 101",
       [](Map& map) {
         map.lanelet(101, map.border(101, "left"),
                     map.line(910, {{0, 3.55}, {40, 3.55}}, {{"type", "line_thin"}}), road_tags());
       }},
      {"Lane.BorderSharing-002", "lane 161",
       [](Map& map) {
         map.eastwards(911, {800, 820}, {13.51, 17}, road_tags());
         map.eastwards(912, {820, 840}, {13.51, 17}, road_tags());
       }},
      {"Lane.CenterlineGeometry-001", "way 780",
       [](Map& map) { map.ways[780].nodes.back() = map.node(839, 1.75); }},
      {"Lane.CenterlineGeometry-002", "way 780",
       [](Map& map) { map.ways[780].nodes[1] = map.node(820, 4); }},
      {"Lane.CenterlineGeometry-003", "way 780",
       [](Map& map) { map.ways[780].nodes[1] = map.node(820, 2, 0.2); }},
      {"Lane.LaneChangeAttribute-001", "way 200000",
       [](Map& map) { map.ways[map.border(100, "left")].tags.erase("lane_change"); }},
      {"Lane.LaneChangeAttribute-002", "way 200000",
       [](Map& map) { map.ways[map.border(100, "left")].tags["lane_change"] = "maybe"; }},
      {"Lane.LaneletGeometry-001", "lane 161",
       [](Map& map) {
         map.ways[map.border(161, "left")].nodes.back() =
             map.ways[map.border(161, "right")].nodes.back();
       }},
      {"Lane.LateralSubtypeConnection-001", "lane 100",
       [](Map& map) { map.relations[102].tags["subtype"] = "walkway"; }},
      {"Lane.LocalCoordinatesDeclaration-001", "node 100000",
       [](Map& map) { map.nodes[100000].has_x = map.nodes[100000].has_y = false; }},
      {"Lane.LocalCoordinatesDeclaration-002", "node 100000",
       [](Map& map) { map.nodes[100000].has_y = false; }},
      {"Lane.LocalCoordinatesDeclaration-003", "node 100000",
       [](Map& map) { map.nodes[100000].has_x = false; }},
      {"Lane.LongitudinalSubtypeConnection-001", "lane 142",
       [](Map& map) {
         map.northwards(913, {120, 122}, {8.5, 12},
                        {{"subtype", "walkway"}, {"participant:pedestrian", "yes"}});
       }},
      {"Lane.LongitudinalSubtypeConnection-002", "lane 180",
       [](Map& map) { map.relations[181].tags["subtype"] = "road_shoulder"; }},
      {"Lane.PedestrianLane-001", "lane 161",
       [](Map& map) { map.relations[161].tags["subtype"] = "pedestrian_lane"; }},
      {"Lane.PedestrianLane-002", "lane 103",
       [](Map& map) { map.relations[101].tags["subtype"] = "road_shoulder"; }},
      {"Lane.PedestrianLane-003", "way 200004",
       [](Map& map) { map.ways[map.border(103, "left")].tags["type"] = "line_thin"; }},
      {"Lane.RoadLaneletAttribute-001", "lane 100",
       [](Map& map) { map.relations[100].tags["location"] = "rural"; }},
      {"Lane.RoadLaneletAttribute-002", "lane 100",
       [](Map& map) { map.relations[100].tags["one_way"] = "no"; }},
      {"Lane.RoadShoulder-001", "lane 161",
       [](Map& map) { map.relations[161].tags["subtype"] = "road_shoulder"; }},
      {"Lane.RoadShoulder-002", "lane 102",
       [](Map& map) { map.relations[100].tags["subtype"] = "pedestrian_lane"; }},
      {"Lane.RoadShoulder-003", "way 200003",
       [](Map& map) { map.ways[map.border(102, "right")].tags["type"] = "line_thin"; }},
      {"Lane.SpeedLimitValidity-001", "lane 100",
       [](Map& map) { map.relations[100].tags["speed_limit"] = "30 km/h"; }},
      {"Lane.SpeedLimitValidity-002", "lane 100",
       [](Map& map) { map.relations[100].tags["speed_limit"] = "60"; }},
      {"Lane.WalkwayIntersection-001", "lane 142",
       [](Map& map) { map.relations[141].tags["subtype"] = "road_shoulder"; }},
      {"Lane.WalkwayIntersection-002", "lane 142",
       [](Map& map) {
         map.northwards(142, {120, 122}, {-2.9, 8.5},
                        {{"subtype", "walkway"}, {"participant:pedestrian", "yes"}});
       }},
  });
}

TEST(AutowareRules, HaveAName) {
  std::set<std::string_view> names;
  for (const auto& rule : map::lanelet2::autoware::rules()) {
    EXPECT_TRUE(rule.info.id.starts_with("autoware.")) << rule.info.id;
    EXPECT_TRUE(names.insert(rule.info.autoware_rule).second) << rule.info.autoware_rule;
  }
  EXPECT_EQ(names.size(), 42u);
}

TEST(AutowareRules, DoTheirWorkWithoutAnyPlace) {
  Map town = autoware_town();
  town.relations[100].tags["location"] = "rural";
  for (auto& [id, node] : town.nodes) node.has_x = node.has_y = false;
  const auto findings = autoware_findings(town);
  EXPECT_TRUE(std::ranges::any_of(findings, [](const auto& finding) {
    return finding.autoware_issue == "Lane.RoadLaneletAttribute-001" &&
           finding.element == "lane 100" && !finding.in_map;
  }));
}

TEST(AutowareRules, PassOverLaneletsOnAnotherLevel) {
  // The crossing lanelet 111 as a bridge does not meet 110, so that it need not yield.
  Map town = autoware_town();
  const Map::Id left = town.border(111, "left"), right = town.border(111, "right");
  for (const Map::Id way : {left, right}) {
    for (Map::Id& node : town.ways[way].nodes) {
      node = town.node(town.nodes[node].x_m, town.nodes[node].y_m, 6.0);
    }
  }
  const auto findings = autoware_findings(town);
  EXPECT_TRUE(std::ranges::any_of(findings, [](const auto& finding) {
    return finding.autoware_issue == "Intersection.RightOfWayWithoutTrafficLights-004";
  }));
}

}  // namespace
}  // namespace roadbed::tests
