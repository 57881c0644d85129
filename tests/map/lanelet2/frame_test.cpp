#include "roadbed/map/lanelet2/frame.h"

#include <gtest/gtest.h>

namespace roadbed::map {
namespace {

TEST(CrsText, UtmIsTheSameByCodeAndByProjString) {
  const auto code = lanelet2::transverse_mercator_of("EPSG:32632").value();
  const auto text =
      lanelet2::transverse_mercator_of("+proj=utm +zone=32 +datum=WGS84 +units=m").value();
  const auto point = GeographicPoint{49.0, 8.4};
  EXPECT_EQ(code.forward(point), text.forward(point));
  EXPECT_NEAR(code.forward(point).x(), 456114.59586, 1e-4);
  const auto etrs89 = lanelet2::transverse_mercator_of("EPSG:25832").value();
  EXPECT_EQ(etrs89.central_meridian_deg, code.central_meridian_deg);
  EXPECT_EQ(etrs89.false_easting_m, code.false_easting_m);
  const auto south = lanelet2::transverse_mercator_of("EPSG:32756").value();
  EXPECT_EQ(south.false_northing_m, 1e7);
  EXPECT_EQ(south.false_northing_m,
            lanelet2::transverse_mercator_of("+proj=utm +zone=56 +south").value().false_northing_m);
}

TEST(CrsText, TransverseMercatorHasItsParameters) {
  const auto grid = lanelet2::transverse_mercator_of(
                        "+proj=tmerc +lat_0=48.5 +lon_0=9 +k=0.9999 +x_0=10 +y_0=-20 +ellps=GRS80 "
                        "+units=m +no_defs")
                        .value();
  EXPECT_EQ(grid.central_meridian_deg, 9.0);
  EXPECT_EQ(grid.latitude_of_origin_deg, 48.5);
  EXPECT_EQ(grid.scale, 0.9999);
  EXPECT_EQ(grid.false_easting_m, 10.0);
  EXPECT_EQ(grid.false_northing_m, -20.0);
}

TEST(CrsText, OtherSystemsAreNotMistakenForOne) {
  for (const char* crs :
       {"", "EPSG:25832x", "EPSG:4326", "EPSG:32661", "+proj=merc +datum=WGS84", "+proj=utm",
        "+proj=utm +zone=61", "+proj=tmerc +ellps=bessel", "+proj=tmerc +lon_0=x",
        "+proj=tmerc +units=us-ft", "+proj=tmerc +lat_0=91", "PROJCS[\"WGS 84 / UTM zone 32N\"]"}) {
    EXPECT_FALSE(lanelet2::transverse_mercator_of(crs)) << crs;
  }
}

}  // namespace
}  // namespace roadbed::map
