#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/tools/golden.h"

namespace roadbed::tests {
namespace {

TEST(ExportCommand, WritesTheFormatThatTheSuffixNames) {
  const std::vector<std::vector<std::string>> runs = {
      {"two_roads.csv"},
      {"two_roads.geojson", "--layer", "drivable_surface", "--layer", "lanes", "--layer",
       "centrelines"}};
  for (const std::vector<std::string>& options : runs) {
    const TemporaryFolder folder;
    const std::string& name = options.front();
    std::vector<std::string> arguments = {"export", golden("export/two_roads.xodr"), "-o",
                                          folder / name};
    arguments.insert(arguments.end(), options.begin() + 1, options.end());
    const ProgramRun run = run_roadbed(arguments);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(bytes_of(folder / name), bytes_of(golden("export/" + name)));
  }
}

TEST(ExportCommand, WritesTheSamePictureFromTheCompiledMap) {
  const TemporaryFolder folder;
  const std::string compiled = folder / "a.rbm";
  ASSERT_EQ(run_roadbed({"import", golden("export/two_roads.xodr"), "-o", compiled}).status, 0);
  ASSERT_EQ(run_roadbed({"export", golden("export/two_roads.xodr"), "-o", folder / "a.svg"}).status,
            0);
  ASSERT_EQ(run_roadbed({"export", compiled, "-o", folder / "b.svg"}).status, 0);
  EXPECT_EQ(bytes_of(folder / "a.svg"), bytes_of(folder / "b.svg"));
  EXPECT_EQ(bytes_of(folder / "a.svg").substr(0, 5), "<svg ");
}

TEST(ExportCommand, ReplacesAFileOnlyWithForce) {
  const TemporaryFolder folder;
  const std::string file = folder.write("a.csv", "mine");
  EXPECT_EQ(run_roadbed({"export", golden("export/two_roads.xodr"), "-o", file}).status, 3);
  EXPECT_EQ(bytes_of(file), "mine");
  EXPECT_EQ(run_roadbed({"export", golden("export/two_roads.xodr"), "-o", file, "--force"}).status,
            0);
  EXPECT_EQ(bytes_of(file), bytes_of(golden("export/two_roads.csv")));
}

TEST(ExportCommand, LeavesNothingBehindWhenItCannotDoIt) {
  const TemporaryFolder folder;
  const std::string bad = folder.write("bad.xodr", "<OpenDRIVE>");
  const ProgramRun suffix =
      run_roadbed({"export", golden("export/two_roads.xodr"), "-o", folder / "a.txt"});
  EXPECT_EQ(suffix.status, 3);
  EXPECT_NE(suffix.err.find(".xodr, .geojson, .gpkg, .fgb, .svg, .html, .csv"), std::string::npos)
      << suffix.err;
  EXPECT_EQ(run_roadbed({"export", bad, "-o", folder / "a.svg"}).status, 3);
  EXPECT_EQ(
      run_roadbed({"export", golden("export/two_roads.xodr"), "-o", folder / "no/a.svg"}).status,
      3);
  EXPECT_EQ(files_below(folder.path()), std::vector<std::string>{"bad.xodr"});
}

TEST(ExportCommand, WritesTheSameGeoPackageAndFlatGeobufEveryTime) {
  const TemporaryFolder folder;
  for (const std::string suffix : {".gpkg", ".fgb"}) {
    for (const std::string name : {"a", "b"}) {
      const ProgramRun run =
          run_roadbed({"export", golden("export/two_roads.xodr"), "-o", folder / (name + suffix)});
      EXPECT_EQ(run.status, 0) << run.err;
    }
    EXPECT_EQ(bytes_of(folder / ("a" + suffix)), bytes_of(folder / ("b" + suffix)));
  }
  EXPECT_EQ(bytes_of(folder / "a.gpkg").substr(0, 15), "SQLite format 3");
  EXPECT_EQ(bytes_of(folder / "a.fgb").substr(0, 3), "fgb");
}

TEST(ExportCommand, PutsAMapOfUnknownSystemAtItsAnchor) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_roadbed({"export", golden("export/two_roads.xodr"), "-o", folder / "a.geojson", "--layer",
                   "centrelines", "--anchor", "48.0,9.0"});
  ASSERT_EQ(run.status, 0) << run.err;
  const nlohmann::json document = nlohmann::json::parse(bytes_of(folder / "a.geojson"));
  EXPECT_FALSE(document.contains("crs"));
  const auto& first = document.at("features").at(0).at("geometry").at("coordinates").at(0);
  // The lane begins 1050 m east and 2001.75 m north: 111,194 m to a degree of latitude here, the
  // mean of 48° and its surroundings on WGS 84; 74,632 m to one of longitude.
  EXPECT_NEAR(first.at(0).get<double>(), 9.0 + 1050.0 / 74632.0, 2e-5);
  EXPECT_NEAR(first.at(1).get<double>(), 48.0 + 2001.75 / 111194.0, 2e-5);
}

TEST(ExportCommand, NotesASystemThatProjCannotUse) {
  const TemporaryFolder folder;
  std::string bytes = bytes_of(data_folder() / "town.xodr");
  bytes.replace(bytes.find("+lat_0=48.5"), 11, "+lat_0=4..5");
  const std::string broken = folder.write("broken.xodr", bytes);
  for (const char* name : {"a.gpkg", "a.geojson", "a.fgb"}) {
    const ProgramRun run = run_roadbed({"export", broken, "-o", folder / name});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.err.find("note: PROJ cannot use the map's coordinate system"), std::string::npos)
        << run.err;
  }
  const ProgramRun named = run_roadbed(
      {"export", broken, "-o", folder / "b.geojson", "--crs", "+proj=tmerc +lat_0=4..5"});
  EXPECT_EQ(named.status, 3);  // what the user says has to be right
}

TEST(ExportCommand, RefusesAnAnchorWhereTheSystemIsKnown) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_roadbed({"export", golden("export/two_roads.xodr"), "-o", folder / "a.geojson", "--crs",
                   "EPSG:32632", "--anchor", "48.0,9.0"});
  EXPECT_EQ(run.status, 3);
  EXPECT_NE(run.err.find("is known"), std::string::npos) << run.err;
  EXPECT_EQ(run_roadbed({"export", golden("export/two_roads.xodr"), "-o", folder / "a.geojson",
                         "--anchor", "148.0,9.0"})
                .status,
            2);
  EXPECT_TRUE(files_below(folder.path()).empty());
}

TEST(ExportCommand, RefusesMoreLayersThanTheFormatHolds) {
  const TemporaryFolder folder;
  const ProgramRun run = run_roadbed({"export", golden("export/two_roads.xodr"), "-o",
                                      folder / "a.fgb", "--layer", "lanes", "--layer", "roads"});
  EXPECT_EQ(run.status, 3);
  EXPECT_NE(run.err.find("at most 1"), std::string::npos) << run.err;
  EXPECT_TRUE(files_below(folder.path()).empty());
}

TEST(ExportCommand, GivesAnOpenDriveFileBackAsItStands) {
  const TemporaryFolder folder;
  const std::string town = data_folder() / "town.xodr";
  ASSERT_EQ(run_roadbed({"export", town, "-o", folder / "a.xodr"}).status, 0);
  EXPECT_TRUE(bytes_of(folder / "a.xodr") == bytes_of(town));
  ASSERT_EQ(run_roadbed({"export", town, "-o", folder / "b.xodr", "--opendrive", "1.4"}).status, 0);
  EXPECT_NE(bytes_of(folder / "b.xodr").find("revMajor=\"1\" revMinor=\"4\""), std::string::npos);
  EXPECT_EQ(run_roadbed({"validate", folder / "b.xodr"}).status, 0);
}

TEST(ExportCommand, GivesEveryDocumentBackInItsOwnFormat) {
  const TemporaryFolder folder;
  for (const char* name : {"junction.xml", "crossing.osm"}) {
    const std::string source = data_folder() / name;
    const std::string output = folder / name;
    ASSERT_EQ(run_roadbed({"convert", source, output}).status, 0);
    EXPECT_TRUE(bytes_of(output) == bytes_of(source)) << name;
  }
}

nlohmann::json lost_of(const std::vector<std::string>& words) {
  const ProgramRun run = run_roadbed(words);
  EXPECT_EQ(run.status, 0) << run.err;
  const nlohmann::json document = nlohmann::json::parse(run.out);
  nlohmann::json lost = nlohmann::json::object();
  for (const auto& one : document.at("lost")) {
    lost[one.at("what").get<std::string>()] = one.at("count");
  }
  return lost;
}

TEST(ExportCommand, SaysWhatOfItsSourceAnotherVersionHasNot) {
  const TemporaryFolder folder;
  std::string bytes = bytes_of(golden("export/two_roads.xodr"));
  bytes.insert(bytes.find("<planView>"), "<type s=\"0\" type=\"town\"/>");
  bytes.insert(bytes.rfind("</road>"),
               "<userData code=\"a\"/><objects><bridge id=\"b\" s=\"1\" "
               "length=\"2\" type=\"steel\"/></objects>");
  const std::string source = folder.write("a.xodr", bytes);
  const nlohmann::json lost = lost_of(
      {"export", source, "-o", folder / "b.xodr", "--opendrive", "1.4", "--json", "--quiet"});
  EXPECT_EQ(lost.value("road/type", 0), 1) << lost;
  EXPECT_EQ(lost.value("road/userData", 0), 1) << lost;
  EXPECT_EQ(lost.value("objects/bridge", 0), 1) << lost;
}

TEST(ExportCommand, SaysThatNoMapHoldsAScenario) {
  const TemporaryFolder folder;
  std::string bytes = bytes_of(data_folder() / "junction.xml");
  const std::string version = "commonRoadVersion=\"2020a\"";
  bytes.replace(bytes.find(version), version.size(), "commonRoadVersion=\"2018b\"");
  const std::string older = folder.write("older.xml", bytes);
  for (const char* output : {"b.xodr", "b.xml"}) {
    const nlohmann::json lost =
        lost_of({"export", older, "-o", folder / output, "--json", "--quiet"});
    EXPECT_EQ(lost.value("planning problems", 0), 1) << lost;
  }
}

TEST(ExportCommand, SaysHowNearOpenDriveIsAndWhatIsLost) {
  const TemporaryFolder folder;
  const ProgramRun run = run_roadbed(
      {"export", data_folder() / "crossing.osm", "-o", folder / "a.xodr", "--json", "--quiet"});
  ASSERT_EQ(run.status, 0) << run.err;
  const nlohmann::json document = nlohmann::json::parse(run.out);
  EXPECT_EQ(document.at("format"), "OpenDRIVE");
  EXPECT_EQ(document.at("bytes"), bytes_of(folder / "a.xodr").size());
  EXPECT_LE(document.at("largest_error_m").get<double>(), 0.01);
  EXPECT_FALSE(document.at("lost").empty());
  for (const auto& loss : document.at("lost")) EXPECT_GT(loss.at("count").get<int>(), 0) << loss;
}

TEST(ConvertCommand, WritesWhatImportAndExportWriteForEveryFormat) {
  const TemporaryFolder folder;
  const std::string town = data_folder() / "town.xodr";
  for (const char* ending :
       {".rbm", ".geojson", ".gpkg", ".fgb", ".svg", ".csv", ".osm", ".xml", ".xodr"}) {
    SCOPED_TRACE(ending);
    const std::string one = folder / (std::string("one") + ending);
    const std::string two = folder / (std::string("two") + ending);
    const char* command = std::string(ending) == ".rbm" ? "import" : "export";
    ASSERT_EQ(run_roadbed({command, town, "-o", one}).status, 0);
    const ProgramRun run = run_roadbed({"convert", town, two});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(bytes_of(one) == bytes_of(two));
    ASSERT_EQ(run_roadbed({"convert", town, "-o", two}).status, 3) << "it is there";
    ASSERT_EQ(run_roadbed({"convert", town, "-f", "-o", two}).status, 0);
  }
  EXPECT_EQ(run_roadbed({"convert", folder / "one.rbm", folder / "back.osm"}).status, 0);
  EXPECT_TRUE(bytes_of(folder / "back.osm") == bytes_of(folder / "one.osm"));
}

TEST(ConvertCommand, TakesTheOptionsOfExport) {
  const TemporaryFolder folder;
  const std::string map = golden("export/two_roads.xodr");
  const std::vector<std::string> options{"--crs", "unknown", "--anchor", "48.0,9.0"};
  for (const char* command : {"export", "convert"}) {
    std::vector<std::string> words{command, map, "-o", folder / (command + std::string(".osm"))};
    words.insert(words.end(), options.begin(), options.end());
    ASSERT_EQ(run_roadbed(words).status, 0);
  }
  EXPECT_EQ(bytes_of(folder / "export.osm"), bytes_of(folder / "convert.osm"));

  const std::string compiled = folder / "a.rbm";
  ASSERT_EQ(run_roadbed({"convert", map, compiled, "--crs", "EPSG:32632"}).status, 0);
  EXPECT_NE(run_roadbed({"info", compiled}).out.find("EPSG:32632"), std::string::npos);
}

TEST(ConvertCommand, NeedsOneOutputAndOptionsThatItsFormatHas) {
  const TemporaryFolder folder;
  const std::string map = golden("export/two_roads.xodr"), a = folder / "a.rbm",
                    b = folder / "b.rbm";
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {map}, {map, a, "-o", b}, {map, a, "--layer", "lanes"}, {map, a, "--anchor", "48,9"}}) {
    std::vector<std::string> line{"convert"};
    line.insert(line.end(), words.begin(), words.end());
    EXPECT_EQ(run_roadbed(line).status, 2);
  }
  EXPECT_EQ(run_roadbed({"convert", map, folder / "a.txt"}).status, 3);
  EXPECT_TRUE(files_below(folder.path()).empty());
}

}  // namespace
}  // namespace roadbed::tests
