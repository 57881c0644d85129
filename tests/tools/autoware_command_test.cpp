// export -o lanelet2_map.osm --profile autoware.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/tools/town.h"

namespace roadbed::tests {
namespace {

using testing::HasSubstr;

std::vector<std::string> command(const std::string& out) {
  return {"export", kTown, "-o", out, "--profile", "autoware"};
}

TEST(AutowareCommand, TheProjectorStandsBesideTheMapAndLossesAreListed) {
  const TemporaryFolder folder;
  std::vector<std::string> words = command(folder / "lanelet2_map.osm");
  words.emplace_back("--json");
  const ProgramRun run = run_roadbed(words);
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(files_below(folder.path()),
            (std::vector<std::string>{"lanelet2_map.osm", "map_projector_info.yaml"}));
  EXPECT_THAT(bytes_of(folder / "map_projector_info.yaml"), HasSubstr("mgrs_grid: 32UNU"));
  const auto document = nlohmann::json::parse(run.out);
  EXPECT_EQ(document["format"], "Lanelet2");
  EXPECT_EQ(document["lost"][0]["what"], "sidewalks that lie beside no road");
}

TEST(AutowareCommand, NothingIsWrittenWhereAFileIsInTheWay) {
  const TemporaryFolder folder;
  folder.write("map_projector_info.yaml", "mine");
  EXPECT_EQ(run_roadbed(command(folder / "lanelet2_map.osm")).status, 3);
  EXPECT_EQ(files_below(folder.path()), std::vector<std::string>{"map_projector_info.yaml"});
  EXPECT_EQ(bytes_of(folder / "map_projector_info.yaml"), "mine");
}

TEST(AutowareCommand, ItIsForFilesOfLanelet2) {
  const TemporaryFolder folder;
  for (const std::string& out : {std::string("town.xodr"), std::string("town.svg")}) {
    const ProgramRun run = run_roadbed(command(folder / out));
    EXPECT_EQ(run.status, 2);
    EXPECT_THAT(run.err, HasSubstr("--profile is for .osm"));
  }
  std::vector<std::string> words = command("-");
  words.insert(words.end(), {"--format", "osm"});
  EXPECT_THAT(run_roadbed(words).err, HasSubstr("two files"));
}

TEST(AutowareCommand, TheSameMapHasTheSameBytes) {
  const TemporaryFolder folder;
  std::vector<std::string> words = command(folder / "a.osm");
  ASSERT_EQ(run_roadbed(words).status, 0);
  words = command(folder / "b.osm");
  words.emplace_back("--force");
  ASSERT_EQ(run_roadbed(words).status, 0);
  EXPECT_EQ(bytes_of(folder / "a.osm"), bytes_of(folder / "b.osm"));
}

}  // namespace
}  // namespace roadbed::tests
