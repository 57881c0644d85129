// Octrees cut, put together, and written for others.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "roadbed/map/files/projection.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

const std::string kOctree = data_folder() / "town.bt";

class OccupancyParts : public testing::Test {
 protected:
  static ProgramRun run(Words words) {
    words.insert(words.begin(), "occupancy");
    return run_roadbed(words);
  }

  std::string made(Words words, const std::string& name, int status = 0) const {
    const std::string output = folder_ / name;
    words.insert(words.end(), {"-o", output});
    const ProgramRun done = run(words);
    EXPECT_EQ(done.status, status) << done.err;
    EXPECT_EQ(done.out, "");
    return output;
  }

  static Json info(const std::string& file) {
    return Json::parse(run({"info", file, "--json"}).out);
  }

  /// Three points in UTM zone 32, as an octree of 0.5 m.
  std::string in_utm(const std::string& name = "utm.bt") const {
    const std::string cloud = folder_.write(
        "utm.xyz", "500010.1 5500020.1 100.3\n500010.6 5500020.1 100.3\n500020 5500030 101\n");
    return made({"build", cloud, "--crs", "EPSG:32632", "--resolution", "0.5"}, name);
  }

  TemporaryFolder folder_;
};

TEST_F(OccupancyParts, CutApartArePutTogetherToTheSameFile) {
  const Json box = info(kOctree).at("bounds");
  const double middle = std::round(5.0 * box.at("min_x_m").get<double>() + 200.0) / 5.0;
  const std::string west = made(
                        {"crop", kOctree, "--bbox=-1e4,-1e4," + std::to_string(middle) + ",1e4"},
                        "west.bt"),
                    east = made(
                        {"crop", kOctree, "--bbox=" + std::to_string(middle) + ",-1e4,1e4,1e4"},
                        "east.bt");
  EXPECT_NEAR(info(west).at("bounds").at("max_x_m").get<double>(), middle, 1e-9);
  EXPECT_NEAR(info(east).at("bounds").at("min_x_m").get<double>(), middle, 1e-9);
  EXPECT_EQ(bytes_of(made({"merge", east, west}, "whole.bt")),
            bytes_of(made({"build", kOctree}, "town.bt")));
}

TEST_F(OccupancyParts, KeepTheirTilesOrGetOthers) {
  const std::string whole = made({"build", kOctree}, "town.bt");
  const std::string tiles = made({"merge", kOctree, "--tiles", "40"}, "town.tiles"),
                    part = made({"crop", tiles, "--heights=-100,1"}, "low.tiles");
  EXPECT_EQ(info(part).at("side_m"), info(tiles).at("side_m"));
  EXPECT_LE(info(part).at("bounds").at("max_z_m").get<double>(), 1.2);
  EXPECT_EQ(bytes_of(made({"merge", tiles, part}, "again.bt")), bytes_of(whole));
  const ProgramRun unsaid = run({"merge", kOctree, "-o", folder_ / "no.tiles"});
  EXPECT_EQ(unsaid.status, 3);
  EXPECT_THAT(unsaid.err, HasSubstr("give --tiles SIDE"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "no.tiles"));
}

TEST_F(OccupancyParts, AreCutByAPolygonInDegreesWhereTheSystemIsKnown) {
  const auto degrees = [](double x, double y) {
    std::vector<Eigen::Vector2d> point{{x, y}};
    map::to_lon_lat("EPSG:32632", point);
    return Json{point[0].x(), point[0].y()};
  };
  const Json ring{degrees(500009, 5500019), degrees(500015, 5500019), degrees(500015, 5500025),
                  degrees(500009, 5500025), degrees(500009, 5500019)};
  const Json polygon{{"type", "Feature"},
                     {"properties", Json::object()},
                     {"geometry", {{"type", "Polygon"}, {"coordinates", Json::array({ring})}}}};
  const std::string file = folder_.write("yard.geojson", polygon.dump());
  const std::string part = made({"crop", in_utm(), "--polygon", file}, "yard.bt");
  EXPECT_EQ(info(part).at("occupied").at("volume_m3"), 2 * 0.125);
  EXPECT_EQ(info(part).at("crs"), "EPSG:32632");
  const ProgramRun unknown = run({"crop", kOctree, "--polygon", file, "-o", folder_ / "no.bt"});
  EXPECT_EQ(unknown.status, 3);
  EXPECT_THAT(unknown.err, HasSubstr("town.bt: names no coordinate system"));
}

TEST_F(OccupancyParts, AreCutAroundALaneOfTheirMap) {
  const std::string map = data_folder() / "town.xodr";
  const std::string near =
      made({"crop", kOctree, "--map", map, "--within", "lane:1/0/-1,8m"}, "near.bt", 0);
  const auto leaves = [](const std::string& file) { return info(file).at("leaves").get<int>(); };
  EXPECT_GT(leaves(near), 0);
  EXPECT_LT(leaves(near), leaves(kOctree) / 2);
}

// Of the street along y = 198.25, as far as the route goes.
TEST_F(OccupancyParts, AreCutAlongARouteOfTheirMap) {
  const std::string map = data_folder() / "town.xodr";
  const std::string route = folder_.write(
      "route.json",
      run_roadbed({"route", map, "--from", "lane:1/3/1@6", "--to", "lane:1/3/1@45", "--json"}).out);
  const std::string line = folder_ / "line.csv";
  ASSERT_EQ(run_roadbed({"reference", map, "--from", "lane:1/3/1@6", "--to", "lane:1/3/1@45", "-o",
                         line, "-q"})
                .status,
            0);
  std::istringstream rows(bytes_of(line));
  double west_m = 1e9, east_m = -1e9, s_m = 0, x_m = 0, y_m = 0;
  char comma = 0;
  std::string row;
  for (std::getline(rows, row); std::getline(rows, row);) {
    std::istringstream(row) >> s_m >> comma >> x_m >> comma >> y_m;
    west_m = std::min(west_m, x_m);
    east_m = std::max(east_m, x_m);
  }
  const Json box =
      info(made({"crop", kOctree, "--map", map, "--within", "route:" + route + ",5m"}, "along.bt"))
          .at("bounds");
  const double half_cell_m = 0.1, reach_m = 5.0;
  EXPECT_NEAR(box.at("min_x_m").get<double>(), west_m - reach_m, 2.0 * half_cell_m);
  EXPECT_NEAR(box.at("max_x_m").get<double>(), east_m + reach_m, 2.0 * half_cell_m);
  EXPECT_NEAR(box.at("min_y_m").get<double>(), y_m - reach_m, 2.0 * half_cell_m);
  EXPECT_NEAR(box.at("max_y_m").get<double>(), y_m + reach_m, 2.0 * half_cell_m);
  const std::string other =
      folder_.write("other.json", R"({"found": true, "lanes": [{"lane": "9"}]})");
  const ProgramRun unknown = run({"crop", kOctree, "--map", map, "--within",
                                  "route:" + other + ",5m", "-o", folder_ / "none.bt"});
  EXPECT_EQ(unknown.status, 3);
  EXPECT_THAT(unknown.err, HasSubstr("/lanes/0/lane: lane 9 is not in the map"));
}

TEST_F(OccupancyParts, HoldTheCellsWhoseMiddleIsOnTheEdge) {
  std::string points;
  for (int i = -15; i < 15; ++i) {
    for (int j = -15; j < 15; ++j) {
      points += std::to_string(0.2 * i + 0.1) + " " + std::to_string(0.2 * j + 0.1) + " 0.1\n";
    }
  }
  const std::string whole =
      made({"build", folder_.write("grid.xyz", points), "--resolution", "0.2"}, "grid.bt");
  const std::string outline = folder_.write("outline.geojson", R"({"type": "FeatureCollection",
"crs": null, "features": [{"type": "Feature", "properties": {}, "geometry": {"type": "Polygon",
"coordinates": [[[-2.1, -1.9], [1.1, -1.9], [1.1, 0.3], [-2.1, 0.3], [-2.1, -1.9]]]}}]})");
  const auto cells = [](const std::string& file) {
    return std::lround(info(file).at("occupied").at("volume_m3").get<double>() / 0.008);
  };
  EXPECT_EQ(cells(made({"crop", whole, "--bbox=-2.1,-1.9,1.1,0.3"}, "box.bt")), 17 * 12);
  EXPECT_EQ(cells(made({"crop", whole, "--polygon", outline}, "polygon.bt")), 17 * 12);
  EXPECT_EQ(cells(made({"crop", whole, "--bbox=-2.0999,-1.8999,1.0999,0.2999"}, "less.bt")),
            15 * 10);
}

TEST_F(OccupancyParts, InTilesAreComparedAsOne) {
  const std::string tiles = made({"merge", kOctree, "--tiles", "100"}, "town.tiles");
  const ProgramRun same = run({"diff", tiles, kOctree, "--json"});
  EXPECT_EQ(same.status, 0) << same.err << same.out;
  EXPECT_GT(Json::parse(same.out).at("stayed_cells").get<int>(), 100'000);
  const std::string part = made({"crop", kOctree, "--bbox=0,0,300,400"}, "part.bt");
  const Json of_tiles = Json::parse(run({"diff", part, tiles, "--json"}).out),
             of_octree = Json::parse(run({"diff", part, kOctree, "--json"}).out);
  EXPECT_EQ(of_tiles, of_octree);
  EXPECT_GT(of_tiles.at("appeared_cells").get<int>(), 1000);
}

TEST_F(OccupancyParts, OfDifferentGridsAreToldByTheirFiles) {
  const std::string coarse = in_utm("coarse.bt");
  const ProgramRun refused = run({"diff", kOctree, coarse});
  EXPECT_EQ(refused.status, 3);
  EXPECT_THAT(refused.err,
              HasSubstr(coarse + ": cells of 0.5 m, needs cells of 0.2 m as " + kOctree));
}

TEST_F(OccupancyParts, OfNothingAreAnEmptyOctreeAndANo) {
  const std::string none = made({"crop", kOctree, "--heights=500,600"}, "none.bt", 1);
  EXPECT_EQ(info(none).at("leaves"), 0);
}

TEST_F(OccupancyParts, AreRefusedInOneLineAndLeaveNothing) {
  const std::string coarse = in_utm("coarse.bt"), out = folder_ / "out.bt";
  for (const auto& [words, status, text] : std::vector<std::tuple<Words, int, std::string>>{
           {{"merge", kOctree, coarse}, 3, "coarse.bt: cells of 0.5 m, needs cells of 0.2 m as"},
           {{"crop", kOctree},
            2,
            "one of --bbox, --polygon and --within, or --heights, is required"},
           {{"crop", kOctree, "--heights=2,1"}, 2, "the first has to be below the second"},
           {{"crop", kOctree, "--within", "lane:1/0/-1,8m"},
            2,
            "--within and --map need each other"},
           {{"crop", kOctree, "--bbox=0,0,1,1", "--tiles", "50"}, 2, "ends in .tiles"},
           {{"export", kOctree}, 2, "ends in none of .pcd .ply .pgm .tif .geojson .gpkg .fgb"}}) {
    Words line = words;
    line.insert(line.end(), {"-o", out});
    const ProgramRun refused = run(line);
    EXPECT_EQ(refused.status, status) << refused.err;
    EXPECT_THAT(refused.err, HasSubstr(text));
    EXPECT_FALSE(std::filesystem::exists(out));
  }
}

TEST_F(OccupancyParts, AreRectanglesInDegreesWhereTheSystemIsKnownElseInMetres) {
  const Json known = Json::parse(bytes_of(made({"export", in_utm()}, "utm.geojson")));
  ASSERT_EQ(known.at("features").size(), 2u);
  EXPECT_FALSE(known.contains("crs"));
  const Json& feature = known.at("features").at(0);
  std::vector<Eigen::Vector2d> corner{{500010.0, 5500020.0}};
  map::to_lon_lat("EPSG:32632", corner);
  const Json& first = feature.at("geometry").at("coordinates").at(0).at(0);
  EXPECT_NEAR(first.at(0).get<double>(), corner[0].x(), 1e-9);
  EXPECT_NEAR(first.at(1).get<double>(), corner[0].y(), 1e-9);
  EXPECT_EQ(feature.at("properties").at("from_z_m"), 100.0);
  EXPECT_EQ(feature.at("properties").at("to_z_m"), 100.5);
  const Json raw = Json::parse(bytes_of(made({"export", kOctree}, "town.geojson")));
  EXPECT_TRUE(raw.at("crs").is_null());
}

TEST_F(OccupancyParts, ComeAsGeoTiffAndFilesOfGeographicSystems) {
  EXPECT_EQ(bytes_of(made({"export", in_utm()}, "utm.tif")).substr(0, 4), std::string("II*\0", 4));
  EXPECT_EQ(bytes_of(made({"export", folder_ / "utm.bt"}, "utm.gpkg")).substr(0, 15),
            "SQLite format 3");
  EXPECT_EQ(bytes_of(made({"export", folder_ / "utm.bt"}, "utm.fgb")).substr(0, 3), "fgb");
}

}  // namespace
}  // namespace roadbed::tests
