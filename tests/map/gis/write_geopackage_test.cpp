#include "roadbed/map/gis/write.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <pugixml.hpp>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/gis/layers.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/number_at.h"

namespace roadbed::map {
namespace {

using tests::number_at;

using Rows = std::vector<std::vector<std::string>>;

/// Reads the bytes of a database with SQLite itself.
class Database {
 public:
  explicit Database(const std::string& bytes) : bytes_(bytes) {
    sqlite3_open(":memory:", &database_);
    const auto size = static_cast<sqlite3_int64>(bytes_.size());
    sqlite3_deserialize(database_, "main", reinterpret_cast<unsigned char*>(bytes_.data()), size,
                        size, SQLITE_DESERIALIZE_READONLY);
  }
  ~Database() { sqlite3_close(database_); }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  Rows rows(const std::string& sql) const {
    Rows rows;
    sqlite3_stmt* statement = nullptr;
    EXPECT_EQ(sqlite3_prepare_v2(database_, sql.c_str(), -1, &statement, nullptr), SQLITE_OK)
        << sqlite3_errmsg(database_);
    while (statement != nullptr && sqlite3_step(statement) == SQLITE_ROW) {
      rows.emplace_back();
      for (int i = 0; i < sqlite3_column_count(statement); ++i) {
        const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement, i));
        const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement, i));
        rows.back().emplace_back(bytes == nullptr ? "" : std::string(bytes, size));
      }
    }
    sqlite3_finalize(statement);
    return rows;
  }

 private:
  std::string bytes_;
  sqlite3* database_ = nullptr;
};

TEST(WriteGeopackage, IsWholeAndNamesItsLayers) {
  const auto layers = make_layers(tests::three_roads_in_a_row().build());
  const Database database(write_geopackage(layers, ""));
  EXPECT_EQ(database.rows("pragma integrity_check"), Rows{{"ok"}});
  EXPECT_EQ(database.rows("pragma foreign_key_check"), Rows{});
  EXPECT_EQ(database.rows("pragma application_id"), Rows{{"1196444487"}});  // "GPKG"
  const Rows named = database.rows(
      "select table_name from gpkg_contents where data_type = 'features' order by rowid");
  ASSERT_EQ(named.size(), layers.size());
  for (std::size_t i = 0; i < layers.size(); ++i) {
    EXPECT_EQ(named[i][0], layers[i].name);
    EXPECT_EQ(database.rows("select count(*) from " + layers[i].name)[0][0],
              std::to_string(layers[i].features.size()));
  }
}

TEST(WriteGeopackage, HoldsAPolygonAsWellKnownBinary) {
  const auto layers =
      make_layers(tests::straight_two_lane_road(100.0).build(), std::vector<std::string>{"lanes"});
  const Database database(write_geopackage(layers, ""));
  const Rows rows = database.rows("select geom, lane, length_m, successors from lanes");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0][1], "1/0/-1");
  EXPECT_EQ(rows[0][2], "100.0");
  EXPECT_EQ(rows[0][3], "[]");
  const std::string& blob = rows[0][0];
  ASSERT_EQ(blob.size(), 8u + 32u + 1 + 4 + 4 + 4 + 5 * 16);
  EXPECT_EQ(blob.substr(0, 2), "GP");
  EXPECT_EQ(number_at<std::int32_t>(blob, 4), -1);
  EXPECT_EQ(number_at<double>(blob, 8), 0.0);     // least x
  EXPECT_EQ(number_at<double>(blob, 16), 100.0);  // greatest x
  EXPECT_EQ(number_at<double>(blob, 24), -3.5);
  EXPECT_EQ(number_at<double>(blob, 32), 0.0);
  EXPECT_EQ(number_at<std::uint32_t>(blob, 41), 3u);  // polygon
  EXPECT_EQ(number_at<std::uint32_t>(blob, 45), 1u);  // of one ring
  EXPECT_EQ(number_at<std::uint32_t>(blob, 49), 5u);  // of five points
  EXPECT_EQ(blob.substr(53, 16), blob.substr(53 + 64, 16));
}

TEST(WriteGeopackage, HasAStyleForEachLayerThatIsWellFormed) {
  const auto layers = make_layers(tests::three_roads_in_a_row().build());
  const Database database(write_geopackage(layers, ""));
  const Rows styles = database.rows(
      "select f_table_name, f_geometry_column, useAsDefault, styleQML from layer_styles");
  ASSERT_EQ(styles.size(), layers.size());
  for (const auto& style : styles) {
    EXPECT_EQ(style[1], "geom");
    EXPECT_EQ(style[2], "1");
    pugi::xml_document document;
    ASSERT_TRUE(document.load_string(style[3].c_str(), pugi::parse_default | pugi::parse_doctype))
        << style[0];
    const auto renderer = document.child("qgis").child("renderer-v2");
    EXPECT_GE(std::distance(renderer.child("symbols").begin(), renderer.child("symbols").end()), 1);
  }
}

TEST(WriteGeopackage, IndexesTheBoxOfEveryShape) {
  Layer layer{"places", "place", ShapeKind::line, false, {}, {}};
  layer.features = {
      {{{{{0, 5, 0}, {10, 7, 0}}}}, {}}, {{}, {}}, {{{{{20, 5, 0}, {30, 4, 0}}}}, {}}};
  const Database database(write_geopackage(std::vector{layer}, ""));
  EXPECT_EQ(database.rows("select id, minx, maxx, miny, maxy from rtree_places_geom order by id"),
            (Rows{{"1", "0.0", "10.0", "5.0", "7.0"}, {"3", "20.0", "30.0", "4.0", "5.0"}}));
  EXPECT_EQ(database.rows("select table_name, extension_name from gpkg_extensions"),
            (Rows{{"places", "gpkg_rtree_index"}}));
  EXPECT_EQ(database.rows("select rtreecheck('rtree_places_geom')"), Rows{{"ok"}});
  EXPECT_EQ(database.rows("select count(*) from sqlite_master where type = 'trigger'"),
            Rows{{"6"}});
}

TEST(WriteGeopackage, IsTheSameEveryTime) {
  const auto layers = make_layers(tests::three_roads_in_a_row().build());
  EXPECT_EQ(write_geopackage(layers, ""), write_geopackage(layers, ""));
}

TEST(WriteGeopackage, KeepsFindingsWithoutAPlace) {
  Layer layer{"findings", "finding", ShapeKind::point, false, {{"rule", ColumnKind::text}}, {}};
  layer.features = {{{}, {std::string("a.b")}}};
  const Database database(write_geopackage(std::vector{layer}, ""));
  EXPECT_EQ(database.rows("select rule from findings where geom is null"), Rows{{"a.b"}});
}

}  // namespace
}  // namespace roadbed::map
