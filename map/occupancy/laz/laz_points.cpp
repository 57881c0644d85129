#include "roadbed/map/occupancy/laz/laz_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/laz/integer_decoder.h"
#include "roadbed/map/occupancy/laz/layered_points.h"
#include "roadbed/map/occupancy/laz/packed_points.h"

namespace roadbed::map::inline occupancy::inline laz {
namespace {

using Kind = LazLayout::Kind;
using Packing = LazLayout::Packing;

constexpr std::size_t kChunkTablePlace = 8;  // what the points of chunks begin with
constexpr std::size_t kBatch = 4096;

[[noreturn]] void refuse(const std::string& name, const std::string& place,
                         const std::string& element, const std::string& found,
                         const std::string& needed, const std::string& remedy) {
  throw InputError({.file = name,
                    .place = place,
                    .element = element,
                    .found = found,
                    .needed = needed,
                    .remedy = remedy});
}

struct KnownItem {
  Kind kind;
  std::uint16_t bytes;  // 0: any number
  bool is_layered;
};

constexpr std::array<KnownItem, 10> kKnownItems{{{Kind::extra_bytes, 0, false},
                                                 {Kind::point10, 20, false},
                                                 {Kind::gps_time, 8, false},
                                                 {Kind::rgb, 6, false},
                                                 {Kind::wave_packet, 29, false},
                                                 {Kind::point14, 30, true},
                                                 {Kind::rgb14, 6, true},
                                                 {Kind::rgb_infrared14, 8, true},
                                                 {Kind::wave_packet14, 29, true},
                                                 {Kind::extra_bytes14, 0, true}}};

bool is_known(const LazLayout::Item& item, bool layered) {
  const auto known = std::ranges::find(kKnownItems, item.kind, &KnownItem::kind);
  if (known == kKnownItems.end() || known->is_layered != layered) return false;
  if (known->bytes != 0 && known->bytes != item.bytes) return false;
  return layered ? item.version >= 2 && item.version <= 4 : item.version == 1 || item.version == 2;
}

/// How many layers an item has in a chunk.
std::size_t layers_of(const LazLayout::Item& item) {
  switch (item.kind) {
    case Kind::point14:
      return 9;
    case Kind::rgb_infrared14:
      return 2;
    case Kind::extra_bytes14:
      return item.bytes;
    default:
      return 1;
  }
}

/// Bytes of chunks, in order, by the table that most files end with; empty where there is none.
/// @param most  as many as the points fill: a few bytes may be said to hold billions.
std::vector<std::size_t> chunk_table(std::string_view file, std::size_t begin, std::uint64_t most) {
  std::vector<std::size_t> sizes;
  const auto table = integer_at<std::uint64_t>(file, begin);
  if (table > file.size() || file.size() - table < kChunkTablePlace) return sizes;
  const auto chunks = std::min<std::uint64_t>(integer_at<std::uint32_t>(file, table + 4), most);
  ArithmeticDecoder from(file.substr(table + kChunkTablePlace));
  IntegerDecoder<32> size(2);
  for (std::uint64_t i = 0; i < chunks && !from.is_past_end(); ++i) {
    const std::int32_t last = sizes.empty() ? 0 : static_cast<std::int32_t>(sizes.back());
    sizes.push_back(static_cast<std::uint32_t>(size.decode(from, last, 1)));
  }
  return sizes;
}

class Unpacking {
 public:
  Unpacking(std::string_view file, std::size_t begin, std::uint64_t points, const LazLayout& layout,
            bool has_attributes, const std::string& name,
            const std::function<void(std::span<const LazPoint>)>& take)
      : file_(file),
        at_(begin),
        left_(points),
        layout_(layout),
        has_attributes_(has_attributes),
        name_(name),
        take_(take) {}

  void run() {
    if (layout_.packing != Packing::one_stream) {
      need(kChunkTablePlace);
      if (layout_.packing == Packing::chunks) {
        sizes_ = chunk_table(file_, at_, left_ / layout_.chunk_points + 1);
      }
      at_ += kChunkTablePlace;
    }
    while (left_ > 0) take_chunks();
    pass_on();
  }

 private:
  struct Opened {
    std::size_t begin;
    std::uint64_t points;
    LazPoint first;
    std::unique_ptr<Chunk> others;
  };

  /// Where a chunk ends, if its points were taken or are layers.
  std::size_t end_of(const Opened& chunk) const {
    return chunk.begin + layout_.point_bytes() + chunk.others->used();
  }

  [[noreturn]] void refuse_end() const {
    refuse(name_, fmt::format("byte {}", std::min(at_, file_.size())), "points",
           fmt::format("the file breaks off {} points before the last", left_), "all of them",
           "get the whole file");
  }

  void need(std::size_t bytes) const {
    if (at_ > file_.size() || file_.size() - at_ < bytes) refuse_end();
  }

  void put(const LazPoint& point) {
    batch_.push_back(point);
    --left_;
    if (batch_.size() == kBatch) pass_on();
  }

  void pass_on() {
    if (!batch_.empty()) take_(batch_);
    batch_.clear();
  }

  std::string_view take_bytes(std::size_t count) {
    need(count);
    const std::string_view bytes = file_.substr(at_, count);
    at_ += count;
    return bytes;
  }

  /// The next chunk, or two in turn where it is known where the second one begins.
  void take_chunks() {
    const Opened first = opened(left_);
    const std::optional<Opened> second = second_after(first);
    std::vector<LazPoint> of_second;
    put(first.first);
    std::uint64_t taken = 1;
    if (second) {
      of_second.reserve(second->points);
      for (; taken < std::min(first.points, second->points); ++taken) {
        const auto [next, next_of_second] = first.others->next_with(*second->others);
        if (first.others->is_past_end()) refuse_end();
        put(next);
        of_second.push_back(next_of_second);
      }
    }
    take_rest(first, taken);
    if (!second) return;
    if (at_ != second->begin) return sizes_.clear();  // the table is wrong
    if (second->others->is_past_end()) refuse_end();
    put(second->first);
    for (const LazPoint& point : of_second) put(point);
    take_rest(*second, 1 + of_second.size());
  }

  void take_rest(const Opened& of, std::uint64_t taken) {
    for (; taken < of.points; ++taken) {
      const LazPoint point = of.others->next();
      if (of.others->is_past_end()) refuse_end();
      put(point);
    }
    at_ = end_of(of);
    ++chunk_;
  }

  Opened opened(std::uint64_t left) {
    return layout_.packing == Packing::layers ? layered_chunk(left) : packed_chunk(left);
  }

  std::optional<Opened> second_after(const Opened& first) {
    if (first.points == left_) return std::nullopt;
    if (layout_.packing == Packing::layers) {
      at_ = end_of(first);
    } else {
      if (chunk_ >= sizes_.size()) return std::nullopt;
      at_ = first.begin + sizes_[chunk_];  // or anything: the table may be wrong
      if (at_ > file_.size() || file_.size() - at_ < layout_.point_bytes()) return std::nullopt;
    }
    return opened(left_ - first.points);
  }

  std::vector<std::unique_ptr<PackedItem>> items_but_position() const {
    std::vector<std::unique_ptr<PackedItem>> items;
    for (const LazLayout::Item& item : std::span(layout_.items).subspan(1)) {
      switch (item.kind) {
        case Kind::gps_time:
          items.push_back(make_gps_time(item.version));
          break;
        case Kind::rgb:
          items.push_back(make_rgb(item.version));
          break;
        case Kind::wave_packet:
          items.push_back(make_wave_packet());
          break;
        default:
          items.push_back(make_extra_bytes(item.bytes, item.version));
      }
    }
    return items;
  }

  Opened packed_chunk(std::uint64_t left) {
    const std::uint64_t points = layout_.packing == Packing::one_stream
                                     ? left
                                     : std::min<std::uint64_t>(left, layout_.chunk_points);
    const std::size_t begin = at_;
    const std::string_view first = take_bytes(layout_.point_bytes());
    return {begin, points, first_of_point10(first),
            std::make_unique<PackedPoints>(make_point10(first, layout_.items.front().version),
                                           items_but_position(), file_.substr(at_))};
  }

  Opened layered_chunk(std::uint64_t left) {
    const std::size_t begin = at_;
    const std::string_view first = take_bytes(layout_.point_bytes());
    const auto points = integer_at<std::uint32_t>(take_bytes(4), 0);
    if (points == 0 || points > left) {
      refuse(name_, fmt::format("byte {}", at_ - 4), "points of a chunk", fmt::format("{}", points),
             fmt::format("1 to {}", left), "get the whole file");
    }
    std::array<std::size_t, 5> sizes{};  // of the first layers, what is looked at
    std::size_t layer = 0, others = 0;
    for (const LazLayout::Item& item : layout_.items) {
      for (std::size_t i = layers_of(item); i > 0; --i, ++layer) {
        const auto bytes = integer_at<std::uint32_t>(take_bytes(4), 0);
        (layer < sizes.size() ? sizes[layer] : others) += bytes;
      }
    }
    PointLayers layers;
    layers.returns_and_xy = take_bytes(sizes[0]);
    layers.z = take_bytes(sizes[1]);
    layers.classification = take_bytes(sizes[2]);
    take_bytes(sizes[3]);  // flags
    layers.intensity = take_bytes(sizes[4]);
    take_bytes(others);
    if (!has_attributes_) layers.classification = layers.intensity = {};
    return {begin, points, LayeredPoints::first_point(first),
            std::make_unique<LayeredPoints>(first, layers, at_ - begin - first.size())};
  }

  std::string_view file_;
  std::size_t at_;
  std::uint64_t left_;
  const LazLayout& layout_;
  bool has_attributes_;
  const std::string& name_;
  const std::function<void(std::span<const LazPoint>)>& take_;
  std::vector<LazPoint> batch_;
  std::vector<std::size_t> sizes_;  // of chunks; empty where it is not known before they are taken
  std::size_t chunk_ = 0;           // the next one
};

}  // namespace

std::size_t LazLayout::point_bytes() const {
  std::size_t bytes = 0;
  for (const Item& item : items) bytes += item.bytes;
  return bytes;
}

LazLayout parse_laz_layout(std::string_view record, const std::string& name) {
  constexpr std::size_t header = 34, each = 6;
  const auto fail = [&](const std::string& found) {
    refuse(name, "", "record \"laszip encoded\"", found, "points as LASzip up to 3.4 packs them",
           "unpack the file with the program that made it");
  };
  if (record.size() < header) fail(fmt::format("has {} bytes", record.size()));
  const auto packing = integer_at<std::uint16_t>(record, 0);
  const auto coder = integer_at<std::uint16_t>(record, 2);
  const auto count = integer_at<std::uint16_t>(record, 32);
  if (packing < 1 || packing > 3 || coder != 0) {
    fail(fmt::format("compressor {}, coder {}", packing, coder));
  }
  if (count == 0 || (record.size() - header) / each < count) {
    fail(fmt::format("{} items in {} bytes", count, record.size()));
  }
  LazLayout layout{.packing = static_cast<Packing>(packing),
                   .chunk_points = integer_at<std::uint32_t>(record, 12),
                   .items = {}};
  const bool layered = layout.packing == Packing::layers;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = header + i * each;
    const LazLayout::Item item{.kind = static_cast<Kind>(integer_at<std::uint16_t>(record, at)),
                               .bytes = integer_at<std::uint16_t>(record, at + 2),
                               .version = integer_at<std::uint16_t>(record, at + 4)};
    const Kind point = layered ? Kind::point14 : Kind::point10;
    if (!is_known(item, layered) || (i == 0) != (item.kind == point)) {
      fail(fmt::format("item {} of {} bytes, version {}, as number {}",
                       static_cast<unsigned>(item.kind), item.bytes, item.version, i + 1));
    }
    layout.items.push_back(item);
  }
  const bool says_points = layout.chunk_points > 0 && layout.chunk_points != 0xffffffffu;
  if (layout.packing == Packing::chunks && !says_points) fail("chunks of unknown size");
  return layout;
}

void unpack_laz(std::string_view file, std::size_t begin, std::uint64_t points,
                const LazLayout& layout, bool has_attributes, const std::string& name,
                const std::function<void(std::span<const LazPoint>)>& take) {
  Unpacking(file, begin, points, layout, has_attributes, name, take).run();
}

}  // namespace roadbed::map::occupancy::laz
