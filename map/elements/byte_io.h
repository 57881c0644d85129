#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/map/elements/border_mark.h"
#include "roadbed/map/elements/id.h"
#include "roadbed/map/elements/lane.h"
#include "roadbed/map/elements/map_content.h"
#include "roadbed/map/files/coordinate_limits.h"
#include "roadbed/map/files/visible_text.h"

namespace roadbed::map::inline elements {

/// Appends values to bytes that outlive it: numbers little-endian, counts as u64.
/// @tparam Bytes  has `append(const char*, std::size_t)`.
template <typename Bytes>
class BasicByteWriter {
 public:
  explicit BasicByteWriter(Bytes& bytes) : bytes_(bytes) {}

  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void operator()(const T& value) { raw(&value, sizeof(T)); }
  template <typename Tag>
  void operator()(const Id<Tag>& id) {
    (*this)(id.index);
  }
  void operator()(const std::string& text) {
    (*this)(std::uint64_t{text.size()});
    raw(text.data(), text.size());
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
  void point(const Eigen::Vector2d& value) { raw(value.data(), 2 * sizeof(double)); }
  void numbers(const std::vector<double>& values) { block(values); }
  template <typename Point>
  void points(const std::vector<Point>& values) {
    block(values);
  }
  void line(const geometry::Polyline& polyline) { block(polyline.points()); }
  void check(bool) const {}

 private:
  void raw(const void* from, std::size_t size) {
    bytes_.append(static_cast<const char*>(from), size);
  }
  template <typename T>
  void block(const std::vector<T>& values) {
    (*this)(std::uint64_t{values.size()});
    raw(values.data(), values.size() * sizeof(T));
  }

  Bytes& bytes_;
};

using ByteWriter = BasicByteWriter<std::string>;

/// Counts bytes where a writer would put them.
struct ByteCount {
  void append(const char*, std::size_t more) { size += more; }
  std::uint64_t size = 0;
};

/// How many there are of what ids name.
struct IdLimits {
  std::size_t lanes = 0, roads = 0, junctions = 0;
};

/// Takes values from bytes as ByteWriter put them there; never makes more than the bytes hold.
class ByteReader {
 public:
  /// The bytes end too early, or hold a value that cannot be.
  struct Damaged {};

  ByteReader(std::string_view bytes, const IdLimits& limits) : bytes_(bytes), limits_(limits) {}

  template <typename T>
  requires std::is_arithmetic_v<T>
  void operator()(T& value) { raw(&value, sizeof(T)); }
  void operator()(bool& value) {
    std::uint8_t byte = 0;
    (*this)(byte);
    check(byte <= 1);
    value = byte == 1;
  }
  template <typename T>
  requires std::is_enum_v<T>
  void operator()(T& kind) {
    std::underlying_type_t<T> value = 0;
    (*this)(value);
    check(value >= 0 && value <= static_cast<std::underlying_type_t<T>>(last(kind)));
    kind = static_cast<T>(value);
  }
  void operator()(LaneId& id) { read_id(id.index, limits_.lanes); }
  void operator()(RoadId& id) { read_id(id.index, limits_.roads); }
  void operator()(JunctionId& id) { read_id(id.index, limits_.junctions); }
  void operator()(std::string& text) {
    const std::size_t size = count(1);
    text = bytes_.substr(0, size);
    make_one_line(text);  // a compiled map may be another one's
    bytes_.remove_prefix(size);
  }
  template <typename T, typename Each>
  void list(std::vector<T>& items, const Each& each) {
    const std::size_t size = count(1);
    items.reserve(std::min<std::size_t>(size, bytes_.size() / sizeof(T) + 1));
    for (std::size_t i = 0; i < size; ++i) each(*this, items.emplace_back());
  }
  template <typename T, typename Each>
  void optional(std::optional<T>& value, const Each& each) {
    bool there = false;
    (*this)(there);
    if (there) each(*this, value.emplace());
  }
  void point(Eigen::Vector2d& value) {
    raw(value.data(), 2 * sizeof(double));
    check_place(value);
  }
  void numbers(std::vector<double>& values) {
    block(values);
    check(std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }));
  }
  template <typename Point>
  void points(std::vector<Point>& values) {
    block(values);
    for (const Point& value : values) check_place(value);
  }
  /// A line of no points is one that the map does not have.
  void line(geometry::Polyline& polyline) {
    std::vector<Eigen::Vector2d> made;
    points(made);
    if (!made.empty()) polyline = geometry::Polyline(std::move(made));
  }
  void check(bool holds) const {
    if (!holds) throw Damaged{};
  }
  bool at_end() const { return bytes_.empty(); }

 private:
  static constexpr LaneType last(LaneType) { return LaneType::other; }
  static constexpr MarkType last(MarkType) { return MarkType::other; }
  static constexpr JunctionKind last(JunctionKind) { return JunctionKind::crossing; }

  // No reader makes places farther off, and exact arithmetic cannot take just any number.
  template <typename Point>
  void check_place(const Point& place) const {
    check((place.array().abs() < kFarthestM).all());  // false for what is no number
  }
  void raw(void* into, std::size_t size) {
    check(bytes_.size() >= size);
    if (size > 0) std::memcpy(into, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }
  void read_id(std::uint32_t& index, std::size_t limit) {
    (*this)(index);
    check(index < limit);
  }
  // A count of things that take at least `least` bytes each.
  std::size_t count(std::size_t least) {
    std::uint64_t size = 0;
    (*this)(size);
    check(size <= bytes_.size() / least);
    return size;
  }
  template <typename T>
  void block(std::vector<T>& values) {
    values.resize(count(sizeof(T)));
    raw(values.data(), values.size() * sizeof(T));
  }

  std::string_view bytes_;
  IdLimits limits_;
};

}  // namespace roadbed::map::elements
