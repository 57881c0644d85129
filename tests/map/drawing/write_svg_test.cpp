#include "roadbed/map/drawing/write_svg.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <pugixml.hpp>
#include <sstream>

#include "roadbed/tests/support/made_maps.h"

namespace roadbed::map {
namespace {

pugi::xml_document parsed(const std::string& svg) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(svg.c_str()));
  return document;
}

/// Path data of the first path with this fill.
std::string data_filled(const pugi::xml_document& document, const std::string& colour) {
  for (const auto& path : document.child("svg").children("path")) {
    if (path.attribute("fill").value() == colour) return path.attribute("d").value();
  }
  return {};
}

int count_of(const std::string& text, char c) {
  return static_cast<int>(std::count(text.begin(), text.end(), c));
}

TEST(WriteSvg, DrawsTheCarriagewayOfATwoLaneRoadAsOneRectangle) {
  const auto document = parsed(write_svg(tests::straight_two_lane_road(100.0).build()));
  const std::string data = data_filled(document, "#4a515b");
  EXPECT_EQ(count_of(data, 'M'), 1);
  EXPECT_EQ(count_of(data, 'L'), 4);  // back to the start, then closed
  EXPECT_EQ(count_of(data, 'Z'), 1);
}

TEST(WriteSvg, SaysHowItsCoordinatesFollowFromTheSource) {
  tests::MadeMap made = tests::straight_two_lane_road(100.0);
  made.parts.origin_in_source = {1000, 2000};
  const auto document = parsed(write_svg(made.build()));
  double x0 = 0.0, y0 = 0.0;
  const std::string words = document.child("svg").child("desc").text().get();
  ASSERT_EQ(std::sscanf(words.c_str(), "metres; source x = %lf + x, source y = %lf - y", &x0, &y0),
            2);
  double x = 0.0, y = 0.0;  // the first corner of the carriageway, lexicographically the lowest
  ASSERT_EQ(std::sscanf(data_filled(document, "#4a515b").c_str(), "M%lf %lfL", &x, &y), 2);
  EXPECT_NEAR(x0 + x, 1000.0, 0.01);
  EXPECT_NEAR(y0 - y, 1996.5, 0.01);
}

TEST(WriteSvg, TintsJunctionsAndPointsArrowsInDrivingDirection) {
  const auto document = parsed(write_svg(tests::three_roads_in_a_row().build()));
  EXPECT_EQ(count_of(data_filled(document, "#5b6470"), 'M'), 1);
  const std::string arrows = data_filled(document, "#cfe3f1");
  double tip_x = 0, tip_y = 0, wing_x = 0, wing_y = 0;
  ASSERT_EQ(std::sscanf(arrows.c_str(), "M%lf %lfL%lf %lf", &tip_x, &tip_y, &wing_x, &wing_y), 4);
  EXPECT_GT(tip_x, wing_x);  // eastwards
  EXPECT_LT(wing_y, tip_y);  // the left wing is drawn first, and up is north
}

TEST(WriteSvg, FillsTheWindowWhateverItsSize) {
  const auto document = parsed(write_svg(tests::three_roads_in_a_row().build()));
  EXPECT_TRUE(document.child("svg").attribute("viewBox"));
  EXPECT_FALSE(document.child("svg").attribute("width"));
}

TEST(WriteSvg, PaintsMarkingsAsTheSourceSays) {
  tests::MadeMap made = tests::straight_two_lane_road(100.0);
  made.lane(LaneId{0}).left_marks = {{0.0, MarkType::broken, "yellow", 0.15},
                                     {40.0, MarkType::none, "", 0.0},
                                     {60.0, MarkType::solid, "white", 0.15}};
  made.lane(LaneId{0}).right_marks = {{0.0, MarkType::none, "", 0.0}};
  made.lane(LaneId{1}).right_marks = {{0.0, MarkType::none, "", 0.0}};
  const auto document = parsed(write_svg(made.build()));
  std::vector<std::string> lines;
  for (const auto& path : document.child("svg").children("path")) {
    const std::string colour = path.attribute("stroke").value();
    if (path.attribute("transform") || path.attribute("fill").value() != std::string("none"))
      continue;
    if (colour == "#f2c14e") {
      lines.push_back("yellow");
      EXPECT_TRUE(path.attribute("stroke-dasharray"));
    }
    if (colour == "#ffffff") {
      lines.push_back("white");
      EXPECT_FALSE(path.attribute("stroke-dasharray"));
      double from_x = 0, y = 0, to_x = 0;
      EXPECT_EQ(std::sscanf(path.attribute("d").value(), "M%lf %lfL%lf", &from_x, &y, &to_x), 3);
      EXPECT_NEAR(to_x - from_x, 40.0, 0.01);
    }
  }
  std::sort(lines.begin(), lines.end());
  EXPECT_EQ(lines, (std::vector<std::string>{"white", "yellow"}));
}

TEST(WriteSvg, DrawsABridgeAfterWhatItCrosses) {
  tests::MadeMap made;
  const RoadId upper = made.add_road("1"), lower = made.add_road("2");
  const LaneId bridge = made.add_lane(upper, "-1", {{-40, 2}, {40, 2}}, {{-40, -2}, {40, -2}});
  made.add_lane(lower, "-1", {{-2, -40}, {-2, 40}}, {{2, -40}, {2, 40}});
  made.lane(bridge).centre.z_m = {6.0, 6.0};
  const auto document = parsed(write_svg(made.build()));
  std::vector<double> widths;
  for (const auto& path : document.child("svg").children("path")) {
    if (path.attribute("fill").value() != std::string("#4a515b")) continue;
    if (path.attribute("transform")) continue;
    double x[3], y[3];
    ASSERT_EQ(std::sscanf(path.attribute("d").value(), "M%lf %lfL%lf %lfL%lf %lf", &x[0], &y[0],
                          &x[1], &y[1], &x[2], &y[2]),
              6);
    widths.push_back(std::max({x[0], x[1], x[2]}) - std::min({x[0], x[1], x[2]}));
  }
  ASSERT_EQ(widths.size(), 2u);
  EXPECT_NEAR(widths[0], 4.0, 0.02);
  EXPECT_NEAR(widths[1], 80.0, 0.02);
}

TEST(WriteSvg, DrawsBuildingsBelowRoadsAndCrosswalksOnThem) {
  tests::MadeMap made = tests::straight_two_lane_road(100.0);
  MapObject building, crosswalk;
  building.type = "building";
  building.outline_in_map = {{0, -9}, {20, -9}, {20, 9}, {0, 9}};
  crosswalk.type = "crosswalk";
  crosswalk.outline_in_map = {{50, -3.5}, {54, -3.5}, {54, 3.5}, {50, 3.5}};
  made.parts.objects = {crosswalk, building};
  const std::string svg = write_svg(made.build());
  const std::size_t below = svg.find("#cfc6b8"), road = svg.find(R"(fill="#4a515b")");
  const std::size_t zebra = svg.find(R"(stroke-width="4.000")");  // as wide as it is walked on
  ASSERT_NE(below, std::string::npos);
  ASSERT_NE(zebra, std::string::npos);
  EXPECT_LT(below, road);
  EXPECT_LT(road, zebra);
}

TEST(WriteSvg, EscapesNames) {
  tests::MadeMap made = tests::straight_two_lane_road();
  made.parts.crs = "<&\">";
  const auto document = parsed(write_svg(made.build()));
  std::string words;
  for (const auto& text : document.child("svg").children("text")) words += text.text().get();
  EXPECT_NE(words.find("<&\">"), std::string::npos);
}

TEST(WriteSvg, IsTheSameEveryTime) {
  const RoadMap road_map = tests::three_roads_in_a_row().build();
  EXPECT_EQ(write_svg(road_map), write_svg(road_map));
}

}  // namespace
}  // namespace roadbed::map
