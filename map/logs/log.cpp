#include "roadbed/map/logs/log.h"

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/unpack.h"
#include "roadbed/map/logs/containers.h"
#include "roadbed/map/logs/unpack_block.h"

namespace roadbed::map::inline logs {
namespace {

namespace fs = std::filesystem;

bool begins_as_log(std::string_view bytes) {
  return bytes.starts_with(kMcapStart) || bytes.starts_with(kSqliteStart);
}

/// No more of it than of a chunk.
void read_packed(const fs::path& file, const LogVisitor& visitor) {
  LogBytes packed(file);
  const std::string name = input_name(file);
  parse_log(unpacked(packed.read(0, packed.size()), name, most_unpacked_of_rows(packed.size())),
            name, visitor);
}

void read_log_file(const fs::path& file, const LogVisitor& visitor) {
  const std::string stored = stored_start(file, kSqliteStart.size());
  if (stored.starts_with(kSqliteStart)) return read_bag_file(file, visitor);
  if (stored.starts_with(kMcapStart)) {
    LogBytes bytes(file);
    return read_mcap(bytes, visitor);
  }
  if (!is_stream(file) && is_packed(stored)) return read_packed(file, visitor);
  parse_log(read_file(file), input_name(file), visitor);
}

}  // namespace

bool is_log(const fs::path& path) {
  std::error_code unreadable;
  if (fs::is_directory(path, unreadable)) return fs::exists(path / "metadata.yaml", unreadable);
  return begins_as_log(read_file_start(path, kSqliteStart.size()));
}

void read_log(const fs::path& path, const LogVisitor& visitor) {
  std::error_code unreadable;
  if (!fs::is_directory(path, unreadable)) return read_log_file(path, visitor);
  for (const fs::path& file : files_of_bag(path)) read_log_file(file, visitor);
}

void parse_log(std::string_view bytes, const std::string& name, const LogVisitor& visitor) {
  if (bytes.starts_with(kSqliteStart)) return parse_bag(bytes, name, visitor);
  if (!bytes.starts_with(kMcapStart)) {
    throw InputError({.file = name,
                      .found = "is no log",
                      .needed = "MCAP, or SQLite of rosbag2",
                      .remedy = "name another file"});
  }
  LogBytes file(bytes, name);
  read_mcap(file, visitor);
}

void refuse_unusable_log(std::string_view bytes, const std::string& name) {
  if (bytes.starts_with("#ROSBAG ")) {
    throw InputError({.file = name,
                      .found = "is a bag of ROS 1",
                      .needed = "a log of ROS 2, or MCAP",
                      .remedy = "convert it: rosbags-convert --src " + name + " --dst FOLDER"});
  }
  if (bytes.size() < kMcapStart.size() || bytes.substr(1, 4) != kMcapStart.substr(1, 4)) return;
  throw InputError({.file = name,
                    .place = "byte 0",
                    .found = "is MCAP of another version, or damaged",
                    .needed = "MCAP 0",
                    .remedy = "copy it anew, or let mcap recover what there is"});
}

}  // namespace roadbed::map::logs
