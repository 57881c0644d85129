// What holds along a lane: speed limits, who may use it, markings and where they may be crossed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "roadbed/tests/support/made_road.h"

namespace roadbed::map {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using tests::lane_of;
using tests::made_lane;
using tests::made_map;
using tests::made_road;
using tests::made_section;
using tests::MadeRoad;

MadeRoad with_lanes(const std::string& left, const std::string& right,
                    const std::string& middle = {}) {
  MadeRoad road;
  road.lanes = made_section(0, left, right, middle);
  return road;
}

TEST(OpenDriveRules, SpeedLimitsFollowTheDriver) {
  MadeRoad road;
  road.type = R"(<type s="0" type="town"><speed max="50" unit="km/h"/></type>
                 <type s="60" type="town"><speed max="20" unit="mph"/></type>)";
  const RoadMap road_map = made_map(made_road(road));
  const Lane& along = lane_of(road_map, "A/0/-1");
  EXPECT_NEAR(along.speed_limit_at_mps(59.9).value(), 50.0 / 3.6, 1e-12);
  EXPECT_NEAR(along.speed_limit_at_mps(60.1).value(), 20.0 * 0.44704, 1e-12);
  const Lane& against = lane_of(road_map, "A/0/1");
  EXPECT_NEAR(against.speed_limit_at_mps(39.9).value(), 20.0 * 0.44704, 1e-12);
  EXPECT_NEAR(against.speed_limit_at_mps(40.1).value(), 50.0 / 3.6, 1e-12);
}

TEST(OpenDriveRules, ALanesOwnSpeedsBeginWhereTheySay) {
  MadeRoad road = with_lanes("", made_lane(-1, R"(<speed sOffset="30" max="10"/>
                                                  <speed sOffset="70" max="no limit"/>)"));
  road.type = R"(<type s="0" type="town"><speed max="20" unit="m/s"/></type>)";
  const RoadMap road_map = made_map(made_road(road));
  const Lane& lane = lane_of(road_map, "A/0/-1");
  ASSERT_EQ(lane.speed_limits.size(), 3u);
  EXPECT_EQ(lane.speed_limit_at_mps(29.0), 20.0);
  EXPECT_EQ(lane.speed_limit_at_mps(31.0), 10.0);
  EXPECT_EQ(lane.speed_limit_at_mps(71.0), std::numeric_limits<double>::infinity());
  EXPECT_EQ(lane.least_speed_limit_mps(), 10.0);
}

TEST(OpenDriveRules, ARoadWithoutSpeedsHasNoLimits) {
  EXPECT_TRUE(lane_of(made_map(made_road({})), "A/0/-1").speed_limits.empty());
}

TEST(OpenDriveRules, NoLimitIsAnInfiniteOneAndUndefinedIsUnknown) {
  const auto with_max = [](const std::string& max) {
    MadeRoad road;
    road.type = "<type s=\"0\"><speed max=\"" + max + "\" unit=\"km/h\"/></type>";
    return lane_of(made_map(made_road(road)), "A/0/-1").speed_limit_at_mps(1.0);
  };
  EXPECT_EQ(with_max("no limit"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(with_max("undefined"), std::nullopt);
}

TEST(OpenDriveRules, AnUnreadableSpeedIsRemarkedAndUnknown) {
  for (const char* speed :
       {R"(max="fast" unit="km/h")", R"(max="50" unit="knots")", R"(max="-5")", R"(max="1e300")"}) {
    MadeRoad road;
    road.type = std::string(R"(<type s="0"><speed )") + speed + "/></type>";
    const RoadMap road_map = made_map(made_road(road));
    EXPECT_THAT(tests::remarks_of(road_map, "import.speed"),
                ElementsAre(HasSubstr("<speed> of road A")))
        << speed;
    EXPECT_FALSE(lane_of(road_map, "A/0/-1").speed_limit_at_mps(1.0)) << speed;
  }
}

Participants users(const std::string& access, const std::string& type = "driving") {
  const MadeRoad road = with_lanes("", made_lane(-1, access, type));
  return lane_of(made_map(made_road(road)), "A/0/-1").participants;
}

TEST(OpenDriveRules, AccessDeniesSomeOrAllowsSomeOnly) {
  Participants no_trucks = Participants::vehicles();
  no_trucks.remove(Participant::truck);
  EXPECT_EQ(users(""), Participants::vehicles());
  EXPECT_EQ(users(R"(<access sOffset="0" rule="deny" restriction="trucks"/>)"), no_trucks);
  EXPECT_EQ(users(R"(<access sOffset="0" restriction="truck"/>)"), no_trucks);
  EXPECT_EQ(users(R"(<access sOffset="0" rule="allow" restriction="bus"/>
                     <access sOffset="0" rule="allow" restriction="taxi"/>)"),
            (Participants{Participant::bus, Participant::taxi}));
  EXPECT_EQ(users(R"(<access sOffset="0" rule="allow"><restriction type="bus"/>
                       <restriction type="bicycle"/></access>)"),
            (Participants{Participant::bus, Participant::bicycle}));
}

TEST(OpenDriveRules, DenyWinsOverAllowAndTheWholeLaneCounts) {
  EXPECT_EQ(users(R"(<access sOffset="0" rule="allow" restriction="bus"/>
                     <access sOffset="0" rule="allow" restriction="taxi"/>
                     <access sOffset="0" rule="deny" restriction="taxi"/>)"),
            Participants{Participant::bus});
  EXPECT_FALSE(users(R"(<access sOffset="0" rule="deny" restriction="none"/>
                        <access sOffset="50" rule="deny" restriction="bus"/>)")
                   .has(Participant::bus));
}

TEST(OpenDriveRules, AccessThatChangesAlongALaneIsRemarked) {
  const auto remarks = [](const std::string& from_m) {
    const std::string access =
        "<access sOffset=\"" + from_m + R"(" rule="deny" restriction="bus"/>)";
    return tests::remarks_of(made_map(made_road(with_lanes("", made_lane(-1, access)))),
                             "import.partial-access");
  };
  EXPECT_TRUE(remarks("0").empty());
  EXPECT_EQ(remarks("20").size(), 1u);
}

TEST(OpenDriveRules, RestrictionsThatAreNoRoadUsersAreKeptInWords) {
  const MadeRoad road = with_lanes(
      "", made_lane(-1, R"(<access sOffset="5" rule="allow" restriction="autonomousTraffic"/>)"));
  const RoadMap road_map = made_map(made_road(road));
  const Lane& lane = lane_of(road_map, "A/0/-1");
  EXPECT_EQ(lane.participants, Participants::vehicles());
  EXPECT_THAT(lane.attributes, ElementsAre(std::pair<std::string, std::string>(
                                   "access", "5 allow autonomousTraffic")));
}

TEST(OpenDriveRules, NobodyDrivesOnRestrictedLanesAndBothWaysOnBidirectionalOnes) {
  EXPECT_TRUE(users("", "restricted").empty());
  const RoadMap road_map = made_map(made_road(with_lanes(
      "",
      made_lane(-1, "", "bidirectional") +
          R"(<lane id="-2" type="driving" direction="both"><width sOffset="0" a="3" b="0" c="0" d="0"/></lane>
                 <lane id="-3" type="driving" direction="reversed"><width sOffset="0" a="3" b="0" c="0" d="0"/></lane>)")));
  EXPECT_FALSE(lane_of(road_map, "A/0/-1").one_way);
  EXPECT_FALSE(lane_of(road_map, "A/0/-2").one_way);
  EXPECT_TRUE(lane_of(road_map, "A/0/-3").one_way);
  EXPECT_NEAR(lane_of(road_map, "A/0/-3").pose_at(0.0).x_m, 100.0, 1e-9);
}

std::vector<MarkType> types(const std::vector<BorderMark>& marks) {
  std::vector<MarkType> types;
  for (const BorderMark& mark : marks) types.push_back(mark.type);
  return types;
}

const char* const kTwoMarks = R"(<roadMark sOffset="0" type="broken" color="white" width="0.12"/>
                                 <roadMark sOffset="30" type="solid" color="yellow"/>)";

TEST(OpenDriveRules, MarkingsFollowTheDriver) {
  const RoadMap road_map =
      made_map(made_road(with_lanes(made_lane(1, kTwoMarks), made_lane(-1, kTwoMarks))));
  const Lane& along = lane_of(road_map, "A/0/-1");
  ASSERT_EQ(types(along.right_marks), (std::vector{MarkType::broken, MarkType::solid}));
  EXPECT_NEAR(along.right_marks[1].from_s_m, 30.0, 1e-9);
  EXPECT_EQ(along.right_marks[0].color, "white");
  EXPECT_EQ(along.right_marks[0].width_m, 0.12);
  const Lane& against = lane_of(road_map, "A/0/1");
  ASSERT_EQ(types(against.right_marks), (std::vector{MarkType::solid, MarkType::broken}));
  EXPECT_NEAR(against.right_marks[1].from_s_m, 70.0, 1e-9);
  EXPECT_TRUE(against.left_marks.empty());  // lane 0 has none
}

// "solid broken" from inside to outside, of lane 0 from left to right.
TEST(OpenDriveRules, OfDoubleLinesTheDriversLeftOneComesFirst) {
  const std::string mark = R"(<roadMark sOffset="0" type="solid broken"/>)";
  const RoadMap road_map = made_map(made_road(
      with_lanes(made_lane(1, mark) + made_lane(2), made_lane(-1, mark) + made_lane(-2), mark)));
  const auto left = [&](const char* name) { return types(lane_of(road_map, name).left_marks); };
  const auto right = [&](const char* name) { return types(lane_of(road_map, name).right_marks); };
  // In the middle, seen along the road: solid left, broken right.
  EXPECT_EQ(left("A/0/-1"), std::vector{MarkType::solid_broken});
  EXPECT_EQ(left("A/0/1"), std::vector{MarkType::broken_solid});
  // Both outer borders are solid on the inside, which is every driver's left.
  EXPECT_EQ(right("A/0/-1"), std::vector{MarkType::solid_broken});
  EXPECT_EQ(left("A/0/-2"), std::vector{MarkType::solid_broken});
  EXPECT_EQ(right("A/0/1"), std::vector{MarkType::solid_broken});
  EXPECT_EQ(left("A/0/2"), std::vector{MarkType::solid_broken});
}

TEST(OpenDriveRules, WhoDrivesBesideTheBrokenLineMayCross) {
  const std::string mark = R"(<roadMark sOffset="0" type="solid broken"/>)";
  const RoadMap road_map = made_map(made_road(
      with_lanes(made_lane(1, mark) + made_lane(2), made_lane(-1, mark) + made_lane(-2), mark)));
  const auto links = [&](const char* name) -> const LaneLinks& {
    return road_map.graph().of(*road_map.find_lane(name));
  };
  EXPECT_TRUE(links("A/0/-1").left->change_allowed());  // broken on the right of the middle
  EXPECT_FALSE(links("A/0/1").left->change_allowed());  // solid on its left
  EXPECT_FALSE(links("A/0/-1").right->change_allowed());
  EXPECT_TRUE(links("A/0/-2").left->change_allowed());
  EXPECT_FALSE(links("A/0/1").right->change_allowed());
  EXPECT_TRUE(links("A/0/2").left->change_allowed());
}

TEST(OpenDriveRules, LaneChangesAreAllowedWhereTheMarkingAllowsThem) {
  const std::string marks = R"(<roadMark sOffset="0" type="broken"/>
    <roadMark sOffset="20" type="solid"/><roadMark sOffset="50" type="solid" laneChange="both"/>
    <roadMark sOffset="60" type="broken" laneChange="increase"/>
    <roadMark sOffset="90" type="none"/>)";
  const RoadMap road_map = made_map(made_road(
      with_lanes(made_lane(1, marks) + made_lane(2), made_lane(-1, marks) + made_lane(-2))));
  const auto windows = [&](const char* name, bool left) {
    const LaneLinks& links = road_map.graph().of(*road_map.find_lane(name));
    return (left ? links.left : links.right)->change_windows;
  };
  const auto near = [](double from_m, double to_m) {
    return testing::AllOf(
        testing::Field(&StationRange::from_s_m, testing::DoubleNear(from_m, 1e-9)),
        testing::Field(&StationRange::to_s_m, testing::DoubleNear(to_m, 1e-9)));
  };
  EXPECT_THAT(windows("A/0/-1", false), ElementsAre(near(0, 20), near(50, 60), near(90, 100)));
  EXPECT_THAT(windows("A/0/-2", true), ElementsAre(near(0, 20), near(50, 100)));
  // Left of the middle the ids grow outwards, and drivers come the other way.
  EXPECT_THAT(windows("A/0/1", false), ElementsAre(near(0, 50), near(80, 100)));
  EXPECT_THAT(windows("A/0/2", true), ElementsAre(near(0, 10), near(40, 50), near(80, 100)));
}

TEST(OpenDriveRules, LeftHandTrafficKeepsMarksSpeedsAndChangesWithItsDrivers) {
  MadeRoad road = with_lanes(made_lane(1), made_lane(-1, kTwoMarks) + made_lane(-2),
                             R"(<roadMark sOffset="0" type="solid broken"/>)");
  road.attributes = R"(rule="LHT")";
  const RoadMap road_map = made_map(made_road(road));
  const Lane& lane = lane_of(road_map, "A/0/-1");  // drives against the road
  EXPECT_NEAR(lane.pose_at(0.0).x_m, 100.0, 1e-9);
  // The middle lies to its right; seen from there the broken line is its own.
  EXPECT_EQ(types(lane.right_marks), std::vector{MarkType::broken_solid});
  EXPECT_EQ(types(lane.left_marks), (std::vector{MarkType::solid, MarkType::broken}));
  const LaneLinks& links = road_map.graph().of(*road_map.find_lane("A/0/-1"));
  EXPECT_EQ(road_map.lane(links.left->lane).name, "A/0/-2");
  EXPECT_EQ(road_map.lane(links.right->lane).name, "A/0/1");
  EXPECT_TRUE(links.right->change_allowed());
  EXPECT_FALSE(links.right->same_direction);
  ASSERT_EQ(links.left->change_windows.size(), 1u);
  EXPECT_NEAR(links.left->change_windows[0].from_s_m, 70.0, 1e-9);
  EXPECT_NEAR(links.left->change_windows[0].to_s_m, 100.0, 1e-9);
  // Along the road drives lane 1, and its border nearer the middle is the right one.
  EXPECT_NEAR(lane_of(road_map, "A/0/1").pose_at(0.0).x_m, 0.0, 1e-9);
  EXPECT_NEAR(lane_of(road_map, "A/0/1").right.in_map.points().front().y(), 0.0, 1e-9);
}

}  // namespace
}  // namespace roadbed::map
