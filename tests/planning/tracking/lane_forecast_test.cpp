#include "roadbed/planning/tracking/lane_forecast.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::planning {
namespace {

class LaneForecasts : public testing::Test {
 protected:
  /// Of a body that has been measured there for two seconds.
  std::vector<ForecastMotion> motions(const geometry::Pose2& pose, double speed_mps,
                                      const std::string& kind = "car", double width_m = 1.8) {
    Tracker tracker({.noise = {.position_m = 0.01, .heading_rad = 0.001, .speed_mps = 0.01}});
    for (int k = -20; k <= 0; ++k) {
      const geometry::Pose2 then = pose * geometry::Pose2{0.1 * k * speed_mps, 0.0, 0.0};
      tracker.observe(0.1 * k, std::vector{Detection{.id = "a",
                                                     .kind = kind,
                                                     .width_m = width_m,
                                                     .centre = then,
                                                     .speed_mps = speed_mps}});
    }
    return forecast_.motions(tracker.slots(), 0);
  }

  double length_of(const std::vector<map::LaneId>& lanes) const {
    double length_m = 0.0;
    for (const map::LaneId lane : lanes) length_m += road_map_.lane(lane).length_m();
    return length_m;
  }

  map::RoadMap road_map_ = map::load_map(tests::data_folder() / "town.xodr");
  LaneForecast forecast_{road_map_};
};

double sum_of(const std::vector<ForecastMotion>& motions) {
  double sum = 0.0;
  for (const ForecastMotion& motion : motions) sum += motion.probability;
  return sum;
}

TEST_F(LaneForecasts, FollowTheLanesMiddle) {
  std::size_t asked = 0;
  for (std::uint32_t i = 0; i < road_map_.lanes().size(); ++i) {
    const map::Lane& lane = road_map_.lane(map::LaneId{i});
    if (lane.type != map::LaneType::driving || lane.length_m() < 30.0) continue;
    const geometry::Pose2 start = lane.pose_at(5.0) * geometry::Pose2{0.0, 0.3, 0.0};
    const auto found = motions(start, 8.0);
    ASSERT_FALSE(found.empty());
    EXPECT_NEAR(sum_of(found), 1.0, 1e-12);
    for (const ForecastMotion& motion : found) {
      ASSERT_FALSE(motion.lanes.empty()) << lane.name;
      for (double t = 8.0; t <= 12.0; t += 0.5) {  // from a lane beside it comes back so late
        const geometry::Pose2 pose = motion.motion.at(t).pose();
        double nearest_m = 1e9;
        for (const map::LaneId on : motion.lanes) {
          nearest_m = std::min(
              nearest_m, std::abs(road_map_.lane(on).centre.in_map.project(pose.position()).d_m));
        }
        const bool is_past_the_road = 8.0 * t > length_of(motion.lanes) - 5.0;
        EXPECT_TRUE(is_past_the_road || nearest_m < 0.1)
            << lane.name << " after " << t << " s: " << nearest_m << " m";
      }
      EXPECT_NEAR(motion.motion.at(0.0).x_m, start.x_m, 0.1);
      EXPECT_NEAR(motion.motion.at(0.0).y_m, start.y_m, 0.1);
    }
    ++asked;
  }
  EXPECT_GT(asked, 10u);
}

TEST_F(LaneForecasts, OfWhatIsNarrowStayAtTheSideOfTheLane) {
  const map::Lane& lane = road_map_.lane(*road_map_.find_lane("5/0/-1"));
  const geometry::Pose2 start = lane.pose_at(20.0) * geometry::Pose2{0.0, -1.2, 0.0};
  for (const auto& [width_m, beside_m] : {std::pair{0.7, -1.2}, std::pair{1.8, 0.0}}) {
    const auto found = motions(start, 4.0, "car", width_m);
    const geometry::Pose2 later = found.front().motion.at(10.0).pose();
    EXPECT_NEAR(lane.centre.in_map.project(later.position()).d_m, beside_m, 0.05) << width_m;
  }
}

TEST_F(LaneForecasts, HeadTheWayThatTheyGo) {
  const map::Lane& straight = road_map_.lane(*road_map_.find_lane("31/0/-2"));
  const auto found = motions(straight.pose_at(10.0) * geometry::Pose2{0.0, 0.8, 0.0}, 8.0);
  for (double t = 0.4; t < 6.0; t += 0.2) {
    const Eigen::Vector2d before = found.front().motion.at(t - 0.2).pose().position();
    const Eigen::Vector2d way = found.front().motion.at(t + 0.2).pose().position() - before;
    const double turned_rad = found.front().motion.at(t).heading_rad - std::atan2(way.y(), way.x());
    EXPECT_NEAR(turned_rad, 0.0, 0.004) << t << " s";
  }
}

TEST_F(LaneForecasts, ABodyInATurnIsExpectedToTurn) {
  std::size_t turns = 0;
  for (std::uint32_t i = 0; i < road_map_.lanes().size(); ++i) {
    const map::Lane& lane = road_map_.lane(map::LaneId{i});
    if (lane.type != map::LaneType::driving || lane.length_m() < 8.0) continue;
    const double turn =
        std::abs(lane.pose_at(lane.length_m()).heading_rad - lane.pose_at(0.0).heading_rad);
    if (turn < 1.2 || turn > 2.0) continue;
    const auto found = motions(lane.pose_at(0.6 * lane.length_m()), 6.0);
    ASSERT_FALSE(found.front().lanes.empty()) << lane.name;
    EXPECT_EQ(found.front().lanes.front(), map::LaneId{i}) << lane.name;
    EXPECT_GT(found.front().probability, 0.5);
    ++turns;
  }
  EXPECT_GT(turns, 3u);
}

TEST_F(LaneForecasts, BeforeAForkEachWayIsPossible) {
  std::size_t forks = 0;
  for (std::uint32_t i = 0; i < road_map_.lanes().size(); ++i) {
    const map::Lane& lane = road_map_.lane(map::LaneId{i});
    if (lane.type != map::LaneType::driving || lane.length_m() < 12.0) continue;
    std::size_t next = 0;
    for (const map::LaneId on : road_map_.graph().of(map::LaneId{i}).successors) {
      next += map::is_drivable(road_map_.lane(on).type) ? 1 : 0;
    }
    if (next < 2) continue;
    const auto found = motions(lane.pose_at(lane.length_m() - 8.0), 8.0);
    EXPECT_GE(found.size(), 2u) << lane.name;
    EXPECT_NEAR(sum_of(found), 1.0, 1e-12);
    for (std::size_t k = 1; k < found.size(); ++k) {
      EXPECT_LE(found[k].probability, found[k - 1].probability);
    }
    ++forks;
  }
  EXPECT_GT(forks, 3u);
}

/// 8 m before a fork at 16 m/s: whom a turn would make brake by more than 8 m/s², so as to drive it
/// at 4 m/s² to the side, does not take it.
TEST_F(LaneForecasts, NobodyTurnsFasterThanTheTurnCanBeDriven) {
  const auto is_too_sharp = [&](map::LaneId id) {
    const map::Lane& turn = road_map_.lane(id);
    const double fastest_m2ps2 = 4.0 * turn.length_m() / std::max(1e-6, turned_along_rad(turn));
    return 0.5 * (16.0 * 16.0 - fastest_m2ps2) / 8.0 > 8.0;
  };
  std::size_t sharp = 0;
  for (std::uint32_t i = 0; i < road_map_.lanes().size(); ++i) {
    const map::Lane& lane = road_map_.lane(map::LaneId{i});
    if (lane.type != map::LaneType::driving || lane.length_m() < 12.0) continue;
    const auto& next = road_map_.graph().of(map::LaneId{i}).successors;
    if (std::ranges::all_of(next, is_too_sharp)) continue;
    sharp += static_cast<std::size_t>(std::ranges::count_if(next, is_too_sharp));
    for (const ForecastMotion& motion : motions(lane.pose_at(lane.length_m() - 8.0), 16.0)) {
      if (motion.lanes.size() < 2 || !is_too_sharp(motion.lanes[1])) continue;
      EXPECT_LT(motion.probability, 0.01) << lane.name;
    }
  }
  EXPECT_GE(sharp, 5U);
}

TEST_F(LaneForecasts, WhoDroveNotLongAgoWillSetOff) {
  const geometry::Pose2 stop = road_map_.lane(*road_map_.find_lane("5/0/-1")).pose_at(60.0);
  const auto after_standing = [&](double stood_s, bool has_driven) {
    Tracker tracker({.noise = {.position_m = 0.01, .heading_rad = 0.001, .speed_mps = 0.01}});
    const double from_s = has_driven ? -3.0 : 0.0;
    for (double t_s = from_s; t_s <= stood_s; t_s += 0.1) {
      const double speed_mps = t_s < 0.0 ? 2.0 : 0.0;
      const geometry::Pose2 then = stop * geometry::Pose2{std::min(0.0, 2.0 * t_s), 0.0, 0.0};
      tracker.observe(t_s,
                      std::vector{Detection{.id = "a", .centre = then, .speed_mps = speed_mps}});
    }
    return LaneForecast(road_map_).motions(tracker.slots(), 0).front().motion;
  };
  EXPECT_EQ(after_standing(6.0, false).points().size(), 1U) << "parked";
  EXPECT_EQ(after_standing(20.0, true).points().size(), 1U) << "parked by now";
  const geometry::Trajectory waits = after_standing(6.0, true);
  const double now_s = waits.start_s();
  EXPECT_NEAR((waits.at(now_s + 2.0).pose().position() - stop.position()).norm(), 0.0, 0.1);
  EXPECT_NEAR((waits.at(now_s + 12.0).pose().position() - stop.position()).norm(), 5.0, 0.1);
}

// 20 s after both stopped: the second stands behind the first, with 40 m to the junction.
TEST_F(LaneForecasts, WhoStandsBehindAnotherWaitsForAsLongAsALightIsRed) {
  const geometry::Pose2 stop = road_map_.lane(*road_map_.find_lane("5/0/-1")).pose_at(60.0);
  const auto second_sets_off = [&](double behind_m, double stood_s) {
    Tracker tracker({.noise = {.position_m = 0.01, .heading_rad = 0.001, .speed_mps = 0.01}});
    for (double t_s = -3.0; t_s <= stood_s; t_s += 0.1) {
      const double driven_m = std::min(0.0, 2.0 * t_s), speed_mps = t_s < 0.0 ? 2.0 : 0.0;
      const auto at = [&](const std::string& id, double back_m) {
        return Detection{.id = id,
                         .centre = stop * geometry::Pose2{driven_m - back_m, 0.0, 0.0},
                         .speed_mps = speed_mps};
      };
      tracker.observe(t_s, std::vector{at("first", 0.0), at("second", behind_m)});
    }
    return LaneForecast(road_map_).motions(tracker.slots(), 1).front().motion.points().size() > 1;
  };
  EXPECT_TRUE(second_sets_off(8.0, 20.0));
  EXPECT_FALSE(second_sets_off(30.0, 20.0)) << "parked by now";
  EXPECT_FALSE(second_sets_off(8.0, 95.0)) << "parked by now";
}

TEST_F(LaneForecasts, WhoWasNeverSeenToDriveWaitsInTheMiddleOfALaneBeforeAJunction) {
  const auto ends_at_junction = [&](const map::Lane& lane) {
    const auto& next = road_map_.graph().of(lane.id).successors;
    return map::is_drivable(lane.type) && !lane.junction && lane.length_m() > 60.0 &&
           !next.empty() && road_map_.lane(next.front()).junction.has_value();
  };
  const auto found = std::ranges::find_if(road_map_.lanes(), ends_at_junction);
  ASSERT_NE(found, road_map_.lanes().end());
  const map::Lane& lane = *found;
  const auto sets_off = [&](double before_end_m, double beside_m) {
    const geometry::Pose2 there = lane.pose_at(lane.length_m() - before_end_m);
    const auto foreseen = motions(there * geometry::Pose2{0.0, beside_m, 0.0}, 0.0);
    return foreseen.front().motion.points().size() > 1;
  };
  EXPECT_TRUE(sets_off(8.0, 0.2));
  EXPECT_FALSE(sets_off(8.0, -0.8)) << "parked at the side";
  EXPECT_FALSE(sets_off(40.0, 0.2)) << "far from the junction";
}

TEST_F(LaneForecasts, WhoWalksOrDrivesAgainstTheLaneFollowsNone) {
  const map::LaneId id = *road_map_.find_lane("31/0/-2");
  const geometry::Pose2 on = road_map_.lane(id).pose_at(30.0);
  const geometry::Pose2 against{on.x_m, on.y_m, on.heading_rad + 3.14159265};
  EXPECT_TRUE(motions(against, 8.0).front().lanes.empty());
  EXPECT_TRUE(motions(on, 1.2, "pedestrian").front().lanes.empty());
  const auto stands = motions(on, 0.0);
  EXPECT_EQ(stands.front().motion.points().size(), 1u);
}

}  // namespace
}  // namespace roadbed::planning
