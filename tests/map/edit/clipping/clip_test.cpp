#include "roadbed/map/edit/clipping/clip.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/validate_file.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

using Eigen::Vector2d;

Region box(double x0, double y0, double x1, double y1) {
  return Region({geometry::box_ring({x0, y0}, {x1, y1})});
}

// Roads along the x axis, of one lane on each side, 3.5 m wide; the second one follows the first.
std::string two_roads() {
  const auto road = [](int id, double x, const std::string& link, const std::string& lane_link) {
    const auto lane = [&](const std::string& lane_id) {
      return "<lane id=\"" + lane_id + "\" type=\"driving\"><link><" + lane_link + " id=\"" +
             lane_id + "\"/></link><width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/>";
    };
    return "<road id=\"" + std::to_string(id) + "\" length=\"100\" junction=\"-1\"><link>" + link +
           "</link><planView><geometry s=\"0\" x=\"" + std::to_string(x) +
           "\" y=\"0\" hdg=\"0\" length=\"100\"><line/></geometry></planView><lanes>"
           "<laneSection s=\"0\"><left>" +
           lane("1") + "</lane></left><center><lane id=\"0\" type=\"none\"/></center><right>" +
           lane("-1") +
           "<userData code=\"mine\" value=\"kept\"/></lane></right></laneSection></lanes>" +
           "<objects><object id=\"tree\" s=\"70\" t=\"8\"/></objects></road>";
  };
  return "<?xml version=\"1.0\"?>\n<!-- a comment -->\n<OpenDRIVE>\n  <header revMajor=\"1\" "
         "revMinor=\"6\"/>\n" +
         road(1, 0, "<successor elementType=\"road\" elementId=\"2\" contactPoint=\"start\"/>",
              "successor") +
         road(2, 100, "<predecessor elementType=\"road\" elementId=\"1\" contactPoint=\"end\"/>",
              "predecessor") +
         "</OpenDRIVE>\n";
}

TEST(ClipOpenDrive, CutsARoadWhereTheEdgeCrossesItStraight) {
  const Edited part = clip(two_roads(), "two.xodr", box(30, -50, 150, 50));
  const RoadMap road_map = parse_map(part.bytes, "part.xodr");
  ASSERT_EQ(road_map.roads().size(), 2u);
  double least_m = HUGE_VAL, most_m = -HUGE_VAL;
  for (const Lane& lane : road_map.lanes()) {
    for (const Vector2d& point : lane.left.in_map.points()) {
      least_m = std::min(least_m, road_map.to_source(point).x());
      most_m = std::max(most_m, road_map.to_source(point).x());
    }
  }
  EXPECT_NEAR(least_m, 30.0, 2e-6);
  EXPECT_NEAR(most_m, 150.0, 2e-6);
}

std::size_t loose_ends(const std::string& bytes) {
  const auto findings = validate_bytes(bytes, "part.xodr").findings;
  return static_cast<std::size_t>(std::ranges::count_if(findings, [](const auto& finding) {
    return finding.rule == "link.dead-end" || finding.rule == "link.unreachable";
  }));
}

TEST(ClipOpenDrive, LeavesNoDeadEndsWhereItCuts) {
  EXPECT_EQ(loose_ends(two_roads()), 4u);
  EXPECT_EQ(loose_ends(clip(two_roads(), "two.xodr", box(-10, -50, 150, 50)).bytes), 2u);
  EXPECT_EQ(loose_ends(clip(two_roads(), "two.xodr", box(30, -50, 150, 50)).bytes), 0u);
  EXPECT_EQ(loose_ends(clip(two_roads(), "two.xodr", box(30, -50, 90, 50)).bytes), 0u);
}

TEST(ClipOpenDrive, OfATownWithoutFaultsHasNone) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const auto file = folder / "opendrive/BerkeleyLearnVerify+Scenic/Town04.xodr";
  const Edited part = clip(read_file(file), file, box(-200, -100, 200, 200));
  for (const auto& finding : validate_bytes(part.bytes, "part.xodr").findings) {
    EXPECT_EQ(finding.severity, validation::Severity::info)
        << finding.element << ": " << finding.message;
  }
}

TEST(ClipOpenDrive, KeepsWhatNobodyReads) {
  const Edited part = clip(two_roads(), "two.xodr", box(-10, -50, 150, 50));
  EXPECT_NE(part.bytes.find("<!-- a comment -->"), std::string::npos);
  EXPECT_NE(part.bytes.find("code=\"mine\" value=\"kept\""), std::string::npos);
}

TEST(ClipOpenDrive, KeepsObjectsInsideOnly) {
  const RoadMap road_map =
      parse_map(clip(two_roads(), "two.xodr", box(-10, -50, 150, 50)).bytes, "part.xodr");
  ASSERT_EQ(road_map.objects().size(), 1u) << "that of road 2 is at x = 170";
}

TEST(ClipOpenDrive, LinksWhatIsLeftAndNothingElse) {
  const auto links = [](const Region& region) {
    const RoadMap road_map = parse_map(clip(two_roads(), "two.xodr", region).bytes, "part.xodr");
    std::size_t count = 0;
    for (const Lane& lane : road_map.lanes()) {
      count += road_map.graph().of(lane.id).successors.size();
    }
    EXPECT_EQ(road_map.import_diagnostics().size(), 0u);
    return count;
  };
  EXPECT_EQ(links(box(30, -50, 150, 50)), 2u) << "one in each direction";
  EXPECT_EQ(links(box(30, -50, 90, 50)), 0u);
}

TEST(ClipOpenDrive, KeepsRoadsWholeIfAsked) {
  const Edited part = clip(two_roads(), "two.xodr", box(30, -50, 60, 50), {.whole = true});
  const RoadMap road_map = parse_map(part.bytes, "part.xodr");
  ASSERT_EQ(road_map.roads().size(), 1u);
  EXPECT_NEAR(road_map.lanes()[0].length_m(), 100.0, 1e-9);
}

TEST(ClipOpenDrive, MakesPartsOfARoadThatComesBack) {
  const Region two(
      {geometry::box_ring({10, -50}, {20, 50}), geometry::box_ring({40, -50}, {60, 50})});
  const RoadMap road_map = parse_map(clip(two_roads(), "two.xodr", two).bytes, "part.xodr");
  ASSERT_EQ(road_map.roads().size(), 2u);
  EXPECT_EQ(road_map.road(RoadId{0}).source_id, "1");
  EXPECT_EQ(road_map.road(RoadId{1}).source_id, "3");
  EXPECT_NEAR(road_map.lanes()[0].length_m() + road_map.lanes()[2].length_m(), 30.0, 1e-5);
}

TEST(Clip, OfNothingHasAReason) {
  const Edited part = clip(two_roads(), "two.xodr", box(500, 500, 600, 600));
  EXPECT_TRUE(part.bytes.empty());
  EXPECT_EQ(part.reason, "no road of the map reaches into the region");
}

TEST(Clip, RefusesWhatHoldsNoDocument) {
  EXPECT_THROW(
      clip("{\"type\":\"FeatureCollection\",\"features\":[]}", "a.geojson", box(0, 0, 1, 1)),
      InputError);
}

TEST(ClipLanelet2, CutsBordersWhereTheEdgeCrossesThem) {
  const auto file = tests::data_folder() / "crossing.osm";
  const std::string bytes = read_file(file);
  const RoadMap whole = parse_map(bytes, "crossing.osm");
  const Lane& lane = whole.lanes()[0];
  const Vector2d middle = whole.to_source(lane.centre.in_map.at(0.5 * lane.length_m()));
  // A box whose left edge runs through the middle of a lane.
  const Region region = box(middle.x(), middle.y() - 1e4, middle.x() + 1e4, middle.y() + 1e4);
  const Edited part = clip(bytes, "crossing.osm", region);
  const RoadMap road_map = parse_map(part.bytes, "part.osm");
  std::size_t on_edge = 0;
  for (const Lane& one : road_map.lanes()) {
    for (const LaneLine* line : {&one.left, &one.right}) {
      for (const Vector2d& point : line->in_map.points()) {
        on_edge += std::abs(road_map.to_source(point).x() - middle.x()) < 1e-6 ? 1 : 0;
      }
    }
  }
  EXPECT_GE(on_edge, 2u);
}

// A box that reaches into a lanelet but over none of its borders keeps it whole.
TEST(ClipLanelet2, LeavesNoReferenceToWhatIsNotThere) {
  const std::string bytes = read_file(tests::data_folder() / "crossing.osm");
  const RoadMap whole = parse_map(bytes, "crossing.osm");
  std::size_t parts = 0;
  for (double x = 620.0; x < 780.0; x += 7.7) {
    for (double y = 220.0; y < 380.0; y += 7.3) {
      for (const double side_m : {3.0, 46.8}) {
        const Edited part = clip(bytes, "crossing.osm", box(x, y, x + side_m, y + side_m));
        if (part.bytes.empty()) continue;
        ++parts;
        const RoadMap map = parse_map(part.bytes, "part.osm");
        for (const ImportDiagnostic& remark : map.import_diagnostics()) {
          EXPECT_FALSE(remark.is_fault) << x << ' ' << y << ' ' << side_m << ": " << remark.message;
        }
      }
    }
  }
  EXPECT_GT(parts, 100u);
}

TEST(ClipLanelet2, CountsLinesWhereNoLaneletIs) {
  std::string bytes = read_file(tests::data_folder() / "crossing.osm");
  std::string far;
  for (const int id : {9001, 9002}) {
    far += fmt::format(
        "<node id=\"{}\" lat=\"0\" lon=\"0\"><tag k=\"local_x\" v=\"{}\"/><tag "
        "k=\"local_y\" v=\"5000\"/></node>",
        id, id);
  }
  bytes.insert(bytes.find("</osm>"),
               far + "<way id=\"9003\"><nd ref=\"9001\"/><nd ref=\"9002\"/></way>");
  const auto lines = [&](const Region& region) {
    const Edited nothing = clip(bytes, "crossing.osm", region);
    EXPECT_EQ(nothing.reason, "no lanelet of the map reaches into the region");
    return nothing.counts;
  };
  EXPECT_TRUE(lines(box(-3e3, -3e3, -2e3, -2e3)).empty());
  EXPECT_EQ(lines(box(9001.25, 4990, 9001.75, 5010)),
            (std::vector<Count>{{"lines left out with it", 1}}));
}

// A clip of OpenDRIVE cuts the map itself, a clipper copies of what is near.
TEST(MakeClipper, ClipsEachSquareAsAClipDoes) {
  for (const char* name : {"town.xodr", "crossing.osm", "junction.xml"}) {
    const std::string bytes = read_file(tests::data_folder() / name);
    const RoadMap whole = parse_map(bytes, name);
    for (const bool keeps_whole : {false, true}) {
      const ClipOptions options{.whole = keeps_whole};
      const Clipper clipper = make_clipper(bytes, name, options);
      std::size_t left = 0, empty = 0;
      for (std::size_t i = 0; i < whole.lanes().size(); i += 1 + whole.lanes().size() / 20) {
        const Vector2d at = whole.to_source(whole.lanes()[i].centre.in_map.points().front());
        for (const double shift_m : {0.0, 1e5}) {
          const Region region = box(at.x() + shift_m, at.y(), at.x() + shift_m + 60, at.y() + 40);
          const Edited once = clip(bytes, name, region, options), part = clipper(region);
          EXPECT_EQ(part.bytes, once.bytes);
          EXPECT_EQ(part.counts, once.counts);
          EXPECT_EQ(part.reason, once.reason);
          ++(part.bytes.empty() ? empty : left);
        }
      }
      EXPECT_GT(left, 0u);
      EXPECT_GT(empty, 0u);
    }
  }
}

// Each part goes through the whole road: many parts of a road with many sections have no end.
TEST(ClipOpenDrive, RefusesToGoThroughALongRoadForEachOfManyParts) {
  constexpr int sections = 2000;
  std::string road =
      "<OpenDRIVE><header revMajor='1' revMinor='6'/><road id='1' length='2000' junction='-1'>"
      "<planView><geometry s='0' x='0' y='0' hdg='0' length='2000'><line/></geometry></planView>"
      "<lanes>";
  for (int s_m = 0; s_m < sections; ++s_m) {
    road += fmt::format(
        "<laneSection s='{}'><center><lane id='0' type='none'/></center><right><lane id='-1' "
        "type='driving'><width sOffset='0' a='3' b='0' c='0' d='0'/></lane></right></laneSection>",
        s_m);
  }
  const Clipper clipper = make_clipper(road + "</lanes></road></OpenDRIVE>", "long.xodr");
  int parts = 0;
  const auto cut_all = [&] {
    for (; parts < sections; ++parts) clipper(box(parts, -10.0, parts + 1.0, 10.0));
  };
  EXPECT_THROW(cut_all(), InputError);
  EXPECT_GT(parts, 500);
}

// Lanelets are cut across: rows stay pairs, and lie on the lanelets that they are of.
TEST(ClipCommonRoad, LeavesPartsOfTheLanelets) {
  const std::string bytes = read_file(tests::data_folder() / "junction.xml");
  const RoadMap whole = parse_map(bytes, "junction.xml");
  std::size_t cut = 0;
  for (std::size_t i = 0; i < whole.lanes().size(); i += 3) {
    const Lane& lane = whole.lanes()[i];
    const Vector2d at = whole.to_source(lane.centre.in_map.at(0.43 * lane.length_m()));
    const Edited part =
        clip(bytes, "junction.xml", box(at.x(), at.y(), at.x() + 500, at.y() + 500));
    const RoadMap road_map = parse_map(part.bytes, "part.xml");
    for (const ImportDiagnostic& remark : road_map.import_diagnostics()) {
      EXPECT_FALSE(remark.rule == "import.link") << remark.element << ": " << remark.message;
    }
    for (const Lane& one : road_map.lanes()) {
      const auto of = whole.find_lane(one.name);
      if (!of) continue;  // a further part
      EXPECT_EQ(one.left.in_map.points().size(), one.right.in_map.points().size());
      cut += one.length_m() < whole.lane(*of).length_m() - 1e-6 ? 1 : 0;
      for (const Vector2d& point : one.left.in_map.points()) {
        const Vector2d there = whole.to_map(road_map.to_source(point));
        EXPECT_NEAR(whole.lane(*of).left.in_map.project(there).d_m, 0.0, 1e-9) << one.name;
      }
    }
  }
  EXPECT_GT(cut, 0u);
}

}  // namespace
}  // namespace roadbed::map
