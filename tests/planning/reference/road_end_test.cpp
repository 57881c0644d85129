#include "roadbed/planning/reference/road_end.h"

#include <gtest/gtest.h>

#include "roadbed/planning/route/router.h"
#include "roadbed/tests/support/made_maps.h"

namespace roadbed::tools {
namespace {

/// Two lanes eastwards, from 0 to 50 m and, after a gap, to 100 m.
struct TwoParts {
  explicit TwoParts(double gap_m) {
    made.parts.format = "made";
    first = made.add_lane(made.add_road("1"), "-1", {{0, 2}, {50, 2}}, {{0, -2}, {50, -2}});
    const map::LaneId second = made.add_lane(made.add_road("2"), "-1", {{50 + gap_m, 2}, {100, 2}},
                                             {{50 + gap_m, -2}, {100, -2}});
    made.link(first, second);
  }

  /// Of a line that starts at x = 10 m and has its goal at x = 40 m.
  double end_s_m(double extend_m) const {
    const map::RoadMap road_map = made.build();
    const auto route = planning::find_route(road_map, {first, 10.0}, {first, 40.0}).route;
    const auto line = planning::ReferenceLine::along(road_map, *route, {.extend_m = extend_m});
    return road_end_s_m(line, road_map);
  }

  tests::MadeMap made;
  map::LaneId first;
};

TEST(RoadEnd, IsWhereTheLanesBehindTheGoalEnd) {
  EXPECT_NEAR(TwoParts(0.0).end_s_m(120.0), 90.0, 2e-3);
}

TEST(RoadEnd, IsTheLinesOwnWhereTheLanesGoOn) {
  EXPECT_NEAR(TwoParts(0.0).end_s_m(30.0), 60.0, 1e-6);
}

TEST(RoadEnd, GapBetweenLanesIsOneOnlyIfItIsWide) {
  EXPECT_NEAR(TwoParts(0.4).end_s_m(120.0), 90.0, 2e-3);
  EXPECT_NEAR(TwoParts(2.0).end_s_m(120.0), 40.0, 2e-3);
}

}  // namespace
}  // namespace roadbed::tools
