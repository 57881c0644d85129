#include "roadbed/map/gis/lon_lat.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

using Eigen::Vector2d;
using testing::HasSubstr;

RoadMap map_in(const std::string& crs, const CrsOffset& offset = {}) {
  tests::MadeMap made = tests::straight_two_lane_road(100.0);
  made.parts.crs = crs;
  made.parts.offset_in_crs = offset;
  return made.build();
}

template <typename Convert>
std::string refusal_of(const Convert& convert, const RoadMap& road_map, Vector2d point = {1, 2}) {
  return tests::refusal_of([&] { convert(road_map, std::span(&point, 1)); });
}

TEST(LonLat, ThereAndBackIsThePointItself) {
  for (const RoadMap& road_map :
       {map_in("EPSG:25832", {500'000.0, 5'400'000.0, 0.0, 0.4}), map_in("EPSG:32755"),
        map_in("+proj=tmerc +lat_0=48.5 +lon_0=9 +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m")}) {
    std::vector<Vector2d> points, there;
    for (int i = 0; i < 100; ++i)
      points.emplace_back(370.0 * i - 9000.0, 5e6 / (1 + i) - 137.0 * i);
    there = points;
    source_to_lon_lat(road_map, there);
    for (const Vector2d& point : there) EXPECT_LE(std::abs(point.y()), 90.0);
    lon_lat_to_source(road_map, there);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_LT((there[i] - points[i]).norm(), 1e-6) << road_map.crs() << " " << i;
    }
  }
}

// Turned by a quarter and moved: source's x axis runs north from the offset on.
TEST(LonLat, GoesByTheHeadersOffset) {
  const std::string crs = "EPSG:32632";
  const RoadMap plain = map_in(crs);
  const RoadMap turned = map_in(crs, {500'000.0, 5'400'000.0, 0.0, std::numbers::pi / 2});
  std::vector<Vector2d> there{{500'000.0 - 20.0, 5'400'000.0 + 100.0}}, here{{100.0, 20.0}};
  source_to_lon_lat(plain, there);
  source_to_lon_lat(turned, here);
  EXPECT_NEAR(here[0].x(), there[0].x(), 1e-13);
  EXPECT_NEAR(here[0].y(), there[0].y(), 1e-13);
}

TEST(LonLat, IsRefusedWhereTheSystemIsUnknownOrBroken) {
  for (const auto convert : {source_to_lon_lat, lon_lat_to_source}) {
    EXPECT_EQ(refusal_of(convert, map_in("")),
              "longitude and latitude: the map names no coordinate system, needs one, for its "
              "coordinates to have a place on the globe; name it with roadbed import --crs");
    EXPECT_THAT(refusal_of(convert, map_in("+proj=nonsense")), HasSubstr("PROJ cannot use it"));
    EXPECT_THAT(refusal_of(convert, map_in("somewhere")), HasSubstr("\"somewhere\""));
    EXPECT_EQ(refusal_of(convert, map_in("EPSG:32632")), "accepted");
  }
}

}  // namespace
}  // namespace roadbed::map
