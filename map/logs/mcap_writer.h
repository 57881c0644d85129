#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/logs/log_messages.h"

namespace roadbed::map::inline logs {

/// What messages of a type hold, as other programs read it.
struct McapSchema {
  std::string encoding;  ///< "protobuf"
  std::string bytes;     ///< of protobuf a FileDescriptorSet
};

/// Writes a log as MCAP [https://mcap.dev/spec]: chunks packed by Zstandard with an index each,
/// statistics and a summary, checksums of all. Same calls, same bytes.
///
///     header, chunk, index, chunk, index, …, metadata, end of data, summary, footer
///
class McapWriter {
 public:
  /// @param library  the program that writes, for the header.
  explicit McapWriter(std::string_view library);

  /// Begins a topic. @returns what its messages are written by.
  /// @throws std::invalid_argument if there are 65,535 of them.
  std::uint16_t add_topic(const LogTopic& topic, const McapSchema& schema);

  /// @param time_ns  when it was recorded; messages in order of time are found soonest.
  /// @throws std::invalid_argument if there is no such topic, or the time is negative.
  void write(std::uint16_t topic, std::int64_t time_ns, std::string_view message);

  /// Words about the whole log.
  void add_metadata(const std::string& name, const std::map<std::string, std::string>& words);

  /// The file. Nothing may be written after it.
  std::string finish();

 private:
  struct Topic {
    std::string record;  // as it stands in the file
    std::uint32_t messages = 0;
  };
  struct Times {
    std::uint64_t first_ns = ~std::uint64_t{0}, last_ns = 0;
    void add(std::uint64_t time_ns);
    std::uint64_t first_or_0() const { return first_ns > last_ns ? 0 : first_ns; }
  };

  void end_chunk();
  std::string summary(std::uint64_t starts_at);

  std::string file_, chunk_;
  std::vector<std::string> schemas_;  // records
  std::map<std::pair<std::string, std::string>, std::uint16_t> schema_ids_;
  std::vector<Topic> topics_;
  std::map<std::uint16_t, std::string> chunk_index_;  // of each topic, time and offset
  Times times_, chunk_times_;
  std::uint32_t chunks_ = 0, metadata_ = 0;
  std::string chunk_indexes_, metadata_indexes_;  // records
};

}  // namespace roadbed::map::logs
