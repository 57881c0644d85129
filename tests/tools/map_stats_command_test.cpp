#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/tools/town.h"

namespace roadbed::tests {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

std::set<std::string> distinct_lines(const std::string& text) {
  std::set<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.insert(line);
  return lines;
}

TEST(MapStatsCommand, SaysTheSameInEveryForm) {
  const Json document = Json::parse(run_roadbed({"map", "stats", kTown, "--json"}).out);
  EXPECT_EQ(document["roadbed_map_stats"], 1);
  const std::string csv = run_roadbed({"map", "stats", kTown, "--csv"}).out;
  std::size_t rows = 2;  // the head and the sum
  for (const char* by :
       {"by_type", "by_speed_kmh", "by_width_m", "by_slope_percent", "by_curvature_per_m"}) {
    ASSERT_TRUE(document.contains(by)) << by;
    rows += document[by].size();
  }
  EXPECT_EQ(distinct_lines(csv).size(), rows);
  EXPECT_THAT(csv, HasSubstr("\nspeed_kmh,"));
  const std::string text = run_roadbed({"map", "stats", kTown}).out;
  EXPECT_THAT(text, HasSubstr("by speed [km/h]"));
}

TEST(MapStatsCommand, CountsOnlyWhatIsAskedFor) {
  const Json document =
      Json::parse(run_roadbed({"map", "stats", kTown, "--json", "--where", "type = driving"}).out);
  ASSERT_EQ(document["by_type"].size(), 1u);
  EXPECT_EQ(document["by_type"][0]["lanes"], document["lanes"]);
  EXPECT_EQ(run_roadbed({"map", "stats", kTown, "--where", "typ = driving"}).status, 2);
}

TEST(MapQueryCommand, PrintsNamesARowOfFieldsOrTheLanes) {
  const std::string question = "type = driving and speed > 40";
  const ProgramRun names = run_roadbed({"map", "query", kTown, question});
  EXPECT_EQ(names.status, 0) << names.err;
  const std::set<std::string> lanes = distinct_lines(names.out);
  EXPECT_GT(lanes.size(), 2u);
  const ProgramRun csv = run_roadbed({"map", "query", kTown, question, "--format", "csv"});
  EXPECT_EQ(distinct_lines(csv.out).size(), lanes.size() + 1);
  EXPECT_THAT(csv.out, testing::StartsWith("lane,id,road,section,"));
  const TemporaryFolder folder;
  const std::string file = folder / "lanes.geojson";
  EXPECT_EQ(run_roadbed({"map", "query", kTown, question, "-o", file}).status, 0);
  const Json geojson = Json::parse(bytes_of(file));
  std::set<std::string> drawn;
  for (const Json& feature : geojson["features"]) {
    drawn.insert(feature["properties"]["lane"].get<std::string>());
  }
  EXPECT_EQ(drawn, lanes);
}

TEST(MapQueryCommand, SaysNoWhereNoLaneFitsAndWhatIsWrongWithAQuestion) {
  const ProgramRun none = run_roadbed({"map", "query", kTown, "speed > 4000"});
  EXPECT_EQ(none.status, 1);
  EXPECT_EQ(none.out, "");
  const ProgramRun wrong = run_roadbed({"map", "query", kTown, "speed >> 40"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("at character 8"));
}

}  // namespace
}  // namespace roadbed::tests
