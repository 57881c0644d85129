#include "roadbed/planning/behaviour/command_hold.h"

#include <gtest/gtest.h>

namespace roadbed::planning {
namespace {

PlannerCommand command(Behaviour behaviour, double acceleration_mps2, const char* reason) {
  PlannerCommand made;
  made.behaviour = behaviour;
  made.acceleration_mps2 = acceleration_mps2;
  made.reason = reason;
  return made;
}

// Somebody is met in every third cycle of 0.1 s, up to 3 s.
TEST(CommandHold, GivesWayOnWhereSomebodyIsMetInTurns) {
  CommandHold hold;
  double last_mps2 = 0.0;
  for (int k = 0; k < 60; ++k) {
    const bool meets = k < 30 && k % 3 == 0;
    PlannerCommand now = meets ? command(Behaviour::yield, -1.0, "he comes")
                               : command(Behaviour::cruise, 1.8, "the road is free");
    hold.look(0.1 * k, 1.8, now);
    const bool is_free = k > 32;  // 0.6 s after the last of them
    EXPECT_EQ(now.behaviour, is_free ? Behaviour::cruise : Behaviour::yield) << k;
    EXPECT_EQ(now.reason, is_free ? "the road is free" : "he comes") << k;
    if (meets) {
      EXPECT_EQ(now.acceleration_mps2, -1.0);
    } else if (!is_free) {
      EXPECT_NEAR(now.acceleration_mps2, last_mps2 + 0.3, 1e-9) << k;
    } else {
      EXPECT_EQ(now.acceleration_mps2, 1.8);
    }
    last_mps2 = now.acceleration_mps2;
  }
}

TEST(CommandHold, BrakesNoLessThanIsAskedFor) {
  CommandHold hold;
  PlannerCommand yields = command(Behaviour::yield, -1.0, "he comes");
  hold.look(0.0, 1.8, yields);
  PlannerCommand slows = command(Behaviour::cruise, -2.0, "a bend");
  hold.look(0.1, -2.0, slows);
  EXPECT_EQ(slows.acceleration_mps2, -2.0);
  PlannerCommand stops = command(Behaviour::stop, 1.0, "the goal");
  hold.look(0.2, 1.0, stops);
  EXPECT_EQ(stops.behaviour, Behaviour::stop);
  EXPECT_EQ(stops.acceleration_mps2, 1.0);
}

// What the law itself asks for, at a sign, is no giving way to somebody.
TEST(CommandHold, LeavesWhatTheLawAsksFor) {
  CommandHold hold;
  PlannerCommand waits = command(Behaviour::yield, -1.0, "stop sign 1");
  hold.look(0.0, -1.0, waits);
  PlannerCommand goes = command(Behaviour::cruise, 1.8, "the road is free");
  hold.look(0.1, 1.8, goes);
  EXPECT_EQ(goes.behaviour, Behaviour::cruise);
  EXPECT_EQ(goes.acceleration_mps2, 1.8);
}

}  // namespace
}  // namespace roadbed::planning
