#include "roadbed/map/gis/write.h"

#include <flatbuffers/flatbuffers.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "roadbed/geometry/index/hilbert.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/projection.h"
#include "roadbed/map/gis/packed_tree.h"

// The format: https://flatgeobuf.org, its tables in header.fbs and feature.fbs. They are few, so
// their fields are written by number, and no compiler of schemas is needed.

namespace roadbed::map::inline gis {
namespace {

using flatbuffers::FlatBufferBuilder;
using flatbuffers::Offset;
using Table = flatbuffers::Offset<flatbuffers::Table>;

/// Place of a table's n-th field in its table of fields.
constexpr flatbuffers::voffset_t field(int n) {
  return static_cast<flatbuffers::voffset_t>(4 + 2 * n);
}

std::uint8_t geometry_type(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::point:
      return 1;
    case ShapeKind::line:
      return 2;
    case ShapeKind::polygon:
      return 3;
    case ShapeKind::multi_polygon:
      return 6;
  }
  return 0;
}

std::uint8_t column_type(ColumnKind kind) {
  switch (kind) {
    case ColumnKind::truth:
      return 2;
    case ColumnKind::whole:
      return 7;
    case ColumnKind::number:
      return 10;
    case ColumnKind::text:
      return 11;
    case ColumnKind::list:
      return 12;  // JSON
  }
  return 11;
}

Table column_table(FlatBufferBuilder& builder, const Column& column) {
  const auto name = builder.CreateString(column.name);
  const auto start = builder.StartTable();
  builder.AddOffset(field(0), name);
  builder.AddElement<std::uint8_t>(field(1), column_type(column.kind), 0);
  return {builder.EndTable(start)};
}

Table crs_table(FlatBufferBuilder& builder, const std::string& crs) {
  const int epsg = epsg_code(crs).value_or(0);
  const auto organization = builder.CreateString("EPSG");
  const auto wkt = builder.CreateString(well_known_text(crs));
  const auto start = builder.StartTable();
  if (epsg != 0) builder.AddOffset(field(0), organization);
  builder.AddElement<std::int32_t>(field(1), epsg, 0);
  builder.AddOffset(field(4), wkt);
  return {builder.EndTable(start)};
}

std::string header(const Layer& layer, const Eigen::AlignedBox2d& extent, std::size_t count,
                   const std::string& crs) {
  FlatBufferBuilder builder;
  const auto name = builder.CreateString(layer.name);
  const auto envelope = builder.CreateVector(
      std::vector<double>{extent.min().x(), extent.min().y(), extent.max().x(), extent.max().y()});
  std::vector<Table> tables;
  for (const Column& column : layer.columns) tables.push_back(column_table(builder, column));
  const auto columns = builder.CreateVector(tables);
  const Table system = crs.empty() ? Table{} : crs_table(builder, crs);
  const auto start = builder.StartTable();
  builder.AddOffset(field(0), name);
  if (count > 0) builder.AddOffset(field(1), envelope);
  builder.AddElement<std::uint8_t>(field(2), geometry_type(layer.shape), 0);
  builder.AddElement<std::uint8_t>(field(3), layer.has_z ? 1 : 0, 0);
  builder.AddOffset(field(7), columns);
  builder.AddElement<std::uint64_t>(field(8), count, 0);
  builder.AddElement<std::uint16_t>(field(9), count > 0 ? kPackedTreeNode : 0, kPackedTreeNode);
  if (!system.IsNull()) builder.AddOffset(field(10), system);
  builder.FinishSizePrefixed(Table(builder.EndTable(start)));
  return {reinterpret_cast<const char*>(builder.GetBufferPointer()), builder.GetSize()};
}

/// One geometry: its rings' points in a row, and where each ring ends.
Table rings_table(FlatBufferBuilder& builder, const std::vector<Points>& rings, ShapeKind kind,
                  bool has_z) {
  std::vector<double> xy, z;
  std::vector<std::uint32_t> ends;
  const auto add = [&](const Eigen::Vector3d& point) {
    xy.insert(xy.end(), {point.x(), point.y()});
    z.push_back(point.z());
  };
  for (const Points& ring : rings) {
    std::for_each(ring.begin(), ring.end(), add);
    if (kind == ShapeKind::polygon) add(ring.front());
    ends.push_back(static_cast<std::uint32_t>(z.size()));
  }
  const auto ends_vector = builder.CreateVector(ends);
  const auto xy_vector = builder.CreateVector(xy);
  const auto z_vector = has_z ? builder.CreateVector(z) : Offset<flatbuffers::Vector<double>>();
  const auto start = builder.StartTable();
  if (rings.size() > 1) builder.AddOffset(field(0), ends_vector);
  builder.AddOffset(field(1), xy_vector);
  if (has_z) builder.AddOffset(field(2), z_vector);
  builder.AddElement<std::uint8_t>(field(6), geometry_type(kind), 0);
  return {builder.EndTable(start)};
}

Table geometry_table(FlatBufferBuilder& builder, const Layer& layer, const Shape& shape) {
  if (layer.shape != ShapeKind::multi_polygon) {
    return rings_table(builder, shape[0], layer.shape, layer.has_z);
  }
  std::vector<Table> parts;
  for (const auto& rings : shape) {
    parts.push_back(rings_table(builder, rings, ShapeKind::polygon, layer.has_z));
  }
  const auto vector = builder.CreateVector(parts);
  const auto start = builder.StartTable();
  builder.AddElement<std::uint8_t>(field(6), geometry_type(layer.shape), 0);
  builder.AddOffset(field(7), vector);
  return {builder.EndTable(start)};
}

template <typename T>
void add_raw(T value, std::vector<std::uint8_t>& bytes) {
  std::uint8_t raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.insert(bytes.end(), raw, raw + sizeof value);
}

void add_text(const std::string& text, std::vector<std::uint8_t>& bytes) {
  add_raw(static_cast<std::uint32_t>(text.size()), bytes);
  bytes.insert(bytes.end(), text.begin(), text.end());
}

/// Values as pairs of column number and value; those that are unknown are left out.
std::vector<std::uint8_t> properties(const std::vector<Value>& values) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::holds_alternative<std::monostate>(values[i])) continue;
    add_raw(static_cast<std::uint16_t>(i), bytes);
    if (const bool* held = std::get_if<bool>(&values[i])) add_raw(std::uint8_t{*held}, bytes);
    if (const auto* held = std::get_if<std::int64_t>(&values[i])) add_raw(*held, bytes);
    if (const double* held = std::get_if<double>(&values[i])) add_raw(*held, bytes);
    if (const auto* held = std::get_if<std::string>(&values[i])) add_text(*held, bytes);
    if (const auto* held = std::get_if<std::vector<std::string>>(&values[i])) {
      const nlohmann::json list(*held);
      add_text(json_text(list), bytes);
    }
  }
  return bytes;
}

std::string feature_bytes(const Layer& layer, const Feature& feature) {
  FlatBufferBuilder builder;
  const Table geometry = geometry_table(builder, layer, feature.shape);
  const auto values = builder.CreateVector(properties(feature.values));
  const auto start = builder.StartTable();
  builder.AddOffset(field(0), geometry);
  builder.AddOffset(field(1), values);
  builder.FinishSizePrefixed(Table(builder.EndTable(start)));
  return {reinterpret_cast<const char*>(builder.GetBufferPointer()), builder.GetSize()};
}

struct Placed {
  const Feature* feature;
  Eigen::AlignedBox2d box;
  std::uint32_t key = 0;
};

std::vector<Placed> in_hilbert_order(const Layer& layer, Eigen::AlignedBox2d& extent) {
  std::vector<Placed> placed;
  for (const Feature& feature : layer.features) {
    if (feature.shape.empty()) continue;
    placed.push_back({&feature, box_of(feature.shape)});
    extent.extend(placed.back().box);
  }
  for (Placed& one : placed) one.key = geometry::hilbert_key(extent, one.box.center());
  std::stable_sort(placed.begin(), placed.end(),
                   [](const Placed& a, const Placed& b) { return a.key < b.key; });
  return placed;
}

}  // namespace

std::string write_flatgeobuf(const Layer& layer, const std::string& crs) {
  Eigen::AlignedBox2d extent;
  const std::vector<Placed> placed = in_hilbert_order(layer, extent);
  std::string features;
  std::vector<PackedTreeLeaf> leaves;
  for (const Placed& one : placed) {
    leaves.push_back({one.box, features.size()});
    features += feature_bytes(layer, *one.feature);
  }
  const std::string magic{'f', 'g', 'b', 3, 'f', 'g', 'b', 0};
  return magic + header(layer, extent, placed.size(), crs) + packed_tree(leaves) + features;
}

}  // namespace roadbed::map::gis
