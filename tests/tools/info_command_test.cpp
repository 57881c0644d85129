#include <gtest/gtest.h>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/tools/golden.h"

namespace roadbed::tests {
namespace {

TEST(InfoCommand, PrintsCountsLengthsAreasAndBounds) {
  const ProgramRun run = run_roadbed({"info", golden("info/two_roads.xodr")});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out, bytes_of(golden("info/two_roads.txt")));
}

TEST(InfoCommand, PrintsTheSameAsJson) {
  const ProgramRun run = run_roadbed({"info", golden("info/two_roads.xodr"), "--json"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out, bytes_of(golden("info/two_roads.json")));
}

TEST(InfoCommand, SaysTheSameOfACompiledMap) {
  const TemporaryFolder folder;
  const std::string compiled = folder / "two_roads.rbm";
  ASSERT_EQ(run_roadbed({"import", golden("info/two_roads.xodr"), "-o", compiled}).status, 0);
  EXPECT_EQ(run_roadbed({"info", compiled}).out, bytes_of(golden("info/two_roads.txt")));
}

TEST(InfoCommand, CountsWhatAScenarioHoldsBesidesItsMap) {
  const ProgramRun run = run_roadbed({"info", data_folder() / "junction.xml"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("1 static, 2 dynamic, 0 other obstacles, 3.0 s recorded, 1 planning"),
            std::string::npos)
      << run.out;
}

TEST(InfoCommand, MeasuresRoadAreasWithoutLanes) {
  const ProgramRun run = run_roadbed({"info", data_folder() / "surface.geojson"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("road areas            2, 2168.5 m"), std::string::npos) << run.out;
}

TEST(InfoCommand, VerifiesACompiledMapAndRefusesADamagedOne) {
  const TemporaryFolder folder;
  const std::string compiled = folder / "two_roads.rbm";
  ASSERT_EQ(run_roadbed({"import", golden("info/two_roads.xodr"), "-o", compiled}).status, 0);
  const ProgramRun whole = run_roadbed({"info", compiled, "--verify"});
  EXPECT_EQ(whole.status, 0) << whole.err;
  EXPECT_NE(whole.out.find("verified"), std::string::npos);
  std::string bytes = bytes_of(compiled);
  bytes.back() = static_cast<char>(~bytes.back());
  const ProgramRun damaged = run_roadbed({"info", folder.write("damaged.rbm", bytes), "--verify"});
  EXPECT_EQ(damaged.status, 3);
  EXPECT_NE(damaged.err.find("checksum"), std::string::npos) << damaged.err;
}

TEST(InfoCommand, SaysWhichMapIsMissing) {
  const ProgramRun run = run_roadbed({"info", "no_such.xodr"});
  EXPECT_EQ(run.status, 3);
  EXPECT_EQ(run.out, "");
  EXPECT_NE(run.err.find("no_such.xodr"), std::string::npos);
}

}  // namespace
}  // namespace roadbed::tests
