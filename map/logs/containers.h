#pragma once

// Private to map/logs: a file each, and how it is told.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/logs/log_bytes.h"
#include "roadbed/map/logs/log_messages.h"
#include "roadbed/map/logs/mcap_records.h"

namespace roadbed::map::inline logs {

/// [https://mcap.dev/spec], with or without a summary, which is not read.
void read_mcap(LogBytes& file, const LogVisitor& visitor);

/// What rosbag2 writes by its storage plugin sqlite3.
inline constexpr std::string_view kSqliteStart{"SQLite format 3\0", 16};
void read_bag_file(const std::filesystem::path& file, const LogVisitor& visitor);
void parse_bag(std::string_view bytes, const std::string& name, const LogVisitor& visitor);

/// The files of a bag's folder, in the order of its metadata.yaml.
std::vector<std::filesystem::path> files_of_bag(const std::filesystem::path& folder);
std::vector<std::filesystem::path> files_in_metadata(std::string_view text,
                                                     const std::filesystem::path& folder);

}  // namespace roadbed::map::logs
