#include <gtest/gtest.h>

#include <filesystem>

#include "roadbed/tests/support/program_run.h"

namespace roadbed::tests {
namespace {

std::filesystem::path golden(const std::string& name) {
  return std::filesystem::path(ROADBED_TESTS) / "tools/export" / name;
}

TEST(ExportCommand, WritesTheFormatThatTheSuffixNames) {
  for (const std::string name : {"two_roads.csv", "two_roads.geojson"}) {
    const TemporaryFolder folder;
    const ProgramRun run = run_roadbed({"export", golden("two_roads.xodr"), "-o", folder / name});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(bytes_of(folder / name), bytes_of(golden(name)));
  }
}

TEST(ExportCommand, WritesTheSamePictureFromTheCompiledMap) {
  const TemporaryFolder folder;
  const std::string compiled = folder / "a.rbm";
  ASSERT_EQ(run_roadbed({"import", golden("two_roads.xodr"), "-o", compiled}).status, 0);
  ASSERT_EQ(run_roadbed({"export", golden("two_roads.xodr"), "-o", folder / "a.svg"}).status, 0);
  ASSERT_EQ(run_roadbed({"export", compiled, "-o", folder / "b.svg"}).status, 0);
  EXPECT_EQ(bytes_of(folder / "a.svg"), bytes_of(folder / "b.svg"));
  EXPECT_EQ(bytes_of(folder / "a.svg").substr(0, 5), "<svg ");
}

TEST(ExportCommand, ReplacesAFileOnlyWithForce) {
  const TemporaryFolder folder;
  const std::string file = folder.write("a.csv", "mine");
  EXPECT_EQ(run_roadbed({"export", golden("two_roads.xodr"), "-o", file}).status, 1);
  EXPECT_EQ(bytes_of(file), "mine");
  EXPECT_EQ(run_roadbed({"export", golden("two_roads.xodr"), "-o", file, "--force"}).status, 0);
  EXPECT_EQ(bytes_of(file), bytes_of(golden("two_roads.csv")));
}

TEST(ExportCommand, LeavesNothingBehindWhenItCannotDoIt) {
  const TemporaryFolder folder;
  const std::string bad = folder.write("bad.xodr", "<OpenDRIVE>");
  const ProgramRun suffix =
      run_roadbed({"export", golden("two_roads.xodr"), "-o", folder / "a.txt"});
  EXPECT_EQ(suffix.status, 1);
  EXPECT_NE(suffix.err.find(".geojson, .gpkg, .fgb, .svg, .csv"), std::string::npos) << suffix.err;
  EXPECT_EQ(run_roadbed({"export", bad, "-o", folder / "a.svg"}).status, 1);
  EXPECT_EQ(run_roadbed({"export", golden("two_roads.xodr"), "-o", folder / "no/a.svg"}).status, 1);
  EXPECT_EQ(files_below(folder.path()), std::vector<std::string>{"bad.xodr"});
}

}  // namespace
}  // namespace roadbed::tests
