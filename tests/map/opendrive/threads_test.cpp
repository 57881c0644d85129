#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "roadbed/map/compiled/compiled_map.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_road.h"

namespace roadbed::map {
namespace {

using tests::made_document;
using tests::made_lane;
using tests::made_road;
using tests::made_section;
using tests::MadeRoad;

std::string arcs(int count, double length_m, double curvature_per_m) {
  std::string pieces;
  for (int i = 0; i < count; ++i) {
    pieces += fmt::format(
        R"(<geometry s="{0}" x="{0}" y="0" hdg="0" length="{1}"><arc curvature="{2}"/></geometry>)",
        i * length_m, length_m, curvature_per_m);
  }
  return pieces;
}

MadeRoad road_named(const std::string& id) {
  MadeRoad road;
  road.id = id;
  return road;
}

// Roads of one to four sections, bent and straight; some have faults that are remarked.
std::string many_roads(int count) {
  std::string all;
  for (int i = 0; i < count; ++i) {
    MadeRoad road = road_named(i % 40 == 11 ? "4" : std::to_string(i));
    road.x_m = 200.0 * i;
    if (i % 3 == 0) road.plan_view = arcs(1, 100.0, 0.002 + 1e-5 * i);
    if (i % 25 == 7) road.length_m = 90.0;  // not that of its plan view
    for (int section = 0; section <= i % 4; ++section) {
      road.lanes += made_section(20.0 * section, made_lane(1),
                                 made_lane(-1) + made_lane(i % 30 == 13 ? -1 : -2, "", "sidewalk"));
    }
    all += made_road(road);
  }
  return all;
}

std::string read_by(int threads, const std::string& text, double max_error_m = 1e-3) {
  try {
    return write_compiled_map(parse_map(text, "many.xodr", {max_error_m, threads}));
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(OpenDriveThreads, ReadTheSameMapForAnyNumber) {
  const std::string text = made_document(many_roads(400));
  const RoadMap one = parse_map(text, "many.xodr", {.threads = 1});
  EXPECT_GT(one.import_diagnostics().size(), 30u);
  EXPECT_GT(one.lanes().size(), 2'000u);
  for (const int threads : {2, 3}) EXPECT_EQ(read_by(threads, text), write_compiled_map(one));
}

std::string copies(int count, MadeRoad road) {
  const std::string id = road.id;
  std::string all;
  for (int i = 0; i < count; ++i) {
    road.id = fmt::format("{}-{}", id, i);
    all += made_road(road);
  }
  return all;
}

void expect_refused_alike(const std::string& body, const std::string& word, double max_error_m) {
  const std::string text = made_document(body);
  const std::string one = read_by(1, text, max_error_m);
  EXPECT_THAT(one, testing::HasSubstr(word));
  for (const int threads : {2, 3, 2, 3}) EXPECT_EQ(read_by(threads, text, max_error_m), one);
}

// What all roads together may have is spent in the order of the file, whoever comes first.
TEST(OpenDriveThreads, RefuseTheRoadThatIsOneTooMany) {
  MadeRoad bent = road_named("bent");
  bent.length_m = 700;
  bent.plan_view = arcs(1, 700.0, 0.004);
  expect_refused_alike(many_roads(50) + copies(60, bent), "more points than a map of this size",
                       1e-6);
}

TEST(OpenDriveThreads, RefuseTheLanesThatAreTooMany) {
  MadeRoad wide = road_named("wide"), broken = road_named("broken");
  for (int i = 0; i < 20'000; ++i) {
    wide.lanes += made_section(0.005 * i, made_lane(1), made_lane(-1) + made_lane(-2));
  }
  broken.plan_view = R"(<geometry s="0" x="a" y="0" hdg="0" length="100"><line/></geometry>)";
  expect_refused_alike(copies(7, wide) + made_road(broken), "more lanes than a map of this size",
                       1e-3);
  expect_refused_alike(made_road(broken) + copies(7, wide), "road broken", 1e-3);
}

}  // namespace
}  // namespace roadbed::map
