#include "roadbed/map/repair/lane_seam.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/opendrive/read.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

using opendrive::ContactPoint;

double width_m(const SeamSide& side, int lane) {
  const auto corners = lane_corners(side, lane);
  return corners ? std::abs(corners->outer_t_m - corners->inner_t_m) : NAN;
}

// The map that is built of the file is the other way to know.
TEST(LaneCorners, AreAsFarApartAsTheBordersOfTheMapsLane) {
  constexpr double sampling_m = 2e-3;
  std::size_t compared = 0;
  for (const char* file : {"town.xodr", "country.xodr", "ramp.xodr"}) {
    const std::string bytes = read_file(tests::data_folder() / file);
    const RoadMap road_map = parse_map(bytes, file);
    const XmlDocument xml(bytes, file);
    const opendrive::Document document = opendrive::read_document(xml);
    const opendrive::rules::Source source(xml, document);
    for (const auto& road : source.roads) {
      for (const auto& section : road.record.sections) {
        for (const opendrive::LaneRecord& lane : section.listed()) {
          const auto found = road_map.find_lane(fmt::format(
              "{}/{}/{}", road.record.id, &section - road.record.sections.data(), lane.id));
          if (!found) continue;
          const Lane& built = road_map.lane(*found);
          const double first_m = width_m({&road, &section, ContactPoint::start}, lane.id);
          const double last_m = width_m({&road, &section, ContactPoint::end}, lane.id);
          const double begin_m = built.width_m(0.0), end_m = built.width_m(built.length_m());
          // Along the road, or against it.
          const auto off_m = [&](double a_m, double b_m) {
            return std::max(std::abs(first_m - a_m), std::abs(last_m - b_m));
          };
          EXPECT_LE(std::min(off_m(begin_m, end_m), off_m(end_m, begin_m)), sampling_m)
              << file << " lane " << built.name;
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 100u);
}

constexpr const char* kRoad =
    R"(<OpenDRIVE><header revMajor="1" revMinor="7"/><road id="1" length="60" junction="-1">)"
    R"(<planView><geometry s="0" x="0" y="0" hdg="0" length="60"><line/></geometry></planView>)"
    R"(<lanes><laneOffset s="0" a="0.5" b="0" c="0" d="0"/><laneOffset s="30" a="1" b="0" c="0" )"
    R"(d="0"/><laneSection s="0"><center><lane id="0" type="none"/></center><right>)"
    R"(<lane id="-1" type="driving"><width sOffset="0" a="3" b="0.1" c="0" d="0"/></lane>)"
    R"(<lane id="-3" type="driving"><width sOffset="0" a="3" b="0" c="0" d="0"/></lane></right>)"
    R"(</laneSection><laneSection s="30"><center><lane id="0" type="none"/></center><right>)"
    R"(<lane id="-1" type="driving"><border sOffset="0" a="-4" b="0" c="0" d="0"/></lane>)"
    R"(<lane id="-2" type="driving"><width sOffset="5" a="3" b="0" c="0" d="0"/></lane>)"
    R"(</right></laneSection></lanes></road></OpenDRIVE>)";

TEST(LaneCorners, GoByWhatHoldsOnTheirSideOfTheSeam) {
  const XmlDocument xml(kRoad, "a map");
  const opendrive::Document document = opendrive::read_document(xml);
  const opendrive::rules::Source source(xml, document);
  const auto& road = source.roads.front();
  const SeamSide before{&road, &road.record.sections[0], ContactPoint::end};
  const SeamSide after{&road, &road.record.sections[1], ContactPoint::start};
  ASSERT_TRUE(lane_corners(before, -1) && lane_corners(after, -1));
  EXPECT_NEAR(lane_corners(before, -1)->inner_t_m, 0.5, 1e-9);
  EXPECT_NEAR(lane_corners(before, -1)->outer_t_m, -5.5, 1e-9);
  EXPECT_NEAR(lane_corners(after, -1)->inner_t_m, 1.0, 1e-9);
  EXPECT_NEAR(lane_corners(after, -1)->outer_t_m, -3.0, 1e-9);
  EXPECT_FALSE(lane_corners(before, -3));  // there is no lane -2
  EXPECT_FALSE(lane_corners(after, -2));   // its first width begins later
  EXPECT_FALSE(lane_corners(after, 1));
}

}  // namespace
}  // namespace roadbed::map
