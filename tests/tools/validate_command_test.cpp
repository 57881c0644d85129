#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {
namespace {

std::filesystem::path golden(const std::string& name) {
  return std::filesystem::path(ROADBED_TESTS) / "tools/validate" / name;
}

TEST(ValidateCommand, PrintsOneLinePerFindingAndASummary) {
  const ProgramRun run = run_roadbed({"validate", golden("gap.xodr")});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out, bytes_of(golden("gap.txt")));
  EXPECT_EQ(run.err, "");
}

TEST(ValidateCommand, FailsOnWarningsWhereAsked) {
  EXPECT_EQ(run_roadbed({"validate", golden("gap.xodr"), "--fail-on", "warning"}).status, 1);
  EXPECT_EQ(
      run_roadbed({"validate", golden("gap.xodr"), "--fail-on", "warning", "--max-gap", "0.2"})
          .status,
      0);
}

TEST(ValidateCommand, FailsOnErrorsAndPrintsOneJsonDocument) {
  const ProgramRun run = run_roadbed({"validate", golden("broken.xodr"), "--json"});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.out, bytes_of(golden("broken.json")));
  EXPECT_TRUE(nlohmann::json::accept(run.out));
}

TEST(ValidateCommand, RefusesSeveritiesItDoesNotKnow) {
  EXPECT_EQ(run_roadbed({"validate", golden("gap.xodr"), "--fail-on", "panic"}).status, 2);
}

TEST(ValidateCommand, SaysWhichMapIsMissing) {
  const ProgramRun run = run_roadbed({"validate", "no_such.xodr", "--json"});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.out, "");
  EXPECT_NE(run.err.find("no_such.xodr"), std::string::npos);
}

TEST(ValidateCommand, FindsNothingButNotesInTheProjectsTown) {
  EXPECT_EQ(run_roadbed({"validate", data_folder() / "town.xodr", "--fail-on", "warning"}).status,
            0);
}

}  // namespace
}  // namespace roadbed::tests
