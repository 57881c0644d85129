#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/tools/golden.h"

namespace roadbed::tests {
namespace {

TEST(ValidateCommand, PrintsOneLinePerFindingAndASummary) {
  const ProgramRun run = run_roadbed({"validate", golden("validate/gap.xodr")});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out, bytes_of(golden("validate/gap.txt")));
  EXPECT_EQ(run.err, "");
}

TEST(ValidateCommand, FailsOnWarningsWhereAsked) {
  EXPECT_EQ(run_roadbed({"validate", golden("validate/gap.xodr"), "--fail-on", "warning"}).status,
            1);
  EXPECT_EQ(run_roadbed({"validate", golden("validate/gap.xodr"), "--fail-on", "warning",
                         "--max-gap", "0.2"})
                .status,
            0);
}

TEST(ValidateCommand, FailsOnErrorsAndPrintsOneJsonDocument) {
  const ProgramRun run = run_roadbed({"validate", golden("validate/broken.xodr"), "--json"});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.out, bytes_of(golden("validate/broken.json")));
  EXPECT_TRUE(nlohmann::json::accept(run.out));
}

TEST(ValidateCommand, RefusesSeveritiesItDoesNotKnow) {
  EXPECT_EQ(run_roadbed({"validate", golden("validate/gap.xodr"), "--fail-on", "panic"}).status, 2);
}

TEST(ValidateCommand, SaysWhichMapIsMissing) {
  const ProgramRun run = run_roadbed({"validate", "no_such.xodr", "--json"});
  EXPECT_EQ(run.status, 3);
  EXPECT_EQ(run.out, "");
  EXPECT_NE(run.err.find("no_such.xodr"), std::string::npos);
}

TEST(ValidateCommand, FindsNothingButNotesInTheProjectsTown) {
  EXPECT_EQ(run_roadbed({"validate", data_folder() / "town.xodr", "--fail-on", "warning"}).status,
            0);
}

TEST(ValidateCommand, RefusesWhatIsNoMapAtAll) {
  const TemporaryFolder folder;
  for (const auto& [name, bytes] : {std::pair{"empty.xodr", std::string()},
                                    {"not_xml.xodr", std::string("lane,x,y\n1,2,3\n")},
                                    {"other.xml", std::string("<kml><Document/></kml>\n")},
                                    {"zeros.rbm", std::string(4096, '\0')}}) {
    SCOPED_TRACE(name);
    const ProgramRun run = run_roadbed({"validate", folder.write(name, bytes), "--json"});
    EXPECT_EQ(run.status, 3);
    EXPECT_EQ(run.out, "");
    EXPECT_NE(run.err.find(name), std::string::npos);
  }
}

TEST(ValidateCommand, DescribesAMapThatCannotBeRead) {
  const TemporaryFolder folder;
  const std::string town = bytes_of(data_folder() / "town.xodr");
  const std::string file = folder.write("half.xodr", town.substr(0, town.size() / 2));
  const ProgramRun run = run_roadbed({"validate", file, "--json"});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_NE(run.err.find("half.xodr"), std::string::npos);
  const auto findings = nlohmann::json::parse(run.out).at("findings");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].at("rule"), "source.not-well-formed");
  EXPECT_EQ(findings[0].at("asam_rule"), "asam.net:xodr:1.0.0:xml.valid_xml_document");
}

TEST(ValidateCommand, ReadmeHoldsTheTableOfRulesThatItPrints) {
  const ProgramRun run = run_roadbed({"validate", "--rules"});
  EXPECT_EQ(run.status, 0) << run.err;
  const std::string readme = bytes_of(tests_folder().parent_path() / "map/validation/README.md");
  EXPECT_NE(readme.find(run.out), std::string::npos)
      << "put the output of `roadbed validate --rules` into map/validation/README.md";
}

TEST(ValidateCommand, NeedsAMapUnlessItListsRules) {
  EXPECT_EQ(run_roadbed({"validate"}).status, 2);
}

/// All outputs for the golden file with a gap.
struct Outputs {
  Outputs() {
    run = run_roadbed({"validate", golden("validate/gap.xodr"), "--junit", folder / "f.xml",
                       "--sarif", folder / "f.sarif", "--geojson", folder / "f.geojson", "--svg",
                       folder / "f.svg"});
  }
  TemporaryFolder folder;
  ProgramRun run;
};

TEST(ValidateCommand, WritesSarif) {
  // What the schema of SARIF 2.1.0 requires of a log, a run, a rule and a result.
  const Outputs outputs;
  ASSERT_EQ(outputs.run.status, 0) << outputs.run.err;
  const auto log = nlohmann::json::parse(bytes_of(outputs.folder / "f.sarif"));
  EXPECT_EQ(log.at("version"), "2.1.0");
  ASSERT_EQ(log.at("runs").size(), 1u);
  const auto& driver = log["runs"][0].at("tool").at("driver");
  EXPECT_EQ(driver.at("name"), "roadbed");
  std::size_t gaps = 0;
  for (const auto& result : log["runs"][0].at("results")) {
    const std::string level = result.at("level");
    EXPECT_TRUE(level == "note" || level == "warning" || level == "error") << level;
    EXPECT_FALSE(result.at("message").at("text").get<std::string>().empty());
    if (result.contains("ruleIndex")) {
      EXPECT_EQ(driver.at("rules").at(result["ruleIndex"].get<std::size_t>()).at("id"),
                result.at("ruleId"));
    }
    const auto& place = result.at("locations").at(0).at("physicalLocation");
    EXPECT_FALSE(place.at("artifactLocation").at("uri").get<std::string>().empty());
    EXPECT_GE(place.contains("region") ? place["region"].at("startLine").get<int>() : 1, 1);
    if (result.at("ruleId") == "geometry.gap") ++gaps;
  }
  EXPECT_EQ(gaps, 2u);
}

TEST(ValidateCommand, WritesJunitWithATestCasePerRule) {
  const Outputs outputs;
  const std::string text = bytes_of(outputs.folder / "f.xml");
  EXPECT_NE(text.find("<failure message=\"2 found\">"), std::string::npos);
  EXPECT_NE(text.find("name=\"geometry.kink\"/>"), std::string::npos);
  EXPECT_NE(text.find("failures=\""), std::string::npos);
}

TEST(ValidateCommand, DrawsFindingsAndWritesThemAsALayer) {
  const Outputs outputs;
  const auto layer = nlohmann::json::parse(bytes_of(outputs.folder / "f.geojson"));
  ASSERT_FALSE(layer.at("features").empty());
  EXPECT_EQ(layer["features"][0].at("geometry").at("type"), "Point");
  EXPECT_NE(bytes_of(outputs.folder / "f.svg").find("[geometry.gap]</title>"), std::string::npos);
}

TEST(ValidateCommand, KeepsOutputsThatExist) {
  const TemporaryFolder folder;
  const std::string file = folder.write("f.sarif", "mine");
  EXPECT_EQ(run_roadbed({"validate", golden("validate/gap.xodr"), "--sarif", file}).status, 3);
  EXPECT_EQ(bytes_of(file), "mine");
  EXPECT_EQ(
      run_roadbed({"validate", golden("validate/gap.xodr"), "--sarif", file, "--force"}).status, 0);
  EXPECT_NE(bytes_of(file), "mine");
}

}  // namespace
}  // namespace roadbed::tests
