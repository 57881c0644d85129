#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "roadbed/map/storage/chunked_file.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {
namespace {

using Json = nlohmann::json;

/// The town as a source and compiled, a post beside a street, and a drive along the street.
class MapPastMemory : public testing::Test {
 protected:
  void SetUp() override {
    const ProgramRun import = run_roadbed({"import", source_, "-o", compiled_});
    ASSERT_EQ(import.status, 0) << import.err;
    std::string post;
    for (int i = 0; i < 20; ++i) post += "140 202.5 " + std::to_string(0.1 * i) + "\n";
    const ProgramRun build =
        run_roadbed({"occupancy", "build", folder_.write("post.xyz", post), "-o", octree_});
    ASSERT_EQ(build.status, 0) << build.err;
    const ProgramRun drive =
        run_roadbed({"audit", "--occupancy", octree_, "--map", source_, "--from", "lane:1/3/1@6",
                     "--to", "lane:1/3/1@60", "--save-drive", drive_, "--unknown", "free"});
    ASSERT_TRUE(std::filesystem::exists(drive_)) << drive.err;
  }

  ProgramRun audit(const std::string& map, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"audit", "--occupancy",  octree_, "--map",
                                       map,     "--ground",     "map",   "--unknown",
                                       "free",  "--trajectory", drive_,  "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_roadbed(arguments);
  }

  /// A certificate without what it says of the map's file.
  Json certificate(const std::string& map) const {
    const std::string file = folder_ / "proof.json";
    audit(map, {"--certificate", file, "--force"});
    Json document = Json::parse(bytes_of(file));
    EXPECT_EQ(document.at("map").erase("file") + document.at("map").erase("sha256"), 2U);
    return document;
  }

  TemporaryFolder folder_;
  const std::string source_ = data_folder() / "town.xodr";
  const std::string compiled_ = folder_ / "town.rbm", drive_ = folder_ / "drive.csv",
                    octree_ = folder_ / "post.bt";
};

TEST_F(MapPastMemory, IsAuditedAsTheSourceIs) {
  const ProgramRun of_source = audit(source_), of_compiled = audit(compiled_);
  EXPECT_NE(of_source.out.find("least_clearance_m"), std::string::npos) << of_source.err;
  EXPECT_EQ(of_compiled.out, of_source.out);
  EXPECT_EQ(of_compiled.err, of_source.err);
  EXPECT_EQ(of_compiled.status, of_source.status);
  EXPECT_EQ(certificate(compiled_), certificate(source_));
}

TEST_F(MapPastMemory, IsHurtOnlyByDamageThatADriveMeets) {
  const std::string whole = bytes_of(compiled_);
  const ProgramRun expected = audit(compiled_);
  std::uint64_t body = 0;
  std::memcpy(&body, whole.data() + 32, sizeof body);
  int untouched = 0, named = 0;
  for (std::size_t chunk = 0; body + chunk * map::ChunkedFile::kChunkSize < whole.size(); ++chunk) {
    std::string bytes = whole;
    char& first = bytes[body + chunk * map::ChunkedFile::kChunkSize];
    first = static_cast<char>(~first);
    const ProgramRun run = audit(folder_.write("damaged.rbm", bytes));
    if (run.out == expected.out && run.status == expected.status) {
      ++untouched;
      continue;
    }
    EXPECT_EQ(run.status, 3);
    EXPECT_EQ(run.out, "");
    EXPECT_NE(run.err.find("damaged.rbm: chunk " + std::to_string(chunk) + ":"), std::string::npos)
        << run.err;
    ++named;
  }
  EXPECT_GT(untouched, named);  // one street of a town
  EXPECT_GT(named, 4);
}

}  // namespace
}  // namespace roadbed::tests
