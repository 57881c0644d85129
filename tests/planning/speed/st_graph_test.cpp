#include "roadbed/planning/speed/st_graph.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "roadbed/planning/speed/lead.h"
#include "roadbed/planning/speed/path_speed_limits.h"
#include "roadbed/tools/simulation/obstacle_motion.h"

namespace roadbed::tools {
namespace {

constexpr double kNoGap_m = std::numeric_limits<double>::infinity();

/// A way that winds, with samples 0.3 to 1 m apart.
planning::PathProfile winding_way(std::mt19937& random) {
  std::uniform_real_distribution<double> step(0.3, 1.0), bend(-0.08, 0.08);
  planning::PathProfile way;
  geometry::Pose2 pose;
  double ahead = 0.0, turn = bend(random);
  for (int i = 0; i < 150; ++i) {
    if (i % 30 == 0) turn = bend(random);
    way.ahead_m.push_back(ahead);
    way.station_m.push_back(ahead);
    way.body.push_back(geometry::body_at(pose, {}));
    way.wanted_mps.push_back(i);
    way.most_mps.push_back(2.0 * i);
    const double driven = step(random);
    ahead += driven;
    pose = pose * geometry::Pose2{driven, 0.0, turn * driven};
  }
  return way;
}

/// Some that drive straight across or along, some that stand, some there for a while only.
std::vector<planning::Obstacle> others_around(const planning::PathProfile& way,
                                              std::mt19937& random) {
  std::uniform_real_distribution<double> place(-8.0, 8.0), turn(-3.2, 3.2), speed(0.0, 12.0);
  std::uniform_int_distribution<std::size_t> sample(0, way.body.size() - 1);
  std::vector<planning::Obstacle> others;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector2d from =
        way.body[sample(random)].centre + Eigen::Vector2d(place(random), place(random));
    const double heading = turn(random), mps = i % 3 == 0 ? 0.0 : speed(random);
    const geometry::Pose2 start{from.x(), from.y(), heading};
    planning::Obstacle other{.id = "other", .motion = {}};
    other.motion = drive_through({{0.0, start}, {3.0, start * geometry::Pose2{3.0 * mps, 0, 0}}});
    other.validity = {i % 4 == 0 ? 0.5 : -1.0, i % 4 == 1 ? 1.5 : 1e9};
    others.push_back(other);
  }
  return others;
}

TEST(StGraph, PartsAreThoseOfEverySampleAndEveryTimeLookedAt) {
  std::mt19937 random(5);
  constexpr double margin = 0.3, start_s = 0.2;
  int touched = 0;
  for (int scene = 0; scene < 40; ++scene) {
    const planning::PathProfile way = winding_way(random);
    const std::vector<planning::Obstacle> others = others_around(way, random);
    const planning::StGraph occupancy(way, {others}, start_s, 20, margin);
    for (int step = 0; step <= 20; ++step) {
      const double t_s = start_s + 0.1 * step;
      std::vector<planning::StInterval> expected;
      for (std::size_t o = 0; o < others.size(); ++o) {
        if (!others[o].is_there(t_s)) continue;
        const geometry::Rectangle other = rectangle_at(others[o], t_s);
        std::size_t first = way.body.size(), last = 0;
        for (std::size_t i = 0; i < way.body.size(); ++i) {
          if (geometry::distance_m(way.body[i], other) > margin) continue;
          first = std::min(first, i);
          last = i;
        }
        if (first == way.body.size()) continue;
        expected.push_back({first > 0 ? way.ahead_m[first - 1] : -1.0,
                            way.ahead_m[std::min(last + 1, way.ahead_m.size() - 1)], o});
      }
      const std::vector<planning::StInterval>& found = occupancy.at(step);
      ASSERT_EQ(found.size(), expected.size()) << "scene " << scene << ", step " << step;
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].obstacle, expected[i].obstacle);
        EXPECT_EQ(found[i].from_m, expected[i].from_m);
        EXPECT_EQ(found[i].to_m, expected[i].to_m);
      }
      touched += static_cast<int>(found.size());
    }
  }
  EXPECT_GT(touched, 1000);
}

TEST(StGraph, GapsAndWhatIsBlockedAreThoseOfAllParts) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> anywhere(0.0, 110.0);
  for (int scene = 0; scene < 40; ++scene) {
    const planning::PathProfile way = winding_way(random);
    const std::vector<planning::Obstacle> others = others_around(way, random);
    const planning::StGraph occupancy(way, {others}, 0.0, 20, 0.3);
    for (int i = 0; i < 400; ++i) {
      const int step = i % 24;  // beyond the last one it is the last one
      const std::vector<planning::StInterval>& parts = occupancy.at(step);
      const bool at_an_end = i % 3 == 0 && !parts.empty();
      const double place = !at_an_end   ? anywhere(random)
                           : i % 2 == 0 ? parts.front().from_m
                                        : parts.back().to_m;
      bool blocked = false;
      double ahead = kNoGap_m, behind = kNoGap_m;
      for (const planning::StInterval& part : parts) {
        blocked = blocked || (place > part.from_m && place < part.to_m);
        if (part.from_m >= place) ahead = std::min(ahead, part.from_m - place);
        if (part.to_m <= place) behind = std::min(behind, place - part.to_m);
      }
      EXPECT_EQ(occupancy.is_blocked(step, place), blocked);
      EXPECT_EQ(occupancy.gap_ahead_m(step, place), ahead);
      EXPECT_EQ(occupancy.gap_behind_m(step, place), behind);
    }
  }
}

TEST(PathSpeedLimits, AreThoseOfTheSampleBefore) {
  std::mt19937 random(7);
  const planning::PathProfile way = winding_way(random);
  const planning::PathSpeedLimits speeds(way);
  std::uniform_real_distribution<double> anywhere(-1.0, 120.0);
  for (int i = 0; i < 5000; ++i) {
    const double place = i % 5 == 0 ? way.ahead_m[static_cast<std::size_t>(i) % way.ahead_m.size()]
                                    : anywhere(random);
    EXPECT_EQ(speeds.wanted_mps(place), way.wanted_mps[way.before(place)]);
    EXPECT_EQ(speeds.most_mps(place), way.most_mps[way.before(place)]);
  }
}

}  // namespace
}  // namespace roadbed::tools
