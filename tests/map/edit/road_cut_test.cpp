#include "roadbed/map/edit/road_cut.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "roadbed/map/derived/map_diff.h"
#include "roadbed/map/edit/merging/road_join.h"
#include "roadbed/map/edit/plan_cut.h"
#include "roadbed/map/edit/xml_edit.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_open_drive.h"

namespace roadbed::map {
namespace {

XmlDocument curved_road() { return {tests::curved_road_xml(), "curved.xodr"}; }

pugi::xml_node road_of(const XmlDocument& xml) { return xml.root().child("road"); }

double length_of(const XmlDocument& xml) { return number(road_of(xml), "length"); }

RoadMap map_of(const XmlDocument& xml) { return parse_map(text_of(xml, "  "), "cut.xodr"); }

// Reference line: line, spiral, arc, spiral, poly3 and paramPoly3, cut anywhere.
TEST(RoadCut, IsWhereTheWholeRoadIs) {
  const XmlDocument whole = curved_road();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> station(0.0, length_of(whole));
  for (int i = 0; i < 60; ++i) {
    const double a = station(random), b = station(random);
    const double from_m = std::min(a, b), to_m = std::max(a, b);
    const XmlDocument cut = curved_road();
    cut_road(road_of(cut), from_m, to_m);
    EXPECT_NEAR(length_of(cut), to_m - from_m, 1e-9);
    for (const double fraction : {0.0, 0.21, 0.5, 0.83, 1.0}) {
      const double s_m = fraction * (to_m - from_m);
      const auto here = reference_pose(road_of(cut), s_m);
      const auto there = reference_pose(road_of(whole), from_m + s_m);
      EXPECT_NEAR((here.position() - there.position()).norm(), 0.0, 1e-7) << from_m << " " << to_m;
      EXPECT_NEAR(std::remainder(here.heading_rad - there.heading_rad, 2.0 * M_PI), 0.0, 1e-7);
    }
  }
}

// A curve whose parameter runs to 1 over no length is nowhere.
TEST(RoadCut, EndsWhereTheLastCurveOfSomeLengthDoes) {
  const XmlDocument xml{R"(<OpenDRIVE><road length="10"><planView>
      <geometry s="0" x="1" y="2" hdg="0" length="10"><line/></geometry>
      <geometry s="10" x="100" y="100" hdg="0" length="0">
        <paramPoly3 aU="0" bU="1" cU="0" dU="0" aV="0" bV="0" cV="0" dV="0" pRange="normalized"/>
      </geometry></planView></road></OpenDRIVE>)",
                        "ends.xodr"};
  const auto end = reference_pose(road_of(xml), 10.0).position();
  EXPECT_NEAR((end - Eigen::Vector2d(11.0, 2.0)).norm(), 0.0, 1e-12);
}

// Widths, lane offset, elevation and superelevation: borders of the cut road lie on those of the
// whole one, which are sampled to within a centimetre.
TEST(RoadCut, KeepsItsBordersWhereTheyWere) {
  const RoadMap whole = map_of(curved_road());
  const double length_m = length_of(curved_road());
  for (const auto& [from, to] : {std::pair{0.0, 0.4}, {0.13, 0.77}, {0.5, 1.0}}) {
    const XmlDocument xml = curved_road();
    cut_road(road_of(xml), from * length_m, to * length_m);
    const RoadMap cut = map_of(xml);
    for (const Lane& lane : cut.lanes()) {
      const auto on_border = [&](const Eigen::Vector2d& point, double z_m, LaneLine Lane::*line) {
        double nearest_m = HUGE_VAL, height_m = HUGE_VAL;
        for (const Lane& other : whole.lanes()) {
          if (other.origin.source_id != lane.origin.source_id) continue;
          const auto place = (other.*line).in_map.project(whole.to_map(cut.to_source(point)));
          if (std::abs(place.d_m) >= nearest_m) continue;
          nearest_m = std::abs(place.d_m);
          const auto& stations = (other.*line).in_map.stations_m();
          for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
            if (stations[i] > place.s_m || place.s_m > stations[i + 1]) continue;
            const double at = (place.s_m - stations[i]) / (stations[i + 1] - stations[i]);
            height_m = std::lerp((other.*line).z_m[i], (other.*line).z_m[i + 1], at);
          }
        }
        EXPECT_NEAR(nearest_m, 0.0, 0.02) << lane.name;
        EXPECT_NEAR(height_m, z_m, 0.02) << lane.name;
      };
      for (std::size_t i = 0; i < lane.left.z_m.size(); ++i) {
        on_border(lane.left.in_map.points()[i], lane.left.z_m[i], &Lane::left);
      }
      for (std::size_t i = 0; i < lane.right.z_m.size(); ++i) {
        on_border(lane.right.in_map.points()[i], lane.right.z_m[i], &Lane::right);
      }
    }
  }
}

// Height over t: linear between stations, each of which has breaks of its own; a strip whose width
// is a cubic, with a hump across it, has it where it was, too.
TEST(RoadCut, KeepsItsSurfaceWhereItWas) {
  const auto road = [](const std::string& lateral) {
    return XmlDocument(
        R"(<OpenDRIVE><header revMajor="1" revMinor="8"/><road id="1" length="300" junction="-1">)"
        R"(<planView><geometry s="0" x="0" y="0" hdg="0" length="300"><line/></geometry></planView>)"
        R"(<lateralProfile>)" +
            lateral +
            R"(</lateralProfile><lanes><laneSection s="0"><center><lane id="0" type="none"/>)"
            R"(</center><right><lane id="-1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" )"
            R"(d="0"/></lane></right></laneSection></lanes></road></OpenDRIVE>)",
        "shape.xodr");
  };
  for (const std::string lateral :
       {R"(<shape s="0" t="-5" a="0.1" b="-0.02" c="0.01" d="0"/><shape s="0" t="0" a="0" b="0" )"
        R"(c="0" d="0"/><shape s="200" t="-4" a="0.3" b="-0.06" c="0" d="0.001"/>)",
        R"(<crossSectionSurface><tOffset><coefficients s="0" a="0" b="0" c="0" d="0"/></tOffset>)"
        R"(<surfaceStrips><strip id="-1"><constant><coefficients s="0" a="0.1" b="0.01" c="0" )"
        R"(d="1e-7"/></constant><linear><coefficients s="0" a="0.02" b="0" c="1e-6" d="0"/>)"
        R"(</linear></strip></surfaceStrips></crossSectionSurface>)"}) {
    const RoadMap whole = map_of(road(lateral));
    for (const auto& [from_m, to_m] : {std::pair{0.0, 120.0}, {37.5, 240.0}, {210.0, 300.0}}) {
      const XmlDocument xml = road(lateral);
      ASSERT_TRUE(can_be_cut(road_of(xml)));
      cut_road(road_of(xml), from_m, to_m);
      const RoadMap cut = map_of(xml);
      const LaneLine &border = cut.lanes()[0].right, &there = whole.lanes()[0].right;
      for (std::size_t i = 0; i < border.z_m.size(); ++i) {
        const double x_m = cut.to_source(border.in_map.points()[i]).x();
        const auto& stations = there.in_map.stations_m();
        std::size_t k = 1;
        while (k + 1 < stations.size() && stations[k] < x_m) ++k;
        const double at = (x_m - stations[k - 1]) / (stations[k] - stations[k - 1]);
        EXPECT_NEAR(border.z_m[i], std::lerp(there.z_m[k - 1], there.z_m[k], at), 0.01) << x_m;
      }
    }
    const XmlDocument first = road(lateral), second = road(lateral), before = road(lateral);
    cut_road(road_of(first), 0.0, 90.0);
    cut_road(road_of(second), 90.0, 300.0);
    join_roads(road_of(first), road_of(second));
    EXPECT_TRUE(say_the_same(road_of(first).child("lateralProfile"),
                             road_of(before).child("lateralProfile"),
                             [](pugi::xml_node) { return false; }));
  }
}

TEST(RoadCut, SaysWhichPartItIs) {
  const XmlDocument xml = curved_road();
  const double length_m = length_of(xml);
  cut_road(road_of(xml), 10.0, 60.0);
  cut_road(road_of(xml), 5.0, 20.0);  // of the part
  const RoadCut cut = road_cut(road_of(xml));
  EXPECT_EQ(cut.from_m, 15.0);
  EXPECT_EQ(cut.to_m, 30.0);
  EXPECT_EQ(cut.length_m, length_m);
  EXPECT_FALSE(cut.has_start());
  EXPECT_FALSE(cut.has_end());
}

TEST(RoadCut, LeavesAWholeRoadAsItIs) {
  const XmlDocument xml = curved_road();
  const std::string before = text_of(xml, "  ");
  cut_road(road_of(xml), 0.0, length_of(xml));
  EXPECT_EQ(text_of(xml, "  "), before);
}

// Cut anywhere, on stations of whole 2⁻²⁰ m as a clip does, parts give the whole back, bit by bit.
TEST(RoadJoin, GivesTheWholeRoadBack) {
  const RoadMap whole = map_of(curved_road());
  std::mt19937 random(12);
  std::uniform_int_distribution<int> station(1, static_cast<int>(length_of(curved_road())) - 1);
  for (int i = 0; i < 40; ++i) {
    const double at_m = station(random) + 0.40625, overlap_m = i % 2 == 0 ? 0.0 : 0.25;
    const XmlDocument first = curved_road(), second = curved_road();
    cut_road(road_of(first), 0.0, at_m);
    cut_road(road_of(second), at_m - overlap_m, length_of(second));
    ASSERT_TRUE(goes_on(road_of(first), road_of(second)));
    join_roads(road_of(first), road_of(second));
    EXPECT_TRUE(road_cut(road_of(first)).is_whole());
    const auto changes = diff(whole, map_of(first), {.tolerance_m = 0.0});
    EXPECT_TRUE(changes.empty()) << at_m << ": " << changes.front().theme << " "
                                 << changes.front().element;
  }
}

XmlDocument straight_road(const std::string& lanes, const std::string& objects) {
  return {R"(<OpenDRIVE><header revMajor="1" revMinor="8"/><road id="1" length="200" junction="-1">
    <planView><geometry s="0" x="0" y="0" hdg="0" length="200"><line/></geometry></planView>
    <lanes><laneSection s="0"><center><lane id="0" type="none">)" +
              lanes + R"(</lane></center></laneSection></lanes><objects>)" + objects +
              "</objects></road></OpenDRIVE>",
          "straight.xodr"};
}

constexpr const char* kZebra = R"(<object id="z" s="100" t="0"><outlines><outline id="0">
    <cornerRoad s="90" t="0"/><cornerRoad s="110" t="2"/></outline></outlines></object>)";

TEST(RoadCut, PutsByAnObjectAcrossTheCutForTheJoin) {
  const XmlDocument first = straight_road("", kZebra), second = straight_road("", kZebra);
  cut_road(road_of(first), 0.0, 105.0);
  cut_road(road_of(second), 105.0, 200.0);
  EXPECT_FALSE(road_of(first).child("objects").child("object"));
  EXPECT_FALSE(road_of(second).child("objects").child("object"));
  join_roads(road_of(first), road_of(second));
  const auto object = road_of(first).child("objects").child("object");
  const auto outline = object.child("outlines").child("outline");
  EXPECT_NEAR(number(object, "s"), 100.0, 1e-9);
  EXPECT_NEAR(number(outline.first_child(), "s"), 90.0, 1e-9);
  EXPECT_NEAR(number(outline.last_child(), "s"), 110.0, 1e-9);
}

TEST(RoadJoin, KeepsAnObjectThatOnlyTheOtherPartHasWhole) {
  const XmlDocument first = straight_road("", kZebra), second = straight_road("", kZebra);
  cut_road(road_of(first), 0.0, 105.0);
  cut_road(road_of(second), 80.0, 200.0);
  EXPECT_TRUE(road_of(second).child("objects").child("object"));
  join_roads(road_of(first), road_of(second));
  EXPECT_NEAR(number(road_of(first).child("objects").child("object"), "s"), 100.0, 1e-9);
}

TEST(RoadCut, MovesVerticesOfSkeletonsWithTheRoad) {
  const XmlDocument xml = straight_road("", R"(<object id="f" s="150" t="4"><skeleton>
    <polyline id="0"><vertexRoad s="145" t="4" dz="0"/><vertexRoad s="155" t="4" dz="0"/></polyline>
    </skeleton></object>)");
  cut_road(road_of(xml), 50.0, 200.0);
  const auto line = road_of(xml).select_node("objects/object/skeleton/polyline").node();
  EXPECT_NEAR(number(line.first_child(), "s"), 95.0, 1e-9);
  EXPECT_NEAR(number(line.last_child(), "s"), 105.0, 1e-9);
}

TEST(RoadCut, MovesLinesAndSwaysOfAMarkingWithIt) {
  const XmlDocument xml = straight_road(
      R"(<roadMark sOffset="0" type="broken"><sway ds="0" a="0" b="0" c="0" d="0"/>
         <sway ds="30" a="1" b="0.1" c="0" d="0"/>
         <type name="broken"><line length="3" space="6" sOffset="1" tOffset="0"/></type>
         <explicit><line length="10" sOffset="2"/><line length="10" sOffset="45"/>
         <line length="10" sOffset="80"/></explicit></roadMark>)",
      "");
  cut_road(road_of(xml), 50.0, 85.0);
  const auto mark = road_of(xml).select_node("lanes//roadMark").node();
  EXPECT_EQ(children(mark, "sway").size(), 1u);
  EXPECT_NEAR(number(mark.child("sway"), "a"), 3.0, 1e-9);                      // 1 + 0.1 · 20
  EXPECT_NEAR(number(mark.child("type").child("line"), "sOffset"), 5.0, 1e-9);  // 1 + 6 · 9 - 50
  const auto lines = children(mark.child("explicit"), "line");
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_NEAR(number(lines[0], "sOffset"), 0.0, 1e-9);
  EXPECT_NEAR(number(lines[0], "length"), 5.0, 1e-9);
  EXPECT_NEAR(number(lines[1], "sOffset"), 30.0, 1e-9);
  EXPECT_NEAR(number(lines[1], "length"), 5.0, 1e-9);
}

TEST(RoadJoin, IsNotForRoadsElsewhere) {
  const XmlDocument first = curved_road(), second = curved_road();
  cut_road(road_of(first), 0.0, 20.0);
  cut_road(road_of(second), 30.0, length_of(second));
  EXPECT_FALSE(goes_on(road_of(first), road_of(second))) << "a gap";
  const XmlDocument moved = curved_road();
  cut_road(road_of(moved), 20.0, length_of(moved));
  auto geometry = road_of(moved).child("planView").child("geometry");
  set_number(geometry, "x", number(geometry, "x") + 1.0);
  EXPECT_FALSE(goes_on(road_of(first), road_of(moved))) << "another place";
}

}  // namespace
}  // namespace roadbed::map
