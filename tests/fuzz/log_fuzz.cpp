// MCAP, a bag's SQLite or its metadata.yaml in; a drive and contents, or InputError out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/logs/containers.h"
#include "roadbed/map/logs/log_contents.h"
#include "roadbed/map/logs/log_drive.h"
#include "roadbed/map/logs/log_poses.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace map = roadbed::map;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const auto go_through = [&](const map::LogVisitor& visitor) {
    map::parse_log(bytes, "fuzz.mcap", visitor);
  };
  try {
    if (bytes.starts_with("rosbag2")) map::files_in_metadata(bytes, "fuzz");
    map::contents_of_log(go_through);
    map::LogPoses poses("fuzz.mcap", "");
    go_through({.wants = [&](const map::LogTopic& topic) { return poses.wants(topic); },
                .take = [&](const map::LogTopic& topic,
                            const map::LogMessage& message) { poses.take(topic, message); }});
    poses.finish();
    for (const char* frame : {"lidar", "base_link"}) {
      if (const auto of = poses.of(frame)) of(1'700'000'000'000'000'000);
      if (const auto in = poses.in_vehicle(frame)) in(1'700'000'000'000'000'000);
    }
    map::drive_of_log(go_through, "fuzz.mcap", size % 2 == 0 ? "" : "/planning/trajectory#1");
  } catch (const map::InputError&) {
    return 0;  // refused, as it should be
  }
  return 0;
}
