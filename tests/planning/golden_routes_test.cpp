// Routes on maps of this project and of others, each looked at once as a picture.

#include <gtest/gtest.h>

#include <string>

#include "roadbed/map/load_map.h"
#include "roadbed/planning/route.h"
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

TEST(GoldenRoutes, OnMapsOfOthersStayAsTheyWereLookedAt) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const Golden all[] = {
      {"BerkeleyLearnVerify+Scenic/Town04.xodr", "901/0/-2", "1497/0/-1", 624.776, 2,
       "901/0/-2 49/0/-2 49/0/-3 1173/0/-3 1173/0/-4 50/0/-4 42/0/-4 271/0/-1 15/0/-1 210/0/-1 "
       "16/0/-1 955/0/-1 52/0/-1 1133/0/-1 9/0/-1 1497/0/-1"},
      {"BerkeleyLearnVerify+Scenic/Town10HD.xodr", "17/0/1", "100/0/1", 347.434, 2,
       "17/0/1 10/0/1 10/0/2 0/0/2 3/0/2 655/0/1 21/0/5 876/0/5 20/0/5 395/0/1 15/0/-2 16/0/-2 "
       "22/0/2 22/0/1 100/0/1"},
      {"maliput+maliput_malidrive/cloverleaf.xodr", "7/0/1", "360/0/1", 1047.297, 2,
       "7/0/1 31/0/-1 151/0/1 3/0/-1 273/0/-1 27/0/-1 821/0/-1 28/0/-1 28/0/-2 29/0/-2 29/0/-3 "
       "384/0/-1 25/0/-2 35/0/2 360/0/1"},
      {"esmini+esmini/multi_intersections.xodr", "262/0/-1", "230/0/-1", 944.913, 1,
       "262/0/-1 266/0/-1 267/0/-1 217/0/1 220/0/-1 222/0/-1 202/0/2 208/0/-1 209/0/-2 209/0/-1 "
       "235/0/1 231/0/-1 230/0/-1"},
      {"esmini+esmini/soderleden.xodr", "2/0/-2", "0/1/-1", 339.830, 1,
       "2/0/-2 2/1/-2 0/0/-2 0/0/-1 0/1/-1"},
      {"huawei-noah+SMARTS/od_newmarket.xodr", "102/0/1", "562/0/-1", 660.089, 0,
       "102/0/1 611/0/-1 101/0/1 605/0/-1 100/0/1 599/0/-1 96/0/-1 589/0/-1 91/0/-1 372/0/-1 "
       "34/0/1 392/0/-1 33/0/1 562/0/-1"},
  };
  for (const Golden& golden : all) {
    expect_route(map::load_map(folder / "opendrive" / golden.file), golden);
  }
}

}  // namespace
}  // namespace roadbed::planning
