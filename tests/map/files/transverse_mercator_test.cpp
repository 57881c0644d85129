#include "roadbed/map/files/transverse_mercator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace roadbed::map {
namespace {

struct Case {
  double latitude_deg, longitude_deg;
  int zone;
  double east_m, north_m;
};

// Made with PROJ 9.5.1, EPSG:4326 to EPSG:326zz and 327zz.
constexpr Case kCases[] = {
    {49.0, 8.4, 32, 456114.59586226, 5427629.20392472},
    {49.0, 11.9999, 32, 719406.38847827, 5431792.57530741},
    {35.2289, 138.8067, 54, 300400.25178151, 3900632.07736961},
    {-33.8688, 151.2093, 56, 334368.63364810, 6250948.34538501},
    {0.0, 3.0, 31, 500000.00000000, 0.00000000},
    {83.9, 9.0, 32, 500000.00000000, 9316930.15406656},
    {1e-06, -179.99, 1, 167135.72497631, 0.11068174},
    {-79.9, 177.0, 60, 500000.00000000, 1129575.67787744},
    {52.5, 20.0, 32, 1245504.09086470, 5873733.19292415},
    {37.0, -122.3, 10, 562283.67824565, 4095101.34915439},
    {60.39, 5.32, 32, 297230.22020963, 6700510.17525360},
};

TEST(TransverseMercator, AgreesWithProjToAHundredNanometres) {
  for (const Case& c : kCases) {
    const TransverseMercator grid = utm_grid(c.zone, c.latitude_deg < 0.0);
    const Eigen::Vector2d at = grid.forward({c.latitude_deg, c.longitude_deg});
    EXPECT_NEAR(at.x(), c.east_m, 1e-7) << c.latitude_deg << ' ' << c.longitude_deg;
    EXPECT_NEAR(at.y(), c.north_m, 1e-7) << c.latitude_deg << ' ' << c.longitude_deg;
  }
}

TEST(TransverseMercator, InverseUndoesForwardWithinNanometres) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> latitude(-84.0, 84.0), offset(-30.0, 30.0);
  for (int i = 0; i < 2000; ++i) {
    const int zone = 1 + i % 60;
    const TransverseMercator grid = utm_grid(zone, i % 2 == 0);
    const GeographicPoint point{latitude(random), grid.central_meridian_deg + offset(random)};
    const GeographicPoint back = grid.inverse(grid.forward(point));
    constexpr double metres_per_degree = 6.4e6 * std::numbers::pi / 180.0;
    EXPECT_NEAR(back.latitude_deg * metres_per_degree, point.latitude_deg * metres_per_degree,
                2e-8);
    EXPECT_NEAR(std::remainder(back.longitude_deg - point.longitude_deg, 360.0) * metres_per_degree,
                0.0, 2e-7);
  }
}

TEST(TransverseMercator, LengthsKeepTheirScaleAlongTheCentralMeridian) {
  // A minute of arc northwards at 45° is 1852.2 m long; k₀ times that on the grid.
  const TransverseMercator utm = utm_grid(32, false);
  TransverseMercator plain = utm;
  plain.scale = 1.0;
  const auto step_m = [](const TransverseMercator& grid) {
    const GeographicPoint from{45.0, grid.central_meridian_deg};
    const GeographicPoint to{from.latitude_deg + 1.0 / 60.0, from.longitude_deg};
    return (grid.forward(to) - grid.forward(from)).norm();
  };
  EXPECT_NEAR(step_m(plain), 1852.2, 0.1);
  EXPECT_NEAR(step_m(utm) / step_m(plain), 0.9996, 1e-12);
}

TEST(TransverseMercator, OriginHasTheFalseCoordinates) {
  const TransverseMercator grid{8.4, 49.0, 1.0, 100.0, 200.0};
  const Eigen::Vector2d at = grid.forward({49.0, 8.4});
  EXPECT_NEAR(at.x(), 100.0, 1e-9);
  EXPECT_NEAR(at.y(), 200.0, 1e-8);
}

TEST(UtmZone, IsSixDegreesWideButInNorwayAndSvalbard) {
  EXPECT_EQ(utm_zone({49.0, 8.4}), 32);
  EXPECT_EQ(utm_zone({-33.9, 151.2}), 56);
  EXPECT_EQ(utm_zone({60.4, 5.3}), 32);   // Bergen
  EXPECT_EQ(utm_zone({78.2, 15.6}), 33);  // Longyearbyen
  EXPECT_EQ(utm_zone({0.0, -180.0}), 1);
  EXPECT_EQ(utm_zone({0.0, 180.0}), 1);
  EXPECT_EQ(utm_zone({0.0, 30.0}), 36);  // a zone begins in the west
  EXPECT_THROW(utm_grid(0, false), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::map
