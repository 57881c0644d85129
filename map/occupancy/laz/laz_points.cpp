#include "roadbed/map/occupancy/laz/laz_points.h"

#include <fmt/format.h>

#include <algorithm>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/laz/layered_points.h"
#include "roadbed/map/occupancy/laz/packed_item.h"

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
    if (layout_.packing != Packing::one_stream) need(kChunkTablePlace), at_ += kChunkTablePlace;
    while (left_ > 0) {
      layout_.packing == Packing::layers ? layered_chunk() : packed_chunk();
    }
    pass_on();
  }

 private:
  [[noreturn]] void refuse_end() const {
    refuse(name_, fmt::format("byte {}", std::min(at_, file_.size())), "points",
           fmt::format("the file ends {} points before the last", left_), "all of them",
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

  std::vector<std::unique_ptr<PackedItem>> items_after(std::string_view first) const {
    std::vector<std::unique_ptr<PackedItem>> items;
    for (const LazLayout::Item& item : layout_.items) {
      switch (item.kind) {
        case Kind::point10:
          items.push_back(make_point10(first, item.version));
          break;
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

  void packed_chunk() {
    const std::uint64_t points = layout_.packing == Packing::one_stream
                                     ? left_
                                     : std::min<std::uint64_t>(left_, layout_.chunk_points);
    const std::string_view first = take_bytes(layout_.point_bytes());
    LazPoint point = first_of_point10(first);
    put(point);
    if (points == 1 && left_ == 0) return;
    const auto items = items_after(first);
    ArithmeticDecoder from(file_.substr(at_));
    for (std::uint64_t i = 1; i < points; ++i) {
      for (const auto& item : items) item->next(from, point);
      if (from.is_past_end()) refuse_end();
      put(point);
    }
    at_ += from.used();
  }

  void layered_chunk() {
    const std::string_view first = take_bytes(layout_.point_bytes());
    const auto points = integer_at<std::uint32_t>(take_bytes(4), 0);
    if (points == 0 || points > left_) {
      refuse(name_, fmt::format("byte {}", at_ - 4), "points of a chunk", fmt::format("{}", points),
             fmt::format("1 to {}", left_), "get the whole file");
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
    LayeredPoints packed(first, layers);
    put(LayeredPoints::first_point(first));
    for (std::uint32_t i = 1; i < points; ++i) {
      const LazPoint point = packed.next();
      if (packed.is_past_end()) refuse_end();
      put(point);
    }
  }

  std::string_view file_;
  std::size_t at_;
  std::uint64_t left_;
  const LazLayout& layout_;
  bool has_attributes_;
  const std::string& name_;
  const std::function<void(std::span<const LazPoint>)>& take_;
  std::vector<LazPoint> batch_;
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
