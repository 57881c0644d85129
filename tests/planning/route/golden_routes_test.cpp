// Routes on maps of this project and of others, each looked at once as a picture.

#include <gtest/gtest.h>

#include <string>

#include "roadbed/map/load_map.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::planning {
namespace {

struct Golden {
  std::string file, from, to;
  double length_m;
  int lane_changes;
  std::string lanes;
};

void expect_route(const map::RoadMap& road_map, const Golden& golden) {
  SCOPED_TRACE(golden.file);
  const auto from = road_map.find_lane(golden.from), to = road_map.find_lane(golden.to);
  ASSERT_TRUE(from && to);
  const RouteAnswer answer = find_route(road_map, {*from, 0.0, 0.0}, {*to, 0.0, 0.0});
  ASSERT_TRUE(answer.route) << answer.reason;
  std::string lanes;
  for (const RouteLeg& leg : answer.route->legs) {
    lanes += (lanes.empty() ? "" : " ") + road_map.lane(leg.lane).name;
  }
  EXPECT_EQ(lanes, golden.lanes);
  EXPECT_NEAR(answer.route->length_m, golden.length_m, 0.05);
  EXPECT_EQ(answer.route->lane_changes, golden.lane_changes);
}

TEST(GoldenRoutes, ThroughTheTownTheRingRoadIsFastest) {
  const Golden golden{
      "town.xodr",
      "1/0/-1",
      "7/0/1",
      1325.274,
      0,
      "1/0/-1 1/1/-1 1/2/-1 1/3/-1 5/0/-1 30/0/-1 30/1/-1 30/2/-1 3000/0/-1 31/0/-1 3100/0/-1 "
      "32/0/-1 32/1/-1 32/2/-1 6/0/-1 6/1/-1 2001/0/-1 20/0/-1 2102/0/-1 7/0/1"};
  expect_route(map::load_map(tests::data_folder() / golden.file), golden);
}

TEST(GoldenRoutes, AtTheCrossingTheLaneForTurningRightIsTakenBeforeIt) {
  const Golden golden{"crossing.osm", "20", "180", 60.0, 1, "20 27 180"};
  expect_route(map::load_map(tests::data_folder() / golden.file), golden);
}

TEST(GoldenRoutes, OnMapsOfOthersStayAsTheyWereLookedAt) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const Golden all[] = {
      {"opendrive/BerkeleyLearnVerify+Scenic/Town04.xodr", "901/0/-2", "1497/0/-1", 624.776, 2,
       "901/0/-2 49/0/-2 49/0/-3 1173/0/-3 1173/0/-4 50/0/-4 42/0/-4 271/0/-1 15/0/-1 210/0/-1 "
       "16/0/-1 955/0/-1 52/0/-1 1133/0/-1 9/0/-1 1497/0/-1"},
      {"opendrive/BerkeleyLearnVerify+Scenic/Town10HD.xodr", "17/0/1", "100/0/1", 347.434, 2,
       "17/0/1 10/0/1 10/0/2 0/0/2 3/0/2 655/0/1 21/0/5 876/0/5 20/0/5 395/0/1 15/0/-2 16/0/-2 "
       "22/0/2 22/0/1 100/0/1"},
      {"opendrive/maliput+maliput_malidrive/cloverleaf.xodr", "7/0/1", "360/0/1", 1047.297, 2,
       "7/0/1 31/0/-1 151/0/1 3/0/-1 273/0/-1 27/0/-1 821/0/-1 28/0/-1 28/0/-2 29/0/-2 29/0/-3 "
       "384/0/-1 25/0/-2 35/0/2 360/0/1"},
      {"opendrive/esmini+esmini/multi_intersections.xodr", "262/0/-1", "230/0/-1", 944.913, 1,
       "262/0/-1 266/0/-1 267/0/-1 217/0/1 220/0/-1 222/0/-1 202/0/2 208/0/-1 209/0/-2 209/0/-1 "
       "235/0/1 231/0/-1 230/0/-1"},
      {"opendrive/esmini+esmini/soderleden.xodr", "2/0/-2", "0/1/-1", 339.830, 1,
       "2/0/-2 2/1/-2 0/0/-2 0/0/-1 0/1/-1"},
      {"opendrive/huawei-noah+SMARTS/od_newmarket.xodr", "102/0/1", "562/0/-1", 660.089, 0,
       "102/0/1 611/0/-1 101/0/1 605/0/-1 100/0/1 599/0/-1 96/0/-1 589/0/-1 91/0/-1 372/0/-1 "
       "34/0/1 392/0/-1 33/0/1 562/0/-1"},
      {"opendrive/BerkeleyLearnVerify+Scenic/Town01.xodr", "341/0/1", "333/0/-1", 676.603, 0,
       "341/0/1 25/0/1 75/0/1 1/0/1 27/0/1 16/0/-1 253/0/-1 10/0/1 354/0/1 9/0/1 193/0/1 21/0/1 "
       "131/0/1 2/0/1 83/0/1 25/0/-1 333/0/-1"},
      {"opendrive/ivsg-psu+PathPlanning_MapTools_ParseXODR/WBeaverAve.xodr", "3534/0/-2",
       "3513/0/-1", 817.308, 2,
       "3534/0/-2 3224/0/-2 3224/0/-1 3422/0/-1 3225/0/-1 3484/0/-1 3218/0/-1 3423/0/-1 3219/0/-1 "
       "3642/0/-1 3217/0/-1 3491/0/-1 2876/0/-1 3532/0/-1 2877/0/-1 3261/0/-1 3226/0/-1 3437/0/-1 "
       "3227/0/-1 3256/0/-1 2897/0/-1 2897/0/-2 3621/0/-2 2898/0/-2 3617/0/-2 2899/0/-2 3399/0/-2 "
       "2900/0/-2 3286/0/-1 2887/0/-1 3511/0/-1 2888/0/-1 3341/0/-1 2889/0/-1 3513/0/-1"},
      {"lanelet2/fzi-forschungszentrum-informatik+Lanelet2/mapping_example.osm",
       "6012398680329441872", "7402914969115001621", 103.162, 3,
       "6012398680329441872 5499728065004547155 6923355182620813640 4819270741178254817 "
       "7634496477757533080 6911248270169482253 104180959442016125 5500878114409909220 "
       "5219605276379452838 3766978479898785248 9123153028072835627 8607646396414175765 "
       "1993127157384578621 3093071314729702331 7402914969115001621"},
      {"lanelet2/autowarefoundation+autoware_core/vm_03_left_hand.osm", "2299", "2271", 66.442, 3,
       "2299 2300 2302 2245 2244 2271"},
      {"commonroad/CommonRoad+commonroad-reachable-set/ARG_Carcarana-1_1_T-1.xml", "4226", "4454",
       824.699, 0,
       "4226 3652 4940 3514 4565 3511 4240 3436 4588 3343 4359 3556 4698 3515 4567 3653 4944 3341 "
       "4454"},
  };
  for (const Golden& golden : all) {
    expect_route(map::load_map(folder / golden.file), golden);
  }
}

}  // namespace
}  // namespace roadbed::planning
