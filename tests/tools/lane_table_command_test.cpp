#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {
namespace {

using Json = nlohmann::json;

TEST(ImportCommand, ReadsLanesOfSomeonesOwnByTheirColumns) {
  const TemporaryFolder folder;
  const std::string lanes = data_folder() / "lanes.geojson", compiled = folder / "lanes.rbm";
  EXPECT_EQ(run_roadbed({"import", lanes, "--columns", data_folder() / "lanes_columns.json", "-o",
                         compiled})
                .status,
            0);
  const ProgramRun route =
      run_roadbed({"route", compiled, "--from", "lane:east", "--to", "lane:north", "--json"});
  EXPECT_EQ(Json::parse(route.out)["lanes"].size(), 3u) << route.out;
  const ProgramRun none =
      run_roadbed({"import", lanes, "--columns", folder / "none.json", "-o", folder / "other.rbm"});
  EXPECT_EQ(none.status, 3);
  // No rule looks at the text of a table: that it is not there is nothing to say.
  const ProgramRun judged = run_roadbed({"validate", compiled});
  EXPECT_EQ(judged.err, "");
  const ProgramRun named = run_roadbed({"validate", compiled, "--source", lanes});
  EXPECT_EQ(named.status, 3);
  EXPECT_NE(named.err.find("no rule looks at"), std::string::npos) << named.err;
}

}  // namespace
}  // namespace roadbed::tests
