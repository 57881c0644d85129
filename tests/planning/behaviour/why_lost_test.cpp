#include "roadbed/planning/behaviour/why_lost.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "roadbed/tests/support/straight_profile.h"

namespace roadbed::planning {
namespace {

Obstacle standing(const char* id, double x_m) {
  return {.id = id,
          .kind = "car",
          .length_m = 4.0,
          .width_m = 1.8,
          .motion = geometry::Trajectory(std::vector<geometry::TrajectoryPoint>{{.x_m = x_m}})};
}

/// At 8 m/s for 4 s, judged among these by the search.
ManeuverHypothesis searched(const std::vector<Obstacle>& others, bool is_free) {
  ManeuverHypothesis made{.goal_line = nullptr,
                          .maneuver = Maneuver::keep_lane,
                          .proposal = {},
                          .profile = tests::straight_profile(10.0),
                          .on_road_m = 1e9};
  for (int i = 0; i <= 40; ++i) {
    made.answer.plan.push_back({.t_s = 0.1 * i, .ahead_m = 0.8 * i, .speed_mps = 8.0});
  }
  made.occupancy = std::make_shared<StGraph>(made.profile, Traffic{others}, 0.0, 60, 0.0);
  made.answer.is_free = is_free;
  made.answer.free_until_s = 1.5;
  return made;
}

TEST(WhyLost, NamesWhoIsMetFirstBySearchedDrives) {
  const std::vector<Obstacle> others{standing("behind it", 33.0), standing("near", 20.0),
                                     standing("far", 150.0)};
  std::vector<ManeuverHypothesis> judged;
  judged.push_back(searched({}, true));
  judged.push_back(searched(others, false));
  const auto outcomes = outcomes_of(judged, 0, Traffic{others});
  ASSERT_EQ(outcomes.size(), 2u);
  EXPECT_TRUE(outcomes[0].is_driven);
  EXPECT_EQ(outcomes[1].reason, "meets car near after 1.5 s");
}

TEST(WhyLost, NamesNobodyWhereNobodyIs) {
  std::vector<ManeuverHypothesis> judged;
  judged.push_back(searched({}, true));
  judged.push_back(searched({}, false));
  EXPECT_EQ(outcomes_of(judged, 0, {})[1].reason, "meets something after 1.5 s");
}

}  // namespace
}  // namespace roadbed::planning
