#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "roadbed/map/logs/log_messages.h"

namespace roadbed::map::inline logs {

/// Whether the input is a log, by content: rosbag2 (an SQLite file, or a folder with a
/// metadata.yaml) or MCAP, also packed as files by Zstandard or gzip.
/// @throws InputError as read_file does.
bool is_log(const std::filesystem::path& path);

/// Goes through a log once. Of a plain file no more is in memory than a message, or a chunk of
/// MCAP; of packed files and streams all.
/// @throws InputError if it is damaged, cut off or no log, and what the visitor throws.
void read_log(const std::filesystem::path& path, const LogVisitor& visitor);

/// The same of the bytes of one file; `name` stands for it in messages.
void parse_log(std::string_view bytes, const std::string& name, const LogVisitor& visitor);

/// For bytes that are no log, before they are taken for a table or a cloud.
/// @throws InputError if they begin as a log that is not read: a bag of ROS 1, or MCAP of another
///         version or with a damaged start.
void refuse_unusable_log(std::string_view bytes, const std::string& name);

}  // namespace roadbed::map::logs
