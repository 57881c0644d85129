#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/sha256sum.h"

namespace roadbed::tests {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

class OccupancyTiles : public testing::Test {
 protected:
  static std::vector<std::string> build_of_scans(const std::string& output) {
    std::vector<std::string> command{"occupancy", "build", "--resolution", "0.2", "--quiet"};
    for (const char* scan : {"scan_02.pcd", "scan_03.pcd", "scan_04.pcd"}) {
      command.push_back((data_folder() / "scans" / scan).string());
    }
    command.insert(command.end(), {"-o", output});
    return command;
  }

  void build() const {
    ASSERT_EQ(run_roadbed(build_of_scans(octree_)).status, 0);
    std::vector<std::string> tiled = build_of_scans(tiles_);
    tiled.insert(tiled.end(), {"--tiles", "20"});
    const ProgramRun run = run_roadbed(tiled);
    ASSERT_EQ(run.status, 0) << run.err;
  }

  std::string drive() const {
    return folder_.write(
        "drive.csv", "t_s,x_m,y_m,heading_rad\n0,120,198.25,0\n2,140,198.25,0\n4,165,197,0.1\n");
  }

  TemporaryFolder folder_;
  std::string octree_ = folder_ / "street.bt", tiles_ = folder_ / "street.tiles";
};

TEST_F(OccupancyTiles, AnAuditOverThemPrintsWhatTheAuditOverOneOctreePrints) {
  build();
  const std::string csv = drive();
  for (const char* policy : {"free", "occupied", "report"}) {
    const auto audit = [&](const std::string& occupancy) {
      return run_roadbed({"audit", "--occupancy", occupancy, "--trajectory", csv, "--unknown",
                          policy, "--json", "--quiet"});
    };
    const ProgramRun whole = audit(octree_), tiles = audit(tiles_);
    EXPECT_EQ(tiles.status, whole.status);
    EXPECT_EQ(tiles.out, whole.out);
    EXPECT_EQ(tiles.err, "");
  }
}

TEST_F(OccupancyTiles, ACertificateAboutThemHoldsUntilATileChanges) {
  build();
  const std::string csv = drive(), proof = folder_ / "proof.json";
  run_roadbed({"audit", "--occupancy", tiles_, "--trajectory", csv, "--certificate", proof});
  const ProgramRun holds = run_roadbed({"audit", "--check", proof});
  EXPECT_EQ(holds.status, 0) << holds.out << holds.err;
  EXPECT_THAT(holds.out, HasSubstr("holds"));
  for (const auto& entry : std::filesystem::directory_iterator(tiles_)) {
    if (entry.path().extension() == ".bt")
      folder_.write("street.tiles/" + entry.path().filename().string(),
                    "# Octomap OcTree binary file\n");
  }
  const ProgramRun changed = run_roadbed({"audit", "--check", proof});
  EXPECT_EQ(changed.status, 3);
  EXPECT_THAT(changed.err, HasSubstr("as the index says"));
}

TEST_F(OccupancyTiles, InfoSaysWhatTheyHold) {
  build();
  const Json tiles = Json::parse(run_roadbed({"occupancy", "info", tiles_, "--json"}).out);
  const Json whole = Json::parse(run_roadbed({"occupancy", "info", octree_, "--json"}).out);
  EXPECT_EQ(tiles.at("kind"), "tiles");
  EXPECT_NEAR(tiles.at("side_m").get<double>(), 25.6, 1e-9);
  EXPECT_GT(tiles.at("tiles"), 4);
  EXPECT_EQ(tiles.at("origin"), whole.at("origin"));
  for (const char* bound : {"min_x_m", "min_y_m", "max_x_m", "max_y_m", "max_z_m"}) {
    EXPECT_NEAR(tiles.at("bounds").at(bound).get<double>(),
                whole.at("bounds").at(bound).get<double>(), 1e-6);
  }
}

TEST_F(OccupancyTiles, NothingIsWrittenWhereACloudIsUnusable) {
  const std::string good = (data_folder() / "scans/scan_02.pcd").string();
  const std::string bad = folder_.write("bad.pcd", "VERSION 0.7\nFIELDS x y z\n");
  const ProgramRun run =
      run_roadbed({"occupancy", "build", good, bad, "-o", tiles_, "--tiles", "20"});
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, HasSubstr("bad.pcd"));
  EXPECT_FALSE(std::filesystem::exists(tiles_));
  const std::string shots =
      folder_.write("shots.csv", "x,y,z,vp_x,vp_y,vp_z\n1,2,3,0,0,0\n4,2,3,1,0,0\n");
  const ProgramRun log_odds =
      run_roadbed({"occupancy", "build", shots, "-o", tiles_, "--tiles", "20", "--no-sticky"});
  EXPECT_EQ(log_odds.status, 3);
  EXPECT_THAT(log_odds.err, HasSubstr("--no-sticky"));
  EXPECT_FALSE(std::filesystem::exists(tiles_));
}

TEST_F(OccupancyTiles, AreReplacedOnlyWithForce) {
  build();
  std::vector<std::string> again = build_of_scans(tiles_);
  again.insert(again.end(), {"--tiles", "20"});
  EXPECT_EQ(run_roadbed(again).status, 3);
  again.emplace_back("--force");
  EXPECT_EQ(run_roadbed(again).status, 0);
}

TEST_F(OccupancyTiles, HaveTheHashesInTheirIndexThatSha256sumMakesOfThem) {
  build();
  const Json index = Json::parse(bytes_of(tiles_ + "/index.json"));
  ASSERT_FALSE(index["tiles"].empty());
  for (const Json& tile : index["tiles"]) {
    EXPECT_EQ(tile["sha256"],
              sha256sum_of(std::filesystem::path(tiles_) / tile["file"].get<std::string>()));
  }
}

TEST_F(OccupancyTiles, OfAnIndexWithOlderHashesAreRefusedAndToBeBuiltAgain) {
  build();
  Json index = Json::parse(bytes_of(tiles_ + "/index.json"));
  index["format"] = "roadbed occupancy tiles 1";
  for (Json& tile : index["tiles"]) {
    tile.erase("sha256");
    tile["xxhash"] = "0123456789abcdef";
  }
  std::ofstream(tiles_ + "/index.json") << index;
  const ProgramRun run =
      run_roadbed({"audit", "--occupancy", tiles_, "--trajectory", drive(), "--json"});
  EXPECT_EQ(run.status, 3);
  EXPECT_EQ(run.out, "");
  EXPECT_THAT(run.err, HasSubstr("index.json: format: \"roadbed occupancy tiles 1\", needs roadbed "
                                 "occupancy tiles 2; build the tiles again"));
}

}  // namespace
}  // namespace roadbed::tests
