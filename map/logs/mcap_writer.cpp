#include "roadbed/map/logs/mcap_writer.h"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "roadbed/map/logs/mcap_records.h"

namespace roadbed::map::inline logs {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 20;
constexpr const char* kPacking = "zstd";

/// Content of a record, field by field.
class Content {
 public:
  template <class Number>
  Content& number(Number value) {
    auto rest = static_cast<std::uint64_t>(value);
    for (std::size_t i = 0; i < sizeof(Number); ++i, rest >>= 8) {
      bytes_.push_back(static_cast<char>(rest & 0xff));
    }
    return *this;
  }
  Content& text(std::string_view value) {
    return number(static_cast<std::uint32_t>(value.size())).raw(value);
  }
  Content& raw(std::string_view value) {
    bytes_.append(value);
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

std::string record(McapRecord kind, const Content& content) {
  Content whole;
  whole.number(static_cast<unsigned char>(kind)).number<std::uint64_t>(content.bytes().size());
  return whole.raw(content.bytes()).bytes();
}

std::string packed(const std::string& bytes) {
  std::string into(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(into.data(), into.size(), bytes.data(), bytes.size(), ZSTD_CLEVEL_DEFAULT);
  if (ZSTD_isError(size) != 0) throw std::bad_alloc();
  into.resize(size);
  return into;
}

}  // namespace

void McapWriter::Times::add(std::uint64_t time_ns) {
  first_ns = std::min(first_ns, time_ns);
  last_ns = std::max(last_ns, time_ns);
}

McapWriter::McapWriter(std::string_view library) : file_(kMcapStart) {
  file_ += record(McapRecord::header, Content().text("").text(library));
}

std::uint16_t McapWriter::add_topic(const LogTopic& topic, const McapSchema& schema) {
  if (topics_.size() >= 0xffff) throw std::invalid_argument("McapWriter: 65,535 topics at most");
  auto& id = schema_ids_[{topic.type, schema.encoding}];
  if (id == 0) {
    id = static_cast<std::uint16_t>(schemas_.size() + 1);
    schemas_.push_back(
        record(McapRecord::schema,
               Content().number(id).text(topic.type).text(schema.encoding).text(schema.bytes)));
    chunk_ += schemas_.back();
  }
  const auto channel = static_cast<std::uint16_t>(topics_.size() + 1);
  const Content content =
      Content().number(channel).number(id).text(topic.name).text(topic.encoding).text("");
  topics_.push_back({record(McapRecord::channel, content)});
  chunk_ += topics_.back().record;
  return channel;
}

void McapWriter::write(std::uint16_t topic, std::int64_t time_ns, std::string_view message) {
  if (topic == 0 || topic > topics_.size() || time_ns < 0) {
    throw std::invalid_argument(fmt::format(
        "McapWriter::write: needs one of {} topics and a time from 0 on, got topic {} at {} ns",
        topics_.size(), topic, time_ns));
  }
  const auto at_ns = static_cast<std::uint64_t>(time_ns);
  chunk_index_[topic] += Content().number(at_ns).number<std::uint64_t>(chunk_.size()).bytes();
  chunk_ += record(McapRecord::message, Content()
                                            .number(topic)
                                            .number(topics_[topic - 1u].messages++)
                                            .number(at_ns)
                                            .number(at_ns)
                                            .raw(message));
  chunk_times_.add(at_ns);
  times_.add(at_ns);
  if (chunk_.size() >= kChunkBytes) end_chunk();
}

void McapWriter::end_chunk() {
  if (chunk_.empty()) return;
  const std::string data = packed(chunk_);
  const std::uint64_t start = file_.size();
  file_ += record(McapRecord::chunk, Content()
                                         .number(chunk_times_.first_or_0())
                                         .number(chunk_times_.last_ns)
                                         .number<std::uint64_t>(chunk_.size())
                                         .number(mcap_crc(chunk_))
                                         .text(kPacking)
                                         .number<std::uint64_t>(data.size())
                                         .raw(data));
  const std::uint64_t end = file_.size();
  Content offsets;
  for (const auto& [topic, index] : chunk_index_) {
    offsets.number(topic).number<std::uint64_t>(file_.size());
    file_ += record(McapRecord::message_index, Content().number(topic).text(index));
  }
  chunk_indexes_ += record(McapRecord::chunk_index, Content()
                                                        .number(chunk_times_.first_or_0())
                                                        .number(chunk_times_.last_ns)
                                                        .number(start)
                                                        .number(end - start)
                                                        .text(offsets.bytes())
                                                        .number(file_.size() - end)
                                                        .text(kPacking)
                                                        .number<std::uint64_t>(data.size())
                                                        .number<std::uint64_t>(chunk_.size()));
  ++chunks_;
  chunk_.clear();
  chunk_index_.clear();
  chunk_times_ = {};
}

void McapWriter::add_metadata(const std::string& name,
                              const std::map<std::string, std::string>& words) {
  end_chunk();
  Content pairs;
  for (const auto& [key, value] : words) pairs.text(key).text(value);
  const std::string written =
      record(McapRecord::metadata, Content().text(name).text(pairs.bytes()));
  metadata_indexes_ += record(McapRecord::metadata_index, Content()
                                                              .number<std::uint64_t>(file_.size())
                                                              .number<std::uint64_t>(written.size())
                                                              .text(name));
  file_ += written;
  ++metadata_;
}

std::string McapWriter::summary(std::uint64_t starts_at) {
  std::string summary, offsets;
  const auto add = [&](McapRecord kind, const std::string& records) {
    if (records.empty()) return;
    offsets +=
        record(McapRecord::summary_offset, Content()
                                               .number(static_cast<unsigned char>(kind))
                                               .number<std::uint64_t>(starts_at + summary.size())
                                               .number<std::uint64_t>(records.size()));
    summary += records;
  };
  std::string schemas, channels;
  Content counts;
  std::uint64_t messages = 0;
  for (const std::string& schema : schemas_) schemas += schema;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    channels += topics_[i].record;
    messages += topics_[i].messages;
    if (topics_[i].messages == 0) continue;
    counts.number(static_cast<std::uint16_t>(i + 1)).number<std::uint64_t>(topics_[i].messages);
  }
  add(McapRecord::schema, schemas);
  add(McapRecord::channel, channels);
  add(McapRecord::statistics,
      record(McapRecord::statistics, Content()
                                         .number(messages)
                                         .number(static_cast<std::uint16_t>(schemas_.size()))
                                         .number(static_cast<std::uint32_t>(topics_.size()))
                                         .number(std::uint32_t{0})  // attachments
                                         .number(metadata_)
                                         .number(chunks_)
                                         .number(times_.first_or_0())
                                         .number(times_.last_ns)
                                         .text(counts.bytes())));
  add(McapRecord::chunk_index, chunk_indexes_);
  add(McapRecord::metadata_index, metadata_indexes_);
  const std::uint64_t offsets_at = starts_at + summary.size();
  summary += offsets;
  // The checksum covers the summary and the footer up to itself.
  Content footer;
  footer.number(starts_at).number(offsets_at);
  const std::string head = Content()
                               .number(static_cast<unsigned char>(McapRecord::footer))
                               .number<std::uint64_t>(footer.bytes().size() + 4)
                               .bytes();
  summary += head + footer.bytes();
  return summary + Content().number(mcap_crc(summary)).bytes();
}

std::string McapWriter::finish() {
  end_chunk();
  file_ += record(McapRecord::data_end, Content().number(mcap_crc(file_)));
  file_ += summary(file_.size());
  file_ += kMcapStart;
  return std::exchange(file_, {});
}

}  // namespace roadbed::map::logs
