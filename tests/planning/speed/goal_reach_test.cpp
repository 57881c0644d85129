#include "roadbed/planning/speed/goal_reach.h"

#include <gtest/gtest.h>

namespace roadbed::planning {
namespace {

constexpr double kMost_mps2 = 2.0;

/// A straight way of 100 m on which a part of 10 m, from 30 m on, is blocked for a while.
class GoalReach : public testing::Test {
 protected:
  GoalReach() {
    for (int i = 0; i <= 100; ++i) {
      way_.ahead_m.push_back(i);
      way_.station_m.push_back(i);
      way_.body.emplace_back();
    }
    way_.wanted_mps.assign(101, 10.0);
    way_.most_mps.assign(101, 60.0);
  }

  /// Blocked in steps of 0.1 s, the second one included; the goal is met at 5 s within 1 m.
  bool may_reach(double goal_m, int from_step, int to_step, double end_m = 100.0) const {
    StGraph occupancy(way_, TrafficBodies({}, 0.0, 60), 0.0);
    for (int step = from_step; step <= to_step; ++step) occupancy.block(step, 30.0, 40.0);
    return may_reach_goal(
        {.profile = way_,
         .occupancy = occupancy,
         .speed_mps = 10.0,
         .horizon_s = 5.0,
         .end_m = end_m,
         .goals = {{.time_s = {5.0, 5.0}, .speed_mps = {}, .ahead_m = {goal_m, goal_m + 1.0}}}},
        kMost_mps2);
  }

  PathProfile way_;
};

TEST_F(GoalReach, BehindWhatIsInTheWayAllTheTimeThereIsNoGoal) {
  EXPECT_FALSE(may_reach(45.0, 0, 60));
  EXPECT_TRUE(may_reach(25.0, 0, 60));
}

TEST_F(GoalReach, BeforeItComesAndAfterItHasGoneTheWayIsFree) {
  EXPECT_TRUE(may_reach(45.0, 40, 60));  // 44 m after 4 s, the speed rising by 2 m/s each second
  EXPECT_FALSE(may_reach(45.0, 20, 60));
  EXPECT_TRUE(may_reach(45.0, 0, 40));  // from 30 m on, 1 s at 20 m/s
  EXPECT_FALSE(may_reach(55.0, 0, 42));
}

TEST_F(GoalReach, NothingBeyondThePathsEndOrTheStrongestCommandIsReached) {
  EXPECT_FALSE(may_reach(45.0, 1, 0, 40.0));
  EXPECT_TRUE(may_reach(75.0, 1, 0));  // 5 s at up to 20 m/s: the bound is a generous one
  EXPECT_FALSE(may_reach(82.0, 1, 0));
}

}  // namespace
}  // namespace roadbed::planning
