#include "roadbed/tools/audit/argoverse_log.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tests/support/needs_pcl.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tools {
namespace {

using planning::ObstacleInSource;
using testing::HasSubstr;

// What data/make_argoverse_log.py says of its street.
constexpr double kStartX_m = 1000.0, kStreetY_m = 2000.0;

std::filesystem::path made_log() { return tests::data_folder() / "argoverse_log"; }

const ObstacleInSource& named(const std::vector<ObstacleInSource>& obstacles,
                              const std::string& id) {
  return *std::ranges::find(obstacles, id, &ObstacleInSource::id);
}

class ArgoverseLogTest : public tests::NeedsPcl {};

TEST(ArgoverseLog, HasItsSweepsInTheOrderOfTheirTimes) {
  const ArgoverseLog log = argoverse_log(made_log());
  ASSERT_EQ(log.sweeps.size(), 5u);
  EXPECT_EQ(log.sweeps.front().stem(), "1700000001600000000");
  EXPECT_EQ(log.map.filename(), "log_map_archive_made____PIT_city_1.json");
  EXPECT_FALSE(log.annotations.empty());
}

TEST(ArgoverseLog, HasAnnotatedBoxesInTheCityAtTimesOfItsDrive) {
  const LogScene scene = scene_of_log(argoverse_log(made_log()), LogBoxes::annotated, 1);
  ASSERT_EQ(scene.obstacles.size(), 6u);
  const ObstacleInSource& ahead = named(scene.obstacles, "ahead");
  EXPECT_EQ(ahead.kind, "REGULAR_VEHICLE");
  EXPECT_EQ(ahead.length_m, 4.6);
  for (const double t_s : {0.0, 1.0, 2.5, 5.0}) {
    EXPECT_NEAR(ahead.pose_at(t_s).x_m, kStartX_m + 36.0 + 8.0 * t_s, 0.01) << t_s;
    EXPECT_NEAR(ahead.pose_at(t_s).y_m, kStreetY_m - 1.75, 0.01) << t_s;
    EXPECT_NEAR(ahead.pose_at(t_s).heading_rad, 0.0, 1e-6) << t_s;
    EXPECT_NEAR(named(scene.obstacles, "oncoming").pose_at(t_s).x_m, kStartX_m + 82 - 11 * t_s,
                0.01);
  }
}

// A box stands for its points: where it has gone nothing is left of them.
TEST(ArgoverseLog, LeavesPointsOfBoxesOutOfTheOccupancy) {
  const LogScene scene = scene_of_log(argoverse_log(made_log()), LogBoxes::annotated, 1);
  const ObstacleInSource& ahead = named(scene.obstacles, "ahead");
  const auto is_occupied = [&](double x_m, double y_m) {
    const map::Box3 box{{x_m - 0.3, y_m - 0.3, 31.0}, {x_m + 0.3, y_m + 0.3, 33.0}};
    return std::ranges::any_of(scene.occupancy->cells_in(box), [&](const auto& cell) {
      return cell.state == map::CellState::occupied && box.holds(cell.centre_in_source);
    });
  };
  for (const double t_s : {1.6, 1.8, 2.0, 2.2, 2.4}) {
    const geometry::Pose2 rear = ahead.pose_at(t_s) * geometry::Pose2{-2.3, 0.0, 0.0};
    EXPECT_FALSE(is_occupied(rear.x_m, rear.y_m)) << t_s;
  }
  EXPECT_TRUE(is_occupied(kStartX_m + 37.0, kStreetY_m + 10.0));  // a house
}

// Between the scanner, 1.9 m over the axle, and what it sees; behind a house it saw nothing.
TEST(ArgoverseLog, HasFreeSpaceWhereTheLidarsSawThrough) {
  const LogScene scene = scene_of_log(argoverse_log(made_log()), LogBoxes::annotated, 1);
  const auto states_at = [&](double x_m, double y_m, double above_m) {
    const double z_m = 30.0 + 0.02 * x_m + above_m;
    const map::Box3 box{{kStartX_m + x_m - 0.2, kStreetY_m + y_m - 0.2, z_m - 0.2},
                        {kStartX_m + x_m + 0.2, kStreetY_m + y_m + 0.2, z_m + 0.2}};
    std::set<map::CellState> states;
    for (const auto& cell : scene.occupancy->cells_in(box)) {
      const double reach_m = 0.2 + 0.5 * cell.size_m;
      const Eigen::Vector3d off_m =
          cell.centre_in_source - 0.5 * (box.min_in_source + box.max_in_source);
      if (off_m.cwiseAbs().maxCoeff() < reach_m) states.insert(cell.state);
    }
    return states;
  };
  using testing::Contains;
  using testing::IsEmpty;
  EXPECT_THAT(states_at(30.0, -1.75, 1.5), Contains(map::CellState::free));
  EXPECT_THAT(states_at(28.0, 0.0, 0.8), Contains(map::CellState::free));
  EXPECT_THAT(states_at(37.0, 14.0, 2.0), IsEmpty()) << "in a house";
}

TEST_F(ArgoverseLogTest, FindsWhatIsAnnotated) {
  const ArgoverseLog log = argoverse_log(made_log());
  const LogScene annotated = scene_of_log(log, LogBoxes::annotated, 1);
  const LogScene found = scene_of_log(log, LogBoxes::found, 2);
  for (const char* id : {"ahead", "oncoming", "parked badly", "in a bay"}) {
    const ObstacleInSource& truth = named(annotated.obstacles, id);
    const auto is_it = [&](const ObstacleInSource& box) {
      return box.is_there(2.0) &&  // of who drives ahead the rear is seen
             geometry::distance_m(rectangle_at(box, 2.0), rectangle_at(truth, 2.0)) == 0.0;
    };
    const auto it = std::ranges::find_if(found.obstacles, is_it);
    ASSERT_NE(it, found.obstacles.end()) << id;
    const Eigen::Vector2d truly_gone =
        truth.pose_at(2.4).position() - truth.pose_at(1.6).position();
    const Eigen::Vector2d gone = it->pose_at(2.4).position() - it->pose_at(1.6).position();
    EXPECT_LT((gone - truly_gone).norm(), 0.5) << id;
  }
}

TEST(ArgoverseLog, RefusesAFolderThatIsNone) {
  const tests::TemporaryFolder folder;
  const auto refused = [&](const char* reason) {
    try {
      argoverse_log(folder.path());
      ADD_FAILURE() << "taken without " << reason;
    } catch (const map::InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(reason));
    }
  };
  const auto copy = [&](const char* name) {
    std::filesystem::copy(made_log() / name, folder / name,
                          std::filesystem::copy_options::recursive);
  };
  refused("has no city_SE3_egovehicle.feather");
  copy("city_SE3_egovehicle.feather");
  refused("has 0 maps");
  copy("map");
  refused("has no *.feather in its sensors/lidar");
  copy("sensors");
  const ArgoverseLog log = argoverse_log(folder.path());
  EXPECT_TRUE(log.annotations.empty());
  EXPECT_THROW(scene_of_log(log, LogBoxes::annotated, 1), map::InputError);
}

TEST(ArgoverseLog, RefusesDamagedAnnotations) {
  const tests::TemporaryFolder folder;
  std::filesystem::copy(made_log(), folder / "log", std::filesystem::copy_options::recursive);
  const std::string whole = tests::bytes_of(made_log() / "annotations.feather");
  for (std::size_t length = 0; length < whole.size(); length += 97) {
    folder.write("log/annotations.feather", whole.substr(0, length));
    EXPECT_THROW(scene_of_log(argoverse_log(folder / "log"), LogBoxes::annotated, 1),
                 map::InputError)
        << length;
  }
  folder.write("log/annotations.feather",
               tests::bytes_of(made_log() / "city_SE3_egovehicle.feather"));
  EXPECT_THROW(scene_of_log(argoverse_log(folder / "log"), LogBoxes::annotated, 1),
               map::InputError);
}

TEST_F(ArgoverseLogTest, IsAuditedAgainstMapHitsAndBoxesByOneCommand) {
  const auto audit = [](const std::vector<std::string>& more) {
    std::vector<std::string> words{"audit", "--log", made_log(), "--unknown", "free", "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return tests::run_roadbed(words);
  };
  const tests::ProgramRun annotated = audit({"--boxes", "annotated"}), found = audit({});
  EXPECT_EQ(annotated.status, 0) << annotated.err << annotated.out;
  EXPECT_EQ(found.status, 0) << found.err << found.out;
  const auto json = nlohmann::json::parse(annotated.out);
  EXPECT_EQ(json.at("verdict"), "clear");
  EXPECT_TRUE(json.contains("surface"));
  // The car that has parked on the lane's edge: its corner is 0.3 m into the lane.
  EXPECT_LT(json.at("least_clearance_m").get<double>(), 0.8);
  EXPECT_GT(json.at("least_clearance_m").get<double>(), 0.5);
  const tests::ProgramRun nearer = audit({"--boxes", "annotated", "--clearance", "0.9"});
  EXPECT_EQ(nearer.status, 1);
  EXPECT_THAT(nearer.out, HasSubstr("parked badly"));
}

TEST(ArgoverseLog, IsProvenByTheFilesThatItsAuditSaved) {
  const tests::TemporaryFolder folder;
  const std::string proof = folder / "proof.json", boxes = folder / "boxes.csv";
  const std::vector<std::string> question{"audit",     "--log",     made_log(), "--boxes",
                                          "annotated", "--unknown", "free",     "--json"};
  std::vector<std::string> words = question;
  words.insert(words.end(), {"--certificate", proof, "--save-drive", folder / "drive.csv",
                             "--save-occupancy", folder / "street.bt", "--save-obstacles", boxes});
  const tests::ProgramRun audit = tests::run_roadbed(words);
  ASSERT_EQ(audit.status, 0) << audit.err << audit.out;
  const auto least_m = [](const tests::ProgramRun& run) {
    return nlohmann::json::parse(run.out).at("least_clearance_m").get<double>();
  };
  EXPECT_NEAR(least_m(audit), least_m(tests::run_roadbed(question)), 1e-5) << "boxes are rounded";
  const tests::ProgramRun check = tests::run_roadbed({"audit", "--check", proof});
  EXPECT_EQ(check.status, 0) << check.out;
  EXPECT_THAT(check.out, HasSubstr("boxes.csv"));
  // A box that is nearer is another question.
  std::string nearer = tests::bytes_of(boxes);
  nearer += "0,late,1010,1998.2,0,1,1\n";
  folder.write("boxes.csv", nearer);
  EXPECT_EQ(tests::run_roadbed({"audit", "--check", proof}).status, 1);
}

TEST(ArgoverseLog, SaysWhatCannotStandBesideIt) {
  const std::string log = made_log();
  EXPECT_EQ(tests::run_roadbed({"audit", "--log", log, "--trajectory", log}).status, 2);
  const auto bare = tests::run_roadbed({"audit", "--log", log, "--certificate", "a.json"});
  EXPECT_EQ(bare.status, 2);
  EXPECT_THAT(bare.err, HasSubstr("needs --save-drive, --save-occupancy, --save-obstacles"));
  EXPECT_EQ(tests::run_roadbed({"audit", "--boxes", "found", "--lane", "lane:1"}).status, 2);
  EXPECT_EQ(tests::run_roadbed({"audit", "--log", log + "/none"}).status, 3);
}

}  // namespace
}  // namespace roadbed::tools
