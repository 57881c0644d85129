#include "roadbed/map/occupancy/clouds/log_clouds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/logs/log.h"
#include "roadbed/tests/map/occupancy/clouds/clouds_of_log.h"
#include "roadbed/tests/support/log_bytes.h"

namespace roadbed::map {
namespace {

using tests::kOdometry;
using tests::MadeCloud;
using tests::Recorded;

TEST(LogClouds, AreTheSameFromEveryContainerAndByteOrderOfMessages) {
  const tests::McapMessage little{kStart_ns, two_points().message()};
  const tests::McapMessage big{kStart_ns, two_points().message(true)};
  for (const auto& message : {little, big}) {
    for (const std::string& log : {tests::bag_bytes("/points", kCloud, {message}),
                                   tests::mcap_bytes("/points", kCloud, {message}, "zstd")}) {
      std::vector<PointCloud> clouds;
      LogClouds([&](const LogVisitor& visitor) { parse_log(log, "a log", visitor); }, "a log", {})
          .for_each([&](PointCloud cloud) { clouds.push_back(std::move(cloud)); });
      expect_are_the_two(clouds);
    }
  }
}

TEST(LogClouds, AreTheSameFromEveryLayout) {
  for (const bool is_big : {false, true}) {
    MadeCloud cloud{.stamp_ns = kStart_ns, .height = 2, .width = 1, .is_big_endian = is_big};
    cloud.fields = {{"z", 1, 7}, {"ring", 0, 2}, {"x", 9, 7}, {"y", 5, 7}};
    cloud.point_step = 15;
    cloud.row_step = 20;
    cloud.pad(1).put(3.0f).put(-2.25f).put(1.5f).pad(7);
    cloud.pad(1).put(-7.0f).put(1e3f).put(0.1f).pad(2);  // the last row need not be padded
    expect_are_the_two(clouds_of({{"/points", kCloud, cloud.message()}}));
  }
}

TEST(LogClouds, KeepDoublesFarFromTheOrigin) {
  for (const bool is_big : {false, true}) {
    MadeCloud cloud{.stamp_ns = kStart_ns, .width = 2, .is_big_endian = is_big};
    cloud.fields = {{"x", 0, 8}, {"y", 8, 8}, {"z", 16, 8}};
    cloud.point_step = 24;
    cloud.put(500'000.125).put(5'400'000.5).put(1.0).put(500'010.25).put(5'400'000.0).put(2.0);
    const auto clouds = clouds_of({{"/points", kCloud, cloud.message()}});
    ASSERT_EQ(clouds.size(), 1u);
    EXPECT_EQ(clouds[0].in_source(0), Eigen::Vector3d(500'000.125, 5'400'000.5, 1.0));
    EXPECT_EQ(clouds[0].in_source(1), Eigen::Vector3d(500'010.25, 5'400'000.0, 2.0));
  }
}

TEST(LogClouds, LeaveOutAndCountWhatIsNotFinite) {
  for (const bool is_big : {false, true}) {
    MadeCloud cloud{.stamp_ns = kStart_ns, .width = 3, .is_big_endian = is_big};
    cloud.put(NAN).put(0.0f).put(0.0f).put(1.0f).put(2.0f).put(3.0f);
    cloud.put(1.0f).put(-INFINITY).put(3.0f);
    LogCloudCounts counts;
    const auto clouds = clouds_of({{"/points", kCloud, cloud.message()}}, {}, &counts);
    ASSERT_EQ(clouds.size(), 1u);
    EXPECT_EQ(clouds[0].points.size(), 1u);
    EXPECT_EQ(counts.not_finite, 2u);
  }
}

TEST(LogClouds, RefuseWhatTheyClaimAndDoNotHold) {
  const auto expect_refused = [](MadeCloud cloud, const char* text) {
    EXPECT_NE(fault_of(cloud).find(text), std::string::npos) << fault_of(cloud);
  };
  MadeCloud cloud = two_points();
  cloud.width = 0xFFFFFFFF;
  expect_refused(cloud, "has 1 rows of 4294967295 points in 24 bytes");
  cloud.height = 0xFFFFFFFF;
  cloud.row_step = 0xFFFFFFFF;
  expect_refused(cloud, "rows of 4294967295 points");
  cloud = two_points();
  cloud.height = 2;
  expect_refused(cloud, "has 2 rows of 2 points in 24 bytes");
  cloud.row_step = 23;
  expect_refused(cloud, "has rows of 2 points of 12 bytes in 23");
  cloud = two_points();
  cloud.point_step = 0;
  expect_refused(cloud, "ends at byte 4");
  cloud = two_points();
  cloud.fields[2].offset = 0xFFFFFFFF;
  expect_refused(cloud, "field z that ends at byte");
  cloud = two_points();
  cloud.fields[2].offset = 6;
  expect_refused(cloud, "overlap");
  cloud = two_points();
  cloud.fields[2].type = 9;
  expect_refused(cloud, "type 9");
  cloud = two_points();
  cloud.fields[2].type = 5;
  expect_refused(cloud, "several types");
  cloud = two_points();
  cloud.fields.pop_back();
  expect_refused(cloud, "not all of x, y and z");
}

TEST(LogClouds, RefuseMessagesCutOffAnywhere) {
  const std::string whole = two_points().message();
  for (std::size_t size = 0; size + 1 < whole.size(); ++size) {  // is_dense is not looked at
    EXPECT_NE(fault_of({{"/points", kCloud, whole.substr(0, size)}}), "accepted") << size;
  }
}

TEST(LogClouds, RefuseMessagesWithoutAnyPoint) {
  EXPECT_NE(fault_of(MadeCloud{}).find("1 messages hold no point"), std::string::npos);
}

TEST(LogClouds, NameTheTopicsWhereThereAreSeveral) {
  const std::vector<Recorded> log{{"/front", kCloud, two_points().message()},
                                  {"/rear", kCloud, two_points().message()}};
  EXPECT_NE(fault_of(log).find("/front, /rear"), std::string::npos) << fault_of(log);
  EXPECT_NE(fault_of(log, {"/side", ""}).find("/front, /rear"), std::string::npos);
  expect_are_the_two(clouds_of(log, {"/rear", ""}));
  EXPECT_NE(fault_of({{"/odom", kOdometry, ""}}), "accepted");
}

TEST(LogClouds, OfATopicAreFoundWithoutItsFirstSlash) {
  expect_are_the_two(clouds_of(
      {{"/points", kCloud, two_points().message()}, {"/other", kCloud, two_points().message()}},
      {"points", ""}));
}

}  // namespace
}  // namespace roadbed::map
