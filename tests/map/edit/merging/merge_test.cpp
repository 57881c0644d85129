#include "roadbed/map/edit/merging/merge.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/derived/map_diff.h"
#include "roadbed/map/edit/clipping/clip.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

// One road of one lane along the x axis, with a signal and a controller.
std::string road_at(double x, double y, const std::string& crs = "") {
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<OpenDRIVE>\n  <header revMajor=\"1\" revMinor=\"6\" west=\"{0}\" "
      "east=\"{1}\">{3}</header>\n  <road id=\"1\" length=\"100\" junction=\"-1\"><planView>"
      "<geometry s=\"0\" x=\"{0}\" y=\"{2}\" hdg=\"0\" length=\"100\"><line/></geometry></planView>"
      "<lanes><laneSection s=\"0\"><center><lane id=\"0\" type=\"none\"/></center><right><lane "
      "id=\"-1\" type=\"driving\"><width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/></lane>"
      "</right></laneSection></lanes><signals><signal id=\"7\" s=\"90\" t=\"-4\" dynamic=\"yes\" "
      "orientation=\"+\" type=\"1000001\" subtype=\"-1\"/></signals></road>\n  <controller "
      "id=\"3\">"
      "<control signalId=\"7\"/></controller>\n</OpenDRIVE>\n",
      x, x + 100, y, crs.empty() ? "" : "<geoReference>" + crs + "</geoReference>");
}

TEST(Merge, GivesOtherIdsToOtherThings) {
  const Merged merged = merge({{road_at(0, 0), "a.xodr"}, {road_at(500, 40), "b.xodr"}});
  const RoadMap road_map = parse_map(merged.bytes, "merged.xodr");
  ASSERT_EQ(road_map.roads().size(), 2u);
  EXPECT_EQ(road_map.signals().size(), 2u);
  ASSERT_EQ(road_map.controllers().size(), 2u);
  EXPECT_NE(road_map.controllers()[0].signals, road_map.controllers()[1].signals);
  ASSERT_EQ(merged.renamed.size(), 3u);
  EXPECT_EQ(merged.renamed[0].kind, "road");
  EXPECT_EQ(merged.renamed[0].file, "b.xodr");
  EXPECT_EQ(merged.renamed[0].from, "1");
  EXPECT_EQ(merged.renamed[0].to, "2");
}

TEST(Merge, TakesOnceWhatIsTheSame) {
  const Merged merged = merge({{road_at(0, 0), "a.xodr"}, {road_at(0, 0), "b.xodr"}});
  EXPECT_EQ(parse_map(merged.bytes, "merged.xodr").roads().size(), 1u);
  EXPECT_TRUE(merged.renamed.empty());
}

std::vector<std::string> ids_of(const std::string& bytes, const char* xpath) {
  const XmlDocument xml(bytes, "merged.xodr");
  std::vector<std::string> ids;
  for (const auto& found : xml.root().select_nodes(xpath)) {
    ids.emplace_back(found.node().attribute("id").value());
  }
  return ids;
}

TEST(Merge, GivesObjectsBridgesAndTunnelsIdsOfTheirOwn) {
  const auto with = [](std::string road, const std::string& objects) {
    return road.insert(road.find("<signals>"), "<objects>" + objects + "</objects>");
  };
  const std::string first = with(road_at(0, 0),
                                 "<object id=\"1\" s=\"5\" t=\"9\"/>"
                                 "<bridge id=\"2\" s=\"0\" length=\"10\"/>");
  const std::string second = with(road_at(500, 40),
                                  "<object id=\"1\" s=\"5\" t=\"9\"/>"
                                  "<bridge id=\"2\" s=\"0\" length=\"10\"/>"
                                  "<tunnel id=\"3\" s=\"0\" length=\"10\"/>"
                                  "<objectReference id=\"1\" s=\"7\"/>");
  const Merged merged = merge({{first, "a.xodr"}, {second, "b.xodr"}});
  const auto own = ids_of(merged.bytes, "//object | //bridge | //tunnel");
  EXPECT_EQ(std::set<std::string>(own.begin(), own.end()).size(), 5u) << merged.bytes;
  EXPECT_EQ(ids_of(merged.bytes, "//road[2]//object"), ids_of(merged.bytes, "//objectReference"));
}

// A number that is free in the first file is not, if the second one has it.
TEST(Merge, GivesNoIdThatTheAddedFileHasItself) {
  std::string second = road_at(500, 40);
  const std::string signal = "<signal id=\"7\"";
  second.insert(second.find(signal), "<signal id=\"8\" s=\"5\" t=\"-4\"/>");
  const Merged merged = merge({{road_at(0, 0), "a.xodr"}, {second, "b.xodr"}});
  EXPECT_EQ(ids_of(merged.bytes, "//signal"), (std::vector<std::string>{"7", "8", "9"}));
}

// Files repeat ids of signals from road to road.
TEST(Merge, LeavesSignalsOfOneIdOnTheirRoads) {
  std::string bytes = road_at(0, 0);
  const std::size_t from = bytes.find("<road "), to = bytes.find("</road>") + 7;
  std::string other = bytes.substr(from, to - from);
  const std::string id = "id=\"1\"", at = "y=\"0\"";
  other.replace(other.find(id), id.size(), "id=\"2\"");
  other.replace(other.find(at), at.size(), "y=\"50\"");
  bytes.insert(to, other);
  const auto half = [&](double from_m, double to_m) {
    const Region side({geometry::box_ring({from_m, -1e4}, {to_m, 1e4})});
    return MergeInput{clip(bytes, "two.xodr", side).bytes, fmt::format("from {}", from_m)};
  };
  const Merged merged = merge({half(-1e4, 30), half(30, 1e4)});
  EXPECT_TRUE(merged.renamed.empty());
  EXPECT_TRUE(diff(parse_map(bytes, "two.xodr"), parse_map(merged.bytes, "two.xodr")).empty());
}

TEST(Merge, LinksLanesAgainOfRoadsThatWereKeptWhole) {
  const auto road = [](int id, double x, const std::string& link, const std::string& of_lanes) {
    return fmt::format(
        "<road id=\"{0}\" length=\"100\" junction=\"-1\"><link>{2}</link><planView><geometry "
        "s=\"0\" x=\"{1}\" y=\"0\" hdg=\"0\" length=\"100\"><line/></geometry></planView><lanes>"
        "<laneSection s=\"0\"><center><lane id=\"0\" type=\"none\"/></center><right><lane "
        "id=\"-1\" type=\"driving\"><link>{3}</link><width sOffset=\"0\" a=\"3.5\" b=\"0\" "
        "c=\"0\" d=\"0\"/></lane></right></laneSection></lanes></road>",
        id, x, link, of_lanes);
  };
  const std::string before =
      "<predecessor elementType=\"road\" elementId=\"{}\" contactPoint=\"end\"/>";
  const std::string behind =
      "<successor elementType=\"road\" elementId=\"{}\" contactPoint=\"start\"/>";
  const std::string lane_before = "<predecessor id=\"-1\"/>",
                    lane_behind = "<successor id=\"-1\"/>";
  const std::string three =
      "<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>" +
      road(1, 0, fmt::format(fmt::runtime(behind), 2), lane_behind) +
      road(2, 100, fmt::format(fmt::runtime(before + behind), 1, 3), lane_before + lane_behind) +
      road(3, 200, fmt::format(fmt::runtime(before), 2), lane_before) + "</OpenDRIVE>";
  const auto part = [&](double from_m, double to_m) {
    const Region region({geometry::box_ring({from_m, -50}, {to_m, 50})});
    return clip(three, "three.xodr", region, {.whole = true}).bytes;
  };
  const std::string middle = part(120, 180);
  const char* links = "//lane/link/predecessor | //lane/link/successor";
  EXPECT_EQ(ids_of(middle, links).size(), 0u) << middle;
  EXPECT_EQ(ids_of(part(20, 180), links).size(), 2u) << "between roads 1 and 2";
  const Merged merged = merge({{part(20, 80), "1"}, {middle, "2"}, {part(220, 280), "3"}});
  EXPECT_EQ(ids_of(merged.bytes, links).size(), 4u);
  EXPECT_EQ(merged.bytes.find("roadbed.clip"), std::string::npos) << merged.bytes;
  EXPECT_TRUE(diff(parse_map(three, "three"), parse_map(merged.bytes, "three")).empty());
}

// The middle part ends where a section does; what its lanes knew of the next one is not lost when
// it is put to the part before.
TEST(Merge, LinksSectionsAgainBetweenThreeParts) {
  const auto section = [](double s_m, const std::string& links) {
    return fmt::format(
        "<laneSection s=\"{}\"><center><lane id=\"0\" type=\"none\"/></center><right><lane "
        "id=\"-1\" type=\"driving\"><link>{}</link><width sOffset=\"0\" a=\"3.5\" b=\"0\" "
        "c=\"0\" d=\"0\"/></lane></right></laneSection>",
        s_m, links);
  };
  const std::string whole =
      "<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/><road id=\"1\" length=\"100\" "
      "junction=\"-1\"><planView><geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"100\"><line/>"
      "</geometry></planView><lanes>" +
      section(0, "<successor id=\"-1\"/>") + section(50, "<predecessor id=\"-1\"/>") +
      "</lanes></road></OpenDRIVE>";
  const auto part = [&](double from_m, double to_m) {
    const Region region({geometry::box_ring({from_m, -50}, {to_m, 50})});
    return MergeInput{clip(whole, "whole.xodr", region).bytes, fmt::format("from {}", from_m)};
  };
  const Merged merged = merge({part(-10, 20), part(20, 50), part(50, 110)});
  EXPECT_EQ(ids_of(merged.bytes, "//lane/link/*").size(), 2u) << merged.bytes;
  EXPECT_TRUE(diff(parse_map(whole, "whole"), parse_map(merged.bytes, "whole")).empty());
}

TEST(Merge, LinksEndsThatCoincide) {
  const Merged merged = merge({{road_at(0, 0), "a.xodr"}, {road_at(100.02, 0.01), "b.xodr"}});
  const RoadMap road_map = parse_map(merged.bytes, "merged.xodr");
  ASSERT_EQ(merged.seams.size(), 1u);
  EXPECT_EQ(merged.seams[0].first, "end of road 1");
  EXPECT_EQ(merged.seams[0].second, "start of road 2");
  EXPECT_EQ(merged.seams[0].what, "linked");
  EXPECT_NEAR(merged.seams[0].gap_m, std::hypot(0.02, 0.01), 1e-9);
  EXPECT_EQ(road_map.graph().of(LaneId{0}).successors, std::vector<LaneId>{LaneId{1}});
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

std::string at_height(double z_m, const std::string& road) {
  return with(road, "<lanes>",
              fmt::format("<elevationProfile><elevation s=\"0\" a=\"{}\" b=\"0\" c=\"0\" "
                          "d=\"0\"/></elevationProfile><lanes>",
                          z_m));
}

// A second lane to the right, 3 m wide.
std::string with_lane(const std::string& road, const std::string& type) {
  return with(road, "</right>",
              "<lane id=\"-2\" type=\"" + type +
                  "\"><width sOffset=\"0\" a=\"3\" b=\"0\" c=\"0\" d=\"0\"/></lane></right>");
}

std::size_t links_in(const std::string& bytes) {
  std::size_t links = 0;
  const RoadMap road_map = parse_map(bytes, "merged.xodr");
  for (const Lane& lane : road_map.lanes()) {
    links += road_map.graph().of(lane.id).successors.size();
  }
  return links;
}

TEST(Merge, LinksNoRoadsAtOtherHeights) {
  const Merged merged = merge({{road_at(0, 0), "a.xodr"}, {at_height(8, road_at(100, 0)), "b"}});
  ASSERT_EQ(merged.seams.size(), 1u);
  EXPECT_EQ(merged.seams[0].what, "heights do not meet");
  EXPECT_NEAR(merged.seams[0].gap_m, 8.0, 1e-9);
  EXPECT_EQ(links_in(merged.bytes), 0u);
  EXPECT_EQ(merged.bytes.find("contactPoint"), std::string::npos);
}

TEST(Merge, LinksRoadsUnderABridgeThatBeginsThere) {
  const Merged merged = merge({{road_at(0, 0), "a.xodr"},
                               {at_height(8, road_at(100, 0)), "bridge.xodr"},
                               {road_at(100, 0), "b.xodr"}});
  ASSERT_GE(merged.seams.size(), 2u);
  EXPECT_EQ(merged.seams[0].second, "start of road 2");
  EXPECT_EQ(merged.seams[0].what, "heights do not meet");
  EXPECT_EQ(merged.seams[1].second, "start of road 3");
  EXPECT_EQ(merged.seams[1].what, "linked");
  EXPECT_EQ(links_in(merged.bytes), 1u);
}

TEST(Merge, SaysHowFarLinkedRoadsAreApartInSpace) {
  const Merged merged =
      merge({{road_at(0, 0), "a.xodr"}, {at_height(0.02, road_at(100.03, 0)), "b.xodr"}});
  ASSERT_EQ(merged.seams.size(), 1u);
  EXPECT_EQ(merged.seams[0].what, "linked");
  EXPECT_NEAR(merged.seams[0].gap_m, std::hypot(0.03, 0.02), 1e-9);
}

TEST(Merge, LinksNoLanesOfOtherTypes) {
  const std::string walk = with(road_at(100, 0), "type=\"driving\"", "type=\"sidewalk\"");
  const Merged merged = merge({{road_at(0, 0), "a.xodr"}, {walk, "b.xodr"}});
  ASSERT_EQ(merged.seams.size(), 1u);
  EXPECT_EQ(merged.seams[0].what, "lanes are of other types");
  EXPECT_EQ(links_in(merged.bytes), 0u);
}

TEST(Merge, LinksNoLanesThatAnOffsetPutsAside) {
  const std::string aside = with(road_at(100, 0), "<lanes>",
                                 "<lanes><laneOffset s=\"0\" a=\"3\" b=\"0\" c=\"0\" d=\"0\"/>");
  const Merged merged = merge({{road_at(0, 0), "a.xodr"}, {aside, "b.xodr"}});
  ASSERT_EQ(merged.seams.size(), 1u);
  EXPECT_EQ(merged.seams[0].what, "lanes do not meet");
  EXPECT_NEAR(merged.seams[0].gap_m, 3.0, 1e-9);
  EXPECT_EQ(links_in(merged.bytes), 0u);
}

TEST(Merge, LinksOnlyTheLanesThatMeet) {
  const Merged merged = merge({{with_lane(road_at(0, 0), "driving"), "a.xodr"},
                               {with_lane(road_at(100.02, 0), "sidewalk"), "b.xodr"}});
  ASSERT_EQ(merged.seams.size(), 1u);
  EXPECT_EQ(merged.seams[0].what, "linked but for lanes -2 of road 1");
  EXPECT_NEAR(merged.seams[0].gap_m, 0.02, 1e-9);
  EXPECT_EQ(links_in(merged.bytes), 1u);
}

// Both roads begin where they meet; lanes of the left face those of the right.
TEST(Merge, LinksRoadsThatBeginAtOnePlace) {
  std::string back = with(road_at(0, 0), "hdg=\"0\"", "hdg=\"3.14159265358979\"");
  back = with(with(back, "<right>", "<left>"), "</right>", "</left>");
  back = with(back, "id=\"-1\"", "id=\"1\"");
  const Merged merged = merge({{road_at(0, 0), "a.xodr"}, {back, "b.xodr"}});
  ASSERT_EQ(merged.seams.size(), 1u);
  EXPECT_EQ(merged.seams[0].what, "linked");
  EXPECT_EQ(merged.seams[0].second, "start of road 2");
  EXPECT_EQ(links_in(merged.bytes), 1u);
}

TEST(Merge, LinksNothingFartherThanTheTolerance) {
  const Merged merged =
      merge({{road_at(0, 0), "a.xodr"}, {road_at(100.02, 0), "b.xodr"}}, {.tolerance_m = 0.01});
  EXPECT_TRUE(merged.seams.empty());
  const RoadMap road_map = parse_map(merged.bytes, "merged.xodr");
  EXPECT_TRUE(road_map.graph().of(LaneId{0}).successors.empty());
}

// Of n roads on each other in each of two files there are n² pairs of ends.
TEST(Merge, RefusesRoadsOnEachOtherBeyondALimitOfTheirNumber) {
  const auto merged = [](int roads) {
    std::vector<MergeInput> files;
    for (const double x : {0.0, 1e-5}) {
      std::string text = R"(<OpenDRIVE><header revMajor="1" revMinor="6"/>)";
      for (int i = 0; i < roads; ++i) {
        text += fmt::format(
            R"(<road id="{}" length="100" junction="-1"><planView><geometry s="0" x="{}" y="0" )"
            R"(hdg="0" length="100"><line/></geometry></planView><lanes><laneSection s="0"><center>)"
            R"(<lane id="0" type="none"/></center></laneSection></lanes></road>)",
            i + (x > 0.0 ? roads : 0), x);
      }
      files.push_back({text + "</OpenDRIVE>", "stack.xodr"});
    }
    return tests::refusal_of([&] { merge(std::move(files)); });
  };
  EXPECT_EQ(merged(20), "accepted");
  EXPECT_EQ(
      merged(100),
      "merge: 400 free ends, too many of which lie on each other, needs a few at most that "
      "meet in one place; leave repeated roads or lanelets out, or give a smaller --tolerance");
}

TEST(Merge, WidensTheHeader) {
  const Merged merged = merge({{road_at(0, 0), "a.xodr"}, {road_at(500, 0), "b.xodr"}});
  EXPECT_NE(merged.bytes.find("west=\"0\" east=\"600\""), std::string::npos) << merged.bytes;
}

TEST(Merge, RefusesOtherSystemsUnlessToldHow) {
  const auto maps = [] {
    return std::vector<MergeInput>{{road_at(0, 0, "EPSG:32632"), "a.xodr"},
                                   {road_at(500, 0, "EPSG:32633"), "b.xodr"}};
  };
  EXPECT_THROW(merge(maps()), InputError);
  EXPECT_EQ(parse_map(merge(maps(), {.same_system = true}).bytes, "merged.xodr").roads().size(),
            2u);
}

// Two lanelets end to end; the second begins a little beside where the first one ends.
std::string lanelet_at(double x, std::int64_t id, std::optional<double> height_m = {}) {
  std::string text = "<osm version=\"0.6\">\n";
  const std::string height =
      height_m ? fmt::format("    <tag k=\"ele\" v=\"{}\" />\n", *height_m) : "";
  const auto node = [&](int i, double east, double north) {
    text += fmt::format(
        "  <node id=\"{}\" lat=\"0\" lon=\"0\">\n    <tag k=\"local_x\" v=\"{}\" />\n    <tag "
        "k=\"local_y\" v=\"{}\" />\n{}  </node>\n",
        10 * id + i, east, north, height);
  };
  node(1, x, 2), node(2, x + 50, 2), node(3, x, -2), node(4, x + 50, -2);
  for (const int side : {5, 6}) {
    text +=
        fmt::format("  <way id=\"{}\">\n    <nd ref=\"{}\" />\n    <nd ref=\"{}\" />\n  </way>\n",
                    10 * id + side, 10 * id + 2 * side - 9, 10 * id + 2 * side - 8);
  }
  return text +
         fmt::format(
             "  <relation id=\"{}\">\n    <member type=\"way\" ref=\"{}\" role=\"left\" />\n"
             "    <member type=\"way\" ref=\"{}\" role=\"right\" />\n    <tag k=\"type\" "
             "v=\"lanelet\" />\n    <tag k=\"subtype\" v=\"road\" />\n  </relation>\n</osm>\n",
             10 * id + 7, 10 * id + 5, 10 * id + 6);
}

TEST(MergeLanelet2, LinksEndsThatCoincide) {
  const Merged merged = merge({{lanelet_at(0, 1), "a.osm"}, {lanelet_at(50.03, 2), "b.osm"}});
  const RoadMap road_map = parse_map(merged.bytes, "merged.osm");
  ASSERT_EQ(road_map.lanes().size(), 2u);
  EXPECT_EQ(road_map.graph().of(LaneId{0}).successors, std::vector<LaneId>{LaneId{1}});
  ASSERT_EQ(merged.seams.size(), 1u);
  EXPECT_NEAR(merged.seams[0].gap_m, 0.03, 1e-9);
}

// Two files that number their elements alike, as editors do from 1 on.
TEST(MergeLanelet2, LinksEndsOfLaneletsThatHadOneId) {
  const Merged merged = merge({{lanelet_at(0, 1), "a.osm"}, {lanelet_at(50.03, 1), "b.osm"}});
  const RoadMap road_map = parse_map(merged.bytes, "merged.osm");
  ASSERT_EQ(road_map.lanes().size(), 2u);
  EXPECT_EQ(road_map.graph().of(LaneId{0}).successors, std::vector<LaneId>{LaneId{1}});
  ASSERT_EQ(merged.seams.size(), 1u);
  EXPECT_EQ(merged.seams[0].what, "linked");
  EXPECT_EQ(merged.seams[0].first, "end of lanelet " + road_map.lanes()[0].name);
  EXPECT_EQ(merged.seams[0].second, "start of lanelet " + road_map.lanes()[1].name);
}

TEST(MergeLanelet2, JoinsNoEndsAtOtherHeights) {
  const Merged merged = merge({{lanelet_at(0, 1, 0), "a.osm"}, {lanelet_at(50, 2, 8), "b.osm"}});
  EXPECT_TRUE(merged.seams.empty());
  const RoadMap road_map = parse_map(merged.bytes, "merged.osm");
  ASSERT_EQ(road_map.lanes().size(), 2u);
  EXPECT_TRUE(road_map.graph().of(LaneId{0}).successors.empty());
  std::size_t high = 0;
  for (std::size_t at = 0; (at = merged.bytes.find("v=\"8\"", at)) != std::string::npos; ++at) {
    ++high;
  }
  EXPECT_EQ(high, 4u) << "nodes of the bridge";
}

TEST(MergeLanelet2, SaysHowFarEndsAreApartInSpace) {
  const Merged merged =
      merge({{lanelet_at(0, 1, 0), "a.osm"}, {lanelet_at(50.03, 2, 0.03), "b.osm"}});
  ASSERT_EQ(merged.seams.size(), 1u);
  EXPECT_EQ(merged.seams[0].what, "linked");
  EXPECT_NEAR(merged.seams[0].gap_m, std::hypot(0.03, 0.03), 1e-9);
}

TEST(MergeLanelet2, JoinsEndsOfWhichOneHasNoHeight) {
  const Merged merged = merge({{lanelet_at(0, 1), "a.osm"}, {lanelet_at(50.03, 2, 8), "b.osm"}});
  ASSERT_EQ(merged.seams.size(), 1u);
  EXPECT_EQ(merged.seams[0].what, "linked");
  EXPECT_NEAR(merged.seams[0].gap_m, 0.03, 1e-9);
}

TEST(MergeLanelet2, GivesOtherIdsToOtherThings) {
  const Merged merged = merge({{lanelet_at(0, 1), "a.osm"}, {lanelet_at(300, 1), "b.osm"}});
  const RoadMap road_map = parse_map(merged.bytes, "merged.osm");
  ASSERT_EQ(road_map.lanes().size(), 2u);
  EXPECT_EQ(road_map.lanes()[0].name, "17");
  EXPECT_EQ(merged.renamed.size(), 7u) << "four nodes, two ways, a lanelet";
}

// Bytes of parts changed at random: they are merged, or refused with a reason.
TEST(Merge, TakesDamagedPartsOrRefusesThem) {
  std::mt19937 random(31);
  for (const char* name : {"town.xodr", "crossing.osm"}) {
    const std::string bytes = read_file(tests::data_folder() / name);
    const RoadMap whole = parse_map(bytes, name);
    const Lane& lane = whole.lanes()[whole.lanes().size() / 2];
    const Eigen::Vector2d at = whole.to_source(lane.centre.in_map.at(0.4 * lane.length_m()));
    const auto half = [&](double from_x, double to_x) {
      return clip(bytes, name, Region({geometry::box_ring({from_x, -1e7}, {to_x, 1e7})})).bytes;
    };
    const std::string left = half(-1e7, at.x()), right = half(at.x(), 1e7);
    for (int i = 0; i < 60; ++i) {
      std::string damaged = right;
      // Numbers of clip memories above all.
      const std::string word = i % 2 == 0 ? "roadbed" : " ";
      for (int k = 0; k < 4; ++k) {
        const std::size_t found = damaged.find(word, random() % damaged.size());
        const std::size_t place = found == std::string::npos ? 0 : found + random() % 60;
        if (place < damaged.size()) damaged[place] = "0123456789.-e\" <>"[random() % 17];
      }
      try {
        const Merged merged = merge({{left, "left"}, {damaged, "right"}});
        EXPECT_FALSE(merged.bytes.empty());
      } catch (const InputError& error) {
        EXPECT_STRNE(error.what(), "");
      }
    }
  }
}

TEST(Merge, RefusesOtherFormats) {
  EXPECT_THROW(merge({{road_at(0, 0), "a.xodr"}, {lanelet_at(0, 1), "b.osm"}}), InputError);
}

}  // namespace
}  // namespace roadbed::map
