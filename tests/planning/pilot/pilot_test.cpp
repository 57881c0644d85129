#include "roadbed/planning/pilot/pilot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::planning {
namespace {

/// On the bypass of the town, 12 m/s in the right lane.
class Pilots : public testing::Test {
 protected:
  Pilots() { view_.ego = {.map_from_vehicle = place("31/0/-2", 20.0), .speed_mps = 12.0}; }

  geometry::Pose2 place(const std::string& lane, double s_m) const {
    return road_map_->lane(*road_map_->find_lane(lane)).pose_at(s_m);
  }
  PilotSetup setup(const std::string& goal_lane = "6/0/-1", double s_m = 100.0) const {
    return {.road_map = road_map_,
            .goal = {*road_map_->find_lane(goal_lane), s_m},
            .driving = {.desired_speed_mps = 12.0}};
  }
  /// The next view, with the vehicle where its last trajectory has it.
  PilotView& follow(const PilotAnswer& answer) {
    view_.t_s += 0.1;
    const geometry::TrajectoryPoint now = answer.trajectory.at(view_.t_s);
    view_.ego = {.map_from_vehicle = now.pose(),
                 .speed_mps = now.speed_mps,
                 .steering_rad = now.steering_rad,
                 .acceleration_mps2 = now.acceleration_mps2};
    return view_;
  }

  std::shared_ptr<const map::RoadMap> road_map_ =
      std::make_shared<map::RoadMap>(map::load_map(tests::data_folder() / "town.xodr"));
  PilotView view_;
};

TEST_F(Pilots, DriveToTheGoalAndStandThere) {
  Pilot pilot(setup());
  PilotAnswer answer = pilot.step(view_);
  for (int k = 0; k < 1200 && !answer.is_at_goal; ++k) {
    EXPECT_EQ(answer.trajectory.start_s(), view_.t_s);
    EXPECT_EQ(answer.trajectory.points().back().speed_mps, 0.0);
    EXPECT_NEAR((answer.trajectory.points().front().pose().position() -
                 view_.ego.map_from_vehicle.position())
                    .norm(),
                0.0, 0.2);
    answer = pilot.step(follow(answer));
  }
  EXPECT_TRUE(answer.is_at_goal) << answer.decision.reason;
  const Eigen::Vector2d goal = place("6/0/-1", 100.0).position();
  EXPECT_LT((view_.ego.map_from_vehicle.position() - goal).norm(), 1.5);
}

// Wherever they stand on the bypass: what a trajectory does after its first seconds, too.
TEST_F(Pilots, GiveTrajectoriesThatMayBeDrivenToTheirEnds) {
  for (const double ahead_m : {60.0, 110.0, 140.0, 180.0}) {
    for (const double speed_mps : {12.0, 16.0, 20.0}) {
      SCOPED_TRACE(testing::Message() << ahead_m << " m ahead at " << speed_mps << " m/s");
      PilotSetup faster = setup();
      faster.driving.desired_speed_mps = 25.0;
      Pilot pilot(std::move(faster));
      view_ = PilotView{};
      view_.ego = {.map_from_vehicle = place("31/0/-2", 20.0), .speed_mps = speed_mps};
      for (const char* lane : {"31/0/-1", "31/0/-2"}) {
        view_.objects.push_back({.id = lane, .centre = place(lane, 20.0 + ahead_m)});
      }
      for (int k = 0; k < 10; ++k) {
        const PilotAnswer answer = pilot.step(view_);
        const geometry::TrajectoryPoint& end = answer.trajectory.points().back();
        const geometry::Rectangle body = geometry::body_at(end.pose(), geometry::VehicleShape{});
        const Detection& stands = view_.objects.back();
        const double along_m = body.axis.dot(stands.centre.position() - body.centre);
        EXPECT_GT(along_m, body.half_length_m + 0.5 * stands.length_m) << k;
        follow(answer);
      }
    }
  }
}

TEST_F(Pilots, StopWhereTheyAreWhenTurnedAroundOrTakenAwayFromAllRoads) {
  Pilot pilot(setup());
  pilot.step(view_);
  const geometry::Pose2 turned = view_.ego.map_from_vehicle * geometry::Pose2{0, 0, 3.14159};
  for (const geometry::Pose2& taken : {turned, geometry::Pose2{9999.0, 9999.0, 0.0}}) {
    view_.t_s += 2.0;
    view_.ego.map_from_vehicle = taken;
    const PilotAnswer answer = pilot.step(view_);
    EXPECT_EQ(answer.decision.behaviour, Behaviour::stop);
    EXPECT_EQ(answer.decision.reason,
              "no route leads to the goal: the vehicle stands along no lane");
    const geometry::TrajectoryPoint& first = answer.trajectory.points().front();
    EXPECT_EQ(first.pose().position(), taken.position());
    EXPECT_NEAR(first.heading_rad, taken.heading_rad, 1e-9);
  }
}

TEST_F(Pilots, AreNotAtTheirGoalWhenPutFarBehindIt) {
  Pilot pilot(setup());
  pilot.step(view_);
  view_.t_s += 2.0;
  const geometry::Pose2 goal = place("6/0/-1", 100.0);
  view_.ego.map_from_vehicle = goal * geometry::Pose2{500.0, 0.0, 0.0};
  const PilotAnswer answer = pilot.step(view_);
  EXPECT_FALSE(answer.is_at_goal);
  EXPECT_TRUE(answer.decision.reason.starts_with("no route leads to the goal"))
      << answer.decision.reason;
}

TEST_F(Pilots, StandBehindWhoStandsWhereverTheyAreNotTold) {
  Pilot pilot(setup());
  // All lanes of the bypass are closed, 60 m ahead.
  for (const char* lane : {"31/0/-1", "31/0/-2"}) {
    view_.objects.push_back({.id = lane, .centre = place(lane, 80.0)});
  }
  PilotAnswer answer = pilot.step(view_);
  for (int k = 0; k < 200; ++k) {
    if (k == 40) view_.objects.clear();  // not measured for half a second: believed in
    if (k == 45) {
      for (const char* lane : {"31/0/-1", "31/0/-2"}) {
        view_.objects.push_back({.id = lane, .centre = place(lane, 80.0)});
      }
    }
    answer = pilot.step(follow(answer));
  }
  EXPECT_EQ(view_.ego.speed_mps, 0.0);
  const double gap_m =
      (place("31/0/-2", 80.0).position() - view_.ego.map_from_vehicle.position()).norm() - 2.25 -
      geometry::VehicleShape{}.front_m();
  EXPECT_GT(gap_m, 0.5);
  EXPECT_LT(gap_m, 8.0);
}

TEST_F(Pilots, ComeToRestBehindWhoStoodThereWhenNobodyLooks) {
  Pilot pilot(setup());
  for (const char* lane : {"31/0/-1", "31/0/-2"}) {
    view_.objects.push_back({.id = lane, .centre = place(lane, 80.0)});
  }
  PilotAnswer answer = pilot.step(view_);
  view_.objects.clear();
  view_.has_objects = false;
  for (int k = 0; k < 95; ++k) answer = pilot.step(follow(answer));
  EXPECT_LT(view_.ego.speed_mps, 1.0);
  const double gap_m =
      (place("31/0/-2", 80.0).position() - view_.ego.map_from_vehicle.position()).norm() - 2.25 -
      geometry::VehicleShape{}.front_m();
  EXPECT_GT(gap_m, 0.5);
}

TEST_F(Pilots, DriveOnWhereSomebodyWasWhoIsGone) {
  Pilot pilot(setup());
  view_.ego.speed_mps = 4.0;
  view_.objects.push_back({.id = "gone", .centre = place("31/0/-2", 40.0)});
  PilotAnswer answer = pilot.step(view_);
  EXPECT_TRUE(answer.decision.lead || answer.decision.behaviour != Behaviour::cruise);
  view_.objects.clear();
  for (int k = 0; k < 30; ++k) answer = pilot.step(follow(answer));
  EXPECT_FALSE(answer.decision.lead);
  EXPECT_GT(view_.ego.speed_mps, 4.0) << answer.decision.reason;
}

/// What a trajectory asks of a body and of who rides in it, by its positions alone.
struct Ride {
  double most_turned_rad = 0.0;  ///< between heading and motion
  double most_lateral_mps2 = 0.0;
  double least_gap_m = 1e9;  ///< to somebody who drives on as it does
};

Ride ride_of(const geometry::Trajectory& drive, const Detection& other, double seen_s) {
  Ride ride;
  const auto& rows = drive.points();
  for (std::size_t k = 1; k + 1 < rows.size(); ++k) {
    const Eigen::Vector2d before = rows[k].pose().position() - rows[k - 1].pose().position();
    const Eigen::Vector2d after = rows[k + 1].pose().position() - rows[k].pose().position();
    const double since_s = rows[k].t_s - seen_s;
    const geometry::Pose2 there =
        other.centre * geometry::Pose2{other.speed_mps * since_s, 0.0, 0.0};
    ride.least_gap_m =
        std::min(ride.least_gap_m,
                 geometry::distance_m(geometry::body_at(rows[k].pose(), geometry::VehicleShape{}),
                                      body_around(there, other.length_m, other.width_m)));
    if (before.norm() < 0.2 || after.norm() < 0.2) continue;
    const double from_rad = std::atan2(before.y(), before.x());
    const double turn_rad = geometry::wrap_angle(std::atan2(after.y(), after.x()) - from_rad);
    const double speed_mps = 0.5 * (before.norm() + after.norm()) / 0.1;
    ride.most_lateral_mps2 = std::max(ride.most_lateral_mps2, std::abs(turn_rad) * speed_mps / 0.1);
    ride.most_turned_rad =
        std::max(ride.most_turned_rad,
                 std::abs(geometry::wrap_angle(rows[k].heading_rad - from_rad - 0.5 * turn_rad)));
  }
  return ride;
}

// Whenever nothing comes after it.
TEST_F(Pilots, NeverSwerveBackIntoWhoTheyPass) {
  PilotSetup faster = setup();
  faster.driving.desired_speed_mps = 20.0;
  Pilot pilot(std::move(faster));
  view_.objects = {{.id = "slower", .centre = place("31/0/-2", 65.0), .speed_mps = 4.0}};
  bool passes = false;
  for (int k = 0; k < 60; ++k) {
    const PilotAnswer answer = pilot.step(view_);
    SCOPED_TRACE(testing::Message() << view_.t_s << " s: " << answer.decision.reason);
    passes = passes || answer.decision.behaviour == Behaviour::pass;
    const Ride ride = ride_of(answer.trajectory, view_.objects[0], view_.t_s);
    EXPECT_GT(ride.least_gap_m, 0.3);
    EXPECT_LT(ride.most_turned_rad, 0.02);
    EXPECT_LT(ride.most_lateral_mps2, 4.2);
    follow(answer);
    view_.objects[0].centre = view_.objects[0].centre * geometry::Pose2{0.4, 0.0, 0.0};
  }
  EXPECT_TRUE(passes);
}

// The signal of the crossroads, on another road.
TEST_F(Pilots, GoOnWithTheirPlanWhenALightComesIntoSight) {
  Pilot pilot(setup()), undisturbed(setup());
  view_.objects = {{.id = "slower", .centre = place("31/0/-2", 65.0), .speed_mps = 4.0}};
  for (int k = 0; k < 50; ++k) {
    PilotView with_light = view_;
    if (k == 30) with_light.lights = {{.signal = "1", .colour = LightColour::red}};
    const PilotAnswer answer = pilot.step(with_light), expected = undisturbed.step(view_);
    ASSERT_EQ(answer.acceleration_mps2, expected.acceleration_mps2) << view_.t_s;
    ASSERT_EQ(answer.steering_rad, expected.steering_rad) << view_.t_s;
    follow(expected);
    view_.objects[0].centre = view_.objects[0].centre * geometry::Pose2{0.4, 0.0, 0.0};
  }
}

// Round the block.
TEST_F(Pilots, DriveRoundWhereTheyHaveStoppedPastTheirGoal) {
  Pilot pilot(setup("31/0/-2", 60.0));
  view_.ego.map_from_vehicle = place("31/0/-2", 50.0);
  pilot.step(view_);
  for (const double past_m : {0.5, 3.0}) {
    view_.t_s += 2.0;
    view_.ego = {.map_from_vehicle = place("31/0/-2", 60.0 + past_m)};
    const PilotAnswer answer = pilot.step(view_);
    EXPECT_EQ(answer.is_at_goal, past_m < 1.0);
    EXPECT_EQ(answer.decision.behaviour == Behaviour::cruise, past_m > 1.0)
        << answer.decision.reason;
  }
}

TEST_F(Pilots, AreAtTheirGoalWhereTheyFirstStandOnIt) {
  for (const double ahead_m : {-0.9, 0.0, 0.9}) {
    Pilot pilot(setup("31/0/-2", 60.0));
    view_.ego = {.map_from_vehicle = place("31/0/-2", 60.0 + ahead_m)};
    const PilotAnswer answer = pilot.step(view_);
    EXPECT_TRUE(answer.is_at_goal) << ahead_m << ": " << answer.decision.reason;
  }
}

TEST_F(Pilots, GoStraightOnToAStopWhereNoPathLeadsFromTheirHeading) {
  Pilot pilot(setup());
  view_.ego = {.map_from_vehicle = place("31/0/-2", 20.0) * geometry::Pose2{0.0, 0.0, 1.1},
               .speed_mps = 6.0};
  const PilotAnswer answer = pilot.step(view_);
  for (const geometry::TrajectoryPoint& row : answer.trajectory.points()) {
    const Eigen::Vector2d off = view_.ego.map_from_vehicle.inverse() * row.pose().position();
    EXPECT_NEAR(off.y(), 0.0, 1e-6);
    EXPECT_NEAR(row.heading_rad, view_.ego.map_from_vehicle.heading_rad, 1e-9);
  }
}

// Main Street, of which the lane of oncoming traffic is free: 3 m behind who has braked hard the
// vehicle waits for ten seconds, then decides once.
TEST_F(Pilots, DriveRoundWhoHasStoppedForGood) {
  Pilot pilot(setup("2/3/-1", 30.0));
  view_.ego = {.map_from_vehicle = place("1/3/1", 40.0)};
  view_.lights = {{.signal = "1", .colour = LightColour::green},
                  {.signal = "2", .colour = LightColour::green}};
  const geometry::Pose2 lead =
      view_.ego.map_from_vehicle * geometry::Pose2{geometry::VehicleShape{}.front_m() + 5.25, 0, 0};
  view_.objects = {{.id = "lead", .centre = lead}};
  int changes = 0;
  Behaviour last = Behaviour::stop;
  double least_m = 1e9;
  for (int k = 0; k < 400; ++k) {
    const PilotAnswer answer = pilot.step(view_);
    changes += answer.decision.behaviour != last;
    last = answer.decision.behaviour;
    least_m = std::min(least_m,
                       geometry::distance_m(
                           geometry::body_at(view_.ego.map_from_vehicle, geometry::VehicleShape{}),
                           body_around(lead, view_.objects[0].length_m, view_.objects[0].width_m)));
    follow(answer);
  }
  EXPECT_GT((view_.ego.map_from_vehicle.position() - lead.position()).norm(), 50.0);
  EXPECT_GT(least_m, 0.25);
  EXPECT_LT(changes, 12);
}

TEST_F(Pilots, SayWhyThereIsNoRouteAndStop) {
  Pilot pilot(setup());
  view_.ego.map_from_vehicle = {1e4, 1e4, 0.0};
  const PilotAnswer answer = pilot.step(view_);
  EXPECT_EQ(answer.decision.behaviour, Behaviour::stop);
  EXPECT_EQ(answer.decision.reason, "no route leads to the goal: the vehicle stands along no lane");
  EXPECT_EQ(answer.acceleration_mps2, -3.0);
  EXPECT_EQ(answer.trajectory.points().back().speed_mps, 0.0);
}

TEST_F(Pilots, SetOffFromBesideALaneAndAcrossIt) {
  Pilot pilot(setup());
  view_.ego.map_from_vehicle = place("31/0/-2", 20.0) * geometry::Pose2{0.0, -2.5, 0.6};
  view_.ego.speed_mps = 0.0;
  const PilotAnswer answer = pilot.step(view_);
  EXPECT_EQ(answer.decision.reason.find("no route"), std::string::npos) << answer.decision.reason;
}

TEST_F(Pilots, FindAnotherRouteWhereTheVehicleIsPutElsewhere) {
  Pilot pilot(setup());
  pilot.step(view_);
  view_.t_s = 5.0;
  view_.ego = {.map_from_vehicle = place("6/0/-1", 20.0), .speed_mps = 5.0};
  const PilotAnswer answer = pilot.step(view_);
  EXPECT_LT(
      (answer.trajectory.points().front().pose().position() - view_.ego.map_from_vehicle.position())
          .norm(),
      0.5);
}

TEST_F(Pilots, RefuseWhatIsUnusableAndGoOnAsIfItHadNotBeenSaid) {
  EXPECT_THROW(Pilot(PilotSetup{}), std::invalid_argument);
  Pilot pilot(setup()), undisturbed(setup());
  const PilotAnswer first = pilot.step(view_);
  undisturbed.step(view_);
  const PilotView good = follow(first);
  PilotView bad = good;
  bad.ego.speed_mps = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(pilot.step(bad), std::invalid_argument);
  bad = good;
  bad.t_s = 0.0;
  EXPECT_THROW(pilot.step(bad), std::invalid_argument);
  bad = good;
  bad.objects.assign(2, {.id = "a", .centre = {}});
  EXPECT_THROW(pilot.step(bad), std::invalid_argument);
  const PilotAnswer answer = pilot.step(good), expected = undisturbed.step(good);
  EXPECT_EQ(answer.acceleration_mps2, expected.acceleration_mps2);
  EXPECT_EQ(answer.trajectory.points().back().x_m, expected.trajectory.points().back().x_m);
}

}  // namespace
}  // namespace roadbed::planning
