#include <gtest/gtest.h>

#include <filesystem>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {
namespace {

std::string map_of(const std::string& name) {
  return (tests_folder() / "tools/info" / name).string();
}

TEST(MapDiffCommand, FindsNoChangeBetweenAMapAndItsCompiledForm) {
  const TemporaryFolder folder;
  const std::string compiled = folder / "two_roads.rbm";
  ASSERT_EQ(run_roadbed({"import", map_of("two_roads.xodr"), "-o", compiled}).status, 0);
  const ProgramRun run = run_roadbed({"map", "diff", map_of("two_roads.xodr"), compiled});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out, "0 changes\n");
}

TEST(MapDiffCommand, PrintsOneDocumentAndFailsWhereMapsDiffer) {
  const TemporaryFolder folder;
  std::string bytes = bytes_of(map_of("two_roads.xodr"));
  const std::size_t type = bytes.find("\"driving\"");
  ASSERT_NE(type, std::string::npos);
  bytes.replace(type, 9, "\"parking\"");
  const std::string changed = folder.write("changed.xodr", bytes);
  const ProgramRun run = run_roadbed({"map", "diff", map_of("two_roads.xodr"), changed, "--json"});
  EXPECT_EQ(run.status, 1) << run.err;
  EXPECT_NE(run.out.find("\"equal\": false"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("\"type\""), std::string::npos) << run.out;
}

}  // namespace
}  // namespace roadbed::tests
