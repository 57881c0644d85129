#include "roadbed/map/gis/geopackage_index.h"

#include <fmt/format.h>

#include <string>

namespace roadbed::map::inline gis {
namespace {

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

}  // namespace

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

}  // namespace roadbed::map::gis
