#include "roadbed/tests/support/log_bytes.h"

#include <lz4frame.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>

namespace roadbed::tests {
namespace {

template <class Number>
std::string little(Number value) {
  std::string bytes(sizeof value, '\0');
  for (std::size_t i = 0; i < sizeof value; ++i) {
    bytes[i] = static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i));
  }
  return bytes;
}

std::string counted(std::string_view text) {
  return little(static_cast<std::uint32_t>(text.size())) + std::string(text);
}

std::uint32_t crc_of(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

void insert_messages(sqlite3* file, const std::vector<McapMessage>& messages) {
  sqlite3_stmt* insert = nullptr;
  sqlite3_prepare_v2(file, "insert into messages(topic_id, timestamp, data) values(1, ?, ?)", -1,
                     &insert, nullptr);
  for (const McapMessage& message : messages) {
    sqlite3_bind_int64(insert, 1, message.time_ns);
    sqlite3_bind_blob64(insert, 2, message.bytes.data(), message.bytes.size(), SQLITE_TRANSIENT);
    sqlite3_step(insert);
    sqlite3_reset(insert);
  }
  sqlite3_finalize(insert);
}

}  // namespace

CdrWriter::CdrWriter(bool is_big_endian)
    : is_big_(is_big_endian), bytes_({0, static_cast<char>(is_big_endian ? 0 : 1), 0, 0}) {}

CdrWriter& CdrWriter::text(std::string_view value) {
  put(static_cast<std::uint32_t>(value.size() + 1));
  bytes_.append(value);
  bytes_ += '\0';
  return *this;
}

void CdrWriter::align(std::size_t size) {
  while ((bytes_.size() - 4) % size != 0) bytes_ += '\0';
}

void CdrWriter::append(const void* value, std::size_t size) {
  std::string bytes(static_cast<const char*>(value), size);
  if (is_big_ != (std::endian::native == std::endian::big)) std::ranges::reverse(bytes);
  bytes_ += bytes;
}

std::string odometry_message(std::int64_t stamp_ns, double x_m, double y_m, double heading_rad,
                             double speed_mps, bool is_big_endian) {
  CdrWriter cdr(is_big_endian);
  cdr.put(static_cast<std::int32_t>(stamp_ns / 1'000'000'000));
  cdr.put(static_cast<std::uint32_t>(stamp_ns % 1'000'000'000)).text("map").text("base_link");
  cdr.put(x_m).put(y_m).put(0.5);
  cdr.put(0.0).put(0.0).put(std::sin(0.5 * heading_rad)).put(std::cos(0.5 * heading_rad));
  for (int i = 0; i < 36; ++i) cdr.put(0.0);
  cdr.put(speed_mps);
  for (int i = 0; i < 5 + 36; ++i) cdr.put(0.0);
  return cdr.bytes();
}

std::string packed(const std::string& bytes, const std::string& packing) {
  if (packing.empty()) return bytes;
  if (packing == "lz4") {
    std::string into(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
    into.resize(LZ4F_compressFrame(into.data(), into.size(), bytes.data(), bytes.size(), nullptr));
    return into;
  }
  std::string into(ZSTD_compressBound(bytes.size()), '\0');
  into.resize(ZSTD_compress(into.data(), into.size(), bytes.data(), bytes.size(), 3));
  return into;
}

std::string mcap_record(unsigned char opcode, std::string_view content) {
  return std::string(1, static_cast<char>(opcode)) +
         little(static_cast<std::uint64_t>(content.size())) + std::string(content);
}

std::string mcap_bytes(const std::string& topic, const std::string& type,
                       const std::vector<McapMessage>& messages, const std::string& packing,
                       bool has_chunk) {
  std::string records =
      mcap_record(3, little(std::uint16_t{1}) + counted(type) + counted("ros2msg") + counted(""));
  records += mcap_record(4, little(std::uint16_t{7}) + little(std::uint16_t{1}) + counted(topic) +
                                counted("cdr") + counted(""));
  for (const McapMessage& message : messages) {
    records +=
        mcap_record(5, little(std::uint16_t{7}) + little(std::uint32_t{0}) +
                           little(message.time_ns) + little(message.time_ns) + message.bytes);
  }
  if (has_chunk) {
    const std::string inside = packed(records, packing);
    records = mcap_record(6, little(std::uint64_t{0}) + little(std::uint64_t{0}) +
                                 little(static_cast<std::uint64_t>(records.size())) +
                                 little(crc_of(records)) + counted(packing) +
                                 little(static_cast<std::uint64_t>(inside.size())) + inside);
  }
  const std::string magic = "\x89MCAP0\r\n";
  const std::string data = magic + mcap_record(1, counted("ros2") + counted("test")) + records;
  return data + mcap_record(15, little(crc_of(data))) + mcap_record(2, std::string(20, '\0')) +
         magic;
}

std::string bag_bytes(const std::string& topic, const std::string& type,
                      const std::vector<McapMessage>& messages) {
  sqlite3* file = nullptr;
  sqlite3_open(":memory:", &file);
  const std::string tables =
      "create table topics(id integer primary key, name text, type text, serialization_format "
      "text, offered_qos_profiles text);"
      "create table messages(id integer primary key, topic_id integer, timestamp integer, data "
      "blob);"
      "insert into topics values(1, '" +
      topic + "', '" + type + "', 'cdr', '')";
  sqlite3_exec(file, tables.c_str(), nullptr, nullptr, nullptr);
  insert_messages(file, messages);
  sqlite3_int64 size = 0;
  unsigned char* image = sqlite3_serialize(file, "main", &size, 0);
  std::string bytes(reinterpret_cast<const char*>(image), static_cast<std::size_t>(size));
  sqlite3_free(image);
  sqlite3_close(file);
  return bytes;
}

void write_bag_with_write_ahead_log(const std::filesystem::path& file, const std::string& bag,
                                    const std::vector<McapMessage>& messages) {
  const std::string open = file.string() + "-open";
  std::ofstream(open, std::ios::binary) << bag;
  sqlite3* database = nullptr;
  sqlite3_open(open.c_str(), &database);
  sqlite3_exec(database, "pragma journal_mode = wal", nullptr, nullptr, nullptr);
  insert_messages(database, messages);
  std::filesystem::copy_file(open, file);
  std::filesystem::copy_file(open + "-wal", file.string() + "-wal");
  sqlite3_close(database);
  std::filesystem::remove(open);
}

}  // namespace roadbed::tests
