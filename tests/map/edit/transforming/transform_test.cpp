#include "roadbed/map/edit/transforming/transform.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "roadbed/map/derived/map_diff.h"
#include "roadbed/map/edit/plan_cut.h"
#include "roadbed/map/edit/xml_edit.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/projection.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_open_drive.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

using Eigen::Vector2d;

const RigidMotion kMotion{.turn_rad = 0.7, .shift_m = {120.0, -45.5, 3.25}};

// Every vertex of every border is where the motion takes it.
void expect_moved(const RoadMap& before, const RoadMap& after, double within_m) {
  ASSERT_EQ(before.lanes().size(), after.lanes().size());
  for (const Lane& lane : before.lanes()) {
    const Lane& moved = after.lane(lane.id);
    for (const auto line : {&Lane::left, &Lane::right}) {
      for (std::size_t i = 0; i < (lane.*line).z_m.size(); ++i) {
        const Vector2d there = kMotion(before.to_source((lane.*line).in_map.points()[i]));
        const double off_m = (moved.*line).in_map.project(after.to_map(there)).d_m;
        EXPECT_NEAR(off_m, 0.0, within_m) << lane.name;
      }
      EXPECT_NEAR((lane.*line).z_m.front() + 3.25, (moved.*line).z_m.front(), 1e-9);
    }
  }
}

TEST(Transform, MovesEveryBorderOfARoad) {
  const std::string bytes = tests::curved_road_xml();
  const Edited moved = transform(bytes, "curved.xodr", {.motion = kMotion, .to = {}, .crs = {}});
  expect_moved(parse_map(bytes, "a.xodr"), parse_map(moved.bytes, "b.xodr"), 1e-6);
}

/// The header's offset leads to the system, in height, too.
TEST(Transform, TakesTheHeadersOffsetIn) {
  std::string bytes = tests::curved_road_xml();
  const std::size_t inside = bytes.find('>', bytes.find("<header")) + 1;
  ASSERT_NE(bytes[inside - 2], '/');
  bytes.insert(inside,
               "<geoReference>EPSG:25832</geoReference>"
               "<offset x=\"500000\" y=\"5400000\" z=\"120\" hdg=\"0\"/>");
  const Edited there = transform(bytes, "a.xodr", {.motion = {}, .to = "EPSG:25832", .crs = {}});
  const RoadMap before = parse_map(bytes, "a.xodr"), after = parse_map(there.bytes, "b.xodr");
  EXPECT_EQ(after.offset_in_crs(), CrsOffset{});
  ASSERT_EQ(before.lanes().size(), after.lanes().size());
  for (const Lane& lane : before.lanes()) {
    const LaneLine &line = lane.left, &moved = after.lane(lane.id).left;
    EXPECT_NEAR(moved.z_m.front(), line.z_m.front() + 120.0, 1e-9);
    const Vector2d at = before.to_source(line.in_map.points().front());
    const Vector2d there_m = after.to_source(moved.in_map.points().front());
    EXPECT_LT((there_m - at - Vector2d(500'000.0, 5'400'000.0)).norm(), 1e-3);
  }
}

TEST(Transform, MovesEveryBorderOfALanelet) {
  const std::string bytes = read_file(tests::data_folder() / "crossing.osm");
  const Edited moved = transform(bytes, "crossing.osm", {.motion = kMotion, .to = {}, .crs = {}});
  expect_moved(parse_map(bytes, "a.osm"), parse_map(moved.bytes, "b.osm"), 1e-4);
}

// 60 degrees from a meridian there is no transverse Mercator any more.
TEST(Transform, RefusesPlacesThatCannotBeReadAgain) {
  const auto shifted = [](const char* name, double by_m) {
    return transform(read_file(tests::data_folder() / name), name,
                     {.motion = {.shift_m = {by_m, by_m, 0.0}}, .to = {}, .crs = {}})
        .bytes;
  };
  for (const char* name : {"town.xodr", "junction.xml", "crossing.osm"}) {
    EXPECT_NO_THROW(parse_map(shifted(name, 1e6), name)) << name;
    EXPECT_THROW(shifted(name, 2e8), InputError) << name;
  }
  EXPECT_NO_THROW(parse_map(shifted("town.xodr", 9e7), "town.xodr"));
  EXPECT_THROW(shifted("crossing.osm", 2e7), InputError);
}

TEST(Transform, TurnsAboutAPlaceThatStays) {
  const Vector2d place(312'000.0, 5'400'000.0);
  const RigidMotion motion = turn_about(place, 0.3);
  EXPECT_NEAR((motion(place) - place).norm(), 0.0, 1e-6);
  const Vector2d moved = motion(place + Vector2d(2.0, 0.0)) - place;
  EXPECT_NEAR((moved - 2.0 * Vector2d(std::cos(0.3), std::sin(0.3))).norm(), 0.0, 1e-6);
}

TEST(Transform, MovesAScenarioWithAllThatIsInIt) {
  const std::string state =
      "<initialState><position><point><x>10</x><y>2</y></point></position><orientation><exact>3"
      "</exact></orientation></initialState>";
  const std::string bytes =
      "<commonRoad commonRoadVersion=\"2020a\" benchmarkID=\"ZAM_Made-1\" timeStepSize=\"0.1\">"
      "<lanelet id=\"1\"><leftBound><point><x>0</x><y>4</y><z>1</z></point><point><x>50</x><y>4</y>"
      "<z>1</z></point></leftBound><rightBound><point><x>0</x><y>0</y><z>1</z></point><point><x>50"
      "</x><y>0</y><z>1</z></point></rightBound><laneletType>urban</laneletType></lanelet>"
      "<dynamicObstacle id=\"2\"><type>car</type><shape><circle><radius>1</radius><center><x>0.5"
      "</x><y>0</y></center></circle></shape>" +
      state + "</dynamicObstacle><planningProblem id=\"3\">" + state +
      "<goalState><position><rectangle><length>4</length><width>2</width><orientation>-0.25"
      "</orientation><center><x>40</x><y>2</y></center></rectangle></position><orientation>"
      "<intervalStart>2.5</intervalStart><intervalEnd>3.5</intervalEnd></orientation></goalState>"
      "</planningProblem></commonRoad>";
  const Edited moved = transform(bytes, "a.xml", {.motion = kMotion, .to = {}, .crs = {}});
  expect_moved(parse_map(bytes, "a.xml"), parse_map(moved.bytes, "b.xml"), 1e-6);
  const auto has = [&](const std::string& part) {
    EXPECT_NE(moved.bytes.find(part), std::string::npos) << part << "\n" << moved.bytes;
  };
  const Vector2d car = kMotion({10, 2}), goal = kMotion({40, 2});
  has(fmt::format("<x>{:.7g}", car.x()).substr(0, 8));
  has(fmt::format("<x>{:.7g}", goal.x()).substr(0, 8));
  has("<x>0.5</x>");  // of the car's own shape, from its middle
  has(fmt::format("<exact>{:.5f}", 3.7 - 2.0 * 3.14159265359).substr(0, 14));
  has("<orientation>0.45</orientation>");
  has("<intervalStart>-3.0831853</intervalStart>");
  has("<intervalEnd>-2.0831853</intervalEnd>");
}

TEST(Transform, BackAgainIsWhereItWas) {
  const RigidMotion back{-0.7, {0, 0, 0}};
  RigidMotion undo = back;
  undo.shift_m.head<2>() = -back(kMotion.shift_m.head<2>());
  for (const Vector2d& point : {Vector2d(3, 4), Vector2d(-1e5, 2e5)}) {
    EXPECT_NEAR((undo(kMotion(point)) - point).norm(), 0.0, 1e-9);
  }
}

// In another system each border is where PROJ puts it; both systems have scales of their own.
// What only the last digits of numbers tell is no change.
TEST(Transform, ThereAndBackLeavesNoChange) {
  RigidMotion back{.turn_rad = -kMotion.turn_rad, .shift_m = {0.0, 0.0, -kMotion.shift_m.z()}};
  back.shift_m.head<2>() = -back(kMotion.shift_m.head<2>());
  for (const char* name : {"town.xodr", "country.xodr", "junction.xml"}) {
    const std::string bytes = read_file(tests::data_folder() / name);
    const Edited there = transform(bytes, name, {.motion = kMotion, .to = {}, .crs = {}});
    const Edited again = transform(there.bytes, name, {.motion = back, .to = {}, .crs = {}});
    const RoadMap before = parse_map(bytes, name), after = parse_map(again.bytes, name);
    for (const MapChange& change : diff(before, after)) {
      ADD_FAILURE() << name << ": " << change.theme << ' ' << change.element << ' '
                    << (change.facets.empty() ? "" : change.facets.front());
    }
  }
}

TEST(Transform, BringsBordersWhereProjDoes) {
  const std::string from =
      "+proj=tmerc +lat_0=48 +lon_0=9 +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m";
  std::string bytes = tests::curved_road_xml();
  const std::size_t header = bytes.find("<header"), end = bytes.find('>', header);
  const bool empty = bytes[end - 1] == '/';
  const std::string reference = "<geoReference><![CDATA[" + from + "]]></geoReference>";
  bytes.replace(end - (empty ? 1 : 0), empty ? 2 : 1, ">" + reference + (empty ? "</header>" : ""));
  const RoadMap before = parse_map(bytes, "a.xodr");
  ASSERT_EQ(before.crs(), from);
  const Edited moved = transform(bytes, "a.xodr", {.motion = {}, .to = "EPSG:32632", .crs = {}});
  const RoadMap after = parse_map(moved.bytes, "b.xodr");
  EXPECT_EQ(after.crs(), "EPSG:32632");
  for (const Lane& lane : before.lanes()) {
    std::vector<Vector2d> points;
    for (const Vector2d& point : lane.left.in_map.points())
      points.push_back(before.to_source(point));
    to_lon_lat(from, points);
    from_lon_lat("EPSG:32632", points);
    for (const Vector2d& point : points) {
      const auto place = after.lane(lane.id).left.in_map.project(after.to_map(point));
      EXPECT_NEAR(place.d_m, 0.0, 0.0015) << lane.name;
    }
  }
}

std::vector<pugi::xml_node> geometries(const XmlDocument& xml) {
  std::vector<pugi::xml_node> all;
  for (const auto road : xml.root().children("road")) {
    for (const auto geometry : road.child("planView").children("geometry")) all.push_back(geometry);
  }
  return all;
}

std::vector<Vector2d> ends(pugi::xml_node geometry) {
  const auto piece = plan_piece(geometry);
  return {piece.start.position(),
          geometry::plan_point(piece, piece.s_m + piece.length_m).pose.position()};
}

std::string straight_road_xml(const std::string& elevations, const std::string& objects) {
  return R"(<OpenDRIVE><header revMajor="1" revMinor="7"/><road id="1" length="100" junction="-1">
    <planView><geometry s="0" x="0" y="0" hdg="0" length="100"><line/></geometry></planView>
    <elevationProfile>)" +
         elevations + R"(</elevationProfile><lanes><laneSection s="0"><center><lane id="0"
    type="none"/></center><right><lane id="-1" type="driving"><width sOffset="0" a="3" b="0" c="0"
    d="0"/></lane></right></laneSection></lanes><objects>)" +
         objects + "</objects></road></OpenDRIVE>";
}

TEST(Transform, LiftsARoadAlsoBeforeItsFirstElevation) {
  const std::string bytes = straight_road_xml(R"(<elevation s="10" a="2" b="0" c="0" d="0"/>)", "");
  const Edited moved =
      transform(bytes, "a.xodr", {.motion = {.shift_m = {0, 0, 5}}, .to = {}, .crs = {}});
  const RoadMap after = parse_map(moved.bytes, "b.xodr");
  const LaneLine& line = after.lanes().begin()->left;
  EXPECT_NEAR(line.z_m.front(), 5.0, 1e-9);
  EXPECT_NEAR(line.z_m.back(), 7.0, 1e-9);
}

TEST(Transform, DeclaresTheEncodingThatItWrites) {
  const auto moved = [](const std::string& encoding, const std::string& umlaut) {
    std::string bytes = straight_road_xml("", "<object id=\"" + umlaut + "\" s=\"0\" t=\"5\"/>");
    bytes = "<?xml version=\"1.0\" encoding=\"" + encoding + "\"?>\n" + bytes;
    return transform(bytes, "a.xodr", {.motion = kMotion, .to = {}, .crs = {}}).bytes;
  };
  for (const auto& [read, umlaut, written, as] :
       {std::array{"ISO-8859-1", "\xe4", "UTF-8", "ä"},
        {"US-ASCII", "&#228;", "UTF-8", "ä"},
        {"utf-8", "ä", "utf-8", "ä"},
        {"windows-1252", "\xe4", "windows-1252", "\xe4"}}) {
    const std::string text = moved(read, umlaut);
    EXPECT_NE(text.find("encoding=\"" + std::string(written) + "\""), std::string::npos) << read;
    EXPECT_NE(text.find("id=\"" + std::string(as) + "\""), std::string::npos) << read;
  }
}

TEST(Transform, KeepsTheCopiesOfARepeatedObject) {
  const std::string bytes = straight_road_xml(
      "", R"(<object id="1" s="0" t="5"><repeat s="0" length="90" distance="10" tStart="5" tEnd="5"
      heightStart="1" heightEnd="1" zOffsetStart="0" zOffsetEnd="0"/></object>)");
  const Edited there = transform(
      bytes, "a.xodr",
      {.motion = {}, .to = "EPSG:3857", .crs = "+proj=tmerc +lat_0=48 +lon_0=9 +units=m"});
  const XmlDocument xml(there.bytes, "b.xodr");
  const auto repeat = xml.root().select_node("road/objects/object/repeat").node();
  EXPECT_GT(number(repeat, "length"), 100.0);  // Mercator at 48 degrees
  EXPECT_NEAR(number(repeat, "length") / number(repeat, "distance"), 9.0, 1e-6);
}

// Scales change along a road, most in systems that are not of equal angles.
TEST(Transform, BringsBothEndsOfEachGeometryWhereProjDoes) {
  const std::string from = "+proj=tmerc +lat_0=48 +lon_0=9 +k=1 +datum=WGS84 +units=m";
  for (const char* to : {"EPSG:3857", "EPSG:3035", "EPSG:32632"}) {
    const XmlDocument before(tests::curved_road_xml(), "a.xodr"),
        after(transform(tests::curved_road_xml(), "a.xodr", {.motion = {}, .to = to, .crs = from})
                  .bytes,
              "b.xodr");
    const auto old = geometries(before), now = geometries(after);
    ASSERT_EQ(old.size(), now.size());
    double s_m = 0.0;
    for (std::size_t i = 0; i < old.size(); ++i) {
      std::vector<Vector2d> there = ends(old[i]);
      to_lon_lat(from, there);
      from_lon_lat(to, there);
      EXPECT_NEAR((there[0] - ends(now[i])[0]).norm(), 0.0, 1e-6) << to << ' ' << i;
      EXPECT_NEAR((there[1] - ends(now[i])[1]).norm(), 0.0, 1e-6) << to << ' ' << i;
      EXPECT_NEAR(number(now[i], "s"), s_m, 1e-6) << to << ' ' << i;
      s_m += number(now[i], "length");
    }
    EXPECT_NEAR(number(after.root().child("road"), "length"), s_m, 1e-6);
  }
}

double worst_step_m(const std::string& bytes) {
  const XmlDocument xml(bytes, "a.xodr");
  double worst_m = 0.0;
  for (const auto geometry : geometries(xml)) {
    if (const auto next = geometry.next_sibling("geometry")) {
      worst_m = std::max(worst_m, (ends(geometry)[1] - ends(next)[0]).norm());
    }
  }
  return worst_m;
}

TEST(Transform, LeavesNoStepBetweenTheGeometriesOfRealRoads) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  for (const auto& [name, to] : {std::pair{"maliput+maliput_malidrive/cloverleaf", "EPSG:3310"},
                                 {"BerkeleyLearnVerify+Scenic/Town04", "EPSG:3857"}}) {
    const std::string bytes = read_file(real / "opendrive" / (std::string(name) + ".xodr"));
    const double before_m = worst_step_m(bytes);
    const Edited moved = transform(bytes, name, {.motion = {}, .to = to, .crs = {}});
    EXPECT_LT(worst_step_m(moved.bytes), 1.01 * before_m + 1e-6) << name << ", scaled by 1.0067";
  }
}

TEST(Transform, NeedsSystemsOfMetresInAPlane) {
  const std::string utm = "EPSG:32632";
  for (const std::string other :
       {"EPSG:4326", "EPSG:4978", "EPSG:2227", "+proj=longlat +datum=WGS84"}) {
    for (const auto& [to, crs] : {std::pair{other, utm}, {utm, other}}) {
      EXPECT_THROW(
          transform(tests::curved_road_xml(), "a.xodr", {.motion = {}, .to = to, .crs = crs}),
          InputError)
          << crs << " to " << to;
    }
  }
}

TEST(Transform, NeedsAKnownSystemForAnother) {
  const TransformOptions unknown{.motion = {}, .to = "EPSG:32632", .crs = ""};
  EXPECT_THROW(transform(tests::curved_road_xml(), "a.xodr", unknown), InputError);
}

TEST(Align, FindsTheMotionOfPairs) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> place(-500.0, 500.0);
  std::vector<PointPair> pairs;
  for (int i = 0; i < 8; ++i) {
    const Vector2d from(place(random), place(random));
    pairs.push_back({from, kMotion(from)});
  }
  const Alignment found = align(pairs);
  EXPECT_NEAR(found.motion.turn_rad, 0.7, 1e-12);
  EXPECT_NEAR((found.motion.shift_m - Eigen::Vector3d(120.0, -45.5, 0.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(found.worst_m, 0.0, 1e-9);
}

// No motion nearby leaves less.
TEST(Align, LeavesTheLeastSquares) {
  std::mt19937 random(10);
  std::uniform_real_distribution<double> place(-50.0, 50.0), error(-0.5, 0.5);
  std::vector<PointPair> pairs;
  for (int i = 0; i < 12; ++i) {
    const Vector2d from(place(random), place(random));
    pairs.push_back({from, kMotion(from) + Vector2d(error(random), error(random))});
  }
  const Alignment best = align(pairs);
  const auto rms = [&](const RigidMotion& motion) {
    double sum = 0.0;
    for (const PointPair& pair : pairs) sum += (motion(pair.from) - pair.to).squaredNorm();
    return std::sqrt(sum / static_cast<double>(pairs.size()));
  };
  EXPECT_NEAR(rms(best.motion), best.rms_m, 1e-12);
  for (const double turn : {-1e-3, 1e-3}) {
    RigidMotion other = best.motion;
    other.turn_rad += turn;
    EXPECT_GT(rms(other), best.rms_m);
  }
  for (const double shift : {-1e-2, 1e-2}) {
    RigidMotion other = best.motion;
    other.shift_m.x() += shift;
    EXPECT_GT(rms(other), best.rms_m);
  }
}

TEST(Align, NeedsTwoPlaces) {
  EXPECT_THROW(align(std::vector<PointPair>{{{0, 0}, {1, 1}}}), std::invalid_argument);
  EXPECT_THROW(align(std::vector<PointPair>{{{0, 0}, {1, 1}}, {{0, 0}, {2, 1}}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::map
