#include "roadbed/tools/report/drive_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

const std::string kHash(64, 'a');

DriveRecord some_record(const fs::path& scenario, const fs::path& map) {
  return {.program = "roadbed 9.9.9",
          .sources = {{"scenario", scenario, kHash}, {"map", map, std::string(64, 'b')}},
          .predicts = true,
          .drops_ego_recording = false,
          .seed = (std::uint64_t{1} << 53) - 1};
}

json some_json() {
  return json::parse(write_drive_record(some_record("/a/s.json", "/b/m.xodr"), "/a/drive"));
}

std::string fault_of(const json& record) {
  return tests::refusal_of([&] { parse_drive_record(record.dump(), "drive/replay.json"); });
}

TEST(DriveRecord, IsReadAsItWasWritten) {
  const DriveRecord written = some_record("/a/s.json", "/b/m.xodr");
  const DriveRecord read =
      parse_drive_record(write_drive_record(written, "/a/drive"), "/a/drive/replay.json");
  EXPECT_EQ(read.program, written.program);
  EXPECT_EQ(read.predicts, true);
  EXPECT_EQ(read.drops_ego_recording, false);
  EXPECT_EQ(read.seed, written.seed);
  ASSERT_EQ(read.sources.size(), 2U);
  EXPECT_EQ(read.file_of("scenario").lexically_normal(), "/a/s.json");
  EXPECT_EQ(read.file_of("map").lexically_normal(), "/b/m.xodr");
  EXPECT_EQ(read.file_of("vehicle"), "");
  EXPECT_EQ(read.sources[1].sha256, written.sources[1].sha256);
}

TEST(DriveRecord, NamesItsFilesFromItsFolderSoThatBothMayBeMoved) {
  EXPECT_EQ(some_json()["files"][0]["file"], "../s.json");
  EXPECT_EQ(some_json()["files"][1]["file"], "../../b/m.xodr");
}

// A link is a name in its folder: what a scenario names is beside the link.
TEST(DriveRecord, NamesALinkedScenarioByItsLinkAndALinkedFolderByWhatItIs) {
  const tests::TemporaryFolder folder;
  fs::create_directories(folder / "far/away");
  fs::create_directory_symlink(folder / "far/away", folder / "near");
  const fs::path elsewhere = folder.write("elsewhere.json", "{}");
  fs::create_symlink(elsewhere, folder / "far/s.json");
  const DriveRecord record = some_record(folder / "near/../s.json", folder / "near/m.xodr");
  const json written = json::parse(write_drive_record(record, folder / "near"));
  EXPECT_EQ(written["files"][0]["file"], "../s.json");
  EXPECT_EQ(written["files"][1]["file"], "m.xodr");
}

TEST(DriveRecord, RefusesWhatItIsNotWithThePlace) {
  const auto refused = [](const char* pointer, const json& value) {
    json record = some_json();
    record[json::json_pointer(pointer)] = value;
    return fault_of(record);
  };
  EXPECT_EQ(fault_of(some_json()), "accepted");
  EXPECT_THAT(refused("/roadbed_drive", 2),
              HasSubstr("drive/replay.json:/roadbed_drive: is 2: another version"));
  EXPECT_THAT(refused("/predict", 1), HasSubstr("replay.json:/predict: is number, needs true"));
  EXPECT_THAT(refused("/seed", 1.5), HasSubstr("replay.json:/seed: is 1.5"));
  EXPECT_THAT(refused("/seed", -1), HasSubstr("replay.json:/seed: is -1"));
  EXPECT_THAT(refused("/program", "a\nb"), HasSubstr("replay.json:/program: has a control"));
  EXPECT_THAT(refused("/more", 1), HasSubstr("replay.json:/more: is not a known key"));
  EXPECT_THAT(refused("/files/0/role", "car"),
              HasSubstr("/files/0/role: is \"car\", needs one of"));
  EXPECT_THAT(refused("/files/1/role", "scenario"), HasSubstr("/files: has 2 of the role"));
  EXPECT_THAT(refused("/files/0/role", "cloud"), HasSubstr("/files: does not begin with a"));
  EXPECT_THAT(refused("/files", json::array()), HasSubstr("/files: does not begin with a"));
  EXPECT_THAT(refused("/files/1/sha256", "abc"), HasSubstr("/files/1/sha256: is no SHA-256"));
  EXPECT_THAT(refused("/files/1/sha256", std::string(64, 'g')), HasSubstr("is no SHA-256"));
  EXPECT_THAT(refused("/files/1/file", ""), HasSubstr("/files/1/file: is empty"));
}

TEST(DriveRecord, WithoutAKeyIsRefusedByItsName) {
  for (const char* key : {"roadbed_drive", "program", "files", "predict", "drop_ego_recording"}) {
    json record = some_json();
    record.erase(key);
    EXPECT_THAT(fault_of(record), HasSubstr(std::string("has no key \"") + key)) << key;
  }
}

}  // namespace
}  // namespace roadbed::tools
