// Every issue about areas, crosswalks, stop lines and traffic lights: silent on a map that is as
// Autoware asks for it, and speaking up on the right element where one thing is wrong.

#include <gtest/gtest.h>

#include "roadbed/tests/support/autoware_cases.h"
#include "roadbed/tests/support/autoware_town.h"

namespace roadbed::tests {
namespace {

using Map = MadeVectorMap;

TEST(AutowareIssues, AreNoneWhereAllIsAsAutowareAsks) {
  for (const auto& finding : autoware_findings(autoware_town())) {
    ADD_FAILURE() << finding.autoware_issue << ": " << finding.element << ": " << finding.message;
  }
}

TEST(AutowareIssues, OfAreasAreFound) {
  expect_each_issue_is_found({
      {"Area.BufferZoneValidity-001", "way 763",
       [](Map& map) { map.ways[763].nodes[2] = map.node(620, -3); }},
      {"Area.BufferZoneValidity-002", "way 763",
       [](Map& map) { std::swap(map.ways[763].nodes[1], map.ways[763].nodes[2]); }},
      {"Area.BufferZoneValidity-003", "way 763",
       [](Map& map) { map.ways[763].nodes[1] = map.node(640, 3.5); }},
      {"Area.DetectionArea-001", "way 760",
       [](Map& map) { map.relations[640].tags["subtype"] = "something"; }},
      {"Area.DetectionArea-002", "regulation 640",
       [](Map& map) {
         map.relations[640].members.push_back({"way", 761, "refers"});
       }},
      {"Area.DetectionArea-003", "regulation 640",
       [](Map& map) { map.relations[640].members[0].id = 761; }},
      {"Area.DetectionArea-004", "regulation 640",
       [](Map& map) { map.relations[640].drop("ref_line"); }},
      {"Area.DetectionArea-005", "regulation 640",
       [](Map& map) { map.relations[150].drop("regulatory_element"); }},
      {"Area.DetectionArea-006", "regulation 640",
       [](Map& map) {
         map.relations[102].members.push_back({"relation", 640, "regulatory_element"});
       }},
      {"Area.MissingRegulatoryElementsForBusStopAreas-001", "way 762",
       [](Map& map) { map.relations[642].drop("refers"); }},
      {"Area.NoStoppingArea-001", "way 761",
       [](Map& map) { map.relations[641].tags["subtype"] = "something"; }},
      {"Area.NoStoppingArea-002", "regulation 641",
       [](Map& map) { map.relations[641].drop("refers"); }},
      {"Area.NoStoppingArea-003", "regulation 641",
       [](Map& map) { map.relations[641].members[0].id = 760; }},
      {"Area.NoStoppingArea-004", "regulation 641",
       [](Map& map) {
         map.relations[641].members.push_back({"way", 751, "ref_line"});
       }},
      {"Area.NoStoppingArea-005", "regulation 641",
       [](Map& map) { map.relations[641].members[1].id = 770; }},
      {"Area.NoStoppingArea-006", "regulation 641",
       [](Map& map) { map.relations[150].drop("regulatory_element"); }},
      {"Area.NoStoppingArea-007", "regulation 641",
       [](Map& map) { map.relations[150].tags["subtype"] = "road_shoulder"; }},
  });
}

TEST(AutowareIssues, OfCrosswalksAreFound) {
  const std::string details = "Crosswalk.RegulatoryElementDetails-0";
  expect_each_issue_is_found({
      {"Crosswalk.MissingRegulatoryElements-001", "lane 140",
       [](Map& map) { map.relations[630].tags["subtype"] = "something"; }},
      {details + "01", "regulation 630", [](Map& map) { map.relations[630].drop("refers"); }},
      {details + "02", "regulation 630",
       [](Map& map) {
         map.relations[630].members.push_back({"relation", 142, "refers"});
       }},
      {details + "03", "regulation 630", [](Map& map) { map.relations[630].drop("ref_line"); }},
      {details + "04", "regulation 630", [](Map&) {}},
      {details + "05", "regulation 630",
       [](Map& map) {
         for (const MadeVectorMap::Id id : {760, 761}) {
           map.relations[630].members.push_back({"way", id, "crosswalk_polygon"});
         }
       }},
      {details + "06", "lane 140",
       [](Map& map) { map.relations[140].tags["subtype"] = "walkway"; }},
      {details + "07", "way 740", [](Map& map) { map.ways[740].tags["type"] = "line_thin"; }},
      {details + "08", "way 760",
       [](Map& map) {
         map.relations[630].members.push_back({"way", 760, "crosswalk_polygon"});
       }},
      {details + "09", "regulation 630",
       [](Map& map) {
         map.relations[630].members.push_back({"way", 750, "ref_line"});
       }},
      {details + "10", "lane 140",
       [](Map& map) { map.relations[140].tags.erase("participant:pedestrian"); }},
      {details + "11", "lane 140",
       [](Map& map) { map.relations[140].tags["participant:pedestrian"] = "no"; }},
      {details + "12", "regulation 630",
       [](Map& map) {
         map.relations[100].members.push_back({"relation", 630, "regulatory_element"});
       }},
      {details + "13", "regulation 630", [](Map& map) { map.relations[630].members[1].id = 750; }},
      {"Crosswalk.SafetyAttributes-001", "lane 140",
       [](Map& map) { map.relations[140].tags["safety_slow_down_speed"] = "-10"; }},
      {"Crosswalk.SafetyAttributes-002", "lane 140",
       [](Map& map) { map.relations[140].tags["safety_slow_down_distance"] = "near"; }},
  });
}

TEST(AutowareIssues, OfStopLinesAreFound) {
  const std::string signs = "StopLine.RegulatoryElementDetailsForTrafficSigns-00";
  expect_each_issue_is_found({
      {"StopLine.MissingRegulatoryElements-001", "way 740",
       [](Map& map) { map.relations[630].drop("ref_line"); }},
      {signs + "1", "regulation 643", [](Map& map) { map.relations[643].drop("refers"); }},
      {signs + "2", "way 770", [](Map& map) { map.ways[770].tags["subtype"] = "speed_limit"; }},
      {signs + "3", "regulation 643", [](Map& map) { map.relations[643].drop("ref_line"); }},
      {signs + "4", "way 750", [](Map& map) { map.ways[750].tags["subtype"] = "solid"; }},
      {signs + "5", "regulation 643", [](Map& map) { map.ways[770].nodes[0] = map.node(900, 5); }},
      {"Intersection.RoadMarkings-001", "regulation 644",
       [](Map& map) { map.relations[644].members[0].role = "ref_line"; }},
      {"Intersection.RoadMarkings-002", "way 751",
       [](Map& map) { map.ways[751].tags["type"] = "line_thin"; }},
  });
}

TEST(AutowareIssues, OfTrafficLightsAreFound) {
  const std::string details = "TrafficLight.RegulatoryElementDetails-00";
  expect_each_issue_is_found({
      {"TrafficLight.BodyHeight-001", "way 700",
       [](Map& map) { map.ways[700].tags.erase("height"); }},
      {"TrafficLight.BodyHeight-002", "way 700",
       [](Map& map) { map.ways[700].tags["height"] = "3"; }},
      {"TrafficLight.CorrectFacing-001", "way 700",
       [](Map& map) {
         map.relations[111].members.push_back({"relation", 610, "regulatory_element"});
       }},
      {"TrafficLight.CorrectFacing-002", "way 700",
       [](Map& map) { std::swap(map.ways[700].nodes[0], map.ways[700].nodes[1]); }},
      {"TrafficLight.CorrectFacing-003", "way 700",
       [](Map& map) {
         // Seen from a lanelet that leads to the west, too.
         map.lanelet(900, map.line(901, {{260, 0}, {240, 0}}, {{"type", "virtual"}}),
                     map.line(902, {{260, 3.5}, {240, 3.5}}, {{"type", "virtual"}}), road_tags());
         map.regulation(903, "traffic_light", map.relations[610].members, {900});
       }},
      {"TrafficLight.LightBulbTagging-001", "node " + std::to_string(0),
       [](Map& map) {
         Map::Node bulb = map.nodes[map.ways[710].nodes[0]];
         bulb.tags.erase("color");
         map.nodes[0] = bulb;
         map.ways[710].nodes[0] = 0;
       }},
      {"TrafficLight.LightBulbTagging-002", "node 0",
       [](Map& map) {
         Map::Node bulb = map.nodes[map.ways[710].nodes[0]];
         bulb.tags["color"] = "blue";
         map.nodes[0] = bulb;
         map.ways[710].nodes[0] = 0;
       }},
      {"TrafficLight.LightBulbTagging-003", "node 0",
       [](Map& map) {
         Map::Node bulb = map.nodes[map.ways[710].nodes[0]];
         bulb.tags["arrow"] = "straight";
         map.nodes[0] = bulb;
         map.ways[710].nodes[0] = 0;
       }},
      {"TrafficLight.MissingReferrers-001", "regulation 610",
       [](Map& map) { map.relations[120].drop("regulatory_element"); }},
      {"TrafficLight.MissingRegulatoryElements-001", "way 700",
       [](Map& map) { map.relations[610].drop("refers"); }},
      {details + "1", "regulation 610", [](Map& map) { map.relations[610].drop("ref_line"); }},
      {details + "2", "way 700", [](Map& map) { map.ways[700].tags["type"] = "line_thin"; }},
      {details + "3", "way 720", [](Map& map) { map.ways[720].tags["type"] = "line_thin"; }},
      {details + "4", "way 710", [](Map& map) { map.ways[710].tags["type"] = "line_thin"; }},
      {details + "5", "way 710", [](Map& map) { map.ways[710].tags.erase("traffic_light_id"); }},
      {details + "6", "regulation 610", [](Map& map) { map.relations[610].drop("light_bulbs"); }},
      {details + "7", "regulation 610",
       [](Map& map) { map.ways[710].tags["traffic_light_id"] = "701"; }},
      {details + "8", "regulation 610",
       [](Map& map) {
         map.ways[700].nodes = {map.node(400, 30), map.node(400, 28)};
       }},
  });
}

}  // namespace
}  // namespace roadbed::tests
