#include "roadbed/map/derived/lane_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/bent_lanes.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

using Eigen::Vector2d;

TEST(LaneFrame, PutsPointsBesideAnArcWhereTheArcDoes) {
  tests::MadeMap made;
  const double radius_m = 30.0;
  const LaneId id =
      tests::add_arc_lane(made, made.add_road("1"), "-1", {0, 0, 0}, 1.0 / radius_m, 40.0, 3.5);
  const LaneFrame frame(made.lane(id));
  for (double s = 0.0; s <= 39.9; s += 0.37) {
    for (const double d : {-5.0, -1.0, 0.0, 2.0, 12.0}) {
      const double turn = s / radius_m;
      const Vector2d expected(std::sin(turn) * (radius_m - d),
                              radius_m - std::cos(turn) * (radius_m - d));
      EXPECT_LT((frame.to_map(s, d) - expected).norm(), 3e-3) << s << ' ' << d;
      const auto back = frame.to_lane(expected);
      if (s < 0.01) continue;  // before the start by rounding
      ASSERT_TRUE(back.has_value()) << s << ' ' << d;
      EXPECT_NEAR(back->s_m, s, 3e-3);
      EXPECT_NEAR(back->d_m, d, 3e-3);
    }
  }
}

TEST(LaneFrame, HasNoPlaceBeforeTheStartOrBeyondTheEnd) {
  const tests::MadeMap made = tests::straight_two_lane_road(100.0);
  const LaneFrame frame(made.parts.lanes[0]);
  EXPECT_FALSE(frame.to_lane({-0.01, 0.0}).has_value());
  EXPECT_FALSE(frame.to_lane({100.01, 0.0}).has_value());
  const auto place = frame.to_lane({40.0, 1.0});
  ASSERT_TRUE(place.has_value());
  EXPECT_NEAR(place->s_m, 40.0, 1e-9);
  EXPECT_NEAR(place->d_m, 2.75, 1e-9);
}

TEST(LaneFrame, ComesBackToThePlaceOnEveryLaneOfRealTowns) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> fraction(0.001, 0.999), offset_m(-2.0, 2.0);
  int places = 0, ambiguous = 0;
  for (const std::string town : {"Town01", "Town04"}) {
    const RoadMap road_map =
        load_map(folder / "opendrive/BerkeleyLearnVerify+Scenic" / (town + ".xodr"));
    for (const Lane& lane : road_map.lanes()) {
      if (!is_drivable(lane.type) || lane.length_m() < 1.0) continue;
      const LaneFrame frame(lane);
      for (int i = 0; i < 5; ++i) {
        const double s = fraction(random) * lane.length_m(), d = offset_m(random);
        const Vector2d point = frame.to_map(s, d);
        const auto back = frame.to_lane(point);
        ++places;
        if (!back) {
          ++ambiguous;
          continue;
        }
        EXPECT_LT((frame.to_map(back->s_m, back->d_m) - point).norm(), 1e-6) << lane.name;
        if (std::abs(back->s_m - s) > 1e-6 || std::abs(back->d_m - d) > 1e-6) ++ambiguous;
      }
    }
  }
  EXPECT_GT(places, 2000);
  EXPECT_LT(ambiguous, places / 100);  // lanes in bends as tight as they are wide
}

}  // namespace
}  // namespace roadbed::map
