#include "roadbed/tools/simulation/recorded_obstacle.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <string>

#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/log_bytes.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/refusal_of.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools {
namespace {

using nlohmann::json;
using std::complex;
using testing::HasSubstr;

constexpr double kTurn_radps = 0.1, kRadius_m = 50.0;

// On a circle beside the town's first street, at 5 m/s.
complex<double> axle_at(double t_s) {
  return complex<double>(150.0, 300.0) + std::polar(kRadius_m, kTurn_radps * t_s);
}
double heading_at(double t_s) { return kTurn_radps * t_s + std::asin(1.0); }

class RecordedOther : public testing::Test {
 protected:
  std::string circle_csv() const {
    std::string text = "t_s,x_m,y_m,heading_rad,speed_mps\n";
    for (int k = 0; k <= 40; ++k) {
      const double t_s = 0.1 * k;
      text += fmt::format("{},{},{},{},5\n", t_s, axle_at(t_s).real(), axle_at(t_s).imag(),
                          heading_at(t_s));
    }
    return folder_.write("circle.csv", text);
  }

  std::string scenario_with(const json& recorded) const {
    const std::string town = (tests::data_folder() / "town.xodr").string();
    return folder_.write(
        "scenario.json",
        json{{"roadbed_scenario", 1},
             {"map", town},
             {"ego", {{"start", "lane:1/3/1@6"}}},
             {"goal", "lane:1/3/1@45"},
             {"duration_s", 20.0},
             {"obstacles", {{{"id", "other"}, {"length_m", 4.0}, {"recorded", recorded}}}}}
            .dump());
  }

  planning::Obstacle other(const json& recorded) const {
    return make_world(read_scenario(scenario_with(recorded)), Inputs()).obstacles.at(0);
  }

  std::string refusal(const json& recorded) const {
    return tests::refusal_of([&] { other(recorded); });
  }

  // The centre is half of its length, less the overhang, ahead of the rear axle.
  void expect_on_circle(const planning::Obstacle& other, double overhang_m, double offset_s) const {
    const auto road_map = map::load_map(tests::data_folder() / "town.xodr");
    for (const double t_s : {0.0, 1.1, 2.5, 4.0}) {
      const complex<double> centre = axle_at(t_s) + std::polar(2.0 - overhang_m, heading_at(t_s));
      const geometry::Pose2 pose = other.pose_at(t_s + offset_s);
      const Eigen::Vector2d found = road_map.to_source(pose.position());
      EXPECT_NEAR(found.x(), centre.real(), 1e-9) << t_s;
      EXPECT_NEAR(found.y(), centre.imag(), 1e-9) << t_s;
      EXPECT_NEAR(pose.heading_rad, heading_at(t_s), 1e-12);
    }
  }

  const tests::TemporaryFolder folder_;
};

TEST_F(RecordedOther, MovesAsItsDriveWithTheCentreAheadOfTheRearAxle) {
  circle_csv();
  const planning::Obstacle own = other({{"file", "circle.csv"}});
  expect_on_circle(own, 0.8312829, 0.0);
  EXPECT_EQ(own.motion.at(1.0).speed_mps, 5.0);
  expect_on_circle(other({{"file", "circle.csv"}, {"rear_overhang_m", 0.5}, {"offset_s", 7.0}}),
                   0.5, 7.0);
}

TEST_F(RecordedOther, IsThereFromItsFirstRowToItsLast) {
  circle_csv();
  const planning::Obstacle later = other({{"file", "circle.csv"}, {"offset_s", 2.0}});
  EXPECT_FALSE(later.is_there(1.99));
  EXPECT_TRUE(later.is_there(2.01));
  EXPECT_TRUE(later.is_there(5.99));
  EXPECT_FALSE(later.is_there(6.01));
}

TEST_F(RecordedOther, ComesFromALogByTheNameOfItsTopic) {
  std::vector<tests::McapMessage> messages;
  for (int k = 0; k <= 40; ++k) {
    const double t_s = 0.1 * k;
    const std::int64_t stamp_ns = 1'700'000'000'000'000'000 + 100'000'000LL * k;
    messages.push_back(
        {stamp_ns, tests::odometry_message(stamp_ns, axle_at(t_s).real(), axle_at(t_s).imag(),
                                           heading_at(t_s), 5.0)});
  }
  folder_.write("log.mcap", tests::mcap_bytes("/odom", "nav_msgs/msg/Odometry", messages, "zstd"));
  expect_on_circle(other({{"file", "log.mcap"}, {"topic", "/odom"}}), 0.8312829, 0.0);
  EXPECT_THAT(refusal({{"file", "log.mcap"}, {"topic", "/no"}}), HasSubstr("/no"));
}

TEST_F(RecordedOther, OfPosesOfItsBodysCentreIsThere) {
  std::string lines;
  for (int k = 0; k <= 40; ++k) {
    const double t_s = 0.1 * k, half_rad = 0.5 * heading_at(t_s);
    lines += fmt::format("{} {} {} 0 0 0 {} {}\n", t_s, axle_at(t_s).real(), axle_at(t_s).imag(),
                         std::sin(half_rad), std::cos(half_rad));
  }
  folder_.write("poses.txt", lines);
  EXPECT_THAT(refusal({{"file", "poses.txt"}}), HasSubstr("which point of the vehicle"));
  expect_on_circle(other({{"file", "poses.txt"}, {"pose_frame", "centre"}}), 2.0, 0.0);
  expect_on_circle(other({{"file", "poses.txt"}, {"pose_frame", "0.25,0"}}), 0.8312829 + 0.25, 0.0);
}

TEST_F(RecordedOther, ThatIsNeverThereOrUnusableIsRefusedAtItsPlace) {
  circle_csv();
  EXPECT_THAT(refusal({{"file", "circle.csv"}, {"offset_s", 20.5}}),
              HasSubstr("/obstacles/0/recorded: is there from 20.5 s to 24.5 s"));
  EXPECT_THAT(refusal({{"file", "circle.csv"}, {"offset_s", -4.5}}),
              HasSubstr("/obstacles/0/recorded: is there from -4.5 s to -0.5 s"));
  EXPECT_THAT(refusal({{"file", "circle.csv"}, {"pose_frame", "nose"}}),
              HasSubstr("/obstacles/0/recorded/pose_frame: is \"nose\""));
  EXPECT_THAT(refusal({{"file", "circle.csv"}, {"rate_hz", 0}}),
              HasSubstr("/obstacles/0/recorded/rate_hz: is 0"));
  EXPECT_THAT(refusal({{"file", "none.csv"}}), HasSubstr("none.csv"));
}

TEST_F(RecordedOther, IsAmongTheFilesThatAScenarioNames) {
  const std::string circle = circle_csv();
  EXPECT_THAT(files_named_by_scenario(scenario_with({{"file", "circle.csv"}})),
              testing::Contains(std::filesystem::path(circle)));
}

// What was driven before stands in the way now.
TEST_F(RecordedOther, KeepsTheEgoBehindIt) {
  const std::string town = (tests::data_folder() / "town.xodr").string();
  const auto scenario = [&](const char* start, const char* goal, const json& obstacles) {
    return json{{"roadbed_scenario", 1},
                {"map", town},
                {"ego", {{"start", start}, {"speed_mps", 5.0}}},
                {"goal", goal},
                {"duration_s", 40.0},
                {"options", {{"desired_speed_mps", 5.0}}},
                {"obstacles", obstacles}}
        .dump();
  };
  const std::string first =
      folder_.write("first.json", scenario("lane:1/3/1@26", "lane:1/3/1@60", json::array()));
  const std::string lead = folder_ / "lead", behind = folder_ / "behind";
  ASSERT_EQ(tests::run_roadbed({"simulate", first, "-o", lead}).status, 0);
  const json obstacles{{{"id", "lead"}, {"recorded", {{"file", "lead/trajectory.csv"}}}}};
  std::string second = scenario("lane:1/3/1@6", "lane:1/3/1@60", obstacles);
  second.replace(second.find("\"desired_speed_mps\":5.0"), 23, "\"desired_speed_mps\":14.0");
  const std::string file = folder_.write("second.json", second);
  const auto run = tests::run_roadbed({"simulate", file, "-o", behind});
  EXPECT_LE(run.status, 1) << run.err;
  const json metrics = json::parse(tests::bytes_of(folder_ / "behind/metrics.json"));
  EXPECT_GT(metrics.at("least_clearance_m").get<double>(), 0.3);
  EXPECT_LT(metrics.at("least_clearance_m").get<double>(), 15.0);  // of 15.5 m at the start
}

}  // namespace
}  // namespace roadbed::tools
