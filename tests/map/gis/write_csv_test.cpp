#include "roadbed/map/gis/write.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "roadbed/tests/support/made_maps.h"

namespace roadbed::map {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> fields_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> fields;
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  return fields;
}

TEST(WriteCsv, GivesEachVertexOfEachLineARow) {
  const auto lines = lines_of(write_csv(tests::straight_two_lane_road(100.0).build()));
  ASSERT_EQ(lines.size(), 1u + 2u * 3u * 2u);
  EXPECT_EQ(lines[0], "road,section,lane,type,line,s_m,x_m,y_m,z_m");
  EXPECT_EQ(lines[1], "1,0,-1,driving,left,0,0,0,0");
  EXPECT_EQ(lines[4], "1,0,-1,driving,right,100,100,-3.5,0");
  EXPECT_EQ(lines[11], "1,0,1,driving,centre,0,100,1.75,0");
}

TEST(WriteCsv, GivesSourceCoordinatesThatReadBackAsTheSameDoubles) {
  tests::MadeMap made;
  const RoadId road = made.add_road("1");
  const double x = 0.1 + 0.2, y = 1.0 / 3.0;
  made.add_lane(road, "-1", {{x, y}, {9, 1}}, {{x, y - 3}, {9, -2}});
  made.parts.origin_in_source = {691607.25, 5334760.5};
  const RoadMap road_map = made.build();
  const auto fields = fields_of(lines_of(write_csv(road_map))[1]);
  ASSERT_EQ(fields.size(), 9u);
  const Eigen::Vector2d expected = road_map.to_source({x, y});
  EXPECT_EQ(std::strtod(fields[6].c_str(), nullptr), expected.x());
  EXPECT_EQ(std::strtod(fields[7].c_str(), nullptr), expected.y());
  EXPECT_NEAR(expected.x(), 691607.55, 1e-6);
}

TEST(WriteCsv, QuotesIdsThatHoldCommasOrQuotes) {
  tests::MadeMap made;
  made.add_lane(made.add_road("a,\"b\""), "-1", {{0, 0}, {9, 0}}, {{0, -3}, {9, -3}});
  EXPECT_EQ(lines_of(write_csv(made.build()))[1].substr(0, 12), "\"a,\"\"b\"\"\",0,");
}

TEST(WriteCsv, LeavesTheRoadEmptyWhereTheSourceHasNone) {
  tests::MadeMap made = tests::straight_two_lane_road();
  made.lane(LaneId{0}).road.reset();
  made.lane(LaneId{0}).origin.source_id = "4711";
  EXPECT_EQ(lines_of(write_csv(made.build()))[1], ",0,4711,driving,left,0,0,0,0");
}

}  // namespace
}  // namespace roadbed::map
