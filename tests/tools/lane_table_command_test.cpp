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
}

}  // namespace
}  // namespace roadbed::tests
