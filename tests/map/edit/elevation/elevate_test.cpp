#include "roadbed/map/edit/elevation/elevate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_open_drive.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

using Eigen::Vector2d;

// Tilted and curved: no plane, no cylinder.
double hill_m(const Vector2d& at) {
  return 250.0 + 0.03 * at.x() - 0.02 * at.y() + 1.5 * std::sin(at.x() / 90.0) +
         std::cos((at.x() + 2.0 * at.y()) / 160.0);
}

std::vector<std::optional<double>> hill(std::span<const Vector2d> at) {
  std::vector<std::optional<double>> heights_m;
  for (const Vector2d& point : at) heights_m.emplace_back(hill_m(point));
  return heights_m;
}

bool is_driven(const Lane& lane) {
  return lane.type != LaneType::sidewalk && lane.type != LaneType::curb &&
         lane.type != LaneType::median && lane.type != LaneType::none;
}

// How far vertices of borders are off the hill at most.
double worst_m(const RoadMap& map, const std::function<bool(const Vector2d&)>& counts) {
  double worst_m = 0.0;
  std::size_t count = 0;
  for (const Lane& lane : map.lanes()) {
    if (!is_driven(lane)) continue;
    for (const auto line : {&Lane::left, &Lane::right}) {
      for (std::size_t i = 0; i < (lane.*line).z_m.size(); ++i) {
        const Vector2d at = map.to_source((lane.*line).in_map.points()[i]);
        if (!counts(at)) continue;
        worst_m = std::max(worst_m, std::abs((lane.*line).z_m[i] - hill_m(at)));
        ++count;
      }
    }
  }
  EXPECT_GT(count, 4u);
  return worst_m;
}

bool everywhere(const Vector2d&) { return true; }

class Elevate : public testing::TestWithParam<std::pair<const char*, double>> {};

// Lanelet2 and CommonRoad have a height for each point; OpenDRIVE's roads are straight across.
INSTANTIATE_TEST_SUITE_P(Formats, Elevate,
                         testing::Values(std::pair{"crossing.osm", 1e-4},
                                         std::pair{"junction.xml", 1e-4},
                                         std::pair{"town.xodr", 0.015},
                                         std::pair{"ramp.xodr", 0.015}));

TEST_P(Elevate, PutsEveryBorderOnTheGround) {
  const std::string bytes = read_file(tests::data_folder() / GetParam().first);
  const Edited higher = elevate(bytes, GetParam().first, hill);
  const RoadMap before = parse_map(bytes, GetParam().first);
  const RoadMap after = parse_map(higher.bytes, GetParam().first);
  ASSERT_EQ(before.lanes().size(), after.lanes().size());
  EXPECT_LT(worst_m(after, everywhere), GetParam().second);
  for (const Lane& lane : before.lanes()) {  // in plan all is where it was, but for what leans
    const Vector2d there = after.lane(lane.id).left.in_map.points().front();
    EXPECT_NEAR(
        (after.to_source(there) - before.to_source(lane.left.in_map.points().front())).norm(), 0.0,
        0.03);
  }
}

// The ground is known on one half only: there it counts, and beyond nothing steps.
TEST_P(Elevate, GoesOnWhereNoGroundIsKnown) {
  const std::string bytes = read_file(tests::data_folder() / GetParam().first);
  const RoadMap before = parse_map(bytes, GetParam().first);
  Vector2d middle(0, 0);
  for (const Lane& lane : before.lanes()) middle += before.to_source(lane.left.in_map.points()[0]);
  middle /= static_cast<double>(before.lanes().size());
  const auto half = [&](std::span<const Vector2d> at) {
    auto heights_m = hill(at);
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (at[i].x() > middle.x()) heights_m[i].reset();
    }
    return heights_m;
  };
  const Edited higher = elevate(bytes, GetParam().first, half);
  const RoadMap after = parse_map(higher.bytes, GetParam().first);
  const auto is_known = [&](const Vector2d& at) { return at.x() < middle.x() - 6.0; };
  EXPECT_LT(worst_m(after, is_known), GetParam().second);
  for (const Lane& lane : after.lanes()) {
    for (const double z_m : lane.left.z_m) EXPECT_NEAR(z_m, 250.0, 40.0) << lane.name;
  }
}

// Ends of lanes that follow each other are as near to each other in height as before.
TEST_P(Elevate, LeavesNoStepBetweenLanes) {
  const std::string bytes = read_file(tests::data_folder() / GetParam().first);
  const RoadMap after = parse_map(elevate(bytes, GetParam().first, hill).bytes, GetParam().first);
  for (const Lane& lane : after.lanes()) {
    for (const LaneId next : after.graph().of(lane.id).successors) {
      const Lane& other = after.lane(next);
      if ((other.left.in_map.points().front() - lane.left.in_map.points().back()).norm() > 0.01) {
        continue;
      }
      EXPECT_NEAR(other.left.z_m.front(), lane.left.z_m.back(), 0.015) << lane.name;
    }
  }
}

TEST(ElevateOpenDrive, SaysHowFarTheGroundIsFromWhatRoadsCanBe) {
  const auto roof = [](std::span<const Vector2d> at) {  // 0.1 m higher in the middle
    std::vector<std::optional<double>> heights_m;
    for (const Vector2d& point : at) heights_m.emplace_back(-0.05 * std::abs(point.y()));
    return heights_m;
  };
  const std::string road =
      "<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/><road id=\"1\" length=\"10\" "
      "junction=\"-1\"><planView><geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"10\"><line/>"
      "</geometry></planView><lanes><laneSection s=\"0\"><left><lane id=\"1\" type=\"driving\">"
      "<width sOffset=\"0\" a=\"4\" b=\"0\" c=\"0\" d=\"0\"/></lane></left><center><lane id=\"0\" "
      "type=\"none\"/></center><right><lane id=\"-1\" type=\"driving\"><width sOffset=\"0\" "
      "a=\"4\" b=\"0\" c=\"0\" d=\"0\"/></lane></right></laneSection></lanes></road></OpenDRIVE>";
  const Edited higher = elevate(road, "roof.xodr", roof);
  ASSERT_EQ(higher.notes.size(), 1u);
  EXPECT_NE(higher.notes[0].find("at most 0.120 m"), std::string::npos) << higher.notes[0];
  const RoadMap map = parse_map(higher.bytes, "roof.xodr");
  EXPECT_NEAR(map.lanes()[0].left.z_m[0], -0.12, 1e-9);
}

// Slopes across and along that a road had are replaced, not added.
TEST(ElevateOpenDrive, ReplacesTheProfilesThatWere) {
  const std::string bytes = read_file(tests::data_folder() / "ramp.xodr");
  const std::string once = elevate(bytes, "ramp.xodr", hill).bytes;
  const std::string twice = elevate(once, "ramp.xodr", hill).bytes;
  const RoadMap a = parse_map(once, "a.xodr"), b = parse_map(twice, "b.xodr");
  for (const Lane& lane : a.lanes()) {
    EXPECT_NEAR(lane.left.z_m.back(), b.lane(lane.id).left.z_m.back(), 0.003);
  }
}

TEST(ElevateOpenDrive, PutsTown04OnTheGround) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const std::filesystem::path file = folder / "opendrive/BerkeleyLearnVerify+Scenic/Town04.xodr";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no Town04";
  const auto slow_hill = [](std::span<const Vector2d> at) {
    std::vector<std::optional<double>> heights_m;
    for (const Vector2d& point : at) {
      heights_m.emplace_back(0.02 * point.x() - 0.03 * point.y() + 5.0);
    }
    return heights_m;
  };
  const RoadMap after = parse_map(elevate(read_file(file), "a.xodr", slow_hill).bytes, "b.xodr");
  for (const Lane& lane : after.lanes()) {
    if (!is_driven(lane)) continue;
    for (std::size_t i = 0; i < lane.left.z_m.size(); ++i) {
      const Vector2d at = after.to_source(lane.left.in_map.points()[i]);
      EXPECT_NEAR(lane.left.z_m[i], 0.02 * at.x() - 0.03 * at.y() + 5.0, 0.02) << lane.name;
    }
  }
}

}  // namespace
}  // namespace roadbed::map
