#include "roadbed/map/lanelet2/write/write.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/lanelet2/write/shared_borders.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/made_open_drive.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

using testing::HasSubstr;

RoadMap written(const RoadMap& road_map) {
  return parse_map(
      lanelet2::write_lanelet2(road_map, {.crs = "EPSG:32632", .offset_in_crs = {}}).bytes,
      "written.osm");
}

double apart_m(const RoadMap& a, const LaneLine& one, const RoadMap& b, const LaneLine& other) {
  const auto& points = one.in_map.points();
  const auto& others = other.in_map.points();
  if (points.size() != others.size()) return 1e9;
  double worst = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    worst = std::max({worst, (a.to_source(points[i]) - b.to_source(others[i])).norm(),
                      std::abs(one.z_m[i] - other.z_m[i])});
  }
  return worst;
}

using Link = std::tuple<std::string, std::string, bool>;

std::vector<std::vector<Link>> links(const RoadMap& road_map) {
  std::vector<std::vector<Link>> all;
  for (const Lane& lane : road_map.lanes()) {
    const LaneLinks& from = road_map.graph().of(lane.id);
    std::vector<Link> list;
    for (const LaneId to : from.successors) list.emplace_back("next", road_map.lane(to).name, true);
    std::sort(list.begin(), list.end());
    for (const auto& [side, neighbour] :
         {std::pair("left", from.left), std::pair("right", from.right)}) {
      if (!neighbour) continue;
      list.emplace_back(side, road_map.lane(neighbour->lane).name, neighbour->same_direction);
      list.emplace_back("change", "", neighbour->change_allowed());
    }
    all.push_back(std::move(list));
  }
  return all;
}

void expect_same(const RoadMap& before, const RoadMap& after) {
  ASSERT_EQ(before.lanes().size(), after.lanes().size());
  for (std::size_t i = 0; i < before.lanes().size(); ++i) {
    const Lane& a = before.lanes()[i];
    const Lane& b = after.lanes()[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.type, b.type);
    EXPECT_EQ(a.participants, b.participants);
    EXPECT_EQ(a.one_way, b.one_way);
    EXPECT_EQ(a.least_speed_limit_mps().has_value(), b.least_speed_limit_mps().has_value());
    EXPECT_LT(apart_m(before, a.left, after, b.left), 1e-4) << "lane " << a.name;
    EXPECT_LT(apart_m(before, a.right, after, b.right), 1e-4) << "lane " << a.name;
    EXPECT_LT(apart_m(before, a.centre, after, b.centre), 1e-4) << "lane " << a.name;
  }
  EXPECT_EQ(links(before), links(after));
  EXPECT_EQ(before.regulations().size(), after.regulations().size());
  EXPECT_EQ(before.areas().size(), after.areas().size());
  EXPECT_EQ(before.crs(), after.crs());
}

TEST(WriteLanelet2, ALanelet2MapComesBackAsItWas) {
  const RoadMap before = load_map(tests::data_folder() / "crossing.osm");
  const lanelet2::Lanelet2File file = lanelet2::write_lanelet2(before);
  EXPECT_TRUE(file.notes.empty());
  expect_same(before, parse_map(file.bytes, "written.osm"));
}

TEST(WriteLanelet2, ARealLanelet2MapComesBackAsItWas) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  const RoadMap before =
      load_map(real / "lanelet2/fzi-forschungszentrum-informatik+Lanelet2/mapping_example.osm");
  expect_same(before, parse_map(lanelet2::write_lanelet2(before).bytes, "written.osm"));
}

TEST(WriteLanelet2, LinksOfAnOpenDriveMapSurvive) {
  const RoadMap before = load_map(tests::data_folder() / "town.xodr");
  const RoadMap after = parse_map(lanelet2::write_lanelet2(before).bytes, "written.osm");
  std::size_t followings = 0;
  for (const Lane& lane : before.lanes()) {
    if (lane.participants.empty()) continue;
    for (const LaneId to : before.graph().of(lane.id).successors) {
      followings += before.lane(to).participants.empty() ? 0 : 1;
    }
  }
  std::size_t found = 0;
  for (const Lane& lane : after.lanes()) found += after.graph().of(lane.id).successors.size();
  EXPECT_EQ(found, followings);
}

TEST(WriteLanelet2, NeighboursShareTheWayBetweenThem) {
  const RoadMap after = written(tests::straight_two_lane_road().build());
  ASSERT_EQ(after.lanes().size(), 2u);
  for (const Lane& lane : after.lanes()) {
    const LaneLinks& sides = after.graph().of(lane.id);
    ASSERT_TRUE(sides.left) << lane.name;
    EXPECT_FALSE(sides.left->same_direction);
    EXPECT_FALSE(sides.right);
  }
}

TEST(WriteLanelet2, LaneChangesAreSaidByTheLineOrItsTags) {
  for (const bool right_may : {false, true}) {
    for (const bool left_may : {false, true}) {
      tests::MadeMap made;
      const RoadId road = made.add_road("1");
      const LaneId left = made.add_lane(road, "-1", {{0, 3}, {50, 3}}, {{0, 0}, {50, 0}});
      const LaneId right = made.add_lane(road, "-2", {{0, 0}, {50, 0}}, {{0, -3}, {50, -3}});
      made.put_beside(left, right);
      const std::vector<StationRange> whole = {{0.0, 50.0}};
      made.parts.links[left.index].right->change_windows =
          left_may ? whole : std::vector<StationRange>{};
      made.parts.links[right.index].left->change_windows =
          right_may ? whole : std::vector<StationRange>{};
      // A marking that says something else than the map.
      made.lane(left).right_marks = {{0.0, MarkType::solid_broken, "white", 0.15}};
      const RoadMap after = written(made.build());
      EXPECT_EQ(after.graph().of(left).right.value().change_allowed(), left_may);
      EXPECT_EQ(after.graph().of(right).left.value().change_allowed(), right_may);
      EXPECT_EQ(after.lane(left).right_marks.at(0).type, MarkType::solid_broken);
    }
  }
}

TEST(WriteLanelet2, NamesWhatItHasNoElementFor) {
  const RoadMap town = load_map(tests::data_folder() / "town.xodr");
  const auto file = lanelet2::write_lanelet2(town, {.crs = "EPSG:32632", .offset_in_crs = {}});
  const auto count = [&](const std::string& what) {
    for (const auto& [name, number] : file.lost) {
      if (name == what) return number;
    }
    return std::size_t{0};
  };
  EXPECT_EQ(count("junctions"), town.junctions().size());
  EXPECT_EQ(count("controllers"), town.controllers().size());
  EXPECT_EQ(count("regulations"), town.regulations().size());
  EXPECT_GT(count("junctions"), 0u);
}

TEST(WriteLanelet2, EndsAreJoinedByLinksAndNotByTouching) {
  tests::MadeMap made;
  const RoadId road = made.add_road("1");
  const LaneId first = made.add_lane(road, "-1", {{0, 3}, {50, 3}}, {{0, 0}, {50, 0}});
  const LaneId next = made.add_lane(road, "-2", {{50.1, 3}, {90, 3}}, {{50.1, 0}, {90, 0}});
  const LaneId apart = made.add_lane(road, "-3", {{50, 3}, {90, 9}}, {{50, 0}, {90, 6}});
  made.link(first, next);
  const RoadMap before = made.build();
  const RoadMap after = written(before);
  EXPECT_EQ(after.graph().of(first).successors, std::vector{next});
  EXPECT_TRUE(after.graph().of(apart).predecessors.empty());
  EXPECT_NEAR(lanelet2::share_borders(before).largest_move_m, 0.1, 1e-9);
  EXPECT_EQ(lanelet2::share_borders(before, {.join_m = 0.05, .step_m = 0.05}).lost_links, 1u);
}

TEST(WriteLanelet2, WhereAWidthJumpsTheBorderGoesOnByAStep) {
  tests::MadeMap made;
  const RoadId road = made.add_road("1");
  const LaneId first = made.add_lane(road, "-1", {{0, 3}, {50, 3}}, {{0, 0}, {50, 0}});
  const LaneId next = made.add_lane(road, "-2", {{50, 4.5}, {90, 4.5}}, {{50, 0}, {90, 0}});
  made.link(first, next);
  const RoadMap before = made.build(), after = written(before);
  EXPECT_EQ(after.graph().of(first).successors, std::vector{next});
  std::vector<Eigen::Vector2d> left;
  for (const Eigen::Vector2d& point : after.lane(next).left.in_map.points()) {
    left.push_back(after.to_source(point));
  }
  ASSERT_EQ(left.size(), 3U);
  EXPECT_NEAR((left[0] - Eigen::Vector2d(50, 3)).norm(), 0.0, 2e-6);
  EXPECT_NEAR((left[1] - Eigen::Vector2d(50, 4.5)).norm(), 0.0, 2e-6);
  EXPECT_NEAR(lanelet2::share_borders(before).largest_step_m, 1.5, 1e-9);
  EXPECT_EQ(lanelet2::share_borders(before).largest_move_m, 0.0);
}

TEST(WriteLanelet2, LimitsDirectionsAndNamesAreTags) {
  tests::MadeMap made = tests::straight_two_lane_road();
  made.lane(LaneId{0}).one_way = false;
  const RoadMap before = made.build();
  const RoadMap after = written(before);
  EXPECT_FALSE(after.lanes()[0].one_way);
  EXPECT_NEAR(after.lanes()[0].least_speed_limit_mps().value(),
              before.lanes()[0].least_speed_limit_mps().value(), 1e-4);
  const auto& tags = after.lanes()[0].attributes;
  EXPECT_TRUE(std::find(tags.begin(), tags.end(),
                        std::pair<std::string, std::string>("name", before.lanes()[0].name)) !=
              tags.end());
}

TEST(WriteLanelet2, AMapWithoutALaneThatSomebodyMayUseIsRefused) {
  tests::MadeMap made = tests::straight_two_lane_road();
  for (std::uint32_t i = 0; i < 2; ++i) made.lane(LaneId{i}).participants = {};
  EXPECT_THROW(written(made.build()), InputError);
}

TEST(WriteLanelet2, AMapOfUnknownPlaceIsRefused) {
  try {
    lanelet2::write_lanelet2(tests::straight_two_lane_road().build());
    FAIL() << "was written";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("--anchor LAT,LON"));
  }
}

}  // namespace
}  // namespace roadbed::map
