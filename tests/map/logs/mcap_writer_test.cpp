#include "roadbed/map/logs/mcap_writer.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <map>
#include <random>
#include <stdexcept>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/logs/log.h"
#include "roadbed/map/logs/unpack_block.h"
#include "roadbed/tests/support/number_at.h"

namespace roadbed::map {
namespace {

using tests::number_at;

struct Written {
  std::string topic;
  std::int64_t time_ns;
  std::string bytes;
  bool operator==(const Written&) const = default;
};

/// Messages that do not pack well, more than a chunk holds.
std::vector<Written> messages() {
  std::mt19937 random(20261126);
  std::vector<Written> all;
  for (int i = 0; i < 3000; ++i) {
    std::string bytes(random() % 2000, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    all.push_back({i % 3 == 0 ? "/a" : "/b", 1'000'000LL * i, std::move(bytes)});
  }
  return all;
}

std::string written(const std::vector<Written>& all) {
  McapWriter writer("a test");
  std::map<std::string, std::uint16_t> topics;
  for (const char* name : {"/a", "/b", "/none"}) {
    topics[name] = writer.add_topic({name, "kind", "protobuf"}, {"protobuf", "what it holds"});
  }
  for (const Written& one : all) writer.write(topics[one.topic], one.time_ns, one.bytes);
  writer.add_metadata("about", {{"who", "nobody"}});
  return writer.finish();
}

TEST(McapWriter, WritesWhatTheReaderReads) {
  const std::vector<Written> all = messages();
  std::vector<Written> read;
  std::vector<std::string> topics;
  parse_log(written(all), "a log",
            {.wants =
                 [&](const LogTopic& topic) {
                   topics.push_back(topic.name + " " + topic.type + " " + topic.encoding);
                   return true;
                 },
             .take =
                 [&](const LogTopic& topic, const LogMessage& message) {
                   read.push_back({topic.name, message.received_ns, std::string(message.bytes)});
                 }});
  EXPECT_EQ(read, all);
  EXPECT_EQ(topics, (std::vector<std::string>{"/a kind protobuf", "/b kind protobuf",
                                              "/none kind protobuf"}));
}

TEST(McapWriter, IsTheSameForTheSameCalls) { EXPECT_EQ(written(messages()), written(messages())); }

/// How many messages an index leads to, each of its topic and time in the chunk.
std::size_t indexed_messages(const std::string& bytes, std::size_t chunk, std::size_t index) {
  constexpr std::size_t head = 9, packing = head + 28, data = packing + 4 + 4 + 8;
  const std::string_view packed(bytes.data() + chunk + data,
                                number_at<std::uint64_t>(bytes, chunk + data - 8));
  std::string records;
  EXPECT_EQ(unpack_block(packed, BlockPacking::zstandard,
                         number_at<std::uint64_t>(bytes, chunk + head + 16), records),
            "");
  const auto topic = number_at<std::uint16_t>(bytes, index + head);
  const std::size_t count = number_at<std::uint32_t>(bytes, index + head + 2) / 16;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t entry = index + head + 6 + 16 * i;
    const auto at = number_at<std::uint64_t>(bytes, entry + 8);
    EXPECT_EQ(records[at], 5);
    EXPECT_EQ(number_at<std::uint16_t>(records, at + head), topic);
    EXPECT_EQ(number_at<std::uint64_t>(records, at + head + 6),
              number_at<std::uint64_t>(bytes, entry));
  }
  return count;
}

// Records are gone through one by one, from the summary on, as a reader does that seeks.
TEST(McapWriter, ItsSummaryLeadsToEveryChunkAndIsChecked) {
  const std::string bytes = written(messages());
  const std::size_t footer = bytes.size() - 8 - 9 - 20;
  ASSERT_EQ(bytes[footer], 2);
  const auto summary = number_at<std::uint64_t>(bytes, footer + 9);
  const auto offsets = number_at<std::uint64_t>(bytes, footer + 17);
  const auto crc = number_at<std::uint32_t>(bytes, footer + 25);
  EXPECT_EQ(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data() + summary), footer + 25 - summary),
      crc);
  std::map<int, int> kinds;
  std::uint64_t messages_in_chunks = 0;
  for (std::size_t at = summary; at < offsets;) {
    const int kind = bytes[at];
    ++kinds[kind];
    if (kind == 8) {  // index of a chunk
      const auto start = number_at<std::uint64_t>(bytes, at + 9 + 16);
      const auto length = number_at<std::uint64_t>(bytes, at + 9 + 24);
      ASSERT_EQ(bytes[start], 6);
      EXPECT_EQ(number_at<std::uint64_t>(bytes, start + 1) + 9, length);
      const auto topics = number_at<std::uint32_t>(bytes, at + 9 + 32) / 10;
      for (std::uint32_t i = 0; i < topics; ++i) {
        const auto index = number_at<std::uint64_t>(bytes, at + 9 + 36 + 10 * i + 2);
        ASSERT_EQ(bytes[index], 7);
        messages_in_chunks += indexed_messages(bytes, start, index);
      }
    }
    if (kind == 11) {
      EXPECT_EQ(number_at<std::uint64_t>(bytes, at + 9), 3000u);
    }
    at += 9 + number_at<std::uint64_t>(bytes, at + 1);
  }
  EXPECT_EQ(messages_in_chunks, 3000u);
  EXPECT_EQ(kinds[3], 1) << "one kind of messages";
  EXPECT_EQ(kinds[4], 3) << "topics";
  EXPECT_GE(kinds[8], 3) << "chunks";
  EXPECT_EQ(kinds[11], 1);
  EXPECT_EQ(kinds[13], 1);
}

TEST(McapWriter, ADamagedByteIsFound) {
  const std::string whole = written({{"/a", 1, "some"}, {"/b", 2, "bytes"}});
  const std::size_t data_end = whole.find("about");
  for (std::size_t at = 8; at < data_end; ++at) {
    std::string bytes = whole;
    bytes[at] ^= 0x10;
    std::size_t read = 0;
    const LogVisitor visitor{.wants = [](const LogTopic&) { return true; },
                             .take = [&](const LogTopic&, const LogMessage&) { ++read; }};
    EXPECT_THROW(parse_log(bytes, "a log", visitor), InputError) << at;
  }
}

TEST(McapWriter, RefusesTopicsThatItDoesNotKnowAndTimesBefore1970) {
  McapWriter writer("a test");
  EXPECT_THROW(writer.write(1, 0, ""), std::invalid_argument);
  const std::uint16_t topic = writer.add_topic({"/a", "kind", "json"}, {"jsonschema", "{}"});
  EXPECT_THROW(writer.write(topic, -1, ""), std::invalid_argument);
  EXPECT_NO_THROW(writer.write(topic, 0, "{}"));
}

TEST(McapWriter, WithoutAMessageIsALogWithoutOne) {
  const std::string bytes = McapWriter("a test").finish();
  const LogVisitor visitor{
      .wants = [](const LogTopic&) { return true; },
      .take = [](const LogTopic&, const LogMessage&) { FAIL() << "a message"; }};
  EXPECT_NO_THROW(parse_log(bytes, "a log", visitor));
}

}  // namespace
}  // namespace roadbed::map
