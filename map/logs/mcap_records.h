#pragma once

// Private to map/logs: what the reader and the writer of MCAP share [https://mcap.dev/spec].

#include <zlib.h>

#include <cstdint>
#include <string_view>

namespace roadbed::map::inline logs {

inline constexpr std::string_view kMcapStart = "\x89MCAP0\r\n";  ///< also its end

/// What a record is, its first byte.
enum class McapRecord : unsigned char {
  header = 1,
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  chunk = 6,
  message_index = 7,
  chunk_index = 8,
  statistics = 11,
  metadata = 12,
  metadata_index = 13,
  summary_offset = 14,
  data_end = 15
};

/// A record's kind, and how long its content is.
inline constexpr std::uint64_t kMcapRecordHead = 9;

/// CRC-32 of bytes after those that have `so_far`.
inline std::uint32_t mcap_crc(std::string_view bytes, std::uint32_t so_far = 0) {
  return static_cast<std::uint32_t>(
      crc32_z(so_far, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace roadbed::map::logs
