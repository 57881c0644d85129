#include "roadbed/map/opendrive/write/road_heights.h"

#include <gtest/gtest.h>

#include "roadbed/map/load_map.h"
#include "roadbed/map/opendrive/write/write.h"
#include "roadbed/tests/support/made_road.h"

namespace roadbed::map {
namespace {

TEST(RoadHeights, LanesKeepTheirHeightAboveTheRoad) {
  const auto kerb = [](int id, const char* heights) {
    return tests::made_lane(id, heights, "sidewalk", 2.0);
  };
  tests::MadeRoad road;
  road.id = "1";
  road.elevation = R"(<elevation s="0" a="5" b="0.02" c="0" d="0"/>)";
  road.lanes = tests::made_section(
      0,
      kerb(2, R"(<height sOffset="0" inner="0.02" outer="0.12"/>
                    <height sOffset="30" inner="0.12" outer="0.15"/>)") +
          tests::made_lane(1),
      tests::made_lane(-1) + kerb(-2, R"(<height sOffset="0" inner="0.12" outer="0.12"/>)"));
  const RoadMap before = tests::made_map(tests::made_road(road));
  for (const int minor : {4, 8}) {
    const opendrive::OpenDriveFile file =
        opendrive::write_open_drive(before, {before.crs(), {}, minor});
    EXPECT_LE(file.largest_height_error_m, 1e-3);
    EXPECT_EQ(file.bytes.find("superelevation"), std::string::npos);
    const RoadMap after = parse_map(file.bytes, "written.xodr");
    for (const Lane& lane : before.lanes()) {
      const Lane& other = tests::lane_of(after, lane.name);
      for (double s_m = 0.5; s_m < lane.length_m(); s_m += 1.0) {
        for (const auto line : {&Lane::left, &Lane::right}) {
          EXPECT_NEAR(Lane::height_at(other.*line, s_m), Lane::height_at(lane.*line, s_m), 1e-3)
              << lane.name << " at " << s_m;
        }
      }
    }
  }
}

}  // namespace
}  // namespace roadbed::map
