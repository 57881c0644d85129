#include "roadbed/map/edit/named_roads.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/edit/clipping/clip.h"
#include "roadbed/map/edit/merging/merge.h"
#include "roadbed/map/edit/plan_cut.h"
#include "roadbed/map/edit/transforming/transform.h"
#include "roadbed/map/edit/xml_edit.h"
#include "roadbed/map/files/projection.h"
#include "roadbed/map/files/xml.h"

namespace roadbed::map {
namespace {

using Eigen::Vector2d;

std::string road(int id, const Vector2d& start, double heading_rad, double length_m,
                 const std::string& more, const std::string& lateral = "") {
  return fmt::format(
      R"(<road id="{}" length="{}" junction="-1"><link/><planView><geometry s="0" x="{}" y="{}" )"
      R"(hdg="{}" length="{}"><line/></geometry></planView>{}<lanes><laneSection s="0"><center>)"
      R"(<lane id="0" type="none"/></center><right><lane id="-1" type="driving"><width )"
      R"(sOffset="0" a="3.5" b="0" c="0" d="0"/></lane></right></laneSection></lanes>{}</road>)",
      id, length_m, start.x(), start.y(), heading_rad, length_m, lateral, more);
}

// All that names a road of OpenDRIVE with a station, and what else counts along a road.
std::string whole_map() {
  const std::string shape =
      R"(<lateralProfile><shape s="0" t="-5" a="0.1" b="-0.02" c="0" d="0"/><shape s="0" t="0" )"
      R"(a="0" b="-0.02" c="0" d="0"/><shape s="200" t="-4" a="0.3" b="-0.06" c="0" d="0"/>)"
      R"(</lateralProfile>)";
  const std::string along =
      R"(<objects><object id="r" type="barrier" s="20" t="9"><repeat s="20" length="250" )"
      R"(distance="0" tStart="9" tEnd="8"/></object><object id="p" type="pole" s="120" t="-8">)"
      R"(<repeat s="120" length="60" distance="10" tStart="-8" tEnd="-9"/></object></objects>)"
      R"(<signals><signal id="8" s="30" t="-5"><positionRoad roadId="1" s="210" t="1"/></signal>)"
      R"(<signal id="7" s="118" t="-5"><positionRoad roadId="2" s="12" t="1"/></signal></signals>)"
      R"(<surface><CRG file="x.crg" sStart="50" sEnd="215" mode="attached" sOffset="0"/></surface>)"
      R"(<railroad><switch id="s"><mainTrack id="1" s="121" dir="+"/><sideTrack id="2" s="10" )"
      R"(dir="+"/></switch></railroad>)";
  return R"(<?xml version="1.0"?><OpenDRIVE><header revMajor="1" revMinor="8"/>)" +
         road(1, {0, 0}, 0.0, 300.0, along, shape) + road(2, {150, 20}, -M_PI / 2, 40.0, "") +
         R"(<junction id="5" type="virtual" mainRoad="1" sStart="130" sEnd="140"/>)"
         R"(<junction id="6" type="crossing"><roadSection id="0" roadId="1" sStart="148" )"
         R"(sEnd="152"/><roadSection id="1" roadId="2" sStart="18" sEnd="22"/></junction>)"
         R"(<junction id="7" type="default"><connection id="0" incomingRoad="1" )"
         R"(connectingRoad="2" contactPoint="start"/><crossPath id="0" crossingRoad="2" )"
         R"(roadAtStart="1" roadAtEnd="2"><startLaneLink s="147" from="-1" to="-1"/><endLaneLink )"
         R"(s="5" from="-1" to="-1"/></crossPath><boundary><segment type="lane" roadId="1" )"
         R"(boundaryLane="-1" sStart="110" sEnd="180"/><segment type="joint" roadId="2" )"
         R"(contactPoint="end"/></boundary><planView><geometry s="0" x="150" y="5" hdg="0.5" )"
         R"(length="20"><line/></geometry></planView><elevationGrid gridSpacing="5" sStart="0">)"
         R"(<elevation center="1" left="2 3.5"/></elevationGrid></junction>)"
         R"(<junctionGroup id="g" type="roundabout"><junctionReference junction="7"/>)"
         R"(</junctionGroup><station id="st"><platform id="p"><segment roadId="1" sStart="105" )"
         R"(sEnd="145"/></platform></station></OpenDRIVE>)";
}

struct Place {
  std::string element;
  Vector2d at;
};

// Where each station of a named road is; a fault where there is no such road, or it is elsewhere.
std::vector<Place> named_places(const std::string& bytes) {
  const XmlDocument xml(bytes, "a.xodr");
  std::vector<Place> places;
  for_each_named_road(xml.root(), [&](const NamedRoad& named) {
    const auto there = xml.root().find_child_by_attribute("road", "id", named.road().c_str());
    EXPECT_TRUE(there) << named.node.name() << " names road " << named.road();
    for (const auto& [node, station] : named.stations) {
      const double s_m = number(node, station);
      EXPECT_TRUE(s_m >= 0.0 && s_m <= number(there, "length")) << node.name() << " at " << s_m;
      places.push_back({named.node.name(), reference_pose(there, s_m).position()});
    }
  });
  return places;
}

void expect_among(const std::vector<Place>& some, const std::vector<Place>& all, double within_m) {
  for (const Place& one : some) {
    EXPECT_TRUE(std::any_of(all.begin(), all.end(),
                            [&](const Place& other) {
                              return other.element == one.element &&
                                     (other.at - one.at).norm() <= within_m;
                            }))
        << one.element << " at " << one.at.transpose();
  }
}

std::string part(double from_x_m, double to_x_m) {
  return clip(whole_map(), "whole.xodr",
              Region({geometry::box_ring({from_x_m, -100}, {to_x_m, 100})}))
      .bytes;
}

std::string moved(const std::string& bytes, const RigidMotion& motion) {
  return transform(bytes, "whole.xodr", {.motion = motion, .to = {}, .crs = {}}).bytes;
}

TEST(NamedRoads, OfAPartAreWhereTheyWere) {
  const std::vector<Place> before = named_places(whole_map());
  ASSERT_EQ(before.size(), 16u);
  const std::vector<Place> after = named_places(part(100, 400));
  EXPECT_EQ(after.size(), before.size() - 1) << "signal 8 is outside";
  expect_among(after, before, 1e-9);
}

TEST(NamedRoads, OfAPartDoNotLeadOutside) {
  for (const auto& [from_m, to_m] : {std::pair{-10, 100}, {-10, 145}, {149, 400}, {200, 400}}) {
    const std::string bytes = part(from_m, to_m);
    named_places(bytes);
    const XmlDocument xml(bytes, "part.xodr");
    for (const auto junction : xml.root().children("junction")) {
      EXPECT_TRUE(text(junction, "type") != "crossing" || from_m == 149) << "to " << to_m;
      EXPECT_FALSE(junction.child("boundary")) << "of which a part is gone";
    }
    for (const auto group : xml.root().children("junctionGroup")) {
      EXPECT_TRUE(xml.root().child("junction")) << text(group, "id");
    }
  }
}

TEST(NamedRoads, OfAllPartsAreAsTheyWere) {
  for (const std::vector<double>& at_m :
       {std::vector<double>{100.0}, {135.0}, {150.0}, {155.0}, {100.0, 150.0, 210.0}}) {
    std::vector<MergeInput> parts;
    double from_m = -10.0;
    for (const double to_m : at_m) {
      parts.push_back({part(from_m, to_m), "part"});
      from_m = to_m;
    }
    parts.push_back({part(from_m, 400), "part"});
    const XmlDocument whole(whole_map(), "whole.xodr"),
        again(merge(std::move(parts)).bytes, "again.xodr");
    EXPECT_TRUE(say_the_same(whole.root(), again.root(), [](pugi::xml_node) { return false; }))
        << at_m.front() << ": " << text_of(again, "  ");
  }
}

TEST(NamedRoads, OfMergedMapsAreThoseOfBoth) {
  const std::string bytes = whole_map(), other = moved(bytes, {.shift_m = {0.0, 1000.0, 0.0}});
  const Merged merged = merge({{bytes, "a.xodr"}, {other, "b.xodr"}});
  const std::vector<Place> here = named_places(bytes), there = named_places(other),
                           both = named_places(merged.bytes);
  EXPECT_EQ(both.size(), here.size() + there.size());
  expect_among(here, both, 1e-9);
  expect_among(there, both, 1e-9);
  const XmlDocument xml(merged.bytes, "both.xodr");
  for (const char* kind : {"junctionGroup", "station"}) {
    EXPECT_EQ(children(xml.root(), kind).size(), 2u) << kind;
  }
  const auto groups = children(xml.root(), "junctionGroup");
  EXPECT_NE(text(groups[0].child("junctionReference"), "junction"),
            text(groups[1].child("junctionReference"), "junction"));
}

TEST(NamedRoads, InAnotherSystemAreWhereItPutsThem) {
  const std::string from = "+proj=tmerc +lat_0=48 +lon_0=9 +k=1 +datum=WGS84 +units=m";
  const TransformOptions to{.motion = {}, .to = "EPSG:3857", .crs = from};
  std::vector<Place> before = named_places(whole_map());
  const std::vector<Place> after = named_places(transform(whole_map(), "a.xodr", to).bytes);
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    to_lon_lat(from, {&before[i].at, 1});
    from_lon_lat("EPSG:3857", {&before[i].at, 1});
    EXPECT_NEAR((before[i].at - after[i].at).norm(), 0.0, 0.01) << before[i].element;
  }
}

TEST(NamedRoads, OfAJunctionGoWithItsOwnReferenceLine) {
  const XmlDocument xml(moved(whole_map(), {.turn_rad = 0.25, .shift_m = {3.0, 4.0, 10.0}}),
                        "moved.xodr");
  const auto junction = xml.root().find_child_by_attribute("junction", "id", "7");
  const auto pose = plan_piece(junction.child("planView").child("geometry")).start;
  const RigidMotion motion{.turn_rad = 0.25, .shift_m = {3.0, 4.0, 10.0}};
  EXPECT_NEAR((pose.position() - motion({150.0, 5.0})).norm(), 0.0, 1e-9);
  EXPECT_NEAR(pose.heading_rad, 0.75, 1e-12);
  const auto heights = junction.child("elevationGrid").child("elevation");
  EXPECT_EQ(text(heights, "center"), "11");
  EXPECT_EQ(text(heights, "left"), "12 13.5");
}

}  // namespace
}  // namespace roadbed::map
