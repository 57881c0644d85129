// The header, and what the file holds beyond what is used.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_road.h"

namespace roadbed::map {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using tests::made_map;
using tests::made_road;
using tests::remarks_of;

TEST(OpenDriveHeader, CrsComesFromTextOrCdataWithoutTheSpaceAround) {
  for (const char* reference :
       {"<geoReference>+proj=utm +zone=32</geoReference>",
        "<geoReference>\n <![CDATA[\n +proj=utm +zone=32\n]]> \n</geoReference>",
        "<geoReference><!-- which --><![CDATA[+proj=utm ]]><![CDATA[+zone=32]]></geoReference>"}) {
    const RoadMap road_map = made_map(made_road({}), reference);
    EXPECT_EQ(road_map.crs(), "+proj=utm +zone=32") << reference;
    EXPECT_THAT(remarks_of(road_map, "import.crs"), IsEmpty()) << reference;
  }
}

TEST(OpenDriveHeader, ACrsWithoutAProjectionIsKeptAndSaid) {
  const RoadMap road_map =
      made_map(made_road({}), "<geoReference>+lat_0=49 +lon_0=8 +ellps=WGS84</geoReference>");
  EXPECT_EQ(road_map.crs(), "+lat_0=49 +lon_0=8 +ellps=WGS84");
  EXPECT_THAT(remarks_of(road_map, "import.crs"), ElementsAre(HasSubstr("names no projection")));
}

TEST(OpenDriveHeader, AWholeFileLeavesNoRemark) {
  const RoadMap road_map = made_map(made_road({}));
  EXPECT_TRUE(road_map.import_diagnostics().empty());
  EXPECT_TRUE(road_map.unused().empty());
}

TEST(OpenDriveHeader, TheOffsetIsKeptForTheCrsAndMovesNoCoordinate) {
  const RoadMap road_map =
      made_map(made_road({}), R"(<offset x="500000" y="5400000.5" z="110" hdg="0.1"/>)");
  EXPECT_EQ(road_map.offset_in_crs(), (CrsOffset{500000, 5400000.5, 110, 0.1}));
  EXPECT_EQ(road_map.to_source(tests::lane_of(road_map, "A/0/-1").pose_at(0).position()).x(), 0.0);
}

TEST(OpenDriveHeader, CommentsMayStandBeforeTheDeclaration) {
  const std::string document = tests::made_document(made_road({}));
  for (const char* before :
       {"<!-- made by hand -->\n<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n",
        "\xef\xbb\xbf<?xml version=\"1.0\"?><!-- x -->", "\n\n  <!-- a --><!-- b -->"}) {
    EXPECT_EQ(parse_map(before + document, "made.xodr").lanes().size(), 2u) << before;
  }
}

TEST(OpenDriveHeader, TheFileMayBeInUtf16) {
  std::string wide = "\xff\xfe";
  for (const char c : tests::made_document(made_road({}))) wide += {c, '\0'};
  EXPECT_EQ(parse_map(wide, "made.xodr").lanes().size(), 2u);
}

TEST(OpenDriveHeader, WhatIsNotUsedIsCountedByItsPlace) {
  tests::MadeRoad road;
  road.rest = R"(<railroad><switch id="1"/><switch id="2"/></railroad><surface><CRG/></surface>
    <objects><object id="1" type="x" s="1" t="0"><userData code="a"/><userData code="b"/>
    <skeleton/></object></objects>)";
  const RoadMap road_map = made_map(made_road(road) + R"(<userData code="z"/><station id="9"/>
    <junction id="J" name=""><controller id="1"><control signalId="5"/></controller></junction>)");
  std::vector<std::string> counted;
  for (const UnusedContent& unused : road_map.unused()) {
    counted.push_back(unused.name + " " + std::to_string(unused.count));
  }
  EXPECT_THAT(counted, ElementsAre("OpenDRIVE/station 1", "OpenDRIVE/userData 1",
                                   "controller/control 1", "object/skeleton 1", "object/userData 2",
                                   "road/railroad 1", "road/surface 1"));
}

}  // namespace
}  // namespace roadbed::map
