// The whole way from a map to a driven and audited route, on the project's own data, as a user
// goes it.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/tools/town.h"

namespace roadbed::tests {
namespace {

constexpr const char* kStart = "lane:1/3/1@6";  // as in data/drive.json

/// Runs the program, expects status 0, and returns what it printed.
std::string answer(const std::vector<std::string>& words) {
  const ProgramRun run = run_roadbed(words);
  EXPECT_EQ(run.status, 0) << run.err;
  return run.out;
}

nlohmann::json json_answer(std::vector<std::string> words) {
  words.push_back("--json");
  const std::string text = answer(words);
  EXPECT_TRUE(nlohmann::json::accept(text)) << text;
  return nlohmann::json::parse(text, nullptr, false);
}

TEST(MainJob, CompiledMapAnswersAsItsSourceDoes) {
  const TemporaryFolder folder;
  const std::string compiled = folder / "town.rbm";
  answer({"import", kTown, "-o", compiled});
  EXPECT_EQ(answer({"info", compiled}), answer({"info", kTown}));
}

// data/check_links.py, which shares no code with the program, counts the same.
TEST(MainJob, InfoCountsTheTownAsItsRecipeDoesAndFindsItInOnePiece) {
  const nlohmann::json info = json_answer({"info", kTown});
  EXPECT_EQ(info.at("roads"), 49);
  EXPECT_EQ(info.at("junctions"), 9);
  EXPECT_EQ(info.at("drivable_component_lanes"), nlohmann::json::array({119}));
}

TEST(MainJob, TownIsFitForPlanning) {
  const nlohmann::json answer = json_answer({"validate", kTown});
  for (const auto& finding : answer.at("findings")) {
    EXPECT_EQ(finding.at("severity"), "info") << finding.dump();
  }
}

TEST(MainJob, RouteAcrossTownGoesOverTheCrossroadsAndThreeQuartersRoundTheRoundabout) {
  const nlohmann::json route = json_answer({"route", kTown, "--from", kStart, "--to", kGoal});
  EXPECT_EQ(route.at("found"), true);
  std::vector<std::string> roads;  // one entry per road, whatever its sections
  for (const auto& leg : route.at("lanes")) {
    const std::string lane = leg.at("lane");
    const std::string road = lane.substr(0, lane.find('/'));
    if (roads.empty() || roads.back() != road) roads.push_back(road);
  }
  EXPECT_EQ(roads, (std::vector<std::string>{"1", "1007", "2", "2201", "22", "2300", "23", "2000",
                                             "20", "2102", "7"}));
  EXPECT_EQ(route.at("lane_changes"), 0);
}

TEST(MainJob, ImportOfTheSameMapGivesTheSameBytes) {
  const TemporaryFolder folder;
  answer({"import", kTown, "-o", folder / "one.rbm", "--threads", "1"});
  answer({"import", kTown, "-o", folder / "two.rbm", "--threads", "2"});
  EXPECT_EQ(bytes_of(folder / "one.rbm"), bytes_of(folder / "two.rbm"));
}

TEST(MainJob, DriveGoesPastAParkedCarToTheGoal) {
  const TemporaryFolder folder;
  const std::string scenario = data_folder() / "scenarios" / "parked_car.json";
  answer({"simulate", scenario, "-o", folder / "drive"});
  const auto metrics = nlohmann::json::parse(bytes_of(folder / "drive/metrics.json"));
  EXPECT_EQ(metrics.at("goal_reached"), true);
  EXPECT_EQ(metrics.at("collision"), false);
  EXPECT_GT(metrics.at("least_clearance_m"), 0.2);
  EXPECT_LT(metrics.at("least_clearance_m"), 2.0);  // it did pass the car
  EXPECT_NE(bytes_of(folder / "drive/report.html").find("</html>"), std::string::npos);
}

TEST(MainJob, DriveBetweenWallsIsClearAndTheSameDriveThroughAWallIsAConflict) {
  const TemporaryFolder folder;
  const std::filesystem::path scenarios = data_folder() / "scenarios";
  answer({"simulate", scenarios / "narrow_gap.json", "-o", folder / "drive"});
  answer({"occupancy", "build", scenarios / "narrow_gap.pcd", "-o", folder / "walls.bt"});
  const std::vector<std::string> audit{"audit",        "--occupancy", folder / "walls.bt",
                                       "--trajectory", "DRIVE",       "--unknown",
                                       "free",         "--json"};
  auto words = audit;
  words[4] = folder / "drive/trajectory.csv";
  const auto clear = nlohmann::json::parse(answer(words));
  EXPECT_EQ(clear.at("verdict"), "clear");
  // Walls 2.9 m apart and a vehicle 1.61 m wide: at best 0.645 m to either side, cells of 0.1 m.
  EXPECT_GT(clear.at("least_clearance_m"), 0.2);
  EXPECT_LT(clear.at("least_clearance_m"), 0.646);

  words[4] = folder.write("through.csv", "t_s,x_m,y_m,heading_rad\n0,160,199,0\n3,180,199.9,0\n");
  const ProgramRun through = run_roadbed(words);
  EXPECT_EQ(through.status, 1);
  EXPECT_EQ(nlohmann::json::parse(through.out).at("verdict"), "conflict");
}

TEST(MainJob, OctreeOfTheTownIsMadeFromItsScans) {
  const TemporaryFolder folder;
  std::vector<std::string> words{"occupancy",    "build", "-o",     folder / "town.bt",
                                 "--resolution", "0.2",   "--quiet"};
  for (const std::string& scan : files_below(data_folder() / "scans")) {
    words.push_back(data_folder() / "scans" / scan);
  }
  answer(words);
  EXPECT_TRUE(bytes_of(folder / "town.bt") == bytes_of(data_folder() / "town.bt"))
      << "make data/town.bt again, as data/README.md says";
}

TEST(MainJob, QuietKeepsNotesFromStderr) {
  const TemporaryFolder folder;
  const ProgramRun run = run_roadbed({"import", kTown, "-o", folder / "t.rbm", "--quiet"});
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.err + run.out, "");
}

}  // namespace
}  // namespace roadbed::tests
