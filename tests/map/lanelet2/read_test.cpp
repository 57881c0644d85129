#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "roadbed/map/lanelet2/document.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_lanelet2.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using tests::MadeLanelet2;
using Tags = MadeLanelet2::Tags;

RoadMap parse(const MadeLanelet2& made) { return parse_map(made.text(), "made.osm"); }

const Lane& lane(const RoadMap& road_map, std::int64_t id) {
  return road_map.lane(road_map.find_lane(std::to_string(id)).value());
}

std::vector<std::int64_t> names(const RoadMap& road_map, const std::vector<LaneId>& lanes) {
  std::vector<std::int64_t> list;
  for (const LaneId id : lanes) list.push_back(std::stoll(road_map.lane(id).name));
  return list;
}

bool has_remark(const RoadMap& road_map, const std::string& rule) {
  return std::any_of(road_map.import_diagnostics().begin(), road_map.import_diagnostics().end(),
                     [&](const ImportDiagnostic& remark) { return remark.rule == rule; });
}

// Three lanes beside each other eastwards from x = 0 to 10, y = 0…3, 3…6, 6…9, and one behind the
// lowest; lines 0 to 3 upwards.
struct Grid {
  MadeLanelet2 made;
  std::vector<std::int64_t> lines, lanes;
  std::int64_t behind = 0;

  explicit Grid(const std::vector<Tags>& line_tags = {{}, {}, {}, {}},
                const std::vector<Tags>& lane_tags = {
                    {{"subtype", "road"}}, {{"subtype", "road"}}, {{"subtype", "road"}}}) {
    std::vector<std::int64_t> ends;
    for (int i = 0; i < 4; ++i) {
      const std::int64_t from = made.node({0, 3 * i}), to = made.node({10, 3 * i});
      lines.push_back(made.way({from, to}, line_tags[static_cast<std::size_t>(i)]));
      ends.push_back(to);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      lanes.push_back(made.lanelet(lines[i + 1], lines[i], lane_tags[i]));
    }
    const std::int64_t left = made.way({ends[1], made.node({25, 3})});
    const std::int64_t right = made.way({ends[0], made.node({25, 0})});
    behind = made.lanelet(left, right);
  }
};

TEST(Lanelet2, BordersAreKeptAndTheLengthIsThatOfTheCentreline) {
  Grid grid;
  const RoadMap road_map = parse(grid.made);
  ASSERT_EQ(road_map.lanes().size(), 4u);
  const Lane& lowest = lane(road_map, grid.lanes[0]);
  EXPECT_THAT(lowest.left.in_map.points(),
              ElementsAre(Eigen::Vector2d(0, 3), Eigen::Vector2d(10, 3)));
  EXPECT_THAT(lowest.right.in_map.points(),
              ElementsAre(Eigen::Vector2d(0, 0), Eigen::Vector2d(10, 0)));
  EXPECT_NEAR(lowest.length_m(), 10.0, 1e-12);
  EXPECT_NEAR(lowest.centre.in_map.at(5.0).y(), 1.5, 1e-12);
  EXPECT_NEAR(lowest.width_m(5.0), 3.0, 1e-12);
  EXPECT_NEAR(geometry::signed_area_m2(lowest.polygon), 30.0, 1e-12);
  EXPECT_THAT(lowest.left.station_m, ElementsAre(0.0, 10.0));
}

TEST(Lanelet2, ALaneFollowsAnotherWhereTheyShareTheEndNodes) {
  Grid grid;
  const RoadMap road_map = parse(grid.made);
  const LaneLinks& links = road_map.graph().of(lane(road_map, grid.lanes[0]).id);
  EXPECT_THAT(names(road_map, links.successors), ElementsAre(grid.behind));
  EXPECT_THAT(names(road_map, road_map.graph().of(lane(road_map, grid.behind).id).predecessors),
              ElementsAre(grid.lanes[0]));
  EXPECT_TRUE(road_map.graph().of(lane(road_map, grid.lanes[1]).id).successors.empty());
}

TEST(Lanelet2, EqualPlacesThatAreDifferentNodesDoNotJoinLanes) {
  MadeLanelet2 made;
  const std::int64_t first =
      made.lanelet(made.line({{0, 3}, {10, 3}}), made.line({{0, 0}, {10, 0}}));
  made.lanelet(made.line({{10, 3}, {20, 3}}), made.line({{10, 0}, {20, 0}}));
  const RoadMap road_map = parse(made);
  EXPECT_TRUE(road_map.graph().of(lane(road_map, first).id).successors.empty());
}

TEST(Lanelet2, ABorderDrawnTheOtherWayIsTurnedByTheOtherOnesSide) {
  for (const bool turn_left : {false, true}) {
    for (const bool turn_right : {false, true}) {
      MadeLanelet2 made;
      std::vector<MadeLanelet2::Point> left = {{0, 3}, {5, 3}, {10, 3}};
      std::vector<MadeLanelet2::Point> right = {{0, 0}, {4, 0}, {10, 0}};
      if (turn_left) std::reverse(left.begin(), left.end());
      if (turn_right) std::reverse(right.begin(), right.end());
      const std::int64_t id = made.lanelet(made.line(left), made.line(right));
      const RoadMap road_map = parse(made);
      const Lane& item = lane(road_map, id);
      EXPECT_EQ(item.left.in_map.points().front(), Eigen::Vector2d(0, 3));
      EXPECT_EQ(item.right.in_map.points().front(), Eigen::Vector2d(0, 0));
      EXPECT_NEAR(item.pose_at(5.0).heading_rad, 0.0, 1e-12);
    }
  }
}

TEST(Lanelet2, SwappedRolesTurnTheDrivingDirectionRound) {
  MadeLanelet2 made;
  const std::int64_t upper = made.line({{0, 3}, {10, 3}}), lower = made.line({{0, 0}, {10, 0}});
  const std::int64_t id = made.lanelet(lower, upper);
  EXPECT_NEAR(std::abs(lane(parse(made), id).pose_at(5.0).heading_rad), 3.14159265358979, 1e-9);
}

TEST(Lanelet2, DashedLinesMayBeCrossedAndSolidOnesNot) {
  Grid grid({{},
             {{"type", "line_thin"}, {"subtype", "dashed"}},
             {{"type", "line_thin"}, {"subtype", "solid"}},
             {}});
  const RoadMap road_map = parse(grid.made);
  const LaneLinks& middle = road_map.graph().of(lane(road_map, grid.lanes[1]).id);
  ASSERT_TRUE(middle.left && middle.right);
  EXPECT_EQ(road_map.lane(middle.right->lane).name, std::to_string(grid.lanes[0]));
  EXPECT_TRUE(middle.right->same_direction);
  EXPECT_TRUE(middle.right->change_allowed());
  EXPECT_EQ(road_map.lane(middle.left->lane).name, std::to_string(grid.lanes[2]));
  EXPECT_FALSE(middle.left->change_allowed());
  EXPECT_EQ(lane(road_map, grid.lanes[1]).right_marks.at(0).type, MarkType::broken);
}

TEST(Lanelet2, ALineDashedOnOneSideIsCrossedFromThatSideOnly) {
  // Eastwards, "dashed_solid" is dashed on the left, that is on the side of lane 1.
  Grid grid({{}, {{"type", "line_thin"}, {"subtype", "dashed_solid"}}, {}, {}});
  const RoadMap road_map = parse(grid.made);
  EXPECT_TRUE(road_map.graph().of(lane(road_map, grid.lanes[1]).id).right->change_allowed());
  EXPECT_FALSE(road_map.graph().of(lane(road_map, grid.lanes[0]).id).left->change_allowed());
}

TEST(Lanelet2, LaneChangeTagsOverrideTheLineType) {
  Grid grid({{},
             {{"type", "line_thin"}, {"subtype", "solid"}, {"lane_change:left", "yes"}},
             {{"type", "line_thin"}, {"subtype", "dashed"}, {"lane_change", "no"}},
             {}});
  const RoadMap road_map = parse(grid.made);
  EXPECT_TRUE(road_map.graph().of(lane(road_map, grid.lanes[0]).id).left->change_allowed());
  const LaneLinks& middle = road_map.graph().of(lane(road_map, grid.lanes[1]).id);
  EXPECT_FALSE(middle.right->change_allowed());
  EXPECT_FALSE(middle.left->change_allowed());
}

TEST(Lanelet2, LanesOfOppositeDirectionsShareTheSameSide) {
  MadeLanelet2 made;
  const std::int64_t upper = made.line({{0, 6}, {10, 6}}), middle = made.line({{0, 3}, {10, 3}}),
                     lower = made.line({{0, 0}, {10, 0}});
  const std::int64_t east = made.lanelet(middle, lower);
  const std::int64_t west = made.lanelet(middle, upper);
  const RoadMap road_map = parse(made);
  for (const auto& [one, other] : {std::pair(east, west), std::pair(west, east)}) {
    const LaneLinks& links = road_map.graph().of(lane(road_map, one).id);
    ASSERT_TRUE(links.left);
    EXPECT_FALSE(links.right);
    EXPECT_EQ(road_map.lane(links.left->lane).name, std::to_string(other));
    EXPECT_FALSE(links.left->same_direction);
  }
}

TEST(Lanelet2, ParticipantTagsOverrideWhatTheSubtypeMeans) {
  Grid grid({{}, {}, {}, {}}, {{{"subtype", "road"}, {"participant:bicycle", "yes"}},
                               {{"subtype", "walkway"}, {"participant:vehicle", "yes"}},
                               {{"subtype", "road"}, {"participant:vehicle:bus", "yes"}}});
  const RoadMap road_map = parse(grid.made);
  const Lane& bicycles = lane(road_map, grid.lanes[0]);
  EXPECT_EQ(bicycles.participants, (Participants{Participant::bicycle}));
  EXPECT_EQ(bicycles.type, LaneType::biking);
  const Lane& vehicles = lane(road_map, grid.lanes[1]);
  EXPECT_EQ(vehicles.participants, Participants::vehicles());
  EXPECT_EQ(vehicles.type, LaneType::driving);
  EXPECT_EQ(lane(road_map, grid.lanes[2]).type, LaneType::bus);
}

TEST(Lanelet2, SubtypesHaveTheirUsersAndTypes) {
  Grid grid({{}, {}, {}, {}},
            {{{"subtype", "crosswalk"}}, {{"subtype", "road_shoulder"}}, {{"subtype", "highway"}}});
  const RoadMap road_map = parse(grid.made);
  const Lane& crosswalk = lane(road_map, grid.lanes[0]);
  EXPECT_EQ(crosswalk.type, LaneType::sidewalk);
  EXPECT_FALSE(crosswalk.one_way);
  EXPECT_EQ(lane(road_map, grid.lanes[1]).type, LaneType::shoulder);
  const Lane& highway = lane(road_map, grid.lanes[2]);
  EXPECT_TRUE(highway.one_way);
  EXPECT_FALSE(highway.participants.has(Participant::bicycle));
}

TEST(Lanelet2, OneWayTagsSayInHowManyDirectionsALaneIsUsed) {
  Grid grid({{}, {}, {}, {}}, {{{"subtype", "road"}, {"one_way", "no"}},
                               {{"subtype", "road"}, {"one_way:vehicle", "no"}},
                               {{"subtype", "walkway"}, {"one_way", "yes"}}});
  const RoadMap road_map = parse(grid.made);
  EXPECT_FALSE(lane(road_map, grid.lanes[0]).one_way);
  EXPECT_FALSE(lane(road_map, grid.lanes[1]).one_way);
  EXPECT_TRUE(lane(road_map, grid.lanes[2]).one_way);
}

TEST(Lanelet2, SpeedLimitTagsHaveUnitsAndMissingOnesAreRemarkedNotGuessed) {
  Grid grid({{}, {}, {}, {}}, {{{"subtype", "road"}, {"speed_limit", "50"}},
                               {{"subtype", "road"}, {"speed_limit", "30 mph"}},
                               {{"subtype", "road"}, {"speed_limit", "10 m/s"}}});
  const RoadMap road_map = parse(grid.made);
  EXPECT_NEAR(lane(road_map, grid.lanes[0]).speed_limit_at_mps(1.0).value(), 50.0 / 3.6, 1e-12);
  EXPECT_NEAR(lane(road_map, grid.lanes[1]).speed_limit_at_mps(1.0).value(), 13.4112, 1e-12);
  EXPECT_NEAR(lane(road_map, grid.lanes[2]).speed_limit_at_mps(1.0).value(), 10.0, 1e-12);
  EXPECT_FALSE(lane(road_map, grid.behind).speed_limit_at_mps(1.0));
  EXPECT_TRUE(has_remark(road_map, "import.speed-limit-unknown"));
}

TEST(Lanelet2, ASpeedLimitElementHoldsOnTheLanesThatNameIt) {
  MadeLanelet2 made;
  const std::int64_t sign =
      made.line({{5, 4}, {5, 5}}, {{"type", "traffic_sign"}, {"subtype", "de274-70"}});
  const std::int64_t limit = made.relation(
      {{sign, "refers"}}, {{"type", "regulatory_element"}, {"subtype", "speed_limit"}});
  const std::int64_t id =
      made.lanelet(made.line({{0, 3}, {10, 3}}), made.line({{0, 0}, {10, 0}}),
                   {{"subtype", "road"}, {"speed_limit", "50"}}, {{-limit, "regulatory_element"}});
  const RoadMap road_map = parse(made);
  EXPECT_NEAR(lane(road_map, id).speed_limit_at_mps(0.0).value(), 70.0 / 3.6, 1e-12);
  ASSERT_EQ(road_map.signals().size(), 1u);
  EXPECT_NEAR(road_map.signals()[0].value.value(), 70.0, 1e-9);
  EXPECT_EQ(road_map.signals()[0].lanes, (std::vector{lane(road_map, id).id}));
}

/// As the library lanelet2 has it.
TEST(Lanelet2, OfSeveralSpeedLimitsTheFirstNamedCountsAndOfOneItsSign) {
  MadeLanelet2 made;
  const auto limit = [&](const std::string& sign, const std::string& said) {
    std::vector<std::pair<std::int64_t, std::string>> members;
    if (!sign.empty()) {
      members.emplace_back(
          made.line({{5, 4}, {5, 5}}, {{"type", "traffic_sign"}, {"subtype", sign}}), "refers");
    }
    return made.relation(
        members, {{"type", "regulatory_element"}, {"subtype", "speed_limit"}, {"sign_type", said}});
  };
  const auto lanelet = [&](double y_m, std::int64_t first, std::int64_t second) {
    return made.lanelet(made.line({{0, y_m + 3}, {10, y_m + 3}}), made.line({{0, y_m}, {10, y_m}}),
                        {{"subtype", "road"}},
                        {{-first, "regulatory_element"}, {-second, "regulatory_element"}});
  };
  const std::int64_t at_30 = limit("de274-30", ""), at_70 = limit("de274-70", ""),
                     of_sign = limit("de274-50", "90"), of_text = limit("", "90");
  const std::int64_t a = lanelet(0, at_30, at_70), b = lanelet(10, at_70, at_30),
                     c = lanelet(20, of_sign, of_sign), d = lanelet(30, of_text, of_text);
  const RoadMap road_map = parse(made);
  const auto kmph = [&](std::int64_t id) {
    return 3.6 * lane(road_map, id).speed_limit_at_mps(0.0).value();
  };
  EXPECT_NEAR(kmph(a), 30.0, 1e-9);
  EXPECT_NEAR(kmph(b), 70.0, 1e-9);
  EXPECT_NEAR(kmph(c), 50.0, 1e-9);
  EXPECT_NEAR(kmph(d), 90.0, 1e-9);
}

TEST(Lanelet2, LightsStopLinesAndUnknownRegulationsAreKept) {
  MadeLanelet2 made;
  const std::int64_t light = made.line({{12, 1}, {12, 2}}, {{"type", "traffic_light"}});
  const std::int64_t stop = made.line({{9, 0}, {9, 3}}, {{"type", "stop_line"}});
  const std::int64_t lights =
      made.relation({{light, "refers"}, {stop, "ref_line"}},
                    {{"type", "regulatory_element"}, {"subtype", "traffic_light"}});
  const std::int64_t odd = made.relation(
      {{stop, "whatever"}}, {{"type", "regulatory_element"}, {"subtype", "moon_phase"}});
  const std::int64_t id = made.lanelet(
      made.line({{0, 3}, {10, 3}}), made.line({{0, 0}, {10, 0}}), {{"subtype", "road"}},
      {{-lights, "regulatory_element"}, {-odd, "regulatory_element"}});
  const RoadMap road_map = parse(made);
  const LaneId only = lane(road_map, id).id;
  ASSERT_EQ(road_map.signals().size(), 1u);
  EXPECT_TRUE(road_map.signals()[0].dynamic);
  EXPECT_THAT(road_map.signals()[0].lanes, ElementsAre(only));
  // The light looks back at the traffic that comes towards it.
  EXPECT_NEAR(std::abs(road_map.signals()[0].heading_rad.value()), 3.14159265358979, 1e-9);
  ASSERT_EQ(road_map.stop_lines().size(), 1u);
  EXPECT_THAT(road_map.stop_lines()[0].lanes, ElementsAre(only));
  EXPECT_THAT(road_map.stop_lines()[0].signals, ElementsAre(std::to_string(light)));
  ASSERT_EQ(road_map.regulations().size(), 2u);
  EXPECT_EQ(road_map.regulations()[1].type, "moon_phase");
  EXPECT_EQ(road_map.regulations()[1].members.at(0).role, "whatever");
  EXPECT_EQ(road_map.regulations()[1].members.at(0).in_map.size(), 2u);
}

TEST(Lanelet2, AnExplicitCentrelineIsTakenAsItIsInDrivingDirection) {
  MadeLanelet2 made;
  const std::int64_t centre = made.line({{10, 1}, {5, 2}, {0, 1}});
  const std::int64_t id = made.lanelet(made.line({{0, 3}, {10, 3}}), made.line({{0, 0}, {10, 0}}),
                                       {{"subtype", "road"}}, {{centre, "centerline"}});
  const RoadMap road_map = parse(made);
  EXPECT_THAT(lane(road_map, id).centre.in_map.points(),
              ElementsAre(Eigen::Vector2d(0, 1), Eigen::Vector2d(5, 2), Eigen::Vector2d(10, 1)));
  EXPECT_TRUE(has_remark(road_map, "import.centreline-reversed"));
}

TEST(Lanelet2, ElevationIsThatOfTheNodes) {
  MadeLanelet2 made;
  const std::int64_t left = made.way({made.node({0, 3}, 1.0), made.node({10, 3}, 3.0)});
  const std::int64_t right = made.way({made.node({0, 0}, 2.0), made.node({10, 0}, 4.0)});
  const std::int64_t id = made.lanelet(left, right);
  const RoadMap road_map = parse(made);
  EXPECT_THAT(lane(road_map, id).left.z_m, ElementsAre(1.0, 3.0));
  EXPECT_DOUBLE_EQ(lane(road_map, id).centre.z_m.front(), 1.5);
  EXPECT_DOUBLE_EQ(lane(road_map, id).centre.z_m.back(), 3.5);
}

// The oracle is the C library.
TEST(Lanelet2, NumbersAreTheNearestDoublesToTheirText) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 20'000; ++i) {
    std::string text = std::to_string(random() >> (random() % 64));
    if (random() % 4 != 0) text.insert(1 + random() % text.size(), ".");
    if (text.back() == '.') text += std::to_string(random() % 10);
    if (random() % 2 == 0) text.insert(0, "-");
    EXPECT_EQ(lanelet2::number_in(text), std::strtod(text.c_str(), nullptr)) << text;
  }
  for (const char* text : {"", "-", ".", "1.2.3", "1e", "4 m", "nan", "1e999", "--1"}) {
    EXPECT_TRUE(std::isnan(lanelet2::number_in(text))) << text;
  }
  EXPECT_TRUE(std::signbit(lanelet2::number_in("-0.0")));
  EXPECT_EQ(lanelet2::number_in(" +1.5e-3 "), 1.5e-3);
}

TEST(Lanelet2, MultipolygonsBecomeAreasWithHoles) {
  MadeLanelet2 made;
  made.lanelet(made.line({{0, 3}, {10, 3}}), made.line({{0, 0}, {10, 0}}));
  const std::int64_t a = made.node({0, 10}), b = made.node({10, 10}), c = made.node({10, 20}),
                     d = made.node({0, 20});
  const std::int64_t one = made.way({a, b, c}), two = made.way({a, d, c});
  const std::int64_t hole = made.line({{4, 14}, {6, 14}, {6, 16}, {4, 16}});
  const std::int64_t closed = made.way({hole - 4, hole - 3, hole - 2, hole - 1, hole - 4});
  made.relation({{one, "outer"}, {two, "outer"}, {closed, "inner"}},
                {{"type", "multipolygon"}, {"subtype", "exit"}});
  made.relation({{one, "outer"}}, {{"type", "multipolygon"}, {"subtype", "parking"}});
  const RoadMap road_map = parse(made);
  ASSERT_EQ(road_map.areas().size(), 1u);
  EXPECT_TRUE(road_map.areas()[0].is_road);
  ASSERT_EQ(road_map.areas()[0].in_map.size(), 1u);
  EXPECT_NEAR(geometry::area_m2(road_map.areas()[0].in_map[0]), 96.0, 1e-9);
  EXPECT_TRUE(has_remark(road_map, "import.area"));  // the second one does not close
}

TEST(Lanelet2, WithoutLocalCoordinatesTheMapIsInUtmOfTheFirstNode) {
  MadeLanelet2 made;
  // East of the zone's edge at 12° the second node stays in zone 32.
  const std::int64_t left =
      made.way({made.geographic_node(49.0, 11.9999), made.geographic_node(49.0, 12.0001)});
  const std::int64_t right =
      made.way({made.geographic_node(48.9999, 11.9999), made.geographic_node(48.9999, 12.0001)});
  const std::int64_t id = made.lanelet(left, right);
  const RoadMap road_map = parse(made);
  EXPECT_EQ(road_map.crs(), "EPSG:32632");
  // By PROJ 9.5: EPSG:4326 EPSG:32632.
  const Eigen::Vector2d first = road_map.to_source(lane(road_map, id).left.in_map.points()[0]);
  EXPECT_NEAR(first.x(), 719406.38848, 1e-4);
  EXPECT_NEAR(first.y(), 5431792.57531, 1e-4);
  EXPECT_NEAR(lane(road_map, id).length_m(), 14.6, 0.1);
}

TEST(Lanelet2, ElementsThatNobodyUsesAreCounted) {
  MadeLanelet2 made;
  made.lanelet(made.line({{0, 3}, {10, 3}}), made.line({{0, 0}, {10, 0}}));
  made.line({{0, 30}, {10, 30}}, {{"type", "fence"}});
  made.line({{0, 31}, {10, 31}}, {{"type", "fence"}});
  made.relation({}, {{"type", "route"}});
  const RoadMap road_map = parse(made);
  ASSERT_EQ(road_map.unused().size(), 2u);
  EXPECT_EQ(road_map.unused()[0].name, "relation/route");
  EXPECT_EQ(road_map.unused()[1].name, "way/fence");
  EXPECT_EQ(road_map.unused()[1].count, 2u);
}

TEST(Lanelet2, FaultyElementsCostOnlyThemselves) {
  MadeLanelet2 made;
  const std::int64_t good =
      made.lanelet(made.line({{0, 3}, {10, 3}}), made.line({{0, 0}, {10, 0}}));
  made.relation({{made.line({{0, 3}, {10, 3}}), "left"}}, {{"type", "lanelet"}});  // one border
  made.lanelet(made.way({}), made.line({{0, 0}, {10, 0}}));                        // empty way
  made.lanelet(99999, made.line({{0, 0}, {10, 0}}));                               // not there
  made.lanelet(made.line({{5, 5}, {5, 5}}), made.line({{5, 5}, {5, 5}}));          // no length
  made.lanelet(made.line({{0, 3}, {1e300, 3}}), made.line({{0, 0}, {10, 0}}));     // not on earth
  made.raw(
      "<node id=\"1\" lat=\"0\" lon=\"0\"/><node id=\"x\"/><way id=\"7e\"/>"
      "<relation id=\"2\"><member type=\"moon\" ref=\"1\"/></relation>");
  const RoadMap road_map = parse(made);
  ASSERT_EQ(road_map.lanes().size(), 1u);
  EXPECT_EQ(road_map.lanes()[0].name, std::to_string(good));
  for (const char* rule : {"import.lanelet-border", "import.lanelet-length", "import.node-position",
                           "import.duplicate-id", "import.id", "import.reference"}) {
    EXPECT_TRUE(has_remark(road_map, rule)) << rule;
  }
}

std::string refusal(const std::string& bytes) {
  return tests::refusal_of([&] { parse_map(bytes, "made.osm"); });
}

TEST(Lanelet2, FilesWithoutUsableLaneletsAreRefused) {
  EXPECT_THAT(refusal("<osm/>"), HasSubstr("made.osm: no lanelet"));
  MadeLanelet2 made;
  made.lanelet(1, 2);
  EXPECT_THAT(refusal(made.text()), HasSubstr("none of its 1 lanelets has two usable borders"));
  EXPECT_THAT(refusal("<osm><node id="), HasSubstr("not well-formed XML"));
}

TEST(Lanelet2, ManyLaneletsOnOneLongBorderDoNotExhaustMemory) {
  MadeLanelet2 made;
  std::vector<MadeLanelet2::Point> points;
  for (int i = 0; i < 3000; ++i) points.push_back({0.1 * i, 0});
  const std::int64_t border = made.line(points);
  for (int i = 0; i < 1500; ++i) made.lanelet(border, border);
  EXPECT_THAT(refusal(made.text()), HasSubstr("repeat more points"));
}

}  // namespace
}  // namespace roadbed::map
