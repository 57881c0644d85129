// Points of PointCloud2 messages in memory, a layout each: reads as points per second.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "roadbed/map/occupancy/clouds/log_clouds.h"
#include "roadbed/tests/support/cloud_message.h"

namespace roadbed::map {
namespace {

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
constexpr std::uint32_t kColumns = 1800, kBeams = 64;
constexpr double kSweep_s = 0.1;

struct Topic {
  std::string name, type;
  std::vector<std::string> messages;
};

// A turn of a scanner with 64 beams, column by column; `time` has the bytes of a time of each
// point.
template <class Real>
tests::MadeCloud turn(bool is_big_endian, bool has_times) {
  const auto size = static_cast<std::uint32_t>(sizeof(Real));
  const std::uint8_t type = size == 8 ? 8 : 7;
  tests::MadeCloud cloud{.stamp_ns = kStart_ns,
                         .frame = "base_link",
                         .width = kColumns * kBeams,
                         .fields = {{"x", 0, type}, {"y", size, type}, {"z", 2 * size, type}},
                         .is_big_endian = is_big_endian,
                         .point_step = 4 * size};
  if (has_times) cloud.fields.push_back({"t", 3 * size, 6});
  cloud.row_step = cloud.width * cloud.point_step;
  for (std::uint32_t column = 0; column < kColumns; ++column) {
    const double way = static_cast<double>(column) / kColumns, angle = 6.2831853 * way;
    for (std::uint32_t beam = 0; beam < kBeams; ++beam) {
      const double away_m = 5.0 + 0.5 * beam;
      cloud.put(static_cast<Real>(away_m * std::cos(angle)));
      cloud.put(static_cast<Real>(away_m * std::sin(angle)));
      cloud.put(static_cast<Real>(0.05 * beam));
      cloud.put(static_cast<std::uint32_t>(1e9 * kSweep_s * way)).pad(size - 4);
    }
  }
  return cloud;
}

/// Without poses, with those of a drive from near 0, or from where floats are too coarse.
enum class Poses { none, near, far };

void read(benchmark::State& state, const tests::MadeCloud& cloud, Poses poses) {
  std::vector<Topic> log{{"/points", "sensor_msgs/msg/PointCloud2", {cloud.message()}}};
  if (poses != Poses::none) {
    log.push_back({"/odom", "nav_msgs/msg/Odometry", {}});
    const double from_x_m = poses == Poses::far ? 500'000.0 : 0.0;
    for (int i = -2; i < 15; ++i) {
      log.back().messages.push_back(tests::odometry_message(
          kStart_ns + i * 10'000'000, from_x_m + 0.1 * i, 0.0, 0.002 * i, 10.0));
    }
  }
  const GoThrough through = [&](const LogVisitor& visitor) {
    for (const Topic& topic : log) {
      const LogTopic named{topic.name, topic.type, "cdr"};
      if (!visitor.wants(named)) continue;
      for (const std::string& bytes : topic.messages) {
        visitor.take(named, {kStart_ns, bytes, "message"});
      }
    }
  };
  const LogClouds clouds(through, "a log", {});
  for (auto _ : state) {
    clouds.for_each(
        [](const PointCloud& points) { benchmark::DoNotOptimize(points.points.data()); });
  }
  state.SetItemsProcessed(state.iterations() * kColumns * kBeams);
}

void log_cloud_floats(benchmark::State& state) {
  read(state, turn<float>(false, false), Poses::none);
}
void log_cloud_floats_big_endian(benchmark::State& state) {
  read(state, turn<float>(true, false), Poses::none);
}
void log_cloud_doubles(benchmark::State& state) {
  read(state, turn<double>(false, false), Poses::none);
}
void log_cloud_floats_placed(benchmark::State& state) {
  read(state, turn<float>(false, false), Poses::near);
}
void log_cloud_floats_each_at_its_time(benchmark::State& state) {
  read(state, turn<float>(false, true), Poses::near);
}
void log_cloud_floats_each_at_its_time_far_from_0(benchmark::State& state) {
  read(state, turn<float>(false, true), Poses::far);
}

BENCHMARK(log_cloud_floats);
BENCHMARK(log_cloud_floats_big_endian);
BENCHMARK(log_cloud_doubles);
BENCHMARK(log_cloud_floats_placed);
BENCHMARK(log_cloud_floats_each_at_its_time);
BENCHMARK(log_cloud_floats_each_at_its_time_far_from_0);

}  // namespace
}  // namespace roadbed::map
