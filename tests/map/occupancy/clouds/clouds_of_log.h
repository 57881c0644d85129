#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/occupancy/clouds/log_clouds.h"
#include "roadbed/tests/support/cloud_message.h"
#include "roadbed/tests/support/made_log.h"
#include "roadbed/tests/support/refusal_of.h"

// The clouds in a log, given as what was recorded.
namespace roadbed::map {

inline constexpr const char* kCloud = "sensor_msgs/msg/PointCloud2";
inline constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;

inline GoThrough through(const std::vector<tests::Recorded>& log) {
  return tests::through(log, kStart_ns);
}

inline std::vector<PointCloud> clouds_of(const std::vector<tests::Recorded>& log,
                                         const LogCloudTopics& topics = {},
                                         LogCloudCounts* counts = nullptr) {
  std::vector<PointCloud> clouds;
  const LogClouds read(through(log), "a log", topics);
  const LogCloudCounts found =
      read.for_each([&](PointCloud cloud) { clouds.push_back(std::move(cloud)); });
  if (counts != nullptr) *counts = found;
  return clouds;
}

inline std::string fault_of(const std::vector<tests::Recorded>& log,
                            const LogCloudTopics& topics = {}) {
  const std::string fault = tests::refusal_of([&] { clouds_of(log, topics); });
  EXPECT_EQ(fault.find('\n'), std::string::npos) << fault;
  return fault;
}

inline std::string fault_of(const tests::MadeCloud& cloud) {
  return fault_of({{"/points", kCloud, cloud.message()}});
}

inline tests::MadeCloud two_points() {
  tests::MadeCloud cloud{.stamp_ns = kStart_ns, .width = 2, .row_step = 24};
  cloud.put(1.5f).put(-2.25f).put(3.0f).put(0.1f).put(1e3f).put(-7.0f);
  return cloud;
}

inline void expect_are_the_two(const std::vector<PointCloud>& clouds) {
  ASSERT_EQ(clouds.size(), 1u);
  ASSERT_EQ(clouds[0].points.size(), 2u);
  EXPECT_EQ(clouds[0].in_source(0), Eigen::Vector3d(1.5, -2.25, 3.0));
  EXPECT_EQ(clouds[0].in_source(1), Eigen::Vector3d(0.1f, 1e3, -7.0));
  EXPECT_FALSE(clouds[0].has_sensor());
}

}  // namespace roadbed::map
