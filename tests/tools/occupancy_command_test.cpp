#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "roadbed/tests/support/needs_pcl.h"
#include "roadbed/tests/support/program_run.h"

namespace roadbed::tests {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

/// Hits on a wall x = 20 m, |y| ≤ 6 m, seen from a scanner at the origin, and a pole at (10, 4).
std::string street_pcd() {
  std::string points;
  int count = 0;
  const auto hit = [&](double x, double y, double z) {
    points += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
    ++count;
  };
  for (double y = -6.0; y < 6.0; y += 0.05) {
    for (double z = 0.05; z < 2.0; z += 0.05) hit(20.05, y, z);
  }
  for (double z = 0.05; z < 2.0; z += 0.05) hit(10.05, 4.05, z);
  const std::string number = std::to_string(count);
  return "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + number +
         "\nHEIGHT 1\nVIEWPOINT 0 0 1 1 0 0 0\nPOINTS " + number + "\nDATA ascii\n" + points;
}

std::string straight_csv(double from_x, double to_x, double y) {
  return "t_s,x_m,y_m,heading_rad\n0," + std::to_string(from_x) + "," + std::to_string(y) +
         ",0\n10," + std::to_string(to_x) + "," + std::to_string(y) + ",0\n";
}

class OccupancyCommands : public testing::Test {
 protected:
  void SetUp() override {
    const std::string cloud = folder_.write("street.pcd", street_pcd());
    const ProgramRun run = run_roadbed({"occupancy", "build", cloud, "-o", octree_, "--quiet"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.out + run.err, "");
  }

  ProgramRun audit(const std::string& csv, std::vector<std::string> more) const {
    more.insert(more.begin(),
                {"audit", "--occupancy", octree_, "--trajectory", folder_.write("drive.csv", csv)});
    return run_roadbed(more);
  }

  TemporaryFolder folder_;
  std::string octree_ = folder_ / "street.bt";
};

TEST_F(OccupancyCommands, BuildLooksAtWhatPointsOfFilesSayOfThemselves) {
  const std::string cloud =
      folder_.write("classes.csv", "x,y,z,Classification\n0,0,0,2\n5,5,5,7\n");
  const std::string octree = folder_ / "ground.bt";
  ASSERT_EQ(run_roadbed({"occupancy", "build", cloud, "--classes", "2", "-o", octree}).status, 0);
  const ProgramRun run = run_roadbed({"occupancy", "info", octree, "--json"});
  EXPECT_EQ(Json::parse(run.out).at("occupied").at("leaves"), 1);
}

TEST_F(OccupancyCommands, InfoTellsBoundsAndSpaceOfWhatBuildMade) {
  const ProgramRun run = run_roadbed({"occupancy", "info", octree_, "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  const Json info = Json::parse(run.out);
  EXPECT_EQ(info.at("resolution_m"), 0.1);
  EXPECT_NEAR(info.at("occupied").at("bounds").at("max_x_m").get<double>(), 20.1, 1e-6);
  EXPECT_NEAR(info.at("occupied").at("bounds").at("min_y_m").get<double>(), -6.0, 1e-6);
  EXPECT_NEAR(info.at("occupied").at("volume_m3").get<double>(), 12.0 * 2.0 * 0.1 + 0.02, 0.3);
  EXPECT_GT(info.at("free").at("volume_m3").get<double>(), 50.0);
  EXPECT_THAT(run_roadbed({"occupancy", "info", octree_}).out, HasSubstr("resolution_m  0.1"));
}

TEST_F(OccupancyCommands, AuditTellsTheDistanceToTheWallAndItsExitStatusTheVerdict) {
  const ProgramRun clear = audit(straight_csv(2, 10, 0), {"--unknown", "free", "--json"});
  ASSERT_EQ(clear.status, 0) << clear.err;
  const Json report = Json::parse(clear.out);
  EXPECT_EQ(report.at("verdict"), "clear");
  // The pole at (10, 4) is nearer than the wall: 4 m less half the width.
  EXPECT_NEAR(report.at("least_clearance_m").get<double>(), 4.0 - 0.805, 0.02);
  EXPECT_TRUE(report.at("conflicts").empty());

  const ProgramRun hit = audit(straight_csv(2, 18, 0), {"--unknown", "free", "--json"});
  EXPECT_EQ(hit.status, 1);
  const Json conflict = Json::parse(hit.out).at("conflicts").at(0);
  // The front meets the wall at x = 20 m: 20 − 3.6767 − 2 metres at 1.6 m/s; the stretch may begin
  // 4 cm earlier.
  EXPECT_NEAR(conflict.at("from_s").get<double>(), (20.0 - 3.6767171 - 2.0) / 1.6, 0.025);
  EXPECT_EQ(conflict.at("to_s").get<double>(), 10.0);

  EXPECT_EQ(audit(straight_csv(2, 10, 0), {"--unknown", "free", "--clearance", "4"}).status, 1);
  EXPECT_EQ(audit(straight_csv(2, 10, 0), {"--unknown", "free", "--inflate", "4"}).status, 1);
}

TEST_F(OccupancyCommands, AuditNamesUnknownSpaceAndADriveOutsideIt) {
  const ProgramRun unknown = audit(straight_csv(2, 10, 40), {});
  EXPECT_EQ(unknown.status, 1);
  EXPECT_THAT(unknown.out, HasSubstr("verdict          unknown"));
  EXPECT_THAT(unknown.out, HasSubstr("not measured     100.0 %"));
  EXPECT_THAT(unknown.out, HasSubstr("bring drive and occupancy into one frame"));
}

TEST_F(OccupancyCommands, CheckVerifiesACertificateAndRefutesAChangedOne) {
  const std::string proof = folder_ / "proof.json";
  const ProgramRun made =
      audit(straight_csv(2, 10, 0), {"--unknown", "free", "--certificate", proof});
  ASSERT_EQ(made.status, 0) << made.err;
  const ProgramRun holds = run_roadbed({"audit", "--check", proof, "--json"});
  EXPECT_EQ(holds.status, 0) << holds.out << holds.err;
  EXPECT_NEAR(Json::parse(holds.out).at("certified_clearance_m").get<double>(), 4.0 - 0.805, 0.05);

  Json bold = Json::parse(bytes_of(proof));
  for (Json& span : bold["from_occupied"]) span[3] = 3.3;
  bold["certified_clearance_m"] = 3.3;
  const ProgramRun refuted =
      run_roadbed({"audit", "--check", folder_.write("bold.json", bold.dump())});
  EXPECT_EQ(refuted.status, 1);
  EXPECT_THAT(refuted.out, HasSubstr("certificate      does not hold"));
  EXPECT_THAT(refuted.out, HasSubstr("that is no 3.300000 m"));

  const std::string other = folder_.write("other.csv", straight_csv(2, 11, 0));
  const ProgramRun mixed = run_roadbed({"audit", "--check", proof, "--trajectory", other});
  EXPECT_EQ(mixed.status, 1);
  EXPECT_THAT(mixed.out, HasSubstr("the certificate is about one with"));
}

TEST_F(OccupancyCommands, CheckRefusesWhatIsNoCertificate) {
  Json document{{"format", "roadbed audit certificate 9"}};
  const ProgramRun nine =
      run_roadbed({"audit", "--check", folder_.write("nine.json", document.dump())});
  EXPECT_EQ(nine.status, 3);
  EXPECT_THAT(nine.err, HasSubstr("nine.json:/format: is \"roadbed audit certificate 9\""));
  const ProgramRun cut =
      run_roadbed({"audit", "--check", folder_.write("cut.json", "{\"format\":")});
  EXPECT_EQ(cut.status, 3);
  EXPECT_THAT(cut.err, HasSubstr("cut.json:byte"));
  EXPECT_EQ(nine.out + cut.out, "");
}

TEST_F(OccupancyCommands, AuditDrawsAPictureAndKeepsAnOldOne) {
  const std::string picture = folder_ / "audit.svg";
  const std::vector<std::string> options{"--unknown", "free", "--svg", picture};
  EXPECT_EQ(audit(straight_csv(2, 18, 0), options).status, 1);
  const std::string svg = bytes_of(picture);
  EXPECT_THAT(svg, HasSubstr("class=\"conflict\""));
  EXPECT_THAT(svg, HasSubstr("class=\"witness\""));
  const ProgramRun again = audit(straight_csv(2, 10, 0), options);
  EXPECT_EQ(again.status, 3);
  EXPECT_THAT(again.err, HasSubstr("--force"));
  EXPECT_EQ(bytes_of(picture), svg);
}

TEST_F(OccupancyCommands, ScaleIsThatOfTheCloudsNotOfTheirPoses) {
  const std::string metres = folder_.write("metres.xyz", "3 1 0.5\n5 2 0.5\n");
  const std::string millimetres = folder_.write("mm.xyz", "3000 1000 500\n5000 2000 500\n");
  const std::string poses = folder_.write("poses.txt", "0 10 20 1 0 0 0 1\n");
  const auto built = [&](const std::string& cloud, std::vector<std::string> more) {
    const std::string out = folder_ / (cloud.ends_with("mm.xyz") ? "mm.bt" : "metres.bt");
    more.insert(more.begin(),
                {"occupancy", "build", cloud, "--poses", poses, "--quiet", "-o", out});
    const ProgramRun run = run_roadbed(more);
    EXPECT_EQ(run.status, 0) << run.err;
    return bytes_of(out);
  };
  EXPECT_EQ(built(millimetres, {"--scale", "0.001"}), built(metres, {}));
}

TEST_F(OccupancyCommands, RefuseUnusableInputInOneLineAndLeaveNothing) {
  const std::string out = folder_ / "out.bt";
  const auto expect_refused = [&](const std::vector<std::string>& arguments, const char* reason) {
    const ProgramRun run = run_roadbed(arguments);
    EXPECT_EQ(run.status, 3) << run.err;
    EXPECT_THAT(run.err, HasSubstr(reason));
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_FALSE(std::filesystem::exists(out));
  };
  const std::string empty = folder_.write("empty.pcd", "");
  const std::string nan = folder_.write("nan.xyz", "nan nan nan\n");
  const std::string cut = folder_.write("cut.bt", bytes_of(octree_).substr(0, 500));
  const std::string drive = folder_.write("ok.csv", straight_csv(0, 1, 0));
  const std::string backwards =
      folder_.write("back.csv", "t_s,x_m,y_m,heading_rad\n1,0,0,0\n0,0,0,0\n");
  expect_refused({"occupancy", "build", empty, "-o", out}, "empty.pcd: is empty");
  expect_refused({"occupancy", "build", nan, "-o", out}, "is finite");
  expect_refused({"occupancy", "build", folder_ / "no.pcd", "-o", out}, "no such file");
  expect_refused({"occupancy", "build", octree_, octree_, "-o", out}, "one octree alone");
  expect_refused({"occupancy", "build", cut, "-o", out}, "ends after");
  expect_refused({"occupancy", "info", cut}, "ends after");
  expect_refused({"audit", "--occupancy", cut, "--trajectory", drive}, "cut.bt");
  expect_refused({"audit", "--occupancy", octree_, "--trajectory", backwards}, "back.csv:3");
  expect_refused({"audit", "--occupancy", nan, "--trajectory", drive},
                 "none of its 1 points is finite");
  const std::string post = folder_.write("post.xyz", "1 2 3\n");
  const auto expect_wrong_usage = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"occupancy", "build", post});
    const ProgramRun run = run_roadbed(more);
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_FALSE(std::filesystem::exists(out));
  };
  for (const char* resolution : {"0", "nan", "1e-9", "-1", "inf", "fine"}) {
    expect_wrong_usage({"-o", out, "--resolution", resolution});
  }
  for (const char* option : {"--voxel", "--carve-range", "--scale"}) {
    expect_wrong_usage({"-o", out, option, "nan"});
  }
  expect_wrong_usage({"-o", folder_ / "out.txt"});
  EXPECT_EQ(run_roadbed({"occupancy", "build"}).status, 2);
  EXPECT_EQ(run_roadbed({"audit", "--unknown", "maybe"}).status, 2);
}

TEST(OccupancyBuild, SaysInEveryPlaceThatHitsWereTakenAway) {
  const TemporaryFolder folder;
  const std::string wall = "10.05 0.05 0.55\n", post = "5.05 0.05 0.55\n";
  std::vector<std::string> build{"occupancy", "build"};
  for (const auto& points : {post, wall, wall}) {
    build.push_back(folder.write("cloud_" + std::to_string(build.size()) + ".xyz", points));
  }
  const std::string octree = folder / "made.bt", tiles = folder / "made.tiles";
  build.insert(build.end(), {"--sensor", "0.05,0.05,0.55", "--remove-seen-through", "2"});
  std::vector<std::string> tiled = build;
  build.insert(build.end(), {"-o", octree});
  tiled.insert(tiled.end(), {"-o", tiles, "--tiles", "10"});
  const std::string drive = folder.write("drive.csv", straight_csv(0, 3, 0));
  for (const auto& [command, file] : {std::pair(build, octree), std::pair(tiled, tiles)}) {
    const ProgramRun run = run_roadbed(command);
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("1 cells with points count as free: 2 clouds or more"));
    const ProgramRun info = run_roadbed({"occupancy", "info", file, "--json"});
    EXPECT_EQ(Json::parse(info.out).at("seen_through").at("removed_cells"), 1);
    EXPECT_THAT(run_roadbed({"occupancy", "info", file}).out,
                HasSubstr("2 clouds or more, 1 cells with points count as free"));
    const ProgramRun audit = run_roadbed(
        {"audit", "--occupancy", file, "--trajectory", drive, "--unknown", "free", "--json"});
    EXPECT_EQ(Json::parse(audit.out).at("occupancy_seen_through").at("clouds"), 2);
    EXPECT_EQ(Json::parse(audit.out).at("verdict"), "clear");
    EXPECT_THAT(audit.err, HasSubstr("was built with --remove-seen-through 2: 1 cells"));
  }
  const std::string again = folder / "again.bt";
  EXPECT_EQ(run_roadbed({"occupancy", "build", octree, "-o", again}).status, 0);
  const ProgramRun info = run_roadbed({"occupancy", "info", again, "--json"});
  EXPECT_EQ(Json::parse(info.out).at("seen_through").at("clouds"), 2);
  const ProgramRun refused = run_roadbed(
      {"occupancy", "build", octree, "-o", folder / "no.bt", "--remove-seen-through", "2"});
  EXPECT_EQ(refused.status, 3);
  EXPECT_THAT(refused.err, HasSubstr("give the clouds"));
  build.emplace_back("--no-sticky");
  EXPECT_EQ(run_roadbed(build).status, 2);
}

TEST(OccupancyBuild, CarvesFromTheSensorOfEachPointUnlessToldOtherwise) {
  const TemporaryFolder folder;
  const std::string cloud = folder.write(
      "shots.csv", "x,y,z,vp_x,vp_y,vp_z\n5,0.05,0.05,0,0.05,0.05\n5,3.05,0.05,0,3.05,0.05\n");
  int built = 0;
  const auto free_m3 = [&](std::vector<std::string> more) {
    const std::string octree = folder / (std::to_string(++built) + ".bt");
    more.insert(more.begin(), {"occupancy", "build", cloud, "-o", octree});
    const ProgramRun run = run_roadbed(more);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.err.find("give --sensor"), std::string::npos) << run.err;
    const ProgramRun info = run_roadbed({"occupancy", "info", octree, "--json"});
    return Json::parse(info.out).at("free").at("volume_m3").get<double>();
  };
  EXPECT_NEAR(free_m3({}), 2 * 5.0 * 0.01, 1e-9);
  EXPECT_NEAR(free_m3({"--sensor", "5.0,0.05,0.05"}), 3.0 * 0.01, 0.2 * 0.01);
  EXPECT_NEAR(free_m3({"--no-carving"}), 0.0, 1e-9);
  const ProgramRun info = run_roadbed({"occupancy", "info", cloud, "--json"});
  EXPECT_EQ(Json::parse(info.out).at("scans"), 2);
}

class OccupancyBuildWithPcl : public NeedsPcl {};

TEST_F(OccupancyBuildWithPcl, CarvesFromTheSensorOfEachPointThatAFilterLeaves) {
  const TemporaryFolder folder;
  const std::string cloud = folder.write("shots.csv",
                                         "x,y,z,vp_x,vp_y,vp_z\n5,0.05,0.05,0,0.05,0.05\n"
                                         "5,3.05,0.05,0,3.05,0.05\n5,3.05,0.05,0,3.05,0.05\n");
  const std::string octree = folder / "out.bt";
  const ProgramRun run = run_roadbed({"occupancy", "build", cloud, "-o", octree, "--voxel", "0.2"});
  ASSERT_EQ(run.status, 0) << run.err;
  const ProgramRun info = run_roadbed({"occupancy", "info", octree, "--json"});
  EXPECT_NEAR(Json::parse(info.out).at("free").at("volume_m3").get<double>(), 2 * 5.0 * 0.01, 1e-9);
}

}  // namespace
}  // namespace roadbed::tests
