#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "roadbed/map/logs/log_drive.h"
#include "roadbed/tests/support/log_bytes.h"

namespace roadbed::tests {

inline constexpr const char* kOdometry = "nav_msgs/msg/Odometry";
inline constexpr const char* kTransforms = "tf2_msgs/msg/TFMessage";

/// A message of a topic, as it stands in a log.
struct Recorded {
  std::string topic, type, bytes;
};

/// All recorded at one time, of which headers know nothing.
inline map::GoThrough through(const std::vector<Recorded>& log, std::int64_t received_ns) {
  return [log, received_ns](const map::LogVisitor& visitor) {
    for (const Recorded& recorded : log) {
      const map::LogTopic topic{recorded.topic, recorded.type, "cdr"};
      if (visitor.wants(topic)) visitor.take(topic, {received_ns, recorded.bytes, "message"});
    }
  };
}

/// One of `/tf`: a frame in its parent at a time, ahead of it and turned about z.
inline std::string transform_message(std::int64_t stamp_ns, const std::string& parent,
                                     const std::string& child, double x_m, double heading_rad) {
  CdrWriter cdr;
  cdr.put(std::uint32_t{1}).put(static_cast<std::int32_t>(stamp_ns / 1'000'000'000));
  cdr.put(static_cast<std::uint32_t>(stamp_ns % 1'000'000'000)).text(parent).text(child);
  cdr.put(x_m).put(0.0).put(0.0);
  cdr.put(0.0).put(0.0).put(std::sin(0.5 * heading_rad)).put(std::cos(0.5 * heading_rad));
  return cdr.bytes();
}

/// nav_msgs/msg/Odometry of a frame in another one, turned about z.
inline std::string odometry_of(std::int64_t stamp_ns, const std::string& frame,
                               const std::string& child, double x_m, double y_m, double heading_rad,
                               double speed_mps) {
  CdrWriter cdr;
  cdr.put(static_cast<std::int32_t>(stamp_ns / 1'000'000'000));
  cdr.put(static_cast<std::uint32_t>(stamp_ns % 1'000'000'000)).text(frame).text(child);
  cdr.put(x_m).put(y_m).put(0.0);
  cdr.put(0.0).put(0.0).put(std::sin(0.5 * heading_rad)).put(std::cos(0.5 * heading_rad));
  for (int i = 0; i < 36; ++i) cdr.put(0.0);
  cdr.put(speed_mps);
  for (int i = 0; i < 5 + 36; ++i) cdr.put(0.0);
  return cdr.bytes();
}

}  // namespace roadbed::tests
