#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "roadbed/map/load_map.h"
#include "roadbed/map/repair/repair.h"
#include "roadbed/map/validate_file.h"

// Links of roads and lanes that a file of OpenDRIVE lacks.

namespace roadbed::map {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// What stands between <laneSection> and its end: lanes with the widths with which they begin and
/// by which they grow per metre, lane 1 or -1 first.
struct LaneText {
  int id;
  double width_m, growth = 0.0;
  std::string type = "driving", link = "";
};

std::string lane_section(double s_m, const std::vector<LaneText>& lanes) {
  std::string left, right;
  for (const LaneText& lane : lanes) {
    (lane.id > 0 ? left : right) += fmt::format(
        R"(<lane id="{}" type="{}">{}<width sOffset="0" a="{}" b="{}" c="0" d="0"/></lane>)",
        lane.id, lane.type, lane.link, lane.width_m, lane.growth);
  }
  return fmt::format(
      R"(<laneSection s="{}">{}<center><lane id="0" type="none"/></center>{}</laneSection>)", s_m,
      left.empty() ? "" : "<left>" + left + "</left>",
      right.empty() ? "" : "<right>" + right + "</right>");
}

/// A road of 60 m along the x axis.
std::string straight_road(int id, double x_m, const std::string& link, const std::string& lanes) {
  return fmt::format(
      R"(<road id="{}" length="60" junction="-1">{}<planView><geometry s="0" x="{}" y="0" hdg="0" )"
      R"(length="60"><line/></geometry></planView><lanes>{}</lanes></road>)",
      id, link, x_m, lanes);
}

std::string open_drive(const std::string& roads) {
  return R"(<OpenDRIVE><header revMajor="1" revMinor="7"/>)" + roads + "</OpenDRIVE>";
}

/// "1/0/-1 1/1/-1" for each lane and one that it leads to, in order.
std::vector<std::string> lane_links(const std::string& bytes) {
  const RoadMap road_map = parse_map(bytes, "a map");
  std::vector<std::string> links;
  for (const Lane& lane : road_map.lanes()) {
    for (const LaneId to : road_map.graph().of(lane.id).successors) {
      links.push_back(lane.name + " " + road_map.lane(to).name);
    }
  }
  std::ranges::sort(links);
  return links;
}

/// What holds of every repair that adds links, and the repaired file.
RepairedFile expect_links_added(const std::string& bytes) {
  RepairedFile file = repair_file(bytes, "a map");
  EXPECT_EQ(file.after, count(validate_bytes(file.bytes, "a map").findings));
  EXPECT_LT(file.after, file.before);
  for (const Repair& repair : file.repairs) EXPECT_EQ(repair.moved_m, 0.0) << repair.what;
  EXPECT_TRUE(repair_file(file.bytes, "a map").repairs.empty());
  return file;
}

TEST(RepairOpenDrive, LinksLanesThatGoOnWhereASectionEnds) {
  const std::string sections = lane_section(0, {{1, 3.0}, {-1, 3.5}, {-2, 2.0, 0.0, "sidewalk"}}) +
                               lane_section(20, {{1, 3.0}, {-1, 3.5}}) +
                               lane_section(45, {{1, 3.0}, {-1, 3.5}});
  const RepairedFile file = expect_links_added(open_drive(straight_road(1, 0.0, "", sections)));
  EXPECT_EQ(file.repairs.size(), 2u);  // one of each seam
  for (const Repair& repair : file.repairs) EXPECT_EQ(repair.rule, "link.dead-end");
  EXPECT_THAT(lane_links(file.bytes),
              ElementsAre("1/0/-1 1/1/-1", "1/1/-1 1/2/-1", "1/1/1 1/0/1", "1/2/1 1/1/1"));
  for (const validation::Finding& finding : validate_bytes(file.bytes, "a map").findings) {
    EXPECT_NE(finding.rule, "link.lane-one-sided");
  }
}

// The second section's lane -1 is as far off as the first one's growth brings it.
TEST(RepairOpenDrive, LinksLanesOverASectionsEndOnlyWhereTheirCornersMeet) {
  const auto links_with = [](const LaneText& before, const LaneText& after) {
    const std::string sections = lane_section(0, {before}) + lane_section(30, {after});
    return lane_links(repair_file(open_drive(straight_road(1, 0, "", sections)), "a map").bytes);
  };
  EXPECT_THAT(links_with({-1, 2.0, 0.05}, {-1, 3.5}), ElementsAre("1/0/-1 1/1/-1"));
  EXPECT_THAT(links_with({-1, 3.5, 0.05}, {-1, 3.5}), IsEmpty());
  EXPECT_THAT(links_with({-1, 3.5}, {-1, 3.5, 0.0, "exit"}), IsEmpty());
  EXPECT_THAT(links_with({-1, 3.0, -0.1}, {-1, 0.0, 0.1}), IsEmpty());  // both without width
  EXPECT_THAT(links_with({1, 3.5}, {-1, 3.5}), IsEmpty());
}

// The first section's lane goes on as lane -2, which says so; lane -1 begins beside it.
TEST(RepairOpenDrive, LinksNoLaneOverASectionsEndThatALinkHasAlready) {
  const LaneText goes_on{-2, 3.5, 0.0, "driving", R"(<link><predecessor id="-1"/></link>)"};
  const std::string sections =
      lane_section(0, {{-1, 3.5}}) + lane_section(30, {{-1, 3.5}, goes_on});
  const RepairedFile file = expect_links_added(open_drive(straight_road(1, 0.0, "", sections)));
  EXPECT_THAT(lane_links(file.bytes), ElementsAre("1/0/-1 1/1/-2"));
}

const char* const kToRoad2 =
    R"(<link><successor elementType="road" elementId="2" contactPoint="start"/></link>)";

TEST(RepairOpenDrive, ReturnsARoadsLinkWithThoseOfItsLanes) {
  const std::string lanes = lane_section(0, {{1, 3.0}, {-1, 3.0}});
  const RepairedFile file = expect_links_added(
      open_drive(straight_road(1, 0.0, kToRoad2, lanes) + straight_road(2, 60.0, "", lanes)));
  ASSERT_EQ(file.repairs.size(), 1u);
  EXPECT_EQ(file.repairs[0].rule, "link.road-one-sided");
  EXPECT_EQ(file.after.warnings, 0u);
  EXPECT_THAT(lane_links(file.bytes), ElementsAre("1/0/-1 2/0/-1", "2/0/1 1/0/1"));
}

TEST(RepairOpenDrive, ReturnsALinkToARoadWhoseIdXmlHasToEscape) {
  const std::string lanes = lane_section(0, {{-1, 3.0}});
  std::string text =
      open_drive(straight_road(1, 0.0, kToRoad2, lanes) + straight_road(2, 60.0, "", lanes));
  text.replace(text.find(R"(id="1")"), 6, R"(id="a&amp;&lt;b")");
  const RepairedFile file = expect_links_added(text);
  EXPECT_THAT(file.bytes, testing::HasSubstr(R"(elementId="a&amp;&lt;b")"));
  EXPECT_THAT(lane_links(file.bytes), ElementsAre("a&<b/0/-1 2/0/-1"));
}

// Of the second road, whose lane 1 is half as wide and which has no lane 2.
TEST(RepairOpenDrive, ReturnsARoadsLinkWithThoseLanesOnlyWhoseCornersMeet) {
  const std::string first = lane_section(0, {{1, 3.0}, {2, 2.0}, {-1, 3.0}});
  const std::string second = lane_section(0, {{1, 1.5}, {-1, 3.0}});
  const RepairedFile file = expect_links_added(
      open_drive(straight_road(1, 0.0, kToRoad2, first) + straight_road(2, 60.0, "", second)));
  EXPECT_THAT(lane_links(file.bytes), ElementsAre("1/0/-1 2/0/-1"));
}

// The second road runs towards the first one, so that their ends meet.
TEST(RepairOpenDrive, ReturnsARoadsLinkWithLanesOfRoadsThatRunTowardsEachOther) {
  std::string first = straight_road(1, 0.0, kToRoad2, lane_section(0, {{1, 2.5}, {-1, 3.0}}));
  first.replace(first.find("\"start\""), 7, "\"end\"");
  std::string second = straight_road(2, 120.0, "", lane_section(0, {{1, 3.0}, {-1, 2.5}}));
  second.replace(second.find("hdg=\"0\""), 7, fmt::format("hdg=\"{}\"", M_PI));
  const RepairedFile file = expect_links_added(open_drive(first + second));
  ASSERT_EQ(file.repairs.size(), 1u);
  EXPECT_THAT(lane_links(file.bytes), ElementsAre("1/0/-1 2/0/1", "2/0/-1 1/0/1"));
}

}  // namespace
}  // namespace roadbed::map
