#include "roadbed/map/derived/map_part.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "roadbed/map/derived/map_diff.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

RoadMap loaded(const char* file) { return load_map(tests::data_folder() / file); }

const Eigen::AlignedBox2d kEverything(Eigen::Vector2d(-1e6, -1e6), Eigen::Vector2d(1e6, 1e6));

std::multiset<std::string> names(const RoadMap& road_map, const std::vector<LaneId>& lanes) {
  std::multiset<std::string> found;
  for (const LaneId id : lanes) found.insert(road_map.lane(id).name);
  return found;
}

// Those of the whole that the part has, too.
std::multiset<std::string> kept_names(const RoadMap& whole, const RoadMap& part,
                                      const std::vector<LaneId>& lanes) {
  std::multiset<std::string> found;
  for (const std::string& name : names(whole, lanes)) {
    if (part.find_lane(name)) found.insert(name);
  }
  return found;
}

TEST(MapPart, OfEverythingIsTheWhole) {
  for (const char* file : {"town.xodr", "crossing.osm"}) {
    const RoadMap whole = loaded(file), part = map_part(whole, kEverything);
    EXPECT_TRUE(diff(whole, part, {}).empty()) << file;
    EXPECT_EQ(part.signals().size(), whole.signals().size()) << file;
    EXPECT_EQ(part.regulations().size(), whole.regulations().size()) << file;
    EXPECT_EQ(part.objects().size(), whole.objects().size()) << file;
    EXPECT_EQ(part.stop_lines().size(), whole.stop_lines().size()) << file;
  }
}

TEST(MapPart, HasEveryLaneThatReachesIntoTheBox) {
  const RoadMap whole = loaded("town.xodr");
  const Lane& lane = whole.lane(*whole.find_lane("7/0/1"));
  const Eigen::Vector2d middle = lane.pose_at(30.0).position(), half(40.0, 25.0);
  const Eigen::AlignedBox2d box(middle - half, middle + half);
  const RoadMap part = map_part(whole, box);
  std::size_t inside = 0;
  for (const Lane& one : whole.lanes()) {
    const auto is_inside = [&](const Eigen::Vector2d& point) { return box.contains(point); };
    if (!std::ranges::any_of(one.polygon, is_inside)) continue;
    EXPECT_TRUE(part.find_lane(one.name)) << one.name;
    ++inside;
  }
  EXPECT_GE(part.lanes().size(), inside);
  EXPECT_LT(part.lanes().size(), whole.lanes().size() / 2);
}

TEST(MapPart, KeepsLinksBetweenLanesThatAreKept) {
  const RoadMap whole = loaded("town.xodr");
  const Eigen::Vector2d middle = whole.lane(*whole.find_lane("7/0/1")).pose_at(0.0).position();
  const RoadMap part = map_part(whole, {middle.array() - 30.0, middle.array() + 30.0});
  std::size_t links = 0;
  for (const Lane& lane : part.lanes()) {
    const LaneId before = *whole.find_lane(lane.name);
    const LaneLinks &now = part.graph().of(lane.id), &then = whole.graph().of(before);
    EXPECT_EQ(names(part, now.successors), kept_names(whole, part, then.successors)) << lane.name;
    EXPECT_EQ(names(part, now.predecessors), kept_names(whole, part, then.predecessors));
    EXPECT_EQ(lane.road ? part.road(*lane.road).source_id : "",
              whole.lane(before).road ? whole.road(*whole.lane(before).road).source_id : "");
    if (now.left) {
      EXPECT_EQ(part.lane(now.left->lane).name, whole.lane(then.left->lane).name);
    }
    links += now.successors.size();
  }
  EXPECT_GT(links, 5U);
}

TEST(MapPart, HasSignsAndRulesOfItsLanesOnly) {
  const RoadMap whole = loaded("crossing.osm");
  ASSERT_GT(whole.regulations().size(), 0U);
  const LaneId first = whole.regulations()[0].lanes.at(0);
  const Eigen::Vector2d at = whole.lane(first).pose_at(0.0).position();
  const RoadMap part = map_part(whole, {at.array() - 3.0, at.array() + 3.0});
  ASSERT_GT(part.regulations().size(), 0U);
  for (const Regulation& one : part.regulations()) {
    EXPECT_FALSE(one.lanes.empty());
    for (const LaneId id : one.lanes) EXPECT_LT(id.index, part.lanes().size());
    for (const RegulationMember& member : one.members) {
      if (member.lane) {
        EXPECT_EQ(part.lane(*member.lane).origin.source_id, member.source_id);
      }
    }
  }
}

TEST(MapPart, OfNoBoxIsEmpty) {
  const RoadMap part = map_part(loaded("town.xodr"), {});
  EXPECT_EQ(part.lanes().size(), 0U);
  EXPECT_EQ(part.roads().size(), 0U);
}

}  // namespace
}  // namespace roadbed::map
