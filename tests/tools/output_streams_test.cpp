// Outputs to standard output, named "-": the bytes of the file, and nothing else.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {
namespace {

using testing::HasSubstr;

/// A command with its output; "OUT" stands for it, `suffix` for what it is.
struct Writing {
  std::vector<std::string> words;
  std::string suffix;
  bool needs_format = true;
};

std::vector<Writing> writings() {
  const std::string town = data_folder() / "town.xodr", from = "lane:1/0/-1@10",
                    to = "lane:7/0/1@35";
  const std::vector<std::string> route{"route", town, "--from", from, "--to", to, "-o", "OUT"};
  const std::vector<std::string> reach{"reach",    town,  "--from", from,
                                       "--within", "60s", "-o",     "OUT"};
  const std::vector<std::string> octree{
      "occupancy", "build", data_folder() / "scans/scan_00.pcd", "--resolution", "0.4",
      "-o",        "OUT"};
  std::vector<Writing> all{
      {{"import", town, "-o", "OUT"}, ".rbm", false},
      {{"reference", town, "--from", from, "--to", to, "-o", "OUT"}, ".csv", false},
      {{"jobs", "import", town, "-o", "OUT"}, ".jsonl", false}};
  for (const char* suffix : {".geojson", ".gpkg", ".fgb", ".svg", ".csv", ".osm", ".xml"}) {
    all.push_back({{"export", town, "-o", "OUT"}, suffix});
  }
  for (const char* suffix : {".geojson", ".csv", ".svg"}) {
    all.push_back({route, suffix});
    all.push_back({reach, suffix});
  }
  for (const char* suffix : {".bt", ".ot"}) all.push_back({octree, suffix});
  return all;
}

std::vector<std::string> with_output(std::vector<std::string> words, const std::string& output) {
  for (std::string& word : words) {
    if (word == "OUT") word = output;
  }
  return words;
}

TEST(OutputStreams, HoldTheBytesOfTheFileAndNothingElse) {
  for (const Writing& writing : writings()) {
    SCOPED_TRACE(testing::PrintToString(writing.words) + writing.suffix);
    const TemporaryFolder folder;
    const std::string file = folder / ("out" + writing.suffix);
    ASSERT_EQ(run_roadbed(with_output(writing.words, file)).status, 0);
    std::vector<std::string> words = with_output(writing.words, "-");
    if (writing.needs_format) {
      const ProgramRun unsaid = run_roadbed(words);
      EXPECT_EQ(unsaid.status, 2);
      EXPECT_THAT(unsaid.err, HasSubstr("--format"));
      words.insert(words.end(), {"--format", writing.suffix.substr(1)});
    }
    const ProgramRun run = run_roadbed(words);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(run.out == bytes_of(file)) << run.out.size();
  }
}

TEST(OutputStreams, AreNotSharedWithAnAnswer) {
  const std::string town = data_folder() / "town.xodr";
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"import", town, "-o", "-", "--json"},
                                             {"reach", town, "--from", "lane:1/0/-1@10", "--within",
                                              "60s", "-o", "-", "--format", "csv", "--json"}}) {
    const ProgramRun run = run_roadbed(words);
    EXPECT_EQ(run.status, 2);
    EXPECT_THAT(run.err, HasSubstr("--json and -o -"));
    EXPECT_EQ(run.out, "");
  }
}

TEST(OutputStreams, FormatStandsInPlaceOfASuffix) {
  const TemporaryFolder folder;
  const std::string town = data_folder() / "town.xodr";
  const std::string named = folder / "named.csv", said = folder / "said";
  ASSERT_EQ(run_roadbed({"export", town, "-o", named}).status, 0);
  ASSERT_EQ(run_roadbed({"export", town, "-o", said, "--format", "csv"}).status, 0);
  EXPECT_TRUE(bytes_of(named) == bytes_of(said));
}

TEST(OutputStreams, GoFromOneCommandToTheNext) {
  const TemporaryFolder folder;
  const std::string town = data_folder() / "town.xodr";
  const std::string map = folder.write("map", run_roadbed({"import", town, "-o", "-"}).out);
  EXPECT_EQ(run_roadbed_reading(map, {"info", "-", "--json"}).out,
            run_roadbed({"info", town, "--json"}).out);
}

}  // namespace
}  // namespace roadbed::tests
