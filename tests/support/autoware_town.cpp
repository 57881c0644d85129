#include "roadbed/tests/support/autoware_town.h"

#include <string>

namespace roadbed::tests {
namespace {

using Id = MadeVectorMap::Id;
using Tags = MadeVectorMap::Tags;

Tags turn_tags(const std::string& direction, Id area) {
  return road_tags({{"turn_direction", direction}, {"intersection_area", std::to_string(area)}});
}

/// A box as an intersection area, with its corners on road borders.
void add_intersection_area(MadeVectorMap& map, Id id, std::pair<double, double> x_m,
                           std::pair<double, double> y_m) {
  map.line(id + 50, {{x_m.first, y_m.first}, {x_m.second, y_m.first}}, {{"type", "road_border"}});
  map.line(id + 60, {{x_m.first, y_m.second}, {x_m.second, y_m.second}}, {{"type", "road_border"}});
  map.area(id,
           {{x_m.first, y_m.first},
            {x_m.second, y_m.first},
            {x_m.second, y_m.second},
            {x_m.first, y_m.second}},
           {{"type", "intersection_area"}});
}

void add_street(MadeVectorMap& map) {
  map.eastwards(100, {0, 40}, {0, 3.5}, road_tags());
  map.eastwards(101, {0, 40}, {3.5, 7}, road_tags());
  map.eastwards(102, {0, 40}, {-1.5, 0}, {{"subtype", "road_shoulder"}, {"one_way", "yes"}});
  map.eastwards(103, {0, 40}, {7, 9}, {{"subtype", "pedestrian_lane"}, {"one_way", "yes"}});
  map.ways[map.border(100, "left")].tags["lane_change"] = "no";
  map.ways[map.border(102, "right")].tags["type"] = "road_border";
  map.ways[map.border(103, "left")].tags["type"] = "road_border";
}

void add_crossing(MadeVectorMap& map) {
  map.eastwards(110, {40, 60}, {0, 3.5}, turn_tags("straight", 500), "virtual");
  map.northwards(111, {48, 51.5}, {-10, 13.5}, turn_tags("straight", 500), "virtual");
  add_intersection_area(map, 500, {40, 60}, {-10, 13.5});
  map.regulation(600, "right_of_way",
                 {{"relation", 110, "right_of_way"}, {"relation", 111, "yield"}}, {110});
}

void add_light(MadeVectorMap& map, Id id, std::pair<double, double> left,
               std::pair<double, double> right) {
  map.line(id, {left, right},
           {{"type", "traffic_light"}, {"subtype", "red_yellow_green"}, {"height", "0.5"}});
}

void add_turn_with_lights(MadeVectorMap& map) {
  map.eastwards(120, {200, 220}, {0, 3.5}, turn_tags("left", 501), "virtual");
  map.northwards(121, {208, 211.5}, {-10, 13.5}, turn_tags("straight", 501), "virtual");
  add_intersection_area(map, 501, {200, 220}, {-10, 13.5});
  add_light(map, 700, {222, 3}, {222, 1});
  add_light(map, 701, {208, 16}, {211, 16});
  map.line(710, {{222, 3.5}, {222, 3.4}}, {{"type", "light_bulbs"}, {"traffic_light_id", "700"}});
  map.line(711, {{208, 17}, {211, 17}}, {{"type", "light_bulbs"}, {"traffic_light_id", "701"}});
  for (const Id bulbs : {710, 711}) {
    for (const Id bulb : map.ways[bulbs].nodes) map.nodes[bulb].tags["color"] = "red";
  }
  map.line(720, {{199, 3.5}, {199, 0}}, {{"type", "stop_line"}});
  map.line(721, {{208, -11}, {211.5, -11}}, {{"type", "stop_line"}});
  map.regulation(610, "traffic_light",
                 {{"way", 700, "refers"}, {"way", 710, "light_bulbs"}, {"way", 720, "ref_line"}},
                 {120});
  map.regulation(611, "traffic_light",
                 {{"way", 701, "refers"}, {"way", 711, "light_bulbs"}, {"way", 721, "ref_line"}},
                 {121});
  map.regulation(612, "right_of_way",
                 {{"relation", 120, "right_of_way"}, {"relation", 121, "yield"}}, {120});
}

void add_virtual_light(MadeVectorMap& map) {
  map.eastwards(130, {380, 400}, {0, 3.5}, road_tags());
  map.eastwards(131, {400, 420}, {0, 3.5}, turn_tags("straight", 502), "virtual");
  map.northwards(132, {408, 411.5}, {-10, 13.5}, turn_tags("straight", 502), "virtual");
  map.eastwards(133, {420, 440}, {0, 3.5}, road_tags());
  add_intersection_area(map, 502, {400, 420}, {-10, 13.5});
  map.line(730, {{385, 3.4}, {385, 0.1}}, {{"type", "virtual"}});
  map.line(731, {{395, 3.4}, {395, 0.1}}, {{"type", "stop_line"}});
  map.line(732, {{415, 3.4}, {415, 0.1}}, {{"type", "virtual"}});
  map.line(733, {{398, 6}, {399, 6}}, {{"type", "intersection_coordination"}});
  map.regulation(620, "virtual_traffic_light",
                 {{"way", 730, "start_line"},
                  {"way", 731, "ref_line"},
                  {"way", 732, "end_line"},
                  {"way", 733, "refers"}},
                 {131});
  map.regulation(621, "right_of_way",
                 {{"relation", 131, "right_of_way"}, {"relation", 132, "yield"}}, {131});
}

void add_crosswalk(MadeVectorMap& map) {
  map.eastwards(141, {90, 130}, {0, 3.5}, road_tags());
  map.northwards(140, {110, 113}, {-3, 6.5},
                 {{"subtype", "crosswalk"},
                  {"participant:pedestrian", "yes"},
                  {"safety_slow_down_speed", "10"},
                  {"safety_slow_down_distance", "5.5"}});
  map.northwards(142, {120, 122}, {-5, 8.5},
                 {{"subtype", "walkway"}, {"participant:pedestrian", "yes"}});
  map.line(740, {{107, 3.5}, {107, 0}}, {{"type", "stop_line"}});
  map.regulation(630, "crosswalk", {{"relation", 140, "refers"}, {"way", 740, "ref_line"}}, {141});
}

void add_areas(MadeVectorMap& map) {
  map.eastwards(150, {600, 640}, {0, 3.5}, road_tags());
  map.eastwards(151, {600, 640}, {-10, -6.5}, road_tags());
  map.line(750, {{638, 3.5}, {638, 0}}, {{"type", "stop_line"}, {"subtype", "stop_line"}});
  const auto box = [&](Id id, double x_m, const std::string& type) {
    map.area(id, {{x_m, 0.5}, {x_m + 3, 0.5}, {x_m + 3, 3}, {x_m, 3}}, {{"type", type}});
  };
  box(760, 605, "detection_area");
  box(761, 610, "no_stopping_area");
  box(762, 615, "bus_stop_area");
  map.regulation(640, "detection_area", {{"way", 760, "refers"}, {"way", 750, "ref_line"}}, {150});
  map.regulation(641, "no_stopping_area", {{"way", 761, "refers"}, {"way", 750, "ref_line"}},
                 {150});
  map.regulation(642, "bus_stop_area", {{"way", 762, "refers"}}, {150});
  map.area(763, {{600, 0}, {640, 0}, {640, -6.5}, {600, -6.5}},
           {{"type", "hatched_road_markings"}});
  map.line(770, {{639, 5}, {639, 4}}, {{"type", "traffic_sign"}, {"subtype", "stop_sign"}});
  map.regulation(643, "traffic_sign", {{"way", 770, "refers"}, {"way", 750, "ref_line"}}, {150});
  map.line(751, {{630, 3.5}, {630, 0}}, {{"type", "stop_line"}});
  map.regulation(644, "road_marking", {{"way", 751, "refers"}}, {150});
}

void add_turns(MadeVectorMap& map) {
  map.eastwards(180, {700, 710}, {0, 3.5}, turn_tags("right", 503), "virtual");
  map.eastwards(181, {710, 716}, {0, 3.5}, road_tags());
  map.eastwards(182, {716, 730}, {0, 3.5}, turn_tags("left", 504), "virtual");
  map.relations[182].tags["turn_signal_distance"] = "5";
  add_intersection_area(map, 503, {700, 710}, {-5, 8});
  add_intersection_area(map, 504, {716, 730}, {-5, 8});
  map.regulation(650, "right_of_way", {{"relation", 180, "right_of_way"}}, {180});
  map.regulation(651, "right_of_way", {{"relation", 182, "right_of_way"}}, {182});
}

void add_centreline(MadeVectorMap& map) {
  map.eastwards(160, {800, 840}, {0, 3.5}, road_tags());
  map.eastwards(161, {800, 840}, {10, 13.5}, road_tags());
  map.line(780, {{800, 1.75}, {820, 2}, {840, 1.75}}, {{"type", "centerline"}});
  map.relations[160].members.push_back({"way", 780, "centerline"});
}

}  // namespace

MadeVectorMap autoware_town() {
  MadeVectorMap map;
  add_street(map);
  add_crossing(map);
  add_turn_with_lights(map);
  add_virtual_light(map);
  add_crosswalk(map);
  add_areas(map);
  add_turns(map);
  add_centreline(map);
  return map;
}

}  // namespace roadbed::tests
