#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

/// The town, of which a lane has forgotten its predecessor.
std::string faulty_town() {
  std::string text = bytes_of(data_folder() / "town.xodr");
  const std::size_t at = text.find("<predecessor id=");
  return text.erase(at, text.find("/>", at) + 2 - at);
}

TEST(MapFixCommand, WritesAndSaysEveryChange) {
  const TemporaryFolder folder;
  const std::string faulty = folder.write("faulty.xodr", faulty_town());
  const std::string mended = folder / "mended.xodr";
  const ProgramRun said = run_roadbed({"map", "fix", faulty});
  EXPECT_EQ(said.status, 0) << said.err;
  EXPECT_THAT(said.out, HasSubstr("(link.lane-one-sided)"));
  const ProgramRun run = run_roadbed({"map", "fix", faulty, "-o", mended, "--json"});
  EXPECT_EQ(run.status, 0) << run.err;
  const Json document = Json::parse(run.out);
  EXPECT_EQ(document["roadbed_map_fix"], 1);
  EXPECT_GE(document["repairs"].size(), 1u);
  EXPECT_LT(document["after"]["warnings"], document["before"]["warnings"]);
  EXPECT_EQ(run_roadbed({"map", "diff", data_folder() / "town.xodr", mended}).out, "0 changes\n");
  EXPECT_EQ(run_roadbed({"map", "fix", faulty, "-o", mended}).status, 3);
}

TEST(MapFixCommand, RefusesWhatItCannotMend) {
  const ProgramRun run = run_roadbed({"map", "fix", data_folder() / "surface.geojson"});
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, HasSubstr("GeoJSON, which is not mended"));
}

}  // namespace
}  // namespace roadbed::tests
