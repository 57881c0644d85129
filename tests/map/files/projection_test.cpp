#include "roadbed/map/files/projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map {
namespace {

using Eigen::Vector2d;

TEST(ToLonLat, PutsACentralMeridianWhereUtmHasIt) {
  std::vector<Vector2d> points{{500000.0, 0.0}, {500000.0, 5400000.0}};
  to_lon_lat("EPSG:32632", points);
  EXPECT_NEAR(points[0].x(), 9.0, 1e-12);
  EXPECT_NEAR(points[0].y(), 0.0, 1e-12);
  EXPECT_NEAR(points[1].x(), 9.0, 1e-12);
  EXPECT_NEAR(points[1].y(), 48.7530, 1e-3);
}

TEST(ToLonLat, AgreesWithTheEarthsRadiusNearAnAnchor) {
  const double latitude_deg = 48.78, longitude_deg = 9.18, step_m = 100.0;
  std::vector<Vector2d> points{{0, 0}, {step_m, 0}, {0, step_m}};
  to_lon_lat(system_anchored_at(latitude_deg, longitude_deg), points);
  EXPECT_NEAR(points[0].x(), longitude_deg, 1e-12);
  EXPECT_NEAR(points[0].y(), latitude_deg, 1e-12);
  const double a_m = 6378137.0, f = 1.0 / 298.257223563, e2 = f * (2.0 - f);  // WGS 84
  const double to_rad = 3.14159265358979323846 / 180.0, sine = std::sin(latitude_deg * to_rad);
  const double across_m = a_m / std::sqrt(1.0 - e2 * sine * sine);
  const double along_m = across_m * (1.0 - e2) / (1.0 - e2 * sine * sine);
  const double east_m =
      (points[1].x() - longitude_deg) * to_rad * across_m * std::cos(latitude_deg * to_rad);
  const double north_m = (points[2].y() - latitude_deg) * to_rad * along_m;
  EXPECT_NEAR(east_m, step_m, 1e-3);
  EXPECT_NEAR(north_m, step_m, 1e-3);
}

TEST(ToLonLat, UsesTheHorizontalPartWhereAGeoidIsNamed) {
  std::vector<Vector2d> points{{0.0, 0.0}};
  to_lon_lat(
      "+proj=tmerc +lat_0=37.4 +lon_0=-122.1 +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m "
      "+geoidgrids=egm96_15.gtx +vunits=m +no_defs ",
      points);
  EXPECT_NEAR(points[0].x(), -122.1, 1e-10);
  EXPECT_NEAR(points[0].y(), 37.4, 1e-10);
}

TEST(ToLonLat, RefusesWhatProjDoesNotKnow) {
  std::vector<Vector2d> points{{0.0, 0.0}};
  EXPECT_THROW(to_lon_lat("somewhere", points), InputError);
  EXPECT_THROW(to_lon_lat("+proj=nonsense", points), InputError);
  EXPECT_THROW(to_lon_lat("", points), InputError);
}

// PROJ looks for a name like any other text, and finds WGS 72 for "WGS".
TEST(ProjectionFault, IsWhatNamesASystemByChance) {
  for (const char* crs : {"WGS", "WGS 84 / UTM zone 32N", "berlin", "utm", "32632", "a:b:c", ""}) {
    EXPECT_EQ(projection_fault(crs),
              "a system is a code (EPSG:32632), a PROJ string or well-known text")
        << crs;
  }
  EXPECT_EQ(projection_fault("EPSG:99999"), "it knows no such system");
}

TEST(ProjectionFault, IsNoneOfEachWayToNameASystem) {
  for (const std::string crs :
       {"EPSG:25832", " epsg:25832\n", "EPSG:25832+5783", "IGNF:LAMB93",
        "urn:ogc:def:crs:EPSG::25832", "http://www.opengis.net/def/crs/EPSG/0/25832",
        "+init=epsg:25832", "proj=utm zone=32", "+proj=utm +zone=32 +datum=WGS84"}) {
    EXPECT_EQ(projection_fault(crs), "") << crs;
  }
  EXPECT_EQ(projection_fault(well_known_text("EPSG:25832")), "");
}

// A map is read by who does not trust it: PROJ would open any path, and wait at a pipe.
TEST(ProjectionFault, IsAFileThatASystemNames) {
  const std::string file = "PROJCS[\"a\",EXTENSION[\"PROJ4_GRIDS\",";
  for (const std::string& crs : std::vector<std::string>{
           "+proj=utm +zone=32 +ellps=GRS80 +nadgrids=/dev/stdin", "+init=/tmp/mine:1",
           "+proj=pipeline +step +proj=vgridshift +grids=../grid.gtx",
           "+proj=longlat\t+nadgrids=@null,a/b", "+proj=longlat +nadgrids=\"/dev/stdin\"",
           "PROJCS[\"a\",EXTENSION[\"PROJ4\",\"+proj=longlat +nadgrids=/dev/stdin\"]]",
           file + "\"/dev/stdin\"]]", file + "\"a/../../b\"]]",
           file + "\xe2\x80\x9c/dev/stdin\xe2\x80\x9d]]", " {\"filename\":\"g.gsb\"}",
           "{\"file\\u006eame\":\"g.gsb\"}"}) {
    EXPECT_EQ(projection_fault(crs), "it names a file, which no coordinate system may") << crs;
  }
  EXPECT_EQ(projection_fault("+proj=utm +zone=32 +ellps=GRS80 +nadgrids=@null"), "");
}

TEST(WellKnownText, NamesTheProjection) {
  const std::string wkt = well_known_text("EPSG:25832");
  EXPECT_EQ(wkt.substr(0, 6), "PROJCS");
  EXPECT_NE(wkt.find("Transverse_Mercator"), std::string::npos);
  EXPECT_NE(well_known_text(system_anchored_at(48, 9)).find("Transverse_Mercator"),
            std::string::npos);
}

TEST(WellKnownText, LeavesHeightsOut) {
  const std::string flat = "+proj=tmerc +lat_0=37.4 +lon_0=-122.1 +datum=WGS84 +units=m";
  for (const std::string heights : {" +vunits=m", " +geoidgrids=egm96_15.gtx +vunits=m"}) {
    EXPECT_EQ(well_known_text(flat + heights + " +no_defs"), well_known_text(flat + " +no_defs"));
  }
}

TEST(EpsgCode, IsReadFromItsName) {
  EXPECT_EQ(epsg_code("EPSG:25832"), 25832);
  EXPECT_FALSE(epsg_code("EPSG:").has_value());
  EXPECT_FALSE(epsg_code("EPSG:25832x").has_value());
  EXPECT_FALSE(epsg_code("+proj=utm +zone=32").has_value());
}

TEST(EpsgCode, IsThatOfUtmAsAProjString) {
  EXPECT_EQ(epsg_code("+proj=utm +zone=32 +datum=WGS84 +units=m +no_defs"), 32632);
  EXPECT_EQ(epsg_code(" +proj=utm +zone=32 +datum=WGS84 +ellps=WGS84 +towgs84=0,0,0"), 32632);
  EXPECT_EQ(epsg_code("+proj=utm +zone=55 +south +ellps=WGS84"), 32755);
  EXPECT_EQ(epsg_code("+proj=longlat +datum=WGS84"), 4326);
  for (const char* other : {"+proj=utm +zone=32 +ellps=GRS80", "+proj=utm +zone=61 +datum=WGS84",
                            "+proj=utm +zone=32 +datum=WGS84 +units=us-ft",
                            "+proj=utm +zone=32 +ellps=WGS84 +towgs84=598,73,418",
                            "+proj=tmerc +lat_0=0 +lon_0=9 +datum=WGS84", "+proj=utm +zone="}) {
    EXPECT_FALSE(epsg_code(other).has_value()) << other;
  }
}

TEST(ProjectionFault, SaysWhyASystemCannotBeUsed) {
  EXPECT_EQ(projection_fault("EPSG:25832"), "");
  EXPECT_NE(projection_fault("+proj=tmerc +lat_0=4..9 +lon_0=9"), "");
}

TEST(SystemAnchoredAt, IsOnTheGlobe) {
  EXPECT_THROW(system_anchored_at(91.0, 0.0), std::invalid_argument);
  EXPECT_THROW(system_anchored_at(0.0, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::map
