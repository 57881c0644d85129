#include "roadbed/map/compiled_map.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <bit>
#include <cstring>
#include <type_traits>

#include "roadbed/map/input_error.h"

namespace roadbed::map {
namespace {

// File: 16 bytes "roadbed map v002", u64 payload size, u64 XXH3 of the payload, payload.
// Payload: the parts in the order of `visit`, numbers little-endian, counts as u64.
constexpr std::string_view kMagic = "roadbed map v002";
constexpr std::size_t kHeaderSize = 32;
static_assert(std::endian::native == std::endian::little);

struct Cut {};  // the payload ends too early, or holds a value that cannot be

class Writer {
 public:
  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void operator()(const T& value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.append(raw, sizeof(T));
  }
  void operator()(const std::string& text) {
    (*this)(std::uint64_t{text.size()});
    bytes += text;
  }
  template <typename T, typename Each>
  void list(const std::vector<T>& items, const Each& each) {
    (*this)(std::uint64_t{items.size()});
    for (const T& item : items) each(*this, item);
  }
  template <typename T, typename Each>
  void optional(const std::optional<T>& value, const Each& each) {
    (*this)(std::uint8_t{value.has_value()});
    if (value) each(*this, *value);
  }
  void line(const geometry::Polyline& polyline) {
    list(polyline.points(), [](Writer& w, const Eigen::Vector2d& p) {
      w(p.x());
      w(p.y());
    });
  }

  std::string bytes;
};

constexpr LaneType last(LaneType) { return LaneType::other; }
constexpr MarkType last(MarkType) { return MarkType::other; }
constexpr JunctionKind last(JunctionKind) { return JunctionKind::crossing; }

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  template <typename T>
  requires std::is_arithmetic_v<T>
  void operator()(T& value) {
    if (bytes_.size() < sizeof(T)) throw Cut{};
    std::memcpy(&value, bytes_.data(), sizeof(T));
    bytes_.remove_prefix(sizeof(T));
  }
  void operator()(bool& value) {
    std::uint8_t byte = 0;
    (*this)(byte);
    if (byte > 1) throw Cut{};
    value = byte == 1;
  }
  template <typename T>
  requires std::is_enum_v<T>
  void operator()(T& kind) {
    std::underlying_type_t<T> value = 0;
    (*this)(value);
    if (value < 0 || value > static_cast<int>(last(kind))) throw Cut{};
    kind = static_cast<T>(value);
  }
  void operator()(std::string& text) {
    const std::size_t size = count(1);
    text = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
  }
  template <typename T, typename Each>
  void list(std::vector<T>& items, const Each& each) {
    items.clear();
    const std::size_t size = count(1);
    items.reserve(std::min<std::size_t>(size, bytes_.size() / sizeof(T) + 1));
    for (std::size_t i = 0; i < size; ++i) each(*this, items.emplace_back());
  }
  template <typename T, typename Each>
  void optional(std::optional<T>& value, const Each& each) {
    std::uint8_t there = 0;
    (*this)(there);
    if (there > 1) throw Cut{};
    if (there == 1) each(*this, value.emplace());
  }
  void line(geometry::Polyline& polyline) {
    std::vector<Eigen::Vector2d> points;
    list(points, [](Reader& r, Eigen::Vector2d& p) {
      r(p.x());
      r(p.y());
    });
    polyline = geometry::Polyline(std::move(points));
  }
  bool at_end() const { return bytes_.empty(); }

 private:
  // A count of things that take at least `least` bytes each.
  std::size_t count(std::size_t least) {
    std::uint64_t size = 0;
    (*this)(size);
    if (size > bytes_.size() / least) throw Cut{};
    return size;
  }

  std::string_view bytes_;
};

// One description serves both directions: `io(field)` writes or reads it.
constexpr auto field = [](auto& io, auto& value) { io(value); };
constexpr auto id_field = [](auto& io, auto& id) { io(id.index); };
constexpr auto point_field = [](auto& io, auto& point) {
  io(point.x());
  io(point.y());
};

constexpr auto point3_field = [](auto& io, auto& point) {
  io(point.x());
  io(point.y());
  io(point.z());
};

constexpr auto attribute = [](auto& io, auto& item) {
  io(item.first);
  io(item.second);
};

template <typename Io, typename T>
void participants(Io& io, T& item) {
  std::uint16_t bits = item.bits();
  io(bits);
  if constexpr (!std::is_const_v<T>) item = Participants::from_bits(bits);
}

constexpr auto region = [](auto& io, auto& polygon) {
  io.list(polygon.outer, point_field);
  io.list(polygon.holes, [](auto& rings, auto& ring) { rings.list(ring, point_field); });
};

constexpr auto speed_limit = [](auto& io, auto& item) {
  io(item.from_s_m);
  io.optional(item.limit_mps, field);
};

constexpr auto mark = [](auto& io, auto& item) {
  io(item.from_s_m);
  io(item.type);
  io(item.color);
  io(item.width_m);
};

constexpr auto lane_line = [](auto& io, auto& line) {
  io.line(line.in_map);
  io.list(line.z_m, field);
  io.list(line.station_m, field);
};

constexpr auto lane = [](auto& io, auto& item) {
  io(item.id.index);
  io.optional(item.road, id_field);
  io.optional(item.junction, id_field);
  io(item.origin.section);
  io(item.origin.source_id);
  io(item.origin.road_from_s_m);
  io(item.origin.road_to_s_m);
  io(item.name);
  io(item.type);
  io(item.one_way);
  participants(io, item.participants);
  io.list(item.speed_limits, speed_limit);
  io.list(item.left_marks, mark);
  io.list(item.right_marks, mark);
  io.list(item.attributes, attribute);
  lane_line(io, item.left);
  lane_line(io, item.centre);
  lane_line(io, item.right);
  io.list(item.polygon, point_field);
};

constexpr auto neighbour = [](auto& io, auto& item) {
  io(item.lane.index);
  io(item.same_direction);
  io.list(item.change_windows, [](auto& ranges, auto& range) {
    ranges(range.from_s_m);
    ranges(range.to_s_m);
  });
};

constexpr auto links = [](auto& io, auto& item) {
  io.list(item.successors, id_field);
  io.list(item.predecessors, id_field);
  io.optional(item.left, neighbour);
  io.optional(item.right, neighbour);
};

constexpr auto road = [](auto& io, auto& item) {
  io(item.id.index);
  io(item.source_id);
  io(item.name);
  io.optional(item.junction, id_field);
  io(item.length_m);
  io.line(item.reference_in_map);
  io.list(item.reference_road_s_m, field);
  io.list(item.lanes, id_field);
};

constexpr auto junction = [](auto& io, auto& item) {
  io(item.id.index);
  io(item.source_id);
  io(item.name);
  io(item.kind);
  io.list(item.connecting_roads, id_field);
};

constexpr auto signal = [](auto& io, auto& item) {
  io(item.source_id);
  io(item.name);
  io.optional(item.road, id_field);
  io(item.road_s_m);
  io(item.road_t_m);
  point_field(io, item.in_map);
  io(item.z_m);
  io.optional(item.heading_rad, field);
  io(item.country);
  io(item.type);
  io(item.subtype);
  io.optional(item.value, field);
  io(item.unit);
  io(item.text);
  io(item.dynamic);
  io.list(item.lanes, id_field);
  io.list(item.attributes, attribute);
};

constexpr auto controller = [](auto& io, auto& item) {
  io(item.source_id);
  io(item.name);
  io.list(item.signals, field);
};

constexpr auto stop_line = [](auto& io, auto& item) {
  io(item.source_id);
  io.list(item.in_map, point3_field);
  io.list(item.lanes, id_field);
  io.list(item.signals, field);
};

constexpr auto regulation_member = [](auto& io, auto& item) {
  io(item.role);
  io(item.source_id);
  io.optional(item.lane, id_field);
  io.list(item.in_map, point3_field);
  io.list(item.attributes, attribute);
};

constexpr auto regulation = [](auto& io, auto& item) {
  io(item.source_id);
  io(item.type);
  io.list(item.lanes, id_field);
  io.list(item.members, regulation_member);
  io.list(item.attributes, attribute);
};

constexpr auto map_object = [](auto& io, auto& item) {
  io(item.source_id);
  io(item.name);
  io(item.type);
  io.optional(item.road, id_field);
  io(item.road_s_m);
  io(item.road_t_m);
  point_field(io, item.in_map);
  io.list(item.outline_in_map, point_field);
  io(item.z_m);
  io(item.height_m);
  io.list(item.attributes, attribute);
};

constexpr auto area = [](auto& io, auto& item) {
  io(item.source_id);
  io(item.type);
  io(item.is_road);
  io.list(item.in_map, region);
  participants(io, item.participants);
  io.list(item.attributes, attribute);
};

constexpr auto unused = [](auto& io, auto& item) {
  io(item.name);
  io(item.count);
};

constexpr auto remark = [](auto& io, auto& item) {
  io(item.rule);
  io(item.is_fault);
  io(item.element);
  io(item.line);
  io(item.message);
};

constexpr auto visit = [](auto& io, auto& parts) {
  io(parts.format);
  io(parts.crs);
  point_field(io, parts.origin_in_source);
  io.list(parts.roads, road);
  io.list(parts.junctions, junction);
  io.list(parts.signals, signal);
  io.list(parts.controllers, controller);
  io.list(parts.stop_lines, stop_line);
  io.list(parts.regulations, regulation);
  io.list(parts.objects, map_object);
  io.list(parts.areas, area);
  io.list(parts.lanes, lane);
  io.list(parts.links, links);
  io.list(parts.remarks, remark);
  io.list(parts.unused, unused);
};

[[noreturn]] void refuse(const std::string& name, const std::string& found) {
  throw InputError({.file = name,
                    .place = {},
                    .element = {},
                    .found = found,
                    .needed = "a whole compiled map of this version",
                    .remedy = "compile it again with roadbed import"});
}

}  // namespace

std::string write_compiled_map(const RoadMap& road_map) {
  Writer payload;
  visit(payload, road_map.parts());
  Writer file;
  file.bytes = kMagic;
  file(std::uint64_t{payload.bytes.size()});
  file(std::uint64_t{XXH3_64bits(payload.bytes.data(), payload.bytes.size())});
  return file.bytes + payload.bytes;
}

bool is_compiled_map(std::string_view bytes) {
  return bytes.starts_with(kMagic.substr(0, kMagic.size() - 4));
}

RoadMap read_compiled_map(std::string_view bytes, const std::string& name) {
  if (!bytes.starts_with(kMagic)) {
    refuse(name, fmt::format("version \"{}\"", bytes.substr(0, kMagic.size())));
  }
  if (bytes.size() < kHeaderSize) refuse(name, "is cut off in its header");
  std::uint64_t size = 0, hash = 0;
  Reader header(bytes.substr(kMagic.size(), kHeaderSize - kMagic.size()));
  header(size);
  header(hash);
  const std::string_view payload = bytes.substr(kHeaderSize);
  if (payload.size() != size) {
    refuse(name, fmt::format("holds {} bytes of {}", payload.size(), size));
  }
  if (XXH3_64bits(payload.data(), payload.size()) != hash) refuse(name, "its checksum is wrong");
  try {
    Reader reader(payload);
    RoadMapParts parts;
    visit(reader, parts);
    if (!reader.at_end()) throw Cut{};
    return RoadMap(std::move(parts));
  } catch (const Cut&) {
    refuse(name, "its content is damaged");
  } catch (const std::invalid_argument& error) {
    refuse(name, error.what());
  }
}

}  // namespace roadbed::map
