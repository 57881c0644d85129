#include "roadbed/map/gis/geopackage_content.h"

#include <bit>
#include <cstdint>
#include <cstring>

namespace roadbed::map::inline gis {
namespace {

static_assert(std::endian::native == std::endian::little);

class Bytes {
 public:
  template <typename T>
  void add(T value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    text.append(raw, sizeof value);
  }
  void add_count(std::size_t count) { add(static_cast<std::uint32_t>(count)); }

  std::string text;
};

class WkbWriter {
 public:
  explicit WkbWriter(bool has_z) : has_z_(has_z) {}

  void add(const Shape& shape, ShapeKind kind, Bytes& bytes) const {
    switch (kind) {
      case ShapeKind::point:
        begin(1, bytes);
        add_point(shape[0][0][0], bytes);
        break;
      case ShapeKind::line:
        begin(2, bytes);
        add_points(shape[0][0], false, bytes);
        break;
      case ShapeKind::polygon:
        add_polygon(shape[0], bytes);
        break;
      case ShapeKind::multi_polygon:
        begin(6, bytes);
        bytes.add_count(shape.size());
        for (const auto& rings : shape) add_polygon(rings, bytes);
        break;
    }
  }

 private:
  /// Byte order, then the type: 1000 more where points have a height (ISO 13249-3).
  void begin(std::uint32_t type, Bytes& bytes) const {
    bytes.add(std::uint8_t{1});
    bytes.add(type + (has_z_ ? 1000U : 0U));
  }

  void add_point(const Eigen::Vector3d& point, Bytes& bytes) const {
    bytes.add(point.x());
    bytes.add(point.y());
    if (has_z_) bytes.add(point.z());
  }

  void add_points(const Points& points, bool close, Bytes& bytes) const {
    bytes.add_count(points.size() + (close ? 1 : 0));
    for (const Eigen::Vector3d& point : points) add_point(point, bytes);
    if (close) add_point(points.front(), bytes);
  }

  void add_polygon(const std::vector<Points>& rings, Bytes& bytes) const {
    begin(3, bytes);
    bytes.add_count(rings.size());
    for (const Points& ring : rings) add_points(ring, true, bytes);
  }

  bool has_z_;
};

}  // namespace

std::string geopackage_blob(const Shape& shape, ShapeKind kind, bool has_z, int srs_id) {
  if (shape.empty()) return {};
  Bytes bytes;
  bytes.text = "GP";
  bytes.add(std::uint8_t{0});  // version 1
  bytes.add(std::uint8_t{3});  // little-endian, envelope of x and y
  bytes.add(static_cast<std::int32_t>(srs_id));
  const Eigen::AlignedBox2d extent = box_of(shape);
  for (const double side : {extent.min().x(), extent.max().x(), extent.min().y(), extent.max().y()})
    bytes.add(side);
  WkbWriter(has_z).add(shape, kind, bytes);
  return bytes.text;
}

}  // namespace roadbed::map::gis
