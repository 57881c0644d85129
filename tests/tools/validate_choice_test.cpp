// Which rules `validate` asks, what it does not tell, and against what it compares.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "roadbed/tests/support/autoware_town.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {
namespace {

using nlohmann::json;

std::filesystem::path gap_file() { return tests_folder() / "tools/validate/gap.xodr"; }

/// The program's findings, with other arguments behind those of `validate FILE --json`.
json findings_of(const std::filesystem::path& file, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"validate", file, "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramRun run = run_roadbed(arguments);
  EXPECT_TRUE(run.status == 0 || run.status == 1) << run.err;
  return json::parse(run.out);
}

std::set<std::string> rules_of(const json& document) {
  std::set<std::string> rules;
  for (const json& finding : document.at("findings")) rules.insert(finding.at("rule"));
  return rules;
}

/// A map for Autoware with one road whose location is not known to it.
std::string town_text() {
  MadeVectorMap town = autoware_town();
  town.relations[100].tags["location"] = "rural";
  return town.text();
}

TEST(ValidateChoice, OfAutowareGivesIssuesToItsFindings) {
  const TemporaryFolder folder;
  const std::string file = folder.write("town.osm", town_text());
  std::size_t issues = 0;
  const json document = findings_of(file, {"--profile", "autoware"});
  for (const json& finding : document.at("findings")) {
    ASSERT_TRUE(finding.contains("autoware_issue"));
    if (finding["autoware_issue"].is_null()) continue;
    ++issues;
    EXPECT_EQ(finding["autoware_issue"], "Lane.RoadLaneletAttribute-001");
    EXPECT_EQ(finding["rule"], "autoware.lane.road-attributes");
    EXPECT_EQ(finding["element"], "lane 100");
    EXPECT_EQ(finding["x_m"], 0.0);
    EXPECT_EQ(finding["y_m"], 3.5);
  }
  EXPECT_EQ(issues, 1u);
  for (const std::string& rule : rules_of(findings_of(file))) {
    EXPECT_FALSE(rule.starts_with("autoware.")) << rule;
  }
}

TEST(ValidateChoice, IsInAllOutputs) {
  const TemporaryFolder folder;
  const std::string file = folder.write("town.osm", town_text());
  const std::string issue = "Lane.RoadLaneletAttribute-001";
  run_roadbed({"validate", file, "--profile", "autoware", "--junit", folder / "f.xml", "--sarif",
               folder / "f.sarif", "--geojson", folder / "f.geojson"});
  for (const char* name : {"f.xml", "f.sarif", "f.geojson"}) {
    EXPECT_NE(bytes_of(folder / name).find(issue), std::string::npos) << name;
  }
  const ProgramRun text = run_roadbed({"validate", file, "--profile", "autoware"});
  EXPECT_NE(text.out.find(issue), std::string::npos);
}

TEST(ValidateChoice, TakesAndLeavesRulesByPattern) {
  EXPECT_EQ(rules_of(findings_of(gap_file(), {"--only", "geometry.*"})),
            std::set<std::string>{"geometry.gap"});
  EXPECT_FALSE(
      rules_of(findings_of(gap_file(), {"--disable", "link.*"})).contains("link.dead-end"));
  const json document = findings_of(gap_file(), {"--profile", "asam"});
  for (const json& finding : document.at("findings")) {
    EXPECT_FALSE(finding.at("asam_rule").is_null()) << finding;
  }
}

TEST(ValidateChoice, TakesOneValueForEachUseOrSeveralWithCommas) {
  const ProgramRun before =
      run_roadbed({"validate", "--only", "geometry.gap", gap_file(), "--json"});
  EXPECT_EQ(rules_of(json::parse(before.out)), std::set<std::string>{"geometry.gap"});
  EXPECT_EQ(rules_of(findings_of(gap_file(), {"--only", "crs.*,geometry.gap"})),
            rules_of(findings_of(gap_file(), {"--only", "crs.*", "--only", "geometry.gap"})));
  EXPECT_EQ(run_roadbed({"validate", "--only", "geometry.gap", "--severity",
                         "geometry.gap=error,geometry.kink=info", gap_file()})
                .status,
            1);
}

TEST(ValidateChoice, GivesFindingsAnotherSeverity) {
  EXPECT_EQ(run_roadbed({"validate", gap_file(), "--severity", "geometry.gap=error"}).status, 1);
  EXPECT_EQ(run_roadbed({"validate", gap_file(), "--fail-on", "warning", "--severity",
                         "geometry.gap=info", "--severity", "link.contact-point-off=off"})
                .status,
            0);
}

TEST(ValidateChoice, RefusesNamesThatNoRuleHas) {
  for (const auto& [option, value] : {std::pair{"--only", "geometry.gpa"},
                                      {"--disable", "Lane.BorderShring-001"},
                                      {"--severity", "geometry.gap=grave"},
                                      {"--severity", "geometry.gap"},
                                      {"--profile", "sumo"}}) {
    const ProgramRun run = run_roadbed({"validate", gap_file(), option, value});
    EXPECT_EQ(run.status, 2) << option << ' ' << value;
    EXPECT_NE(run.err, "");
  }
}

TEST(ValidateBaseline, LetsKnownFindingsPassAndSaysWhatIsNewAndGone) {
  const TemporaryFolder folder;
  const std::string map = bytes_of(gap_file());
  const std::string old_file = folder.write("map.xodr", map), known = folder / "known.json";
  EXPECT_EQ(
      run_roadbed({"validate", old_file, "--disable", "geometry.gap", "--write-baseline", known})
          .status,
      0);
  const ProgramRun again = run_roadbed({"validate", old_file, "--disable", "geometry.gap",
                                        "--baseline", known, "--fail-on", "info"});
  EXPECT_EQ(again.status, 0) << again.out;
  EXPECT_EQ(again.out, "0 errors, 0 warnings, 0 notes that are new, 7 known, 0 gone\n");

  const ProgramRun more =
      run_roadbed({"validate", old_file, "--baseline", known, "--fail-on", "warning"});
  EXPECT_EQ(more.status, 1);
  EXPECT_NE(more.out.find("2 warnings, 0 notes that are new, 7 known, 0 gone"), std::string::npos)
      << more.out;

  const ProgramRun less =
      run_roadbed({"validate", old_file, "--disable", "geometry.gap", "--disable", "crs.missing",
                   "--baseline", known, "--fail-on", "info"});
  EXPECT_EQ(less.status, 0);
  EXPECT_NE(less.out.find("6 known, 0 gone, 1 not looked for"), std::string::npos) << less.out;

  const std::string other = folder.write(
      "other.json",
      R"({"roadbed_findings":1,"findings":[{"rule":"geometry.gap","element":"lane 9/0/1"}]})");
  EXPECT_NE(run_roadbed({"validate", old_file, "--baseline", other})
                .out.find("gone: lane 9/0/1 [geometry.gap]"),
            std::string::npos);
}

TEST(ValidateBaseline, AFindingThatHasBecomeGraverIsNew) {
  const TemporaryFolder folder;
  const std::string known = folder / "known.json";
  run_roadbed({"validate", gap_file(), "--write-baseline", known});
  const ProgramRun same = run_roadbed({"validate", gap_file(), "--baseline", known, "--severity",
                                       "geometry.gap=error", "--fail-on", "info"});
  EXPECT_EQ(same.status, 0) << same.out;
  std::string text = bytes_of(known);
  const std::size_t gap = text.find("geometry.gap"), grave = text.find("\"warning\"", gap);
  ASSERT_NE(grave, std::string::npos);
  folder.write("known.json", text.replace(grave, 9, "\"info\""));
  const ProgramRun graver =
      run_roadbed({"validate", gap_file(), "--baseline", known, "--fail-on", "warning"});
  EXPECT_EQ(graver.status, 1) << graver.out;
  EXPECT_NE(graver.out.find("1 warnings, 0 notes that are new"), std::string::npos) << graver.out;
}

TEST(ValidateBaseline, MarksFindingsInJsonAndSarif) {
  const TemporaryFolder folder;
  const std::string known = folder / "known.json", sarif = folder / "f.sarif";
  run_roadbed({"validate", gap_file(), "--only", "geometry.gap", "--write-baseline", known});
  run_roadbed({"validate", gap_file(), "--baseline", known, "--sarif", sarif});
  const json document = findings_of(gap_file(), {"--baseline", known});
  EXPECT_TRUE(document.at("gone").empty());
  for (const json& finding : document.at("findings")) {
    EXPECT_EQ(finding.at("known"), finding.at("rule") == "geometry.gap");
  }
  const json log = json::parse(bytes_of(sarif));
  for (const json& result : log["runs"][0]["results"]) {
    EXPECT_EQ(result.at("baselineState"),
              result.at("ruleId") == "geometry.gap" ? "unchanged" : "new");
  }
}

TEST(ValidateBaseline, RefusesWhatIsNone) {
  const TemporaryFolder folder;
  for (const char* text : {"", "[]", "{}", R"({"findings":[{}]})", R"({"findings":[{"rule":1}]})",
                           R"({"roadbed_findings":99,"findings":[]})"}) {
    const std::string file = folder.write("known.json", text);
    const ProgramRun run = run_roadbed({"validate", gap_file(), "--baseline", file});
    EXPECT_EQ(run.status, 3) << text;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_NE(run.err.find("known.json"), std::string::npos) << run.err;
  }
  EXPECT_EQ(run_roadbed({"validate", gap_file(), "--baseline", "no_such.json"}).status, 3);
}

TEST(ValidateSuppression, OfUserDataHoldsForItsElement) {
  const TemporaryFolder folder;
  const std::string map = bytes_of(gap_file());
  const std::string data =
      R"(<userData code="roadbed:suppress" value="geometry.*, link.dead-end"/>)";
  const auto with_data_behind = [&](const std::string& place) {
    std::string text = map;
    const std::size_t at = text.find(place);
    EXPECT_NE(at, std::string::npos) << place;
    return folder.write("map.xodr", text.insert(at, data));
  };
  // In road 1: one of two gaps, and of two dead ends, is a lane of it.
  const json of_road = findings_of(with_data_behind("</road>"));
  EXPECT_EQ(of_road.at("suppressed").size(), 2u);
  for (const json& finding : of_road["suppressed"]) {
    EXPECT_TRUE(finding.at("element").get<std::string>().starts_with("lane 1/")) << finding;
  }
  // In the root: all of them.
  const json of_map = findings_of(with_data_behind("</OpenDRIVE>"));
  EXPECT_EQ(of_map.at("suppressed").size(), 4u);
  EXPECT_FALSE(rules_of(of_map).contains("geometry.gap"));
}

TEST(ValidateSuppression, OfTagsHoldsForItsElement) {
  const TemporaryFolder folder;
  MadeVectorMap town = autoware_town();
  for (const MadeVectorMap::Id id : {100, 101}) {
    town.relations[id].tags["location"] = "rural";
  }
  town.relations[100].tags["roadbed:suppress"] = "Lane.RoadLaneletAttribute-001";
  const json document =
      findings_of(folder.write("town.osm", town.text()), {"--only", "Lane.RoadLaneletAttribute"});
  ASSERT_EQ(document.at("findings").size(), 1u);
  EXPECT_EQ(document["findings"][0].at("element"), "lane 101");
  ASSERT_EQ(document.at("suppressed").size(), 1u);
  EXPECT_EQ(document["suppressed"][0].at("element"), "lane 100");
}

TEST(ValidateText, SaysMuchOfOneKindInALine) {
  const TemporaryFolder folder;
  MadeVectorMap town = autoware_town();
  for (auto& [id, relation] : town.relations) {
    if (relation.tags["subtype"] == "road") relation.tags["location"] = "rural";
  }
  const std::string file = folder.write("town.osm", town.text());
  const std::vector<std::string> few = {"validate", file, "--only", "Lane.RoadLaneletAttribute"};
  const ProgramRun run = run_roadbed(few);
  EXPECT_NE(run.out.find("autoware.lane.road-attributes: 18 errors: lane 100 (line "),
            std::string::npos)
      << run.out;
  EXPECT_NE(run.out.find("and 15 more"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("and 13 more of autoware.lane.road-attributes; --all"), std::string::npos)
      << run.out;
  std::vector<std::string> all = few;
  all.push_back("--all");
  const std::string text = run_roadbed(all).out;
  EXPECT_EQ(text.find("--all"), std::string::npos);
  EXPECT_NE(text.find("lane 182: "), std::string::npos) << text;
}

TEST(ValidateCompiledMap, SaysWhatItsSourceWouldAndOnWhichLine) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "compiled");
  const std::string source = folder.write("gap.xodr", bytes_of(gap_file()));
  const std::string beside = folder / "gap.rbm", elsewhere = folder / "compiled/gap.rbm";
  ASSERT_EQ(run_roadbed({"import", source, "-o", beside}).status, 0);
  ASSERT_EQ(run_roadbed({"import", source, "-o", elsewhere}).status, 0);
  const ProgramRun of_source = run_roadbed({"validate", source, "--json"});
  for (const std::vector<std::string>& of_compiled :
       {std::vector<std::string>{"validate", beside, "--json"},
        {"validate", elsewhere, "--source", source, "--json"}}) {
    const ProgramRun run = run_roadbed(of_compiled);
    EXPECT_EQ(run.out, of_source.out);
    EXPECT_EQ(run.err, "");
  }

  const ProgramRun alone = run_roadbed({"validate", elsewhere, "--json"});
  EXPECT_NE(alone.err.find("gap.rbm was made from is not beside it"), std::string::npos)
      << alone.err;
  EXPECT_TRUE(rules_of(json::parse(alone.out)).contains("geometry.gap"));
}

TEST(ValidateCompiledMap, IsNotJudgedByTheTextOfAnotherFile) {
  const TemporaryFolder folder;
  const std::string source = folder.write("gap.xodr", bytes_of(gap_file()));
  const std::string compiled = folder / "gap.rbm";
  ASSERT_EQ(run_roadbed({"import", source, "-o", compiled}).status, 0);
  folder.write("gap.xodr", bytes_of(gap_file()) + "<!-- changed -->");
  EXPECT_NE(run_roadbed({"validate", compiled}).err.find("is not beside it"), std::string::npos);
  const ProgramRun named = run_roadbed({"validate", compiled, "--source", source});
  EXPECT_EQ(named.status, 3);
  EXPECT_NE(named.err.find("gap.xodr: not what "), std::string::npos) << named.err;
  const ProgramRun of_text = run_roadbed({"validate", source, "--source", source});
  EXPECT_EQ(of_text.status, 3);
  EXPECT_NE(of_text.err.find("leave out --source"), std::string::npos) << of_text.err;
}

TEST(ValidateCompiledMap, IsTheSameWhateverItsSourceIsCalledAndWhereverItLies) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "elsewhere");
  const std::string one = folder.write("one.xodr", bytes_of(gap_file()));
  const std::string two = folder.write("elsewhere/two.xodr", bytes_of(gap_file()));
  ASSERT_EQ(run_roadbed({"import", one, "-o", folder / "one.rbm"}).status, 0);
  ASSERT_EQ(run_roadbed({"import", two, "-o", folder / "two.rbm"}).status, 0);
  EXPECT_EQ(bytes_of(folder / "one.rbm"), bytes_of(folder / "two.rbm"));
}

}  // namespace
}  // namespace roadbed::tests
