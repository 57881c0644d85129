#include "roadbed/map/query/map_stats.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/elements/lane_lines.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/query/lane_strips.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

std::vector<LaneId> all_lanes(const RoadMap& road_map) {
  std::vector<LaneId> lanes;
  for (const Lane& lane : road_map.lanes()) lanes.push_back(lane.id);
  return lanes;
}

const StatsRow* row_of(const StatsTable& table, const std::string& value) {
  const auto found = std::ranges::find(table.rows, value, &StatsRow::value);
  return found == table.rows.end() ? nullptr : &*found;
}

TEST(LaneStrips, AddUpToTheLengthAndAreaOfALane) {
  for (const char* name : {"town.xodr", "country.xodr", "crossing.osm", "junction.xml"}) {
    const RoadMap road_map = load_map(tests::data_folder() / name);
    for (const Lane& lane : road_map.lanes()) {
      double length_m = 0.0;
      for (const LaneStrip& strip : lane_strips(lane)) length_m += strip.length_m();
      EXPECT_NEAR(length_m, lane.length_m(), 1e-9) << name << " " << lane.name;
      EXPECT_NEAR(measure(lane).area_m2, geometry::signed_area_m2(lane.polygon), 1e-3)
          << name << " " << lane.name;
    }
  }
}

/// A lane of this width along an arc of 1 rad to the left that climbs.
Lane arc_lane(double radius_m, double width_m, double slope, int steps = 400) {
  std::vector<Eigen::Vector3d> left, right;
  for (int i = 0; i <= steps; ++i) {
    const double angle_rad = static_cast<double>(i) / steps;
    const Eigen::Vector2d out(std::sin(angle_rad), -std::cos(angle_rad));
    const double z_m = slope * radius_m * angle_rad;
    const Eigen::Vector2d l = (radius_m - 0.5 * width_m) * out,
                          r = (radius_m + 0.5 * width_m) * out;
    left.emplace_back(l.x(), l.y(), z_m);
    right.emplace_back(r.x(), r.y(), z_m);
  }
  Lane lane;
  set_borders(left, right, lane);
  return lane;
}

TEST(LaneStrips, MeasureAnArc) {
  const LaneMeasures measures = measure(arc_lane(50.0, 3.5, 0.04));
  EXPECT_NEAR(measures.area_m2, 0.5 * 1.0 * (51.75 * 51.75 - 48.25 * 48.25), 1e-3);
  EXPECT_NEAR(measures.mean_width_m, 3.5, 1e-5);
  EXPECT_NEAR(measures.least_width_m, 3.5, 1e-5);
  EXPECT_NEAR(measures.greatest_width_m, 3.5, 1e-5);
  EXPECT_NEAR(measures.greatest_slope, 0.04, 1e-6);
  EXPECT_NEAR(measures.greatest_curvature_per_m, 0.02, 1e-4);
}

TEST(LaneStrips, MeasureAnArcThatIsDrawnByFewPoints) {
  for (const double radius_m : {20.0, 100.0}) {
    for (const int steps : {4, 7, 25}) {
      if (radius_m == 100.0 && steps == 4) continue;  // an arc would be 0.8 m off its chord
      const LaneMeasures measures = measure(arc_lane(radius_m, 3.5, 0.0, steps));
      EXPECT_NEAR(measures.greatest_curvature_per_m, 1.0 / radius_m, 0.13 / radius_m) << steps;
      EXPECT_NEAR(measures.least_width_m, 3.5, 0.06) << radius_m << " " << steps;
      EXPECT_NEAR(measures.greatest_width_m, 3.5, 0.06) << radius_m << " " << steps;
    }
  }
}

/// The points of a border lie where somebody set them, not beside those of the other.
TEST(LaneStrips, MeasureTheWidthAcrossTheLane) {
  Lane lane;
  set_borders({{0, 3.5, 0}, {14, 3.5, 0}, {31, 3.5, 0}, {50, 3.5, 0}},
              {{0, 0, 0}, {5, 0, 0}, {44, 0, 0}, {50, 0, 0}}, lane);
  const LaneMeasures measures = measure(lane);
  EXPECT_NEAR(measures.least_width_m, 3.5, 1e-9);
  EXPECT_NEAR(measures.greatest_width_m, 3.5, 1e-9);
  EXPECT_NEAR(measures.mean_width_m, 3.5, 1e-9);
}

TEST(MapStats, EveryTableAddsUpToTheWhole) {
  for (const char* name : {"town.xodr", "country.xodr", "crossing.osm", "junction.xml"}) {
    const RoadMap road_map = load_map(tests::data_folder() / name);
    const MapStats stats = map_stats(road_map, all_lanes(road_map));
    EXPECT_EQ(stats.all.lanes, road_map.lanes().size());
    for (const StatsTable& table : stats.tables) {
      double length_m = 0.0, area_m2 = 0.0;
      for (const StatsRow& row : table.rows) {
        length_m += row.length_m;
        area_m2 += row.area_m2;
        EXPECT_GT(row.lanes, 0u);
        EXPECT_LE(row.lanes, stats.all.lanes);
      }
      EXPECT_NEAR(length_m, stats.all.length_m, 1e-6) << name << " " << table.by;
      EXPECT_NEAR(area_m2, stats.all.area_m2, 1e-6) << name << " " << table.by;
    }
  }
}

RoadMap one_lane(Lane lane) {
  RoadMapParts parts;
  lane.name = "1";
  parts.lanes.push_back(std::move(lane));
  parts.links.resize(1);
  return RoadMap(std::move(parts));
}

TEST(MapStats, SpeedLimitsCountFromTheirStationOn) {
  Lane lane;
  set_borders({{0, 3, 0}, {100, 3, 0}}, {{0, 0, 0}, {100, 0, 0}}, lane);
  lane.type = LaneType::driving;
  lane.speed_limits = {{30.0, 50.0 / 3.6},
                       {70.0, std::nullopt},
                       {80.0, std::numeric_limits<double>::infinity()},
                       {90.0, 50.0 / 3.6}};
  const RoadMap road_map = one_lane(lane);
  const StatsTable speeds = map_stats(road_map, all_lanes(road_map)).tables[1];
  ASSERT_EQ(speeds.by, "speed");
  ASSERT_EQ(speeds.rows.size(), 3u);
  EXPECT_NEAR(row_of(speeds, "50")->length_m, 50.0, 1e-9);
  EXPECT_NEAR(row_of(speeds, "50")->area_m2, 150.0, 1e-9);
  EXPECT_EQ(row_of(speeds, "50")->lanes, 1u);
  EXPECT_NEAR(row_of(speeds, "unknown")->length_m, 40.0, 1e-9);
  EXPECT_NEAR(row_of(speeds, "no limit")->length_m, 10.0, 1e-9);
}

TEST(MapStats, ClassesHoldTheirLowerBoundAndNotTheirUpper) {
  Lane lane;
  set_borders({{0, 3, 0}, {10, 3, 0.1}, {20, 3, 0.5}}, {{0, 0, 0}, {10, 0, 0.1}, {20, 0, 0.5}},
              lane);
  const RoadMap road_map = one_lane(lane);
  const MapStats stats = map_stats(road_map, all_lanes(road_map));
  const StatsTable &widths = stats.tables[2], &slopes = stats.tables[3];
  ASSERT_EQ(widths.rows.size(), 1u);
  EXPECT_EQ(widths.rows[0].from, 3.0);
  EXPECT_EQ(widths.rows[0].to, 3.25);
  ASSERT_EQ(slopes.rows.size(), 2u);  // 1 % and 4 %
  EXPECT_EQ(slopes.rows[0].from, 1.0);
  EXPECT_EQ(slopes.rows[1].from, 4.0);
}

}  // namespace
}  // namespace roadbed::map
