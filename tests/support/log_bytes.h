#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace roadbed::tests {

/// Puts values one behind the other as CDR has them, of either byte order.
class CdrWriter {
 public:
  explicit CdrWriter(bool is_big_endian = false);
  template <class Number>
  CdrWriter& put(Number value) {
    align(sizeof value);
    append(&value, sizeof value);
    return *this;
  }
  CdrWriter& text(std::string_view value);
  const std::string& bytes() const { return bytes_; }

 private:
  void align(std::size_t size);
  void append(const void* value, std::size_t size);
  bool is_big_;
  std::string bytes_;
};

/// nav_msgs/msg/Odometry in the frame map, turned by a heading about z.
std::string odometry_message(std::int64_t stamp_ns, double x_m, double y_m, double heading_rad,
                             double speed_mps, bool is_big_endian = false);

/// By "lz4" or "zstd"; as they are by "".
std::string packed(const std::string& bytes, const std::string& packing);

/// A record of MCAP.
std::string mcap_record(unsigned char opcode, std::string_view content);

struct McapMessage {
  std::int64_t time_ns;
  std::string bytes;
};

/// MCAP with one topic, in one chunk packed by "", "lz4" or "zstd", or without a chunk; no summary.
std::string mcap_bytes(const std::string& topic, const std::string& type,
                       const std::vector<McapMessage>& messages, const std::string& packing,
                       bool has_chunk = true);

/// An SQLite file as rosbag2 writes it.
std::string bag_bytes(const std::string& topic, const std::string& type,
                      const std::vector<McapMessage>& messages);

/// Puts messages behind those of a bag's file, in a write-ahead log that is copied before the bag
/// is closed. Both lie alone in the folder.
void write_bag_with_write_ahead_log(const std::filesystem::path& file, const std::string& bag,
                                    const std::vector<McapMessage>& messages);

}  // namespace roadbed::tests
