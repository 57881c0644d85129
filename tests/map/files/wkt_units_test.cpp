#include "roadbed/map/files/wkt_units.h"

#include <gtest/gtest.h>

#include <string>

namespace roadbed::map {
namespace {

const std::string kBelow =
    R"(GEOGCS["NAD83",DATUM["D",SPHEROID["GRS 1980",6378137,298.25]],PRIMEM["G",0],)"
    R"(UNIT["degree",0.0174532925199433]],PROJECTION["Lambert"],PARAMETER["false_easting",1312335.9])";
const std::string kFeet = "PROJCS[\"NAD83 / Oregon (ft)\"," + kBelow + R"(,UNIT["foot",0.3048]])";

TEST(WktUnits, OfAProjectedSystemAreThoseOfItself) {
  const CrsUnits units = units_of_wkt(kFeet);
  EXPECT_EQ(units.horizontal_m, 0.3048);
  EXPECT_FALSE(units.vertical_m);
  EXPECT_FALSE(units.is_in_degrees);
}

TEST(WktUnits, OfACompoundSystemAreThoseOfBothParts) {
  const CrsUnits units =
      units_of_wkt("COMPD_CS[\"both\"," + kFeet +
                   R"(,VERT_CS["NAVD88",VERT_DATUM["N",2005],UNIT["metre",1],AXIS["H",UP]]])");
  EXPECT_EQ(units.horizontal_m, 0.3048);
  EXPECT_EQ(units.vertical_m, 1.0);
}

TEST(WktUnits, OfTheSecondEditionAreThoseOfTheAxes) {
  const CrsUnits units = units_of_wkt(
      R"(PROJCRS["x [y",BASEGEOGCRS["b",DATUM["d",ELLIPSOID["e",6378137,298,LENGTHUNIT["metre",1]]]],)"
      R"(CONVERSION["c",METHOD["m"],PARAMETER["p",3,LENGTHUNIT["metre",1]]],CS[Cartesian,2],)"
      R"(AXIS["E",east,ORDER[1],LENGTHUNIT["US survey foot",0.304800609601219]],)"
      R"(AXIS["N",north,ORDER[2],LENGTHUNIT["US survey foot",0.304800609601219]]])");
  EXPECT_EQ(units.horizontal_m, 0.304800609601219);
  EXPECT_FALSE(units.is_in_degrees);
}

TEST(WktUnits, AreDegreesOfAGeographicSystem) {
  for (const char* text :
       {R"(GEOGCS["WGS 84",DATUM["W",SPHEROID["W",6378137,298]],UNIT["degree",0.01745]])",
        R"(GEOGCRS["WGS 84",ENSEMBLE["W",ELLIPSOID["W",6378137,298,LENGTHUNIT["metre",1]]],)"
        R"(CS[ellipsoidal,2],AXIS["Lat",north,ANGLEUNIT["degree",0.01745]]])"}) {
    EXPECT_TRUE(units_of_wkt(text).is_in_degrees) << text;
    EXPECT_FALSE(units_of_wkt(text).horizontal_m) << text;
  }
}

TEST(WktUnits, AreNotToldByOtherText) {
  for (const char* text : {"", "EPSG:25832", "]]]][\"", "PROJCS[UNIT[",
                           "PROJCS[\"a\",UNIT[\"m\",-1]]", "+proj=utm +zone=32"}) {
    EXPECT_FALSE(units_of_wkt(text).horizontal_m) << text;
    EXPECT_FALSE(units_of_wkt(text).is_in_degrees) << text;
  }
}

}  // namespace
}  // namespace roadbed::map
