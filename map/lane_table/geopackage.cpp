#include <fmt/format.h>
#include <sqlite3.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>

#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/untrusted_sqlite.h"
#include "roadbed/map/files/visible_text.h"
#include "roadbed/map/lane_table/table.h"

namespace roadbed::map::lane_table {
namespace {

static_assert(std::endian::native == std::endian::little);

struct Refusal {
  std::string found, needed;
};

/// Well-known binary behind the header of a GeoPackage, piece by piece.
class ShapeReader {
 public:
  explicit ShapeReader(std::string_view bytes) : bytes_(bytes) {}

  /// The points of a line or outer ring; none of other shapes, or of several parts.
  /// @throws Refusal if the shape is broken.
  std::optional<Line3> read(bool& is_ring) {
    if (!bytes_.starts_with("GP") || bytes_.size() < 8) refuse();
    constexpr std::array<std::size_t, 8> envelopes = {0, 32, 48, 48, 64, 0, 0, 0};
    const auto flags = static_cast<unsigned char>(bytes_[3]);
    skip(8 + envelopes[(flags >> 1U) & 7U]);
    return shape(is_ring, 2);
  }

 private:
  static constexpr std::uint32_t kLine = 2, kPolygon = 3, kLines = 5, kPolygons = 6;

  [[noreturn]] static void refuse() {
    throw Refusal{"a broken shape", "well-known binary with the header of a GeoPackage"};
  }

  void skip(std::size_t size) {
    if (size > bytes_.size()) refuse();
    bytes_.remove_prefix(size);
  }

  template <typename T>
  T take() {
    std::array<char, sizeof(T)> raw;
    if (bytes_.size() < raw.size()) refuse();
    std::memcpy(raw.data(), bytes_.data(), raw.size());
    skip(raw.size());
    if (is_big_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }

  std::optional<Line3> shape(bool& is_ring, int depth) {
    is_big_ = take<std::uint8_t>() == 0;
    const auto type = take<std::uint32_t>();
    // Heights and measures: 1000, 2000 and 3000 more (ISO 13249-3), or the upper bits.
    const std::uint32_t kind = (type & 0x0fffffffU) % 1000U, more = (type & 0x0fffffffU) / 1000U;
    const bool has_z = (type & 0x80000000U) != 0 || more == 1 || more == 3;
    const bool has_m = (type & 0x40000000U) != 0 || more == 2 || more == 3;
    is_ring = kind == kPolygon;
    if (kind == kLine) return points(has_z, has_m);
    if (kind == kPolygon) {
      if (take<std::uint32_t>() == 0) return {};
      return points(has_z, has_m);
    }
    if ((kind != kLines && kind != kPolygons) || depth == 0) return {};
    if (take<std::uint32_t>() != 1) return {};
    return shape(is_ring, depth - 1);
  }

  Line3 points(bool has_z, bool has_m) {
    const std::size_t count = take<std::uint32_t>();
    const std::size_t size = 16 + (has_z ? 8U : 0U) + (has_m ? 8U : 0U);
    if (count > bytes_.size() / size) refuse();
    Line3 line;
    line.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double x = take<double>(), y = take<double>();
      const double z = has_z ? take<double>() : 0.0;
      if (has_m) take<double>();
      line.emplace_back(x, y, z);
    }
    return line;
  }

  std::string_view bytes_;
  bool is_big_ = false;
};

class Database {
 public:
  /// The bytes stay where they are while it is open.
  explicit Database(std::string& bytes)
      : steps_(geometry::most_steps(bytes.size() / kLeastRow)),
        memory_(kFewBytes + kBytesPerByte * bytes.size()) {
    sqlite3* opened = nullptr;
    const int status = sqlite3_open_v2(":memory:", &opened, SQLITE_OPEN_READWRITE, nullptr);
    database_.reset(opened);
    check(status);
    // A file that was open in QGIS says that it has a log beside it, which memory has not.
    if (bytes.size() > 20) bytes[18] = bytes[19] = 1;
    check(sqlite3_deserialize(opened, "main", reinterpret_cast<unsigned char*>(bytes.data()),
                              static_cast<sqlite3_int64>(bytes.size()),
                              static_cast<sqlite3_int64>(bytes.size()),
                              SQLITE_DESERIALIZE_READONLY));
    distrust(opened, bytes.size(), steps_);
    const std::string fault = schema_fault(opened);
    if (!fault.empty()) throw Refusal{fault, "a whole GeoPackage, whose columns hold values"};
  }

  /// Calls `row(statement)` for every row of an answer.
  template <typename Row>
  void ask(const std::string& question, const std::string& value, const Row& row) {
    sqlite3_stmt* prepared = nullptr;
    const int status =
        sqlite3_prepare_v2(database_.get(), question.c_str(), -1, &prepared, nullptr);
    const std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)> statement(prepared,
                                                                               sqlite3_finalize);
    check(status);
    if (sqlite3_bind_parameter_count(prepared) > 0) {
      check(sqlite3_bind_text(prepared, 1, value.c_str(), -1, SQLITE_TRANSIENT));
    }
    for (;;) {
      const int step = sqlite3_step(prepared);
      if (step == SQLITE_DONE) return;
      if (step != SQLITE_ROW) check(step);
      count(prepared);
      row(prepared);
    }
  }

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close(database); }
  };

  static constexpr std::size_t kLeastRow = 64;  // bytes, with its shape
  // Of memory: a column of a row that holds one digit takes more than its byte.
  static constexpr std::size_t kFewBytes = 64'000'000, kBytesPerByte = 16;

  // Pages that several branches of a damaged tree name are rows without end, and what a column
  // holds where nothing was written is stored once for all rows.
  void count(sqlite3_stmt* row) {
    for (int i = 0; i < sqlite3_column_count(row); ++i) {
      const int type = sqlite3_column_type(row, i);
      std::size_t bytes = 1;
      if (type != SQLITE_NULL) {
        bytes = sizeof(Attributes::value_type) + std::strlen(sqlite3_column_name(row, i));
      }
      if (type == SQLITE_TEXT || type == SQLITE_BLOB) {
        bytes += static_cast<std::size_t>(sqlite3_column_bytes(row, i));
      }
      if (!memory_.spend(bytes)) throw Refusal{"more rows than it can hold", "a whole GeoPackage"};
    }
  }

  void check(int status) const {
    if (status == SQLITE_OK) return;
    if (status == SQLITE_INTERRUPT) {
      throw Refusal{"rows that take longer to read than its size can ask for",
                    "a whole GeoPackage"};
    }
    const char* why = database_ ? sqlite3_errmsg(database_.get()) : sqlite3_errstr(status);
    throw Refusal{fmt::format("SQLite says: {}", one_line(why)), "a whole GeoPackage"};
  }

  geometry::WorkBudget steps_, memory_;
  std::unique_ptr<sqlite3, Close> database_;
};

std::string text_at(sqlite3_stmt* statement, int column) {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement, column));
  const int size = sqlite3_column_bytes(statement, column);
  return text == nullptr ? "" : one_line(std::string(text, static_cast<std::size_t>(size)));
}

std::string_view bytes_at(sqlite3_stmt* statement, int column) {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement, column));
  const int size = sqlite3_column_bytes(statement, column);
  return bytes == nullptr ? "" : std::string_view(bytes, static_cast<std::size_t>(size));
}

std::string quoted(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? "\"\"" : std::string(1, c);
  return text + '"';
}

struct LayerTable {
  std::string name, column, key;
  bool in_degrees = false;
  std::string crs;
};

class GeopackageReader {
 public:
  GeopackageReader(std::string& bytes, std::string layer)
      : database_(bytes), wanted_(std::move(layer)) {}

  Table read() {
    const LayerTable layer = find_layer();
    Table table;
    table.in_degrees = layer.in_degrees;
    table.crs = layer.crs;
    database_.ask("select * from " + quoted(layer.name), "",
                  [&](sqlite3_stmt* statement) { add(statement, layer, table); });
    return table;
  }

 private:
  LayerTable find_layer() {
    std::vector<LayerTable> layers;
    std::string names;
    database_.ask(
        "select g.table_name, g.column_name, s.organization, s.organization_coordsys_id, "
        "s.definition from gpkg_geometry_columns g join gpkg_spatial_ref_sys s on s.srs_id = "
        "g.srs_id join sqlite_master m on m.name = g.table_name and m.type = 'table' "
        "order by g.table_name",
        "", [&](sqlite3_stmt* row) {
          LayerTable layer{text_at(row, 0), text_at(row, 1), "", false, ""};
          names += (names.empty() ? "" : ", ") + layer.name;
          if (!wanted_.empty() && layer.name != wanted_) return;
          set_system(row, layer);
          layers.push_back(std::move(layer));
        });
    if (layers.size() != 1) {
      throw Refusal{fmt::format("layers: {}", names.empty() ? "none" : names),
                    wanted_.empty() ? "one, or \"layer\" in the mapping of columns"
                                    : "the layer \"" + wanted_ + "\""};
    }
    database_.ask("select name from pragma_table_info(?) where pk = 1", layers[0].name,
                  [&](sqlite3_stmt* row) { layers[0].key = text_at(row, 0); });
    return std::move(layers.front());
  }

  static void set_system(sqlite3_stmt* row, LayerTable& layer) {
    const std::string organization = text_at(row, 2), code = text_at(row, 3);
    const std::string definition = text_at(row, 4);
    layer.in_degrees = definition.starts_with("GEOG");
    if (layer.in_degrees) return;
    if (organization == "EPSG") layer.crs = "EPSG:" + code;
    if (organization != "EPSG" && definition != "undefined") layer.crs = definition;
  }

  void add(sqlite3_stmt* statement, const LayerTable& layer, Table& table) {
    Row row;
    std::optional<Line3> points;
    for (int i = 0; i < sqlite3_column_count(statement); ++i) {
      const std::string name = one_line(sqlite3_column_name(statement, i));
      const int type = sqlite3_column_type(statement, i);
      if (name == layer.column && type == SQLITE_BLOB) {
        points = ShapeReader(bytes_at(statement, i)).read(row.is_ring);
      } else if (type != SQLITE_NULL && type != SQLITE_BLOB) {
        row.values.emplace_back(name, text_at(statement, i));
      }
    }
    row.id = layer.key.empty() ? std::to_string(table.rows.size() + table.unused + 1)
                               : std::string(row.value(layer.key));
    if (!points) {
      ++table.unused;
      return;
    }
    row.points = std::move(*points);
    if (row.is_ring && row.points.size() > 1 && row.points.front() == row.points.back()) {
      row.points.pop_back();
    }
    table.rows.push_back(std::move(row));
  }

  Database database_;
  std::string wanted_;
};

}  // namespace

bool is_geopackage(std::string_view bytes) {
  return bytes.starts_with(std::string_view("SQLite format 3\0", 16));
}

Table read_geopackage(std::string bytes, const std::string& name, const std::string& layer) {
  try {
    return GeopackageReader(bytes, layer).read();
  } catch (const Refusal& refusal) {
    throw InputError({.file = name,
                      .found = refusal.found,
                      .needed = refusal.needed,
                      .remedy = "check the file with QGIS or ogrinfo"});
  }
}

}  // namespace roadbed::map::lane_table
