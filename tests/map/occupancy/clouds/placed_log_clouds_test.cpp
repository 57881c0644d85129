#include "roadbed/map/occupancy/clouds/log_clouds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/tests/map/occupancy/clouds/clouds_of_log.h"

namespace roadbed::map {
namespace {

using tests::kOdometry;
using tests::kTransforms;
using tests::MadeCloud;
using tests::Recorded;
using tests::transform_message;

std::string odometry(double at_s, double x_m, double heading_rad = 0.0) {
  const std::int64_t stamp_ns = kStart_ns + std::llround(1e9 * at_s);
  return tests::odometry_message(stamp_ns, x_m, 0.0, heading_rad, 10.0);
}

/// One point 5 m ahead, half a second after the start.
MadeCloud one_ahead() {
  MadeCloud cloud{.stamp_ns = kStart_ns + 500'000'000, .width = 1};
  return cloud.put(5.0f).put(0.0f).put(0.0f);
}

std::vector<Recorded> with_odometry(const MadeCloud& cloud) {
  return {{"/tf_static", kTransforms, transform_message(0, "base_link", "lidar", 2.0, M_PI_2)},
          {"/odom", kOdometry, odometry(0.0, 1000.0)},
          {"/points", kCloud, cloud.message()},
          {"/odom", kOdometry, odometry(1.0, 1010.0)}};
}

TEST(PlacedLogClouds, StandWhereTheSensorWasBetweenTwoPoses) {
  std::vector<Recorded> log = with_odometry(one_ahead());
  const auto expect_placed = [](const std::vector<PointCloud>& clouds) {
    ASSERT_EQ(clouds.size(), 1u);
    ASSERT_TRUE(clouds[0].sensor_in_source);
    EXPECT_NEAR((*clouds[0].sensor_in_source - Eigen::Vector3d(1007, 0, 0.5)).norm(), 0, 1e-9);
    EXPECT_NEAR((clouds[0].in_source(0) - Eigen::Vector3d(1007, 5, 0.5)).norm(), 0, 1e-4);
  };
  expect_placed(clouds_of(log));
  const auto second = [](double at_s, double x_m) {
    return transform_message(kStart_ns + std::llround(1e9 * at_s), "map", "base_link", x_m, 0.0);
  };
  // Transforms are taken before odometry, which may drift.
  log[1].bytes = odometry(0.0, 0.0);
  log.push_back({"/tf", kTransforms, second(0.0, 1000.0)});
  log.push_back({"/tf", kTransforms, second(1.0, 1010.0)});
  const auto clouds = clouds_of(log);
  ASSERT_EQ(clouds.size(), 1u);
  EXPECT_NEAR((clouds[0].in_source(0) - Eigen::Vector3d(1007, 5, 0)).norm(), 0, 1e-4);
  log[1].bytes = odometry(0.0, 1000.0);
  expect_placed(clouds_of(log, {"", "/odom"}));
}

TEST(PlacedLogClouds, AskForATopicWhereSeveralSayWhereTheSensorWas) {
  std::vector<Recorded> log = with_odometry(one_ahead());
  log.push_back({"/other", kOdometry, odometry(0.0, 0.0)});
  EXPECT_NE(fault_of(log).find("/odom, /other"), std::string::npos) << fault_of(log);
  EXPECT_EQ(fault_of(log, {"", "/odom"}), "accepted");
}

std::vector<double> places_of(const std::vector<Recorded>& log, const LogCloudTopics& topics = {}) {
  std::vector<double> x_m;
  for (const PointCloud& cloud : clouds_of(log, topics)) x_m.push_back(cloud.in_source(0).x());
  return x_m;
}

// Half a second after the start it is 5 m farther than at it.
void add_moving(std::vector<Recorded>& log, const std::string& topic, const std::string& parent,
                const std::string& child, double x_m) {
  for (int second : {0, 1}) {
    log.push_back({topic, kTransforms,
                   transform_message(kStart_ns + 1'000'000'000 * second, parent, child,
                                     x_m + 10.0 * second, 0.0)});
  }
}

TEST(PlacedLogClouds, AreNotPlacedByTheTransformsOfTwoRobots) {
  std::vector<Recorded> log{{"/points", kCloud, one_ahead().message()}};
  for (const auto& [robot, x_m] : {std::pair("/robot1", 100.0), std::pair("/robot2", 2000.0)}) {
    const std::string name(robot);
    log.push_back({name + "/tf_static", kTransforms,
                   transform_message(0, "base_link", "lidar", 0.01 * x_m, 0.0)});
    add_moving(log, name + "/tf", "odom", "base_link", x_m);
  }
  const std::string fault = fault_of(log);
  EXPECT_NE(fault.find("/robot1/tf, /robot2/tf"), std::string::npos) << fault;
  EXPECT_NE(fault.find("--pose-topic"), std::string::npos) << fault;
  EXPECT_EQ(places_of(log, {"", "/robot1/tf"}), std::vector{111.0});
  EXPECT_EQ(places_of(log, {"", "robot2/tf"}), std::vector{2030.0});
  log.push_back({"/robot2/odom", kOdometry, odometry(0.0, 1000.0)});
  log.push_back({"/robot2/odom", kOdometry, odometry(1.0, 1010.0)});
  EXPECT_EQ(places_of(log, {"", "/robot2/odom"}), std::vector{1030.0});
}

TEST(PlacedLogClouds, StandOnATopicOfPosesWhereTransformsMoveOnlyBelowIt) {
  std::vector<Recorded> log{{"/points", kCloud, one_ahead().message()},
                            {"/odom", kOdometry, odometry(0.0, 1000.0)},
                            {"/odom", kOdometry, odometry(1.0, 1010.0)}};
  add_moving(log, "/tf", "base_link", "lidar", 1.0);
  EXPECT_EQ(places_of(log), std::vector{1016.0});
  EXPECT_EQ(places_of(log, {"", "/odom"}), std::vector{1016.0});
  log.erase(log.begin() + 1, log.begin() + 3);
  LogCloudCounts counts;
  clouds_of(log, {}, &counts);
  EXPECT_EQ(counts.frames_as_they_stand, std::vector<std::string>{"lidar"});
}

TEST(PlacedLogClouds, StandOnTheTopicOfPosesThatIsAskedForWhateverTransformsSayOfItsFrame) {
  std::vector<Recorded> log{{"/points", kCloud, one_ahead().message()},
                            {"/odom", kOdometry, odometry(0.0, 1000.0)},
                            {"/odom", kOdometry, odometry(1.0, 1010.0)}};
  add_moving(log, "/tf", "base_link", "lidar", 1.0);
  add_moving(log, "/tf", "odom", "base_link", 20.0);
  add_moving(log, "/tf", "world", "base_link", 300.0);
  const std::string fault = fault_of(log);
  EXPECT_NE(fault.find("name a topic of poses by --pose-topic"), std::string::npos) << fault;
  EXPECT_EQ(places_of(log, {"", "/odom"}), std::vector{1016.0});
}

TEST(PlacedLogClouds, StandWhereMovingTransformsAboveATopicOfPosesLead) {
  std::vector<Recorded> log = with_odometry(one_ahead());
  for (const int second : {0, 1}) {
    log[second == 0 ? 1 : 3].bytes = tests::odometry_of(kStart_ns + 1'000'000'000 * second, "odom",
                                                        "base_link", 10.0 * second, 0.0, 0.0, 10.0);
  }
  const double in_odom_m = places_of(log).at(0);
  add_moving(log, "/tf", "map", "odom", 700.0);
  EXPECT_NEAR(places_of(log).at(0), in_odom_m + 705.0, 1e-6);
}

TEST(PlacedLogClouds, InGapsOfThePosesAreLeftOut) {
  std::vector<Recorded> log;
  for (int i = 0; i <= 30; ++i) {
    if (i == 11 || i == 12 || (i > 20 && i < 24)) continue;  // of 0.3 s, and of 0.4 s
    log.push_back({"/odom", kOdometry, odometry(0.1 * i, 1.0 * i)});
  }
  for (const std::int64_t at_ms : {1000, 1150, 2000, 2001, 2200, 2399, 2400}) {
    MadeCloud cloud = one_ahead();
    cloud.frame = "base_link";
    cloud.stamp_ns = kStart_ns + 1'000'000 * at_ms;
    log.push_back({"/points", kCloud, cloud.message()});
  }
  LogCloudCounts counts;
  EXPECT_EQ(clouds_of(log, {}, &counts).size(), 4u);
  EXPECT_EQ(counts.without_pose, 3u);
}

TEST(PlacedLogClouds, MayComeBetweenPosesAtIrregularTimes) {
  std::vector<Recorded> log;
  for (const double at_s : {0.0, 0.01, 0.02, 0.03, 0.04, 0.29, 0.3, 0.31, 0.4, 0.64}) {
    log.push_back({"/odom", kOdometry, odometry(at_s, 10.0 * at_s)});
  }
  MadeCloud cloud = one_ahead();
  cloud.frame = "base_link";
  log.push_back({"/points", kCloud, cloud.message()});
  EXPECT_NEAR(places_of(log).at(0), 10.0, 1e-6);
}

TEST(PlacedLogClouds, StandAsTheyAreInFramesWithoutPoses) {
  MadeCloud cloud = two_points();
  cloud.frame = "elsewhere";
  LogCloudCounts counts;
  expect_are_the_two(clouds_of(with_odometry(cloud), {}, &counts));
  EXPECT_EQ(counts.frames_as_they_stand, std::vector<std::string>{"elsewhere"});
  cloud.frame = "map";
  expect_are_the_two(clouds_of(with_odometry(cloud)));
}

TEST(PlacedLogClouds, LeaveOutMessagesBeforeTheFirstAndAfterTheLastPose) {
  std::vector<Recorded> log = with_odometry(one_ahead());
  for (const std::int64_t beyond_ns : {-1, 1'000'000'001}) {
    MadeCloud cloud = one_ahead();
    cloud.stamp_ns = kStart_ns + beyond_ns;
    log.push_back({"/points", kCloud, cloud.message()});
  }
  LogCloudCounts counts;
  EXPECT_EQ(clouds_of(log, {}, &counts).size(), 1u);
  EXPECT_EQ(counts.without_pose, 2u);
}

/// Points 5 m ahead of a lidar on the rear axle at times from 0 to 0.1 s, one every 0.1 ms, with a
/// field of times.
template <class Time>
MadeCloud sweep(const char* field, std::uint8_t type, bool is_big, Time (*time_of)(int i)) {
  MadeCloud cloud{.stamp_ns = kStart_ns + 500'000'000, .frame = "base_link", .width = 1000};
  cloud.is_big_endian = is_big;
  cloud.fields.push_back({field, 12, type});
  cloud.point_step = 12 + sizeof(Time);
  for (int i = 0; i < 1000; ++i) cloud.put(5.0f).put(0.0f).put(0.0f).put(time_of(i));
  return cloud;
}

TEST(PlacedLogClouds, PlaceEachPointWhereTheSensorWasThen) {
  for (const bool is_big : {false, true}) {
    const MadeCloud sweeps[] = {
        sweep<std::uint32_t>("t", 6, is_big,
                             [](int i) { return 100'000u * static_cast<unsigned>(i); }),
        sweep<float>("time", 7, is_big, [](int i) { return 1e-4f * static_cast<float>(i); }),
        sweep<std::uint32_t>("offset_time", 6, is_big,
                             [](int i) { return 100'000u * static_cast<unsigned>(i); }),
        sweep<float>("timeOffset", 7, is_big, [](int i) { return 1e-4f * static_cast<float>(i); }),
        sweep<double>("timestamp", 8, is_big, [](int i) { return 1.7e9 + 0.5 + 1e-4 * i; }),
        sweep<double>("timestamp", 8, is_big, [](int i) { return 1.7e18 + 5e8 + 1e5 * i; })};
    for (const MadeCloud& cloud : sweeps) {
      SCOPED_TRACE(cloud.fields.back().name);
      const auto turning = [](double at_s) { return 0.8 * at_s; };
      std::vector<Recorded> log{{"/points", kCloud, cloud.message()}};
      for (double at_s : {0.0, 0.55, 1.0}) {
        log.push_back({"/odom", kOdometry, odometry(at_s, 20.0 * at_s, turning(at_s))});
      }
      const auto clouds = clouds_of(log);
      ASSERT_EQ(clouds.size(), 1u);
      ASSERT_EQ(clouds[0].points.size(), 1000u);
      for (int i = 0; i < 1000; ++i) {
        const double at_s = 0.5 + 1e-4 * i;
        const Eigen::Vector3d expected(20.0 * at_s + 5.0 * std::cos(turning(at_s)),
                                       5.0 * std::sin(turning(at_s)), 0.5);
        const auto k = static_cast<std::size_t>(i);
        EXPECT_NEAR((clouds[0].in_source(k) - expected).norm(), 0, 1e-5) << i;
      }
      // 2 m of way, at most 2 cm from one position of the sensor to the next.
      EXPECT_NEAR(static_cast<double>(clouds[0].scans.size()), 100.0, 10.0);
      for (const ScanStart& scan : clouds[0].scans) {
        const double at_s = 0.5 + 1e-4 * static_cast<double>(scan.first);
        EXPECT_NEAR(scan.sensor_in_source->x(), 20.0 * at_s, 1e-5);
      }
    }
  }
}

TEST(PlacedLogClouds, SayWhichTimesOfPointsTheyDoNotTake) {
  const auto note_of = [](const MadeCloud& cloud) {
    const LogClouds read(through({{"/points", kCloud, cloud.message()},
                                  {"/odom", kOdometry, odometry(0.0, 0.0)},
                                  {"/odom", kOdometry, odometry(1.0, 20.0)}}),
                         "a log", {});
    const auto notes = read.notes(read.for_each([](const PointCloud& points) {
      for (std::size_t i = 0; i < points.points.size(); ++i) {
        EXPECT_NEAR(points.in_source(i).x(), 15.0, 1e-5) << i;  // as at the stamp
      }
    }));
    return notes.empty() ? "" : notes.front();
  };
  const auto zero = [](int) { return 0.0f; };
  const auto late_ms = [](int i) { return 0.1f * static_cast<float>(i); };
  for (const char* name : {"curvature", "T", "offset_time", "TimeStamp"}) {
    EXPECT_EQ(note_of(sweep<float>(name, 7, false, late_ms)),
              "/points: times of points in a field " + std::string(name) +
                  " are not taken, as their unit is not known: all count as measured at their "
                  "message's stamp");
  }
  EXPECT_EQ(note_of(sweep<float>("intensity", 7, false, late_ms)), "");
  MadeCloud both = sweep<float>("curvature", 7, false, zero);
  both.fields.push_back({"time", 12, 7});
  EXPECT_EQ(note_of(both), "");
}

TEST(PlacedLogClouds, SayInWhichFrameTheVehiclesBoxCountsIfNotInItsOwn) {
  const CloudFilter filter{.vehicle_box = Box3{{-1, -1, -1}, {1, 1, 1}}};
  const auto notes_of = [&](const MadeCloud& cloud, const CloudFilter& asked) {
    const LogClouds read(through(with_odometry(cloud)), "a log", {});
    const auto notes = read.notes(read.for_each([](const PointCloud&) {}, asked));
    return notes.empty() ? "" : notes.back();
  };
  MadeCloud cloud = one_ahead();
  EXPECT_EQ(notes_of(cloud, filter), "");  // a transform says where it is
  cloud.frame = "base_link";
  EXPECT_EQ(notes_of(cloud, filter), "");
  cloud.frame = "mast";
  EXPECT_EQ(
      notes_of(cloud, filter),
      "/points: the vehicle's box counts in mast, as the log does not say where base_link is");
  EXPECT_EQ(notes_of(cloud, {}), "/points: points stand as they are, the log has no poses of mast");
}

TEST(PlacedLogClouds, AreRangedFromTheirOwnFrameWhereTheyHaveNoPoses) {
  const CloudFilter far{.range_m = ValueRange{100, 2000}};
  MadeCloud cloud = two_points();
  cloud.frame = "mast";
  const auto clouds = clouds_of(with_odometry(cloud));
  ASSERT_EQ(clouds.size(), 1u);
  EXPECT_EQ(within_reach(clouds[0], far).points.size(), 1u);
  cloud.frame = "map";  // no sensor is there
  EXPECT_THROW(within_reach(clouds_of(with_odometry(cloud)).at(0), far), InputError);
}

TEST(PlacedLogClouds, LeaveOutTheVehicleInItsOwnFrame) {
  // The lidar is 2 m ahead of base_link and looks to the left: its point is at 2, 5 there.
  const LogClouds read(through(with_odometry(one_ahead())), "a log", {});
  const auto kept = [&](const Box3& box) {
    std::size_t points = 0;
    try {
      read.for_each([&](const PointCloud& cloud) { points += cloud.points.size(); },
                    {.vehicle_box = box});
    } catch (const InputError&) {  // no point is left
    }
    return points;
  };
  EXPECT_EQ(kept({{1.9, 4.9, -1}, {2.1, 5.1, 1}}), 0u);
  EXPECT_EQ(kept({{4.9, -0.1, -1}, {5.1, 0.1, 1}}), 1u);
}

TEST(PlacedLogClouds, TakeTheStampWhereTimesAreUnlikely) {
  MadeCloud cloud = sweep<float>("time", 7, false, [](int i) { return i == 3 ? 1e5f : 0.0f; });
  for (const double from_x_m : {0.0, 500'000.0}) {  // the latter needs an origin of its own
    std::vector<Recorded> log{{"/points", kCloud, cloud.message()},
                              {"/odom", kOdometry, odometry(0.0, from_x_m)},
                              {"/odom", kOdometry, odometry(1.0, from_x_m + 10.0)}};
    LogCloudCounts counts;
    const auto clouds = clouds_of(log, {}, &counts);
    ASSERT_EQ(clouds.size(), 1u);
    ASSERT_EQ(clouds[0].points.size(), 1000u);
    EXPECT_EQ(counts.points_with_unlikely_times, 1u);
    for (std::size_t i = 0; i < 1000; ++i) {
      EXPECT_NEAR(clouds[0].in_source(i).x(), from_x_m + 10.0, 1e-5) << i;
    }
    ASSERT_TRUE(clouds[0].sensor_in_source);
    EXPECT_NEAR(clouds[0].sensor_in_source->x(), from_x_m + 5.0, 1e-9);
  }
}

TEST(PlacedLogClouds, LeaveOutPointsOfASweepPastTheLastPose) {
  MadeCloud cloud =
      sweep<float>("time", 7, false, [](int i) { return 1e-4f * static_cast<float>(i); });
  std::vector<Recorded> log{{"/points", kCloud, cloud.message()},
                            {"/odom", kOdometry, odometry(0.0, 0.0)},
                            {"/odom", kOdometry, odometry(0.55, 5.5)}};
  LogCloudCounts counts;
  const auto clouds = clouds_of(log, {}, &counts);
  ASSERT_EQ(clouds.size(), 1u);
  EXPECT_NEAR(static_cast<double>(clouds[0].points.size()), 500.0, 1.0);
  EXPECT_EQ(clouds[0].points.size() + counts.points_without_pose, 1000u);
}

}  // namespace
}  // namespace roadbed::map
