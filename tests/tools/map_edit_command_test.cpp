#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/tools/town.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tests {
namespace {

tools::Json document_of(const ProgramRun& run) {
  return tools::Json::parse(run.out, nullptr, false);
}

TEST(MapClipCommand, OfNothingIsAnAnswerWithAReason) {
  const TemporaryFolder folder;
  const std::string part = folder / "part.xodr";
  const ProgramRun run =
      run_roadbed({"map", "clip", kTown, "--bbox=5000,5000,6000,6000", "-o", part, "--json"});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.err, "roadbed: nothing is left: no road of the map reaches into the region\n");
  EXPECT_EQ(document_of(run)["written"], false);
  EXPECT_TRUE(files_below(folder.path()).empty());
}

TEST(MapClipCommand, NeedsJustOneRegion) {
  const TemporaryFolder folder;
  const std::string part = folder / "part.xodr";
  EXPECT_EQ(run_roadbed({"map", "clip", kTown, "-o", part}).status, 2);
  EXPECT_EQ(run_roadbed({"map", "clip", kTown, "--bbox=1,1,0,0", "-o", part}).status, 2);
  EXPECT_EQ(run_roadbed({"map", "clip", kTown, "--within", "lane:1", "-o", part}).status, 2);
}

TEST(MapEditCommands, WriteNoMapUnderTheNameOfAnotherFormat) {
  const TemporaryFolder folder;
  const std::string osm = folder / "part.osm";
  const std::vector<std::vector<std::string>> commands{{"map", "clip", kTown, "--bbox=0,0,300,300"},
                                                       {"map", "transform", kTown, "--shift=1,0"},
                                                       {"map", "fix", kTown}};
  for (std::vector<std::string> command : commands) {
    command.insert(command.end(), {"-o", osm});
    const ProgramRun run = run_roadbed(command);
    EXPECT_EQ(run.status, 3);
    EXPECT_NE(run.err.find("the map is OpenDRIVE, not Lanelet2"), std::string::npos) << run.err;
    EXPECT_TRUE(files_below(folder.path()).empty());
  }
}

// A lane and what is near it; the same as polygon in longitude and latitude.
TEST(MapClipCommand, TakesTheSurroundingsOfALaneAndPolygons) {
  const TemporaryFolder folder;
  const std::string near = folder / "near.xodr", inside = folder / "inside.xodr";
  EXPECT_EQ(run_roadbed({"map", "clip", kTown, "--within", "lane:1/0/-1,60m", "-o", near}).status,
            0);
  EXPECT_EQ(run_roadbed({"locate", near, "--at", "60,0"}).status, 0);
  // Around the place of x, y = 150, 198 m in the town's own system.
  const std::string polygon = folder.write(
      "polygon.geojson",
      R"({"type":"Polygon","coordinates":[[[9.001,48.501],[9.003,48.501],[9.003,48.503],)"
      R"([9.001,48.503],[9.001,48.501]]]})");
  const ProgramRun run = run_roadbed({"map", "clip", kTown, "--polygon", polygon, "-o", inside});
  EXPECT_EQ(run.status, 0) << run.err;
  const ProgramRun info = run_roadbed({"info", inside, "--json"});
  const auto bounds = document_of(info)["bounds"];
  EXPECT_GT(bounds["min_x_m"].get<double>(), 40.0);
  EXPECT_LT(bounds["max_x_m"].get<double>(), 250.0);
}

TEST(MapTileCommand, GivesTilesThatMergeToTheWhole) {
  const TemporaryFolder folder;
  const std::string tiles = folder / "tiles", whole = folder / "whole.xodr";
  const ProgramRun run = run_roadbed({"map", "tile", kTown, "200", "-o", tiles});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto index = tools::Json::parse(bytes_of(folder / "tiles/tiles.json"));
  std::vector<std::string> words{"map", "merge", "-o", whole};
  for (const auto& tile : index["tiles"]) {
    words.push_back(folder / ("tiles/" + tile["file"].get<std::string>()));
  }
  EXPECT_GT(words.size(), 8u);
  ASSERT_EQ(run_roadbed(words).status, 0);
  const ProgramRun diff = run_roadbed({"map", "diff", kTown, whole});
  EXPECT_EQ(diff.out, "0 changes\n");
}

TEST(MapTileCommand, LeavesNoTileOfAnotherTiling) {
  const TemporaryFolder folder;
  const std::string tiles = folder / "tiles", fresh = folder / "fresh";
  ASSERT_EQ(run_roadbed({"map", "tile", kTown, "300", "-o", tiles}).status, 0);
  folder.write("tiles/notes_1.txt", "mine");
  ASSERT_EQ(run_roadbed({"map", "tile", kTown, "250", "-o", tiles, "--force"}).status, 0);
  ASSERT_EQ(run_roadbed({"map", "tile", kTown, "250", "-o", fresh}).status, 0);
  auto expected = files_below(fresh);
  expected.push_back("notes_1.txt");
  std::ranges::sort(expected);
  EXPECT_EQ(files_below(tiles), expected);
}

TEST(MapMergeCommand, WritesDownWhatGotAnotherId) {
  const TemporaryFolder folder;
  const std::string moved = folder / "moved.xodr", both = folder / "both.xodr",
                    ids = folder / "ids.csv";
  ASSERT_EQ(run_roadbed({"map", "transform", kTown, "--shift=5000,0", "-o", moved}).status, 0);
  const ProgramRun run = run_roadbed({"map", "merge", kTown, moved, "-o", both, "--renamed", ids});
  ASSERT_EQ(run.status, 0) << run.err;
  const std::string rows = bytes_of(ids);
  EXPECT_EQ(rows.substr(0, rows.find('\n')), "file,kind,from,to");
  EXPECT_NE(rows.find(",road,1,"), std::string::npos) << rows;
  const auto lanes = [](const std::string& map) {
    return document_of(run_roadbed({"info", map, "--json"}))["lanes"].get<int>();
  };
  EXPECT_EQ(lanes(both), 2 * lanes(kTown));
}

TEST(MapMergeCommand, RefusesOtherSystems) {
  const TemporaryFolder folder;
  const std::string utm = folder / "utm.xodr", both = folder / "both.xodr";
  ASSERT_EQ(run_roadbed({"map", "transform", kTown, "--to", "EPSG:32632", "-o", utm}).status, 0);
  const ProgramRun run = run_roadbed({"map", "merge", kTown, utm, "-o", both});
  EXPECT_EQ(run.status, 3);
  EXPECT_NE(run.err.find("--same-system"), std::string::npos) << run.err;
}

TEST(MapTransformCommand, RefusesShiftsThatAreNone) {
  const TemporaryFolder folder;
  const std::string moved = folder / "moved.xodr";
  for (const char* shift : {"--shift=nan,0", "--shift=0,inf", "--shift=1"}) {
    EXPECT_EQ(run_roadbed({"map", "transform", kTown, shift, "-o", moved}).status, 2) << shift;
  }
  EXPECT_TRUE(files_below(folder.path()).empty());
}

TEST(MapTransformCommand, AlignsToPairs) {
  const TemporaryFolder folder;
  const std::string moved = folder / "moved.xodr";
  const std::string pairs = folder.write("pairs.csv",
                                         "from_x_m,from_y_m,to_x_m,to_y_m\n0,0,10,20\n"
                                         "100,0,10,120\n0,50,-40,20\n");
  const ProgramRun run =
      run_roadbed({"map", "transform", kTown, "--align", pairs, "-o", moved, "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("turned by 1.570796327 rad and shifted by 10.0000,20.0000 m"),
            std::string::npos)
      << run.out;
}

// A slope of points under a street of the town, and one far away.
TEST(MapTransformCommand, TakesHeightsFromClouds) {
  const TemporaryFolder folder;
  const auto slope = [&](const char* name, double x_m) {
    std::string points;
    for (int i = 0; i < 500; ++i) {
      for (int k = -40; k <= 40; ++k) {
        points += std::to_string(x_m + 0.2 * i) + " " + std::to_string(200.0 + 0.2 * k) + " " +
                  std::to_string(7.0 + 0.05 * (x_m + 0.2 * i)) + "\n";
      }
    }
    return folder.write(name, points);
  };
  const std::string under = slope("under.xyz", 110.0), away = slope("away.xyz", 90'000.0);
  const std::string high = folder / "high.xodr", lanes = folder / "lanes.csv";
  const ProgramRun run = run_roadbed({"map", "transform", kTown, "--elevation", under,
                                      "--elevation", away, "--lift", "1", "-o", high, "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_GT(document_of(run)["counts"]["stations on the ground"].get<int>(), 20);
  const ProgramRun place = run_roadbed({"locate", high, "--at", "150,198.3", "--json"});
  ASSERT_EQ(place.status, 0) << place.err;
  ASSERT_EQ(run_roadbed({"export", high, "-o", lanes}).status, 0);
  std::istringstream rows(bytes_of(lanes));
  std::string row;
  std::getline(rows, row);
  std::size_t on_slope = 0;
  while (std::getline(rows, row)) {
    std::vector<std::string> cells;
    std::istringstream line(row);
    for (std::string cell; std::getline(line, cell, ',');) cells.push_back(cell);
    const double x = std::stod(cells[6]), y = std::stod(cells[7]), z = std::stod(cells[8]);
    if (x < 114.0 || x > 206.0 || std::abs(y - 200.0) > 5.0 || cells[3] != "driving") continue;
    EXPECT_NEAR(z, 8.0 + 0.05 * x, 0.01) << row;
    ++on_slope;
  }
  EXPECT_GT(on_slope, 10u);
}

TEST(MapTransformCommand, RefusesGroundThatIsElsewhere) {
  const TemporaryFolder folder;
  const std::string cloud = folder.write("far.xyz", "90000 0 1\n90001 0 1\n90000 1 1\n");
  const ProgramRun run =
      run_roadbed({"map", "transform", kTown, "--elevation", cloud, "-o", folder / "high.xodr"});
  EXPECT_EQ(run.status, 3);
  EXPECT_NE(run.err.find("ground at no point of the map"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("90000,0 to 90001,1"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace roadbed::tests
