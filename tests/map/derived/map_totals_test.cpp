#include "roadbed/map/derived/map_totals.h"

#include <gtest/gtest.h>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/compiled/compiled_map.h"
#include "roadbed/map/derived/surface.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/reseal.h"

namespace roadbed::map {
namespace {

double area_m2(const std::vector<geometry::Polygon>& polygons) {
  double sum_m2 = 0.0;
  for (const geometry::Polygon& polygon : polygons) sum_m2 += geometry::area_m2(polygon);
  return sum_m2;
}

TEST(MapTotals, OfARowOfRoadsAreThoseOfItsDrawing) {
  tests::MadeMap made = tests::three_roads_in_a_row();
  made.lane(LaneId{2}).type = LaneType::sidewalk;
  made.parts.remarks = {{"b", false, "", 0, ""}, {"a", true, "", 0, ""}, {"b", false, "", 0, ""}};
  const RoadMap row = made.build();
  const MapTotals totals = totals_of(row);
  EXPECT_EQ(totals.lanes_of_type.at(static_cast<std::size_t>(LaneType::driving)), 2U);
  EXPECT_EQ(totals.lanes_of_type.at(static_cast<std::size_t>(LaneType::sidewalk)), 1U);
  EXPECT_NEAR(totals.drivable_lanes_m, 100.0, 1e-9);
  EXPECT_NEAR(covered_areas(row).value().drivable_m2, 400.0, 1e-9);
  EXPECT_NEAR(covered_areas(row).value().junctions_m2, 200.0, 1e-9);
  EXPECT_EQ(totals.bounds.value().low_in_map, Eigen::Vector2d(0.0, -2.0));
  EXPECT_EQ(totals.bounds.value().high_in_map, Eigen::Vector2d(150.0, 2.0));
  EXPECT_EQ(totals.component_lanes, std::vector<std::uint64_t>{2});
  const std::vector<std::pair<std::string, std::uint64_t>> remarks{{"a", 1}, {"b", 2}};
  EXPECT_EQ(totals.remarks, remarks);
  EXPECT_FALSE(totals.has_road_areas);
}

TEST(MapTotals, OfACompiledMapAreSaidWithoutTouchingItsLanes) {
  const RoadMap town = load_map(tests::data_folder() / "town.xodr");
  const RoadMap compiled = read_compiled_map(write_compiled_map(town), "town.rbm");
  EXPECT_EQ(write_totals(totals_of(compiled)), write_totals(totals_of(town)));
  EXPECT_LE(loaded_chunks(compiled).loaded, 8U);  // the head, and where three lists begin
  EXPECT_GT(loaded_chunks(compiled).of, 30U);
}

TEST(MapTotals, HaveTheAreasOfTheExactSurfaceButWhatWasWelded) {
  const RoadMap town = load_map(tests::data_folder() / "town.xodr");
  const auto lanes = drivable_lanes(town);
  const Surface surface = lanes_surface(town, lanes);
  double border_m = 0.0;
  for (const LaneId id : lanes) border_m += geometry::perimeter_m(town.lane(id).polygon);
  double junctions_m2 = 0.0;
  for (const Junction& junction : town.junctions()) {
    junctions_m2 += area_m2(junction_surface(town, junction.id));
  }
  const double welded_m2 = SurfaceOptions{}.weld_m * border_m;
  const MapAreas areas = covered_areas(town).value();
  EXPECT_NEAR(areas.drivable_m2, area_m2(surface.polygons), welded_m2);
  EXPECT_NEAR(areas.junctions_m2, junctions_m2, welded_m2);
  EXPECT_LT(welded_m2, 2e-3 * areas.drivable_m2);
}

TEST(MapTotals, ThatAreNotThoseOfTheMapAreNotVerified) {
  const RoadMap made = tests::straight_two_lane_road(100.0).build();
  std::string bytes = write_compiled_map(made);
  const std::string right = write_totals(totals_of(made));
  MapTotals wrong = totals_of(made);
  wrong.drivable_lanes_m += 1.0;
  const std::size_t at = bytes.find(right);
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, right.size(), write_totals(wrong));
  tests::reseal(bytes);
  EXPECT_EQ(totals_of(read_compiled_map(bytes, "wrong.rbm")).drivable_lanes_m, 201.0);
  EXPECT_THROW(verify_compiled_map(bytes, "wrong.rbm"), InputError);
}

TEST(MapTotals, ThatAreDamagedAreRefused) {
  const RoadMap made = tests::straight_two_lane_road(100.0).build();
  std::string bytes = write_compiled_map(made);
  const std::size_t at = bytes.find(write_totals(totals_of(made)));
  ASSERT_NE(at, std::string::npos);
  bytes[at] = 1;  // as many lane types
  tests::reseal(bytes);
  EXPECT_THROW(totals_of(read_compiled_map(bytes, "damaged.rbm")), InputError);
}

}  // namespace
}  // namespace roadbed::map
