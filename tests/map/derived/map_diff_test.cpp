#include "roadbed/map/derived/map_diff.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/made_open_drive.h"

namespace roadbed::map {
namespace {

using Kind = MapChange::Kind;

RoadMapParts parts() { return tests::straight_two_lane_road().parts; }

std::vector<MapChange> changes(const RoadMapParts& before, const RoadMapParts& after) {
  return diff(RoadMap(before), RoadMap(after));
}

TEST(MapDiff, OfAMapWithItselfIsEmpty) {
  EXPECT_TRUE(diff(tests::curved_two_lane_road(), tests::curved_two_lane_road()).empty());
}

TEST(MapDiff, NamesALaneThatIsNew) {
  tests::MadeMap after = tests::straight_two_lane_road();
  after.add_lane(RoadId{0}, "-2", {{0.0, -3.5}, {100.0, -3.5}}, {{0.0, -7.0}, {100.0, -7.0}});
  const auto found = changes(parts(), after.parts);
  const auto added = std::find_if(found.begin(), found.end(),
                                  [](const MapChange& change) { return change.theme == "lane"; });
  ASSERT_NE(added, found.end());
  EXPECT_EQ(added->element, "1/0/-2");
  EXPECT_EQ(added->kind, Kind::added);
  const auto back = changes(after.parts, parts());
  EXPECT_TRUE(std::any_of(back.begin(), back.end(), [](const MapChange& change) {
    return change.theme == "lane" && change.kind == Kind::removed;
  }));
}

TEST(MapDiff, NamesALaneOfAnotherType) {
  RoadMapParts after = parts();
  after.lanes[1].type = LaneType::parking;
  const auto found = changes(parts(), after);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].theme, "lane");
  EXPECT_EQ(found[0].element, after.lanes[1].name);
  EXPECT_EQ(found[0].facets, std::vector<std::string>{"type"});
}

TEST(MapDiff, SaysHowFarAndWhereABorderMoved) {
  RoadMapParts after = parts();
  Lane& lane = after.lanes[0];
  auto points = lane.right.in_map.points();
  points.back() += Eigen::Vector2d(0.0, -0.25);
  lane.right.in_map = geometry::Polyline(points);
  const auto found = changes(parts(), after);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].theme, "geometry");
  EXPECT_NEAR(found[0].moved_m, 0.25, 1e-3);
  ASSERT_TRUE(found[0].in_source);
  EXPECT_NEAR((*found[0].in_source - points.back()).norm(), 0.0, 1e-9);
}

TEST(MapDiff, SaysThatALaneWasRaised) {
  RoadMapParts after = parts();
  for (double& z_m : after.lanes[0].centre.z_m) z_m += 0.1;
  const auto found = changes(parts(), after);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].facets, std::vector<std::string>{"elevation"});
}

TEST(MapDiff, IsSilentOfMovesBelowTheTolerance) {
  RoadMapParts after = parts();
  Lane& lane = after.lanes[0];
  auto points = lane.right.in_map.points();
  points.back().y() -= 0.0005;
  lane.right.in_map = geometry::Polyline(points);
  EXPECT_TRUE(changes(parts(), after).empty());
  EXPECT_EQ(diff(RoadMap(parts()), RoadMap(after), {.tolerance_m = 1e-4}).size(), 1U);
}

TEST(MapDiff, NamesALinkThatIsGone) {
  RoadMapParts before = parts();
  before.links[0].successors = {LaneId{1}};
  before.links[1].predecessors = {LaneId{0}};
  const auto found = changes(before, parts());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].theme, "link");
  EXPECT_EQ(found[0].kind, Kind::removed);
  EXPECT_EQ(found[0].element, before.lanes[0].name + " to " + before.lanes[1].name);
}

TEST(MapDiff, NamesASpeedLimitASignalAndARegulationThatChanged) {
  RoadMapParts before = parts();
  before.signals.emplace_back().source_id = "7";
  before.regulations.emplace_back().source_id = "8";
  RoadMapParts after = before;
  after.lanes[0].speed_limits = {{0.0, 8.3}};
  after.signals[0].value = 30.0;
  after.regulations[0].lanes = {LaneId{1}};
  const auto found = changes(before, after);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].theme, "speed_limit");
  EXPECT_EQ(found[1].theme, "signal");
  EXPECT_EQ(found[1].facets, std::vector<std::string>{"value"});
  EXPECT_EQ(found[2].theme, "regulation");
  EXPECT_EQ(found[2].facets, std::vector<std::string>{"lanes"});
}

TEST(MapDiff, DoesNotCareAboutTheOriginOfCoordinates) {
  RoadMapParts after = parts();
  const Eigen::Vector2d shift(1000.0, -2000.0);
  after.origin_in_source = shift;
  for (Road& road : after.roads) {
    auto points = road.reference_in_map.points();
    for (auto& point : points) point -= shift;
    if (!points.empty()) road.reference_in_map = geometry::Polyline(points);
  }
  for (Lane& lane : after.lanes) {
    for (LaneLine* line : {&lane.left, &lane.centre, &lane.right}) {
      auto points = line->in_map.points();
      for (auto& point : points) point -= shift;
      line->in_map = geometry::Polyline(points);
    }
    for (auto& point : lane.polygon) point -= shift;
  }
  EXPECT_TRUE(changes(parts(), after).empty());
}

TEST(MapDiff, MindsNoOrderInWhichLanesAreNamed) {
  RoadMapParts before = parts(), after = parts();
  Regulation regulation;
  regulation.source_id = "7";
  regulation.lanes = {LaneId{0}, LaneId{1}};
  before.regulations = {regulation};
  std::reverse(regulation.lanes.begin(), regulation.lanes.end());
  after.regulations = {regulation};
  EXPECT_TRUE(changes(before, after).empty());
  after.regulations[0].lanes.pop_back();
  EXPECT_EQ(changes(before, after).size(), 1U);
}

}  // namespace
}  // namespace roadbed::map
