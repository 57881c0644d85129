#include <fmt/format.h>

#include <map>
#include <optional>

#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/visible_text.h"
#include "roadbed/map/logs/containers.h"
#include "roadbed/map/logs/mcap_records.h"
#include "roadbed/map/logs/message_unpacker.h"
#include "roadbed/map/logs/unpack_block.h"

namespace roadbed::map::inline logs {
namespace {

/// Fields of a record, in turn.
class Fields {
 public:
  Fields(std::string_view bytes, const std::string& file, std::string place)
      : rest_(bytes), file_(file), place_(std::move(place)) {}

  [[noreturn]] void refuse(const std::string& found, const std::string& needed) const {
    throw InputError({.file = file_,
                      .place = place_,
                      .found = found,
                      .needed = needed,
                      .remedy = "copy or record the log anew"});
  }

  std::string_view take(std::uint64_t count) {
    if (count > rest_.size()) {
      refuse(fmt::format("the record has {} bytes left", rest_.size()),
             fmt::format("{} as it says", count));
    }
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }

  template <class Number>
  Number number() {
    std::uint64_t value = 0;
    const std::string_view bytes = take(sizeof(Number));
    for (std::size_t i = bytes.size(); i-- > 0;) {
      value = (value << 8) | static_cast<unsigned char>(bytes[i]);
    }
    return static_cast<Number>(value);
  }

  McapRecord kind() { return static_cast<McapRecord>(number<unsigned char>()); }
  std::string_view text() { return take(number<std::uint32_t>()); }
  std::string_view rest() const { return rest_; }
  const std::string& place() const { return place_; }

 private:
  std::string_view rest_;
  const std::string& file_;
  std::string place_;
};

struct Channel {
  LogTopic topic;
  bool is_wanted = false;
};

class McapReader {
 public:
  McapReader(LogBytes& file, const LogVisitor& visitor)
      : file_(file),
        visitor_(visitor),
        unpacked_(most_unpacked_in_all(file.size())),
        unpacker_(file.name(), file.size()) {}

  void run() {
    take_bytes(kMcapStart.size());
    for (;;) {
      const std::uint64_t at = offset_;
      Fields head(file_.read(offset_, kMcapRecordHead), file_.name(), fmt::format("byte {}", at));
      const McapRecord kind = head.kind();
      const auto length = head.number<std::uint64_t>();
      if (kind == McapRecord::data_end) return end_data(at, length);
      take_bytes(kMcapRecordHead);
      Fields fields(take_bytes(length), file_.name(), fmt::format("byte {}", at));
      if (kind == McapRecord::chunk) {
        chunk(fields);
      } else {
        record(kind, fields);
      }
    }
  }

 private:
  std::string_view take_bytes(std::uint64_t count) {
    const std::string_view bytes = file_.read(offset_, count);
    offset_ += count;
    crc_ = mcap_crc(bytes, crc_);
    return bytes;
  }

  void end_data(std::uint64_t at, std::uint64_t length) {
    const std::string_view content = file_.read(at + kMcapRecordHead, length);
    Fields end(content, file_.name(), fmt::format("byte {}", at));
    const auto written = end.number<std::uint32_t>();
    if (written != 0 && written != crc_) {
      end.refuse("the checksum of the data is another than the one written", "the same");
    }
  }

  void record(McapRecord kind, Fields& fields) {
    if (kind == McapRecord::schema) return schema(fields);
    if (kind == McapRecord::channel) return channel(fields);
    if (kind == McapRecord::message) return message(fields);
    if (kind == McapRecord::footer) fields.refuse("the footer", "the end of the data before it");
    if (kind == McapRecord{}) fields.refuse("a record of kind 0", "a kind that MCAP has");
  }

  // Channels name a schema by a number, and each keeps its name.
  static std::string name_in(Fields& fields) {
    constexpr std::size_t longest = 512;
    std::string name = one_line(std::string(fields.text()));
    if (name.size() > longest) {
      fields.refuse(fmt::format("a name of {} bytes", name.size()),
                    fmt::format("at most {}", longest));
    }
    return name;
  }

  void schema(Fields& fields) {
    const auto id = fields.number<std::uint16_t>();
    types_[id] = name_in(fields);
  }

  void channel(Fields& fields) {
    const auto id = fields.number<std::uint16_t>();
    const auto schema = fields.number<std::uint16_t>();
    const auto type = types_.find(schema);
    if (schema != 0 && type == types_.end()) {
      fields.refuse(fmt::format("a channel of schema {}", schema), "that schema before it");
    }
    LogTopic topic{.name = name_in(fields),
                   .type = schema == 0 ? std::string() : type->second,
                   .encoding = name_in(fields)};
    const auto known = channels_.find(id);
    if (known != channels_.end()) {  // told again in each chunk
      if (known->second.topic.name != topic.name || known->second.topic.type != topic.type) {
        fields.refuse(
            fmt::format("channel {} is {} and {}", id, known->second.topic.name, topic.name),
            "one topic");
      }
      return;
    }
    const bool is_wanted = visitor_.wants(topic);
    channels_.emplace(id, Channel{std::move(topic), is_wanted});
  }

  void message(Fields& fields) {
    const auto id = fields.number<std::uint16_t>();
    const auto found = channels_.find(id);
    if (found == channels_.end()) {
      fields.refuse(fmt::format("a message of channel {}", id), "that channel before it");
    }
    fields.take(4);  // sequence
    const auto received_ns = fields.number<std::int64_t>();
    fields.take(8);  // published
    if (!found->second.is_wanted) return;
    if (!is_usable_time(received_ns)) {
      fields.refuse(fmt::format("a message of {} ns", received_ns), "a time before 2116");
    }
    const LogTopic& topic = found->second.topic;
    visitor_.take(topic, {received_ns, unpacker_.unpacked(topic, fields.rest(), fields.place()),
                          fields.place()});
  }

  void chunk(Fields& fields) {
    fields.take(16);  // first and last time
    const auto size = fields.number<std::uint64_t>();
    const auto crc = fields.number<std::uint32_t>();
    const std::string packing(fields.text());
    const std::string_view packed = fields.take(fields.number<std::uint64_t>());
    const std::string_view records = unpacked_chunk(fields, packed, packing, size);
    if (crc != 0 && mcap_crc(records) != crc) {
      fields.refuse("the checksum of the chunk is another than the one written", "the same");
    }
    Fields rest(records, file_.name(), fields.place());
    while (!rest.rest().empty()) {
      const McapRecord kind = rest.kind();
      Fields inner(rest.take(rest.number<std::uint64_t>()), file_.name(), fields.place());
      record(kind, inner);
    }
  }

  std::string_view unpacked_chunk(const Fields& fields, std::string_view packed,
                                  const std::string& packing, std::uint64_t size) {
    if (packing.empty()) {
      if (packed.size() != size) fields.refuse("a chunk not of its size", "the size it says");
      return packed;
    }
    if (packing != "lz4" && packing != "zstd") {
      fields.refuse("a chunk packed by " + one_line(packing), "none, lz4 or zstd");
    }
    if (size > most_unpacked_of_rows(file_.size())) {
      fields.refuse(fmt::format("a chunk of {} bytes, packed in {}", size, packed.size()),
                    fmt::format("at most {}", most_unpacked_of_rows(file_.size())));
    }
    if (!unpacked_.spend(size)) {
      fields.refuse(fmt::format("chunks of more than {} bytes", most_unpacked_in_all(file_.size())),
                    "fewer");
    }
    const auto kind = packing == "lz4" ? BlockPacking::lz4 : BlockPacking::zstandard;
    if (const std::string fault = unpack_block(packed, kind, size, chunk_); !fault.empty()) {
      fields.refuse(fmt::format("a chunk that cannot be unpacked as {}: {}", packing, fault),
                    "whole data");
    }
    return chunk_;
  }

  LogBytes& file_;
  const LogVisitor& visitor_;
  geometry::WorkBudget unpacked_;  // of chunks
  MessageUnpacker unpacker_;
  std::uint64_t offset_ = 0;
  std::uint32_t crc_ = 0;
  std::string chunk_;
  std::map<std::uint16_t, std::string> types_;
  std::map<std::uint16_t, Channel> channels_;
};

}  // namespace

void read_mcap(LogBytes& file, const LogVisitor& visitor) { McapReader(file, visitor).run(); }

}  // namespace roadbed::map::logs
