#include "roadbed/planning/tracking/tracker.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <stdexcept>

namespace roadbed::planning {
namespace {

Detection at(double x_m, double y_m, double speed_mps, double heading_rad = 0.0,
             std::string id = "") {
  return {.id = std::move(id), .centre = {x_m, y_m, heading_rad}, .speed_mps = speed_mps};
}

const Track* find(const Tracker& tracker, const std::string& id) {
  for (const auto& track : tracker.slots()) {
    if (track && track->id == id) return &*track;
  }
  return nullptr;
}

std::size_t alive(const Tracker& tracker) {
  return static_cast<std::size_t>(
      std::ranges::count_if(tracker.slots(), [](const auto& slot) { return slot.has_value(); }));
}

TEST(Tracker, KnowsByIdAndByFit) {
  Tracker tracker;
  for (int k = 0; k < 20; ++k) {
    const double t = 0.1 * k;
    const std::vector<Detection> seen{at(10.0 * t, 0.0, 10.0), at(50.0 - 8.0 * t, 3.5, -8.0),
                                      at(30.0, -5.0, 0.0, 0.0, "parked")};
    tracker.observe(t, seen);
    EXPECT_EQ(alive(tracker), 3u) << t;
  }
  EXPECT_NE(find(tracker, "parked"), nullptr);
  ASSERT_NE(find(tracker, "track 1"), nullptr);
  EXPECT_NEAR(find(tracker, "track 1")->filter.state().pose.x_m, 19.0, 0.02);
  EXPECT_NEAR(find(tracker, "track 2")->filter.state().speed_mps, -8.0, 0.02);
}

TEST(Tracker, GoesOnWhileNothingIsMeasuredAndFindsTheObjectAgain) {
  Tracker tracker({.coasts_for_s = 1.0});
  double t = 0.0;
  const auto step = [&](bool sees) {
    t += 0.1;
    std::vector<Detection> seen;
    if (sees) seen.push_back(at(12.0 * t, 0.0, 12.0));
    tracker.observe(t, seen);
  };
  for (int k = 0; k < 20; ++k) step(true);
  for (int k = 0; k < 9; ++k) step(false);
  ASSERT_NE(find(tracker, "track 1"), nullptr);
  EXPECT_NEAR(find(tracker, "track 1")->filter.state().pose.x_m, 12.0 * t, 0.3);
  step(true);
  EXPECT_EQ(alive(tracker), 1u);
  EXPECT_NE(find(tracker, "track 1"), nullptr);
  for (int k = 0; k < 11; ++k) step(false);
  EXPECT_EQ(alive(tracker), 0u);
  step(true);
  EXPECT_NE(find(tracker, "track 2"), nullptr);
}

TEST(Tracker, WhoIsHiddenIsNotGoneForTenSeconds) {
  for (const bool is_hidden : {true, false}) {
    Tracker tracker;
    double t = 0.0, gone_s = 0.0;
    for (; t < 2.0; t += 0.1) tracker.observe(t, std::vector{at(12.0 * t, 0.0, 12.0)});
    const double last_s = t - 0.1;
    double last_speed_mps = 0.0;
    for (; t < 20.0; t += 0.1) {
      if (alive(tracker) == 1) last_speed_mps = tracker.slots()[0]->filter.state().speed_mps;
      tracker.observe(t, {}, [&](const Eigen::Vector2d& point) {
        EXPECT_NEAR(point.x(), 12.0 * t, 0.5);  // where it is believed to be
        return is_hidden;
      });
      if (gone_s == 0.0 && alive(tracker) == 0) gone_s = t - last_s;
    }
    // Expected until 10 s, and for a second more.
    EXPECT_NEAR(gone_s, is_hidden ? 11.1 : 1.1, 0.11);
    EXPECT_NEAR(last_speed_mps, 12.0, 0.1) << "it drives on, however little is known of it";
  }
}

TEST(Tracker, WhoIsNotMeasuredGoesOnForTenSeconds) {
  Tracker tracker;
  double t_s = 0.0;
  for (; t_s < 0.95; t_s += 0.1) {
    tracker.observe(t_s, std::vector{at(10.0 * t_s, 0.0, 10.0), at(0.0, 9.0, 0.0, 0.0, "stands")});
  }
  for (; t_s < 9.0; t_s += 0.1) tracker.foresee(t_s);
  EXPECT_EQ(alive(tracker), 2u);
  EXPECT_NEAR(find(tracker, "track 1")->filter.state().pose.x_m, 10.0 * (t_s - 0.1), 0.5);
  for (; t_s < 13.0; t_s += 0.1) tracker.foresee(t_s);
  EXPECT_EQ(alive(tracker), 0u);
  EXPECT_THROW(tracker.foresee(t_s - 1.0), std::invalid_argument);
}

TEST(Tracker, WhatIsMeasuredEverySecondTimeIsNotForgottenBetween) {
  Tracker tracker;
  for (int k = 0; k < 10; ++k) {
    if (k % 2 == 0) {
      tracker.observe(0.1 * k, std::vector{at(k, 0.0, 10.0)});
    } else {
      tracker.foresee(0.1 * k);
    }
    ASSERT_EQ(alive(tracker), 1u) << k;
  }
  EXPECT_FALSE(find(tracker, "track 1")->is_tentative());
}

TEST(Tracker, TellsWhichDetectionIsOfWhom) {
  Tracker tracker;
  for (int k = 0; k < 5; ++k) {
    const double t = 0.1 * k;
    tracker.observe(t, std::vector{at(10.0 * t, 0.0, 10.0), at(50.0, 4.0, 0.0)});
  }
  tracker.observe(0.5, std::vector{at(50.0, 4.0, 0.0)});
  EXPECT_EQ(tracker.slots()[0]->detection, std::nullopt);
  EXPECT_EQ(tracker.slots()[1]->detection, std::optional<std::size_t>(0));
}

TEST(Tracker, GivesASlotToNobodyElseForTenSeconds) {
  Tracker tracker;
  tracker.observe(0.0, std::vector{at(0, 0, 0, 0, "a")});
  tracker.observe(2.0, {});
  tracker.observe(3.0, std::vector{at(0, 0, 0, 0, "b")});
  EXPECT_FALSE(tracker.slots()[0]);
  EXPECT_EQ(tracker.slots()[1]->id, "b");
  tracker.observe(12.5, {});
  tracker.observe(12.6, std::vector{at(0, 0, 0, 0, "c")});
  EXPECT_EQ(tracker.slots()[0]->id, "c");
}

TEST(Tracker, AnIdThatJumpsIsSeenWhereItIs) {
  Tracker tracker;
  for (int k = 0; k < 10; ++k) tracker.observe(0.1 * k, std::vector{at(k, 0, 10, 0, "a")});
  tracker.observe(1.0, std::vector{at(500, 40, 3, 1, "a")});
  EXPECT_EQ(find(tracker, "a")->filter.state().pose.x_m, 500.0);
  EXPECT_EQ(find(tracker, "a")->past.size(), 1u);
}

TEST(Tracker, WhatWasMeasuredOnceIsForgottenAtOnceAndTakesNothingFromOthers) {
  Tracker tracker;
  for (int k = 0; k < 30; ++k) {
    const double t = 0.1 * k;
    std::vector<Detection> seen{at(10.0 * t, 0.0, 10.0)};
    if (k == 20) seen.front().centre.y_m = 3.0;  // an error: far outside what it can be
    tracker.observe(t, seen);
    EXPECT_EQ(alive(tracker), k == 20 || k == 21 ? 2u : 1u) << k;
  }
  EXPECT_NE(find(tracker, "track 1"), nullptr);
}

TEST(Tracker, RefusesTimesThatDoNotIncreaseAndIdsThatStandTwice) {
  Tracker tracker;
  tracker.observe(1.0, {});
  EXPECT_THROW(tracker.observe(1.0, {}), std::invalid_argument);
  EXPECT_THROW(tracker.observe(std::nan(""), {}), std::invalid_argument);
  const std::vector twice{at(0, 0, 0, 0, "a"), at(9, 0, 0, 0, "a")};
  EXPECT_THROW(tracker.observe(2.0, twice), std::invalid_argument);
}

/// Forty-two cars without ids on three lanes each way, each lane at a speed of its own, so that
/// cars overtake each other 3.5 m apart; one in ten is not measured at any time.
TEST(Tracker, KeepsCarsApartInDenseTraffic) {
  constexpr int kCars = 42, kLanes = 6, kCycles = 1500;
  const ObjectNoise noise{.position_m = 0.25, .heading_rad = 0.03, .speed_mps = 0.3};
  std::mt19937_64 random(21);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<double> x(kCars);
  for (int i = 0; i < kCars; ++i) x[i] = 25.0 * (i / kLanes) + 8.0 * uniform(random);
  const auto y_of = [](int car) { return 3.5 * (car % kLanes); };
  const auto sense_of = [](int car) { return car % kLanes < 3 ? 1.0 : -1.0; };
  const auto speed_of = [](int car) { return 8.0 + 3.0 * (car % 3); };
  Tracker tracker({.noise = noise});
  std::map<int, std::string> name_of;
  int swaps = 0;
  double squared_m2 = 0.0;
  long count = 0;
  for (int k = 0; k < kCycles; ++k) {
    std::vector<Detection> seen;
    std::vector<int> who;
    for (int i = 0; i < kCars; ++i) {
      const double sense = sense_of(i);
      x[i] += 0.1 * speed_of(i) * sense;
      if (uniform(random) < 0.1) continue;
      seen.push_back(at(x[i] + noise.position_m * normal(random),
                        y_of(i) + noise.position_m * normal(random),
                        speed_of(i) + noise.speed_mps * normal(random),
                        (sense > 0 ? 0.0 : 3.14159265) + noise.heading_rad * normal(random)));
      who.push_back(i);
    }
    std::vector<int> order(seen.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    std::ranges::shuffle(order, random);
    std::vector<Detection> shuffled;
    for (const int i : order) shuffled.push_back(seen[static_cast<std::size_t>(i)]);
    tracker.observe(0.1 * (k + 1), shuffled);
    if (k < 20) continue;
    for (int i = 0; i < kCars; ++i) {
      const Track* nearest = nullptr;
      double least_m = 2.0;
      for (const auto& track : tracker.slots()) {
        if (!track || track->is_tentative()) continue;
        const geometry::Pose2 pose = track->filter.state().pose;
        const double away_m = std::hypot(pose.x_m - x[i], pose.y_m - y_of(i));
        if (away_m < least_m) least_m = away_m, nearest = &*track;
      }
      ASSERT_NE(nearest, nullptr) << "car " << i << " is lost at cycle " << k;
      squared_m2 += least_m * least_m;
      ++count;
      std::string& name = name_of[i];
      if (!name.empty() && name != nearest->id) ++swaps;
      name = nearest->id;
    }
  }
  EXPECT_LE(swaps, 1);
  EXPECT_LT(std::sqrt(squared_m2 / static_cast<double>(count)), 0.2);
}

}  // namespace
}  // namespace roadbed::planning
