// What all commands keep to where they write, as a user meets it; kills and faults: tests/faults.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <vector>

#include "roadbed/tests/support/file_size_limit.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/tools/town.h"

namespace roadbed::tests {
namespace {

using testing::HasSubstr;

TEST(Outputs, ThatAreInputsAreRefusedHoweverTheyAreNamed) {
  const TemporaryFolder folder;
  const std::string input = folder.write("town.xodr", town_bytes());
  std::filesystem::create_symlink("town.xodr", folder / "link.rbm");
  std::filesystem::create_hard_link(input, folder / "second.rbm");
  for (const char* output : {"town.xodr", "link.rbm", "second.rbm", "../x/town.xodr"}) {
    const std::string named =
        output[0] == '.' ? (folder.path() / ".." / folder.path().filename() / "town.xodr").string()
                         : (folder / output).string();
    const ProgramRun run = run_roadbed({"import", input, "-o", named, "--force"});
    EXPECT_EQ(run.status, 2) << named;
    EXPECT_THAT(run.err, HasSubstr("is an input")) << named;
    EXPECT_EQ(bytes_of(input), town_bytes());
  }
}

TEST(Outputs, ThatAScenarioReadsAreRefused) {
  const TemporaryFolder folder;
  const std::string cloud =
      folder.write("narrow_gap.pcd", bytes_of(data_folder() / "scenarios/narrow_gap.pcd"));
  const std::string scenario =
      folder.write("narrow_gap.json", bytes_of(data_folder() / "scenarios/narrow_gap.json"));
  const ProgramRun run = run_roadbed(
      {"simulate", scenario, "-o", (folder / "drive").string(), "--timings", cloud, "--force"});
  EXPECT_EQ(run.status, 2) << run.err;
  EXPECT_THAT(run.err, HasSubstr("is an input"));
  EXPECT_EQ(bytes_of(cloud), bytes_of(data_folder() / "scenarios/narrow_gap.pcd"));
}

TEST(Outputs, OfOneNameAreRefused) {
  const TemporaryFolder folder;
  const std::string input = folder.write("town.xodr", town_bytes()),
                    output = (folder / "f").string();
  const auto other = std::filesystem::relative(output).string();
  for (const std::string& second : {output, other, "./" + other}) {  // none of which is there
    const ProgramRun run = run_roadbed({"validate", input, "--junit", other, "--sarif", second});
    EXPECT_EQ(run.status, 2);
    EXPECT_THAT(run.err, HasSubstr("--junit and --sarif are both"));
    EXPECT_FALSE(std::filesystem::exists(output));
  }
}

TEST(Outputs, BesideTheOneThatIsNamedAreNoInputs) {
  const TemporaryFolder folder;
  const std::string input = folder.write("n.edg.xml", bytes_of(data_folder() / "junction.xml"));
  const ProgramRun run =
      run_roadbed({"export", input, "-o", (folder / "n.nod.xml").string(), "--force"});
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, HasSubstr("is an input"));
  EXPECT_EQ(bytes_of(input), bytes_of(data_folder() / "junction.xml"));
  EXPECT_FALSE(std::filesystem::exists(folder / "n.nod.xml"));
}

TEST(Outputs, OfJobsAndBatchesAreNoInputs) {
  const TemporaryFolder folder;
  const std::string map = folder.write("town.xodr", town_bytes());
  const ProgramRun jobs =
      run_roadbed({"jobs", "validate", (folder / "*.xodr").string(), "-o", map, "--force"});
  EXPECT_EQ(jobs.status, 3);
  EXPECT_THAT(jobs.err, HasSubstr("is an input"));
  EXPECT_EQ(bytes_of(map), town_bytes());
  const std::string line = "{\"job\":\"validate\",\"inputs\":[\"town.xodr\"]}\n";
  const std::string file = folder.write("results.jsonl", line);
  const ProgramRun batch = run_roadbed({"batch", file, "-o", folder.path().string(), "--force"});
  EXPECT_EQ(batch.status, 3);
  EXPECT_THAT(batch.err, HasSubstr("is an input"));
  EXPECT_EQ(bytes_of(file), line);
}

TEST(Outputs, OnDevicesMayBeInputsToo) {
  EXPECT_THAT(run_roadbed({"import", "/dev/null", "-o", "/dev/null", "--force"}).err,
              HasSubstr("is a device"));
}

TEST(Outputs, ThatMayNotGrowAreOneLineAndNothingElse) {
  const TemporaryFolder folder;
  const std::string output = (folder / "town.rbm").string();
  const FileSizeLimit limit(4096);
  const ProgramRun run =
      run_roadbed({"import", (data_folder() / "town.xodr").string(), "-o", output});
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, HasSubstr("town.rbm: cannot be written: File too large"));
  EXPECT_EQ(std::ranges::count(run.err, '\n'), 1);
  EXPECT_TRUE(files_below(folder.path()).empty());
}

TEST(Outputs, OfACycleAreNotPutIntoItsDrive) {
  const TemporaryFolder folder;
  const std::string drive = (folder / "drive").string();
  run_roadbed({"simulate", (data_folder() / "scenarios/narrow_gap.json").string(), "-o", drive});
  const std::string before = bytes_of(folder / "drive/trajectory.csv");
  const ProgramRun run = run_roadbed({"plan", drive + "@1", "-o", drive, "--force"});
  EXPECT_NE(run.status, 0);
  EXPECT_THAT(run.err, HasSubstr("is the drive that the cycle is of"));
  EXPECT_EQ(bytes_of(folder / "drive/trajectory.csv"), before);
}

TEST(Outputs, OfTilesReplaceTheOldTilesAndLeaveWhatElseIsThere) {
  const TemporaryFolder folder;
  const std::string cloud = (data_folder() / "scenarios/narrow_gap.pcd").string();
  const std::string tiles = (folder / "city.tiles").string(), other = (folder / "b.tiles").string();
  const auto build = [&](const std::string& output, const char* side_m) {
    return run_roadbed({"occupancy", "build", cloud, "--tiles", side_m, "-o", output, "--force"});
  };
  EXPECT_EQ(build(tiles, "12").status, 0);
  folder.write("city.tiles/notes.txt", "mine");
  EXPECT_EQ(build(tiles, "50").status, 0);
  EXPECT_EQ(build(other, "50").status, 0);
  std::vector<std::string> expected = files_below(other);
  expected.emplace_back("notes.txt");
  std::ranges::sort(expected);
  EXPECT_EQ(files_below(tiles), expected);
}

}  // namespace
}  // namespace roadbed::tests
