#include "roadbed/map/logs/log_drive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/tests/map/logs/logged_drive.h"
#include "roadbed/tests/support/endless_rows.h"
#include "roadbed/tests/support/log_bytes.h"
#include "roadbed/tests/support/made_log.h"
#include "roadbed/tests/support/program_run.h"

namespace roadbed::map {
namespace {

using tests::bag_bytes;
using tests::CdrWriter;
using tests::kOdometry;
using tests::kTransforms;
using tests::mcap_bytes;
using tests::McapMessage;
using tests::odometry_message;
using tests::Recorded;
using tests::transform_message;

std::vector<McapMessage> odometry(bool is_big_endian = false) {
  std::vector<McapMessage> messages;
  for (int i = 0; i < 20; ++i) {
    const std::int64_t t_ns = kStart_ns + 100'000'000 * i;
    messages.push_back(
        {t_ns + 5, odometry_message(t_ns, 0.1 * i + 1e6, -0.2 * i, 0.05 * i, 1.5, is_big_endian)});
  }
  return messages;
}

void expect_is_the_drive(const LogDrive& drive) {
  ASSERT_EQ(drive.poses.size(), 20u);
  for (int i = 0; i < 20; ++i) {
    const TimedPose& at = drive.poses[static_cast<std::size_t>(i)];
    EXPECT_EQ(at.stamp_ns, kStart_ns + 100'000'000 * i);
    EXPECT_EQ(at.pose.translation().x(), 0.1 * i + 1e6);
    EXPECT_EQ(at.pose.translation().y(), -0.2 * i);
    EXPECT_EQ(at.speed_mps, 1.5);
    EXPECT_NEAR(std::atan2(at.pose.linear()(1, 0), at.pose.linear()(0, 0)), 0.05 * i, 1e-12);
  }
}

TEST(LogDrive, IsTheSameFromEveryContainerAndPacking) {
  for (const char* packing : {"", "lz4", "zstd"}) {
    SCOPED_TRACE(packing);
    expect_is_the_drive(drive_in(mcap_bytes("/odom", kOdometry, odometry(), packing)));
  }
  expect_is_the_drive(drive_in(mcap_bytes("/odom", kOdometry, odometry(), "", false)));
  expect_is_the_drive(drive_in(bag_bytes("/odom", kOdometry, odometry())));
}

TEST(LogDrive, IsTheSameFromMessagesPackedOneByOne) {
  std::vector<McapMessage> messages = odometry();
  for (McapMessage& message : messages) message.bytes = tests::packed(message.bytes, "zstd");
  expect_is_the_drive(drive_in(mcap_bytes("/odom", kOdometry, messages, "")));
  expect_is_the_drive(drive_in(bag_bytes("/odom", kOdometry, messages)));
}

TEST(LogDrive, RefusesMessagesThatTogetherUnpackToMoreThanItsBytesAreWorth) {
  const std::string zeros = tests::packed(std::string(10'000'000, '\0'), "zstd");
  const std::vector<McapMessage> messages(3, {0, zeros});
  const LogVisitor all{.wants = [](const LogTopic&) { return true; },
                       .take = [](const LogTopic&, const LogMessage&) {}};
  for (const std::string& bytes : {mcap_bytes("/blob", "std_msgs/msg/String", messages, ""),
                                   bag_bytes("/blob", "std_msgs/msg/String", messages)}) {
    try {
      parse_log(bytes, "a log", all);
      ADD_FAILURE();
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("messages of more than"), std::string::npos);
    }
  }
}

TEST(LogDrive, HoldsWhatABagsWriteAheadLogHoldsAndLeavesBothAsTheyAre) {
  const tests::TemporaryFolder folder;
  const std::filesystem::path file = folder / "b g#1%.db3";
  const std::vector<McapMessage> all = odometry();
  tests::write_bag_with_write_ahead_log(
      file, bag_bytes("/odom", kOdometry, {all.begin(), all.begin() + 5}),
      {all.begin() + 5, all.end()});
  const auto stored = [&] {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(file.parent_path())) {
      files[entry.path().string()] = read_file(entry.path());
    }
    return files;
  };
  const auto before = stored();
  ASSERT_EQ(before.size(), 2u);
  expect_is_the_drive(drive_of_log(file, ""));
  const tests::TemporaryFolder other;
  std::filesystem::create_symlink(file, other / "link.db3");
  expect_is_the_drive(drive_of_log(other / "link.db3", ""));
  EXPECT_EQ(stored(), before);
  const std::filesystem::path ahead = file.string() + "-wal";
  for (auto size = std::filesystem::file_size(ahead); size > 0; size /= 2) {  // as of a copy
    std::filesystem::resize_file(ahead, size);
    const auto cut = stored();
    EXPECT_GE(drive_of_log(file, "").poses.size(), 5u);
    EXPECT_EQ(stored(), cut) << size;
  }
}

TEST(LogDrive, IsTheSameFromEitherByteOrder) {
  expect_is_the_drive(drive_in(mcap_bytes("/odom", kOdometry, odometry(true), "zstd")));
}

TEST(LogDrive, IsInOrderOfTime) {
  std::vector<McapMessage> messages = odometry();
  std::swap(messages[3], messages[15]);
  messages.push_back(messages[7]);
  expect_is_the_drive(drive_in(mcap_bytes("/odom", kOdometry, messages, "")));
}

TEST(LogDrive, RefusesWhatIsCutOffAnywhere) {
  for (const char* packing : {"", "lz4", "zstd"}) {
    const std::string bytes = mcap_bytes("/odom", kOdometry, odometry(), packing);
    const std::size_t data = bytes.size() - 8 - 9 - 20;  // the footer is not looked at
    for (std::size_t size = 0; size < data; size += 7) {
      EXPECT_NE(fault_of(bytes.substr(0, size)), "accepted") << size;
    }
  }
}

TEST(LogDrive, RefusesDamagedChunks) {
  std::string bytes = mcap_bytes("/odom", kOdometry, odometry(), "");
  bytes[bytes.size() / 2] ^= 1;
  EXPECT_NE(fault_of(bytes).find("checksum"), std::string::npos) << fault_of(bytes);
}

TEST(LogDrive, RefusesChunksThatClaimToBeHuge) {
  std::string bytes = mcap_bytes("/odom", kOdometry, odometry(), "zstd");
  const std::size_t size_at = bytes.find("zstd") - 4 - 4 - 8;
  bytes[size_at + 5] = 1;  // a terabyte
  EXPECT_NE(fault_of(bytes).find("at most"), std::string::npos) << fault_of(bytes);
}

TEST(LogDrive, RefusesChunksThatTogetherUnpackToMoreThanItsBytesAreWorth) {
  constexpr std::size_t head = 8 + 9 + 16, tail = 9 + 4 + 9 + 20 + 8;
  const std::string zeros(20'000'000, '\0');
  const std::string one = mcap_bytes("/blob", "std_msgs/msg/String", {{0, zeros}}, "zstd");
  std::string many = one;
  for (int i = 0; i < 200; ++i) {
    many.insert(head, one.substr(head, one.size() - head - tail));
  }
  EXPECT_NE(fault_of(many).find("chunks of more than"), std::string::npos) << fault_of(many);
}

TEST(LogDrive, RefusesMessagesThatEndEarly) {
  std::vector<McapMessage> messages = odometry();
  messages[4].bytes.resize(60);
  EXPECT_NE(fault_of(bag_bytes("/odom", kOdometry, messages)).find("message 5"), std::string::npos);
}

TEST(LogDrive, RefusesBagsWithMoreRowsThanTheyCanHold) {
  const std::string bag = bag_bytes("/odom", kOdometry, odometry());
  const std::string fault = fault_of(tests::with_endless_rows(bag, "messages"));
  EXPECT_NE(fault.find("more rows than"), std::string::npos) << fault;
  const std::string of_topics = fault_of(tests::with_endless_rows(bag, "topics"));
  EXPECT_NE(of_topics.find("more rows than"), std::string::npos) << of_topics;
  const std::string of_tables = fault_of(tests::with_endless_rows(bag, "sqlite_schema"));
  EXPECT_NE(of_tables.find("a schema that takes longer to read"), std::string::npos) << of_tables;
}

TEST(LogDrive, ListsTopicsWhereNoneIsADrive) {
  const std::string fault = fault_of(bag_bytes("/chatter", "std_msgs/msg/String", {}));
  EXPECT_NE(fault.find("/chatter (std_msgs/msg/String)"), std::string::npos) << fault;
}

TEST(LogDrive, ChainsTransformsBetweenStamps) {
  std::vector<McapMessage> messages;
  for (int i = 0; i <= 10; ++i) {
    const std::int64_t t_ns = kStart_ns + 100'000'000 * i;
    messages.push_back({t_ns, transform_message(t_ns, "odom", "base_link", 1.0 * i, 0.0)});
  }
  messages.push_back({0, transform_message(kStart_ns, "map", "odom", 100.0, 0.0)});
  messages.push_back({0, transform_message(kStart_ns + 500'000'000, "map", "odom", 200.0, 0.0)});
  const LogDrive drive = drive_in(bag_bytes("/tf", kTransforms, messages));
  ASSERT_EQ(drive.poses.size(), 6u) << "odom is known in the map for half a second";
  EXPECT_EQ(drive.notes, std::vector<std::string>{
                             "5 of 11 poses left out: no transform from map at their time"});
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(drive.poses[static_cast<std::size_t>(i)].pose.translation().x(),
                100.0 + 20.0 * i + 1.0 * i, 1e-9);
  }
}

/// `x_m` ahead of its parent at the start, and a metre more half a second later.
void add_moving(std::vector<Recorded>& log, const std::string& topic, const std::string& parent,
                const std::string& child, double x_m) {
  log.push_back({topic, kTransforms, transform_message(kStart_ns, parent, child, x_m, 0.0)});
  log.push_back({topic, kTransforms,
                 transform_message(kStart_ns + 500'000'000, parent, child, x_m + 1.0, 0.0)});
}

void expect_starts_at(const LogDrive& drive, const std::string& topic, double x_m) {
  EXPECT_EQ(drive.topic, topic);
  ASSERT_EQ(drive.poses.size(), 2u);
  EXPECT_NEAR(drive.poses[0].pose.translation().x(), x_m, 1e-12);
  EXPECT_NEAR(drive.poses[1].pose.translation().x(), x_m + 1.0, 1e-12);
}

TEST(LogDrive, OfEachRobotIsByItsOwnTransforms) {
  std::vector<Recorded> log;
  for (const auto& [robot, x_m] : {std::pair("/robot1", 10.0), std::pair("/robot2", 1000.0)}) {
    const std::string name(robot);
    add_moving(log, name + "/tf", "odom", "base_link", x_m);
    log.push_back(
        {name + "/tf_static", kTransforms, transform_message(0, "map", "odom", x_m, 0.0)});
  }
  EXPECT_NE(fault_of(log).find("/robot1/tf, /robot2/tf"), std::string::npos) << fault_of(log);
  expect_starts_at(drive_in(log, "/robot1/tf"), "/robot1/tf", 20.0);
  expect_starts_at(drive_in(log, "/robot2/tf"), "/robot2/tf", 2000.0);
}

TEST(LogDrive, IsByTransformsOfSeveralTopicsWhereNoFrameStandsInTwo) {
  std::vector<Recorded> log;
  add_moving(log, "/body", "odom", "base_link", 10.0);
  log.push_back({"/tf_static", kTransforms, transform_message(0, "map", "odom", 300.0, 0.0)});
  add_moving(log, "/wheel", "base_link", "wheel", 1.0);
  expect_starts_at(drive_in(log), "/body", 310.0);
}

/// Ten rows at 10 Hz of base_link in `frame`, 1 m apart.
std::vector<Recorded> odometry_in(const std::string& frame) {
  std::vector<Recorded> log;
  for (int i = 0; i < 10; ++i) {
    log.push_back({"/odom", kOdometry,
                   tests::odometry_of(kStart_ns + 100'000'000 * i, frame, "base_link", 1.0 * i, 0.0,
                                      0.0, 10.0)});
  }
  return log;
}

TEST(LogDrive, OfPosesIsInTheMapWhereStaticTransformsLeadThere) {
  std::vector<Recorded> log = odometry_in("odom");
  log.push_back(
      {"/tf_static", kTransforms, transform_message(0, "map", "odom", 5.0, 0.5 * std::acos(-1.0))});
  for (const char* topic : {"", "/odom"}) {
    const LogDrive drive = drive_in(log, topic);
    ASSERT_EQ(drive.poses.size(), 10u);
    for (int i = 0; i < 10; ++i) {
      const TimedPose& at = drive.poses[static_cast<std::size_t>(i)];
      EXPECT_NEAR((at.pose.translation() - Eigen::Vector3d(5.0, i, 0.0)).norm(), 0.0, 1e-12);
      EXPECT_NEAR(at.pose.linear()(1, 0), 1.0, 1e-12) << "it heads to the left";
      EXPECT_EQ(at.speed_mps, 10.0);
    }
  }
}

TEST(LogDrive, OfPosesIsInTheMapWhereMovingTransformsLeadThere) {
  std::vector<Recorded> log = odometry_in("odom");
  for (const auto& [at_ns, x_m] : {std::pair(0, 100.0), std::pair(500'000'000, 200.0)}) {
    log.push_back(
        {"/tf", kTransforms, transform_message(kStart_ns + at_ns, "map", "odom", x_m, 0.0)});
  }
  const LogDrive drive = drive_in(log);
  EXPECT_EQ(drive.topic, "/odom");
  ASSERT_EQ(drive.poses.size(), 6u) << "odom is known in the map for half a second";
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(drive.poses[static_cast<std::size_t>(i)].pose.translation().x(), 100.0 + 21.0 * i,
                1e-9);
  }
}

TEST(LogDrive, OfPosesStaysInTheirFrameWhereNothingLeadsOn) {
  std::vector<Recorded> log = odometry_in("map");
  log.push_back({"/tf_static", kTransforms, transform_message(0, "world", "map", 1000.0, 0.0)});
  EXPECT_EQ(drive_in(log).poses.front().pose.translation().x(), 0.0);
  EXPECT_EQ(drive_in(odometry_in("odom")).poses.front().pose.translation().x(), 0.0);
}

/// base_link at 10 m, 20 m turned by 0.3, said of what is mounted 1.5 m ahead and turned by 0.5.
Recorded odometry_of_imu() {
  return {"/odom", kOdometry,
          tests::odometry_of(kStart_ns, "map", "imu_link", 10.0 + 1.5 * std::cos(0.3),
                             20.0 + 1.5 * std::sin(0.3), 0.8, 7.0)};
}

void expect_is_at(const TimedPose& at, double x_m, double y_m, double heading_rad) {
  EXPECT_NEAR(at.pose.translation().x(), x_m, 1e-9);
  EXPECT_NEAR(at.pose.translation().y(), y_m, 1e-9);
  EXPECT_NEAR(std::atan2(at.pose.linear()(1, 0), at.pose.linear()(0, 0)), heading_rad, 1e-9);
}

TEST(LogDrive, OfAMountedFrameIsOfTheBody) {
  const Recorded mount{"/tf_static", kTransforms,
                       transform_message(0, "base_link", "imu_link", 1.5, 0.5)};
  // The same, said the other way round: 1.5 m behind in a frame that is turned back by 0.5.
  const Recorded step{"/tf_static", kTransforms,
                      transform_message(0, "imu_link", "turned", 0.0, -0.5)},
      back{"/tf_static", kTransforms, transform_message(0, "turned", "base_link", -1.5, 0.0)};
  for (const std::vector<Recorded>& transforms : {std::vector{mount}, std::vector{step, back}}) {
    std::vector<Recorded> log{odometry_of_imu()};
    log.insert(log.end(), transforms.begin(), transforms.end());
    const LogDrive drive = drive_in(log);
    ASSERT_EQ(drive.poses.size(), 1u);
    expect_is_at(drive.poses[0], 10.0, 20.0, 0.3);
    EXPECT_FALSE(drive.poses[0].speed_mps) << "7 m/s are those of the mount's own axis";
  }
}

TEST(LogDrive, KeepsSpeedsOfAFrameThatStandsStraightBehind) {
  const LogDrive drive =
      drive_in({{"/odom", kOdometry,
                 tests::odometry_of(kStart_ns, "map", "base_footprint", 1.0, 2.0, 0.0, 7.0)},
                {"/tf_static", kTransforms,
                 transform_message(0, "base_footprint", "base_link", 0.25, 0.0)}});
  expect_is_at(drive.poses.at(0), 1.25, 2.0, 0.0);
  EXPECT_EQ(drive.poses[0].speed_mps, 7.0);
}

TEST(LogDrive, OfAMountedFrameIsAsRecordedWhereItsPlaceIsSaid) {
  const std::vector<Recorded> log{
      odometry_of_imu(),
      {"/tf_static", kTransforms, transform_message(0, "base_link", "imu_link", 1.5, 0.5)}};
  const LogDrive drive =
      drive_of_log(tests::through(log, kStart_ns), "a log", "", "--topic", DriveFrame::recorded);
  expect_is_at(drive.poses.at(0), 10.0 + 1.5 * std::cos(0.3), 20.0 + 1.5 * std::sin(0.3), 0.8);
  EXPECT_EQ(drive.poses[0].speed_mps, 7.0);
}

TEST(LogDrive, OfOneTopicIsOfOneFrame) {
  std::vector<Recorded> log = odometry_in("map");
  log.push_back(odometry_of_imu());
  EXPECT_NE(fault_of(log).find("/odom: is of the frames base_link and imu_link"), std::string::npos)
      << fault_of(log);
}

TEST(LogDrive, OfATopicOfPosesDoesNotAskTransformsWhereItsFrameIs) {
  std::vector<Recorded> log;
  add_moving(log, "/tf", "odom", "base_link", 10.0);
  add_moving(log, "/tf", "world", "base_link", 500.0);
  for (const auto& [topic, x_m] : {std::pair("/odom", 0.0), std::pair("/other", 70.0)}) {
    for (int i = 0; i < 2; ++i) {
      log.push_back({topic, kOdometry, odometry_message(kStart_ns + i, x_m + i, 0, 0, 1)});
    }
  }
  expect_starts_at(drive_in(log, "/odom"), "/odom", 0.0);
  EXPECT_NE(fault_of(log).find("name a topic of poses by --topic"), std::string::npos);
}

TEST(LogDrive, OfATopicIsFoundWithoutItsFirstSlash) {
  std::vector<Recorded> log;
  add_moving(log, "/tf", "odom", "base_link", 10.0);
  add_moving(log, "/b/tf", "odom", "base_link", 20.0);
  expect_starts_at(drive_in(log, "tf"), "/tf", 10.0);
  expect_starts_at(drive_in(log, "b/tf"), "/b/tf", 20.0);
  add_moving(log, "tf", "odom", "base_link", 30.0);
  expect_starts_at(drive_in(log, "tf"), "tf", 30.0);
}

TEST(LogDrive, IsOfTheOnlyBodyInANamespaceOrOnTheGround) {
  std::vector<Recorded> log;
  add_moving(log, "/tf", "odom", "base_footprint", 5.0);
  expect_starts_at(drive_in(log), "/tf", 5.0);
  add_moving(log, "/tf", "odom", "robot/base_link", 10.0);
  expect_starts_at(drive_in(log), "/tf", 10.0);
  add_moving(log, "/tf", "odom", "base_link", 20.0);
  expect_starts_at(drive_in(log), "/tf", 20.0);
  std::vector<Recorded> two;
  add_moving(two, "/tf", "odom", "a/base_link", 1.0);
  add_moving(two, "/tf", "odom", "b/base_link", 2.0);
  EXPECT_NE(fault_of(two, "/tf").find("a/base_link, b/base_link"), std::string::npos);
}

TEST(LogDrive, HoldsATransformThatWasSaidOnce) {
  std::vector<Recorded> by_transforms, by_poses = odometry_in("odom");
  for (int i = 0; i < 250; ++i) {
    by_transforms.push_back({"/tf", kTransforms,
                             transform_message(kStart_ns + std::int64_t{20'000'000} * i, "odom",
                                               "base_link", 1.0 * i, 0.0)});
  }
  for (auto* log : {&by_transforms, &by_poses}) {
    const std::size_t rows = log->size();
    log->push_back(
        {"/tf", kTransforms, transform_message(kStart_ns + 40'000'000, "map", "odom", 300.0, 0.0)});
    const LogDrive drive = drive_in(*log);
    ASSERT_EQ(drive.poses.size(), rows);
    EXPECT_TRUE(drive.notes.empty());
    EXPECT_NEAR(drive.poses.front().pose.translation().x(), 300.0, 1e-12);
    EXPECT_NEAR(drive.poses.back().pose.translation().x(), 300.0 + static_cast<double>(rows - 1),
                1e-12);
  }
}

TEST(LogDrive, OfOnePoseThatWasSaidOnceIsOneRow) {
  std::vector<Recorded> log{
      {"/tf", kTransforms, transform_message(kStart_ns, "map", "base_link", 3.0, 0.0)}};
  EXPECT_EQ(drive_in(log).poses.size(), 1u);
}

TEST(LogDrive, SaysWhyAllOfItsPosesAreLeftOut) {
  std::vector<Recorded> log = odometry_in("odom");
  for (int i = 0; i < 2; ++i) {
    log.push_back({"/tf", kTransforms, transform_message(5 + i, "map", "odom", 1.0, 0.0)});
  }
  EXPECT_NE(fault_of(log).find("/odom: 10 of 10 poses left out: no transform from map"),
            std::string::npos)
      << fault_of(log);
}

TEST(LogDrive, SaysThatNothingSaysWhereItsFrameIsOnTheVehicle) {
  const LogDrive drive = drive_in({odometry_of_imu()});
  ASSERT_EQ(drive.notes.size(), 1u);
  EXPECT_EQ(drive.notes[0].find("/odom is of imu_link, taken for the rear axle"), 0u)
      << drive.notes[0];
  EXPECT_TRUE(drive_in(odometry_in("map")).notes.empty());
}

std::string planned_message(int points, bool has_times, double step_m = 2.0,
                            float speed_mps = 4.0F) {
  CdrWriter cdr;
  cdr.put(std::int32_t{5}).put(std::uint32_t{0}).text("map");
  cdr.put(static_cast<std::uint32_t>(points));
  for (int i = 0; i < points; ++i) {
    cdr.put(std::int32_t{0}).put(static_cast<std::uint32_t>(has_times ? 1'000'000 * i : 0));
    cdr.put(step_m * i).put(0.0).put(0.0).put(0.0).put(0.0).put(0.0).put(1.0);
    for (const float value : {speed_mps, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F}) cdr.put(value);
  }
  return cdr.bytes();
}

TEST(LogDrive, TakesThePlannedTrajectoryThatIsNumbered) {
  const std::string bytes =
      bag_bytes("/planning/trajectory", "autoware_planning_msgs/msg/Trajectory",
                {{1, planned_message(5, true)}, {2, planned_message(7, false)}});
  EXPECT_NE(fault_of(bytes).find("--topic /planning/trajectory#2"), std::string::npos);
  EXPECT_EQ(drive_in(bytes, "/planning/trajectory#1").poses.back().stamp_ns, 4'000'000);
  const LogDrive without_times = drive_in(bytes, "/planning/trajectory#2");
  ASSERT_EQ(without_times.poses.size(), 7u);
  EXPECT_EQ(without_times.poses.back().stamp_ns, 3'000'000'000) << "12 m at 4 m/s";
}

TEST(LogDrive, SaysWhichPointsOfAPlanHaveNoTimes) {
  const std::string stands = planned_message(5, false, 2.0, 0.0F);
  const LogDrive drive =
      drive_in(bag_bytes("/plan", "autoware_planning_msgs/msg/Trajectory", {{1, stands}}));
  EXPECT_TRUE(drive.is_planned);
  EXPECT_EQ(drive.poses.size(), 1u);
  ASSERT_EQ(drive.notes.size(), 1u);
  EXPECT_EQ(drive.notes[0].find("4 of 5 points left out: their speeds are 0"), 0u);
}

TEST(LogDrive, SaysHowManyTrajectoriesThereAre) {
  const std::string bytes =
      bag_bytes("/plan", "autoware_planning_msgs/msg/Trajectory", {{1, planned_message(5, true)}});
  const std::string fault = fault_of(bytes, "/plan#6");
  EXPECT_NE(fault.find("/plan holds 1 trajectories, needs at least 6"), std::string::npos) << fault;
}

TEST(LogDrive, RefusesPlansThatTakeLongerThanTimesReach) {
  const std::string slow = planned_message(5, false, 1e8, 0.01F);
  const std::string fault =
      fault_of(bag_bytes("/plan", "autoware_planning_msgs/msg/Trajectory", {{1, slow}}));
  EXPECT_NE(fault.find("a trajectory of 1e+10 s"), std::string::npos) << fault;
}

TEST(LogDrive, RefusesTimesWhoseDifferencesDoNotFit) {
  std::vector<McapMessage> messages = odometry();
  messages[3].time_ns = std::numeric_limits<std::int64_t>::max();
  messages[7].time_ns = std::numeric_limits<std::int64_t>::min();
  for (const std::string& bytes :
       {mcap_bytes("/odom", kOdometry, messages, ""), bag_bytes("/odom", kOdometry, messages)}) {
    EXPECT_NE(fault_of(bytes).find("9223372036854775807 ns"), std::string::npos);
  }
}

}  // namespace
}  // namespace roadbed::map
