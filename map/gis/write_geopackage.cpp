#include "roadbed/map/gis/write.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <string_view>

#include "roadbed/map/files/projection.h"
#include "roadbed/map/gis/geopackage_content.h"
#include "roadbed/map/gis/sqlite_file.h"

namespace roadbed::map::inline gis {
namespace {

constexpr const char* kDate = "1970-01-01T00:00:00.000Z";
constexpr int kOwnSystem = 100000;  ///< of a system that has no EPSG code
constexpr int kUndefinedCartesian = -1;

// Table definitions of OGC 12-128r18, annex C; layer_styles as QGIS makes it.
constexpr const char* kTables = R"(
pragma application_id = 1196444487;
pragma user_version = 10300;
begin;
create table gpkg_spatial_ref_sys (srs_name text not null, srs_id integer not null primary key,
  organization text not null, organization_coordsys_id integer not null, definition text not null,
  description text);
create table gpkg_contents (table_name text not null primary key, data_type text not null,
  identifier text unique, description text default '', last_change datetime not null default
  (strftime('%Y-%m-%dT%H:%M:%fZ','now')), min_x double, min_y double, max_x double, max_y double,
  srs_id integer, constraint fk_gc_r_srs_id foreign key (srs_id) references
  gpkg_spatial_ref_sys(srs_id));
create table gpkg_geometry_columns (table_name text not null, column_name text not null,
  geometry_type_name text not null, srs_id integer not null, z tinyint not null,
  m tinyint not null, constraint pk_geom_cols primary key (table_name, column_name),
  constraint uk_gc_table_name unique (table_name), constraint fk_gc_tn foreign key (table_name)
  references gpkg_contents(table_name), constraint fk_gc_srs foreign key (srs_id) references
  gpkg_spatial_ref_sys (srs_id));
create table gpkg_extensions (table_name text, column_name text, extension_name text not null,
  definition text not null, scope text not null, constraint ge_tce unique (table_name, column_name,
  extension_name));
create table layer_styles (id integer primary key autoincrement not null, f_table_catalog text,
  f_table_schema text, f_table_name text, f_geometry_column text, styleName text, styleQML text,
  styleSLD text, useAsDefault boolean, description text, owner text, ui text,
  update_time datetime default (strftime('%Y-%m-%dT%H:%M:%fZ','now')));
)";

constexpr const char* kGeographic =
    "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563,"
    "AUTHORITY[\"EPSG\",\"7030\"]],AUTHORITY[\"EPSG\",\"6326\"]],PRIMEM[\"Greenwich\",0],"
    "UNIT[\"degree\",0.0174532925199433],AUTHORITY[\"EPSG\",\"4326\"]]";

/// Adds the three systems that every GeoPackage has, and the map's. Returns the map's number.
int add_systems(SqliteFile& file, const std::string& crs) {
  SqliteFile::Insert insert(file, "insert into gpkg_spatial_ref_sys values (?, ?, ?, ?, ?, ?)");
  const auto add = [&](const std::string& name, int id, const std::string& organization, int number,
                       const std::string& definition, const std::string& description) {
    insert.text(name).whole(id).text(organization).whole(number).text(definition).text(description);
    insert.run();
  };
  add("Undefined Cartesian", -1, "NONE", -1, "undefined", "metres of a system that is not known");
  add("Undefined geographic", 0, "NONE", 0, "undefined", "");
  add("WGS 84 geodetic", 4326, "EPSG", 4326, kGeographic, "longitude and latitude");
  if (crs.empty()) return kUndefinedCartesian;
  const std::optional<int> epsg = epsg_code(crs);
  if (epsg == 4326) return 4326;
  const int id = epsg.value_or(kOwnSystem);
  const std::string code = epsg ? fmt::format("EPSG:{}", *epsg) : "";
  add(epsg ? code : "of the map's source", id, epsg ? "EPSG" : "NONE", id,
      well_known_text(epsg ? code : crs), crs);
  return id;
}

std::string_view sql_type(ColumnKind kind) {
  switch (kind) {
    case ColumnKind::truth:
      return "boolean";
    case ColumnKind::whole:
      return "integer";
    case ColumnKind::number:
      return "double";
    case ColumnKind::text:
    case ColumnKind::list:
      return "text";
  }
  return "text";
}

std::string_view sql_type(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::point:
      return "POINT";
    case ShapeKind::line:
      return "LINESTRING";
    case ShapeKind::polygon:
      return "POLYGON";
    case ShapeKind::multi_polygon:
      return "MULTIPOLYGON";
  }
  return "GEOMETRY";
}

Eigen::AlignedBox2d extent_of(const Layer& layer) {
  Eigen::AlignedBox2d extent;
  for (const Feature& feature : layer.features) extent.extend(box_of(feature.shape));
  return extent;
}

void register_layer(SqliteFile& file, const Layer& layer, int srs_id) {
  SqliteFile::Insert contents(
      file, "insert into gpkg_contents values (?, 'features', ?, '', ?, ?, ?, ?, ?, ?)");
  contents.text(layer.name).text(layer.name).text(kDate);
  const Eigen::AlignedBox2d extent = extent_of(layer);
  for (const double side : {extent.min().x(), extent.min().y(), extent.max().x(), extent.max().y()})
    contents.value(extent.isEmpty() ? Value() : Value(side));
  contents.whole(srs_id);
  contents.run();
  SqliteFile::Insert geometry(file,
                              "insert into gpkg_geometry_columns values (?, 'geom', ?, ?, ?, 0)");
  geometry.text(layer.name).text(std::string(sql_type(layer.shape))).whole(srs_id);
  geometry.whole(layer.has_z ? 1 : 0);
  geometry.run();
}

void add_features(SqliteFile& file, const Layer& layer, int srs_id) {
  std::string columns =
      fmt::format("fid integer primary key not null, geom {}", sql_type(layer.shape));
  std::string places = "null, ?";
  for (const Column& column : layer.columns) {
    columns += fmt::format(", {} {}", sql_name(column.name), sql_type(column.kind));
    places += ", ?";
  }
  const std::string table = sql_name(layer.name);
  file.run(fmt::format("create table {} ({})", table, columns));
  SqliteFile::Insert insert(file, fmt::format("insert into {} values ({})", table, places));
  for (const Feature& feature : layer.features) {
    insert.blob(geopackage_blob(feature.shape, layer.shape, layer.has_z, srs_id));
    for (const Value& value : feature.values) insert.value(value);
    insert.run();
  }
}

void add_styles(SqliteFile& file, std::span<const Layer> layers) {
  SqliteFile::Insert contents(
      file,
      "insert into gpkg_contents values ('layer_styles', 'attributes', 'layer_styles', '', ?, "
      "null, null, null, null, null)");
  contents.text(kDate);
  contents.run();
  SqliteFile::Insert insert(
      file,
      "insert into layer_styles values (null, '', '', ?, 'geom', 'roadbed', ?, '', 1, '', '', "
      "null, ?)");
  for (const Layer& layer : layers) {
    insert.text(layer.name).text(qgis_style(layer)).text(kDate);
    insert.run();
  }
}

void add_triggers(SqliteFile& file, const std::string& table, const std::string& index) {
  const auto add = [&](const char* name, const char* event, const std::string& condition,
                       const std::string& actions) {
    file.run(fmt::format("create trigger {} after {} on {} when {} begin {} end",
                         sql_name(index + "_" + name), event, sql_name(table), condition, actions));
  };
  const std::string shape = "new.geom notnull and not ST_IsEmpty(new.geom)";
  const std::string no_shape = "(new.geom isnull or ST_IsEmpty(new.geom))";
  const std::string put = fmt::format(
      "insert or replace into {} values (new.fid, ST_MinX(new.geom), ST_MaxX(new.geom), "
      "ST_MinY(new.geom), ST_MaxY(new.geom));",
      sql_name(index));
  const auto drop = [&](const char* ids) {
    return fmt::format("delete from {} where id in ({});", sql_name(index), ids);
  };
  add("insert", "insert", shape, put);
  add("update1", "update of geom", "old.fid = new.fid and " + shape, put);
  add("update2", "update of geom", "old.fid = new.fid and " + no_shape, drop("old.fid"));
  add("update3", "update", "old.fid != new.fid and " + shape, drop("old.fid") + put);
  add("update4", "update", "old.fid != new.fid and " + no_shape, drop("old.fid, new.fid"));
  add("delete", "delete", "old.geom notnull", drop("old.fid"));
}

void add_boxes(SqliteFile& file, const Layer& layer, const std::string& index) {
  SqliteFile::Insert insert(file,
                            fmt::format("insert into {} values (?, ?, ?, ?, ?)", sql_name(index)));
  std::int64_t id = 0;
  for (const Feature& feature : layer.features) {
    ++id;
    if (feature.shape.empty()) continue;
    const Eigen::AlignedBox2d box = box_of(feature.shape);
    insert.whole(id).number(box.min().x()).number(box.max().x());
    insert.number(box.min().y()).number(box.max().y());
    insert.run();
  }
}

/// Adds the spatial index of a layer whose features are in the file: an R-tree of their boxes, and
/// the triggers by which programs that change features keep it right (OGC 12-128r18, annex F.3).
void add_spatial_index(SqliteFile& file, const Layer& layer) {
  const std::string index = "rtree_" + layer.name + "_geom";
  file.run(fmt::format("create virtual table {} using rtree(id, minx, maxx, miny, maxy)",
                       sql_name(index)));
  add_boxes(file, layer, index);
  add_triggers(file, layer.name, index);
  SqliteFile::Insert extension(
      file,
      "insert into gpkg_extensions values (?, 'geom', 'gpkg_rtree_index', "
      "'http://www.geopackage.org/spec121/#extension_rtree', 'write-only')");
  extension.text(layer.name);
  extension.run();
}

}  // namespace

std::string write_geopackage(std::span<const Layer> layers, const std::string& crs) {
  SqliteFile file;
  file.run(kTables);
  const int srs_id = add_systems(file, crs);
  for (const Layer& layer : layers) {
    register_layer(file, layer, srs_id);
    add_features(file, layer, srs_id);
    add_spatial_index(file, layer);
  }
  add_styles(file, layers);
  file.run("commit");
  return file.bytes();
}

}  // namespace roadbed::map::gis
