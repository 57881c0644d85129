#include "roadbed/tools/audit/audit_clock.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/tools/audit/audit_command_fixture.h"
#include "roadbed/tools/audit/road_audit.h"

namespace roadbed::tools {
namespace {

using tests::ProgramRun;
using tests::run_roadbed;
using tests::TemporaryFolder;

constexpr int kStart = 30;  // the problem's initial time step, of 0.1 s

std::string state(const std::string& element, double x_m, int step) {
  return fmt::format(
      "<{0}><position><point><x>{1}</x><y>2</y></point></position>"
      "<orientation><exact>0</exact></orientation><time><exact>{2}</exact></time>"
      "<velocity><exact>0</exact></velocity></{0}>",
      element, x_m, step);
}

std::string problem_at(int step) {
  return "<planningProblem id=\"9\">" + state("initialState", 10.0, step) + "</planningProblem>";
}

/// A lane along x from 0 to 50 m and one on to 120 m, each from y = 0 to 4 m.
std::string lanelet(int id, double from_x_m, double to_x_m, const std::string& links) {
  const auto bound = [&](const char* name, double y_m) {
    return fmt::format(
        "<{0}><point><x>{1}</x><y>{3}</y></point><point><x>{2}</x><y>{3}</y></point></{0}>", name,
        from_x_m, to_x_m, y_m);
  };
  return fmt::format("<lanelet id=\"{}\">", id) + bound("leftBound", 4.0) +
         bound("rightBound", 0.0) + links + "</lanelet>";
}

/// Red for 4 s, then green for 6 s, at x = 50 m.
const std::string kLight =
    "<trafficLight id=\"50\"><cycle>"
    "<cycleElement><duration>40</duration><color>red</color></cycleElement>"
    "<cycleElement><duration>60</duration><color>green</color></cycleElement>"
    "<timeOffset>0</timeOffset></cycle><active>true</active></trafficLight>";

const std::string kRoads =
    lanelet(1, 0.0, 50.0,
            "<successor ref=\"2\"/><stopLine><point><x>50</x><y>4</y></point>"
            "<point><x>50</x><y>0</y></point><lineMarking>solid</lineMarking>"
            "<trafficLightRef ref=\"50\"/></stopLine><laneletType>urban</laneletType>"
            "<trafficLightRef ref=\"50\"/>") +
    lanelet(2, 50.0, 120.0, "<predecessor ref=\"1\"/><laneletType>urban</laneletType>") + kLight;

/// Stands at x = 80 m from second 6 of the recording, the problem's 3, to its second 12.
std::string standing_car() {
  return "<dynamicObstacle id=\"42\"><type>car</type><shape><rectangle><length>4</length>"
         "<width>2</width></rectangle></shape>" +
         state("initialState", 80.0, 60) + "<trajectory>" + state("state", 80.0, 120) +
         "</trajectory></dynamicObstacle>";
}

/// A scenario of those; a drive at 10 m/s from x = 10 m, of its own time or in absolute steps.
class AuditClock : public testing::Test {
 protected:
  std::string scenario(const std::string& more) const {
    return folder_.write(
        "scenario.xml",
        "<commonRoad timeStepSize=\"0.1\" commonRoadVersion=\"2020a\" benchmarkID=\"ZAM_X-1\">" +
            more + "</commonRoad>");
  }

  std::string table() const {
    return folder_.write("drive.csv", "t_s,x_m,y_m,heading_rad\n0,10,2,0\n8,90,2,0\n");
  }

  std::string solution() const {
    std::string states;
    for (int i = 0; i <= 80; ++i) {
      states += fmt::format(
          "<ksState><x>{}</x><y>2</y><steeringAngle>0</steeringAngle><velocity>10</velocity>"
          "<orientation>0</orientation><time>{}</time></ksState>",
          11.4227171 + i, kStart + i);  // of the middle of vehicle 2's body
    }
    return folder_.write("solution.xml",
                         "<CommonRoadSolution benchmark_id=\"KS2:SM1:X:2020a\"><ksTrajectory "
                         "planningProblem=\"9\">" +
                             states + "</ksTrajectory></CommonRoadSolution>");
  }

  static ProgramRun audit(std::vector<std::string> more) {
    more.insert(more.begin(), "audit");
    return run_roadbed(more);
  }

  static nlohmann::json json_of(std::vector<std::string> more) {
    more.push_back("--json");
    const ProgramRun run = audit(more);
    EXPECT_LE(run.status, 1) << run.err;
    return nlohmann::json::parse(run.out);
  }

  TemporaryFolder folder_;
};

TEST_F(AuditClock, OfASolutionIsStep0AndElseTheProblemsStart) {
  const std::array<std::filesystem::path, 2> files{"", scenario(problem_at(kStart))};
  EXPECT_EQ(second_0_step(solution(), files), 0);
  EXPECT_EQ(second_0_step(table(), files), kStart);
  EXPECT_EQ(second_0_step("", files), kStart);
  const std::array<std::filesystem::path, 1> without{scenario(kLight)};
  EXPECT_EQ(second_0_step(table(), without), 0);
  EXPECT_EQ(second_0_step(table(), {}), 0);
}

TEST_F(AuditClock, MovesLights) {
  const std::string file = scenario(kLight);
  ASSERT_EQ(recorded_lights(file, 0).size(), 1u);
  EXPECT_NEAR(recorded_lights(file, 0).front().offset_s, 0.0, 1e-12);
  EXPECT_NEAR(recorded_lights(file, kStart).front().offset_s, -3.0, 1e-12);
}

// The front passes the stop line at (50 − 13.6767171) / 10 = 3.63 s of the drive: after 3.63 s it
// is red, after 3 s more it is green.

TEST_F(AuditClock, HasLightsShowWhatTheyDoFromTheProblemsStartOn) {
  const auto lights = [&](const std::string& drive, int start) {
    const std::string map = scenario(kRoads + problem_at(start));
    return json_of({"--map", map, "--on", "drivable", "--rules", "lights", "--trajectory", drive,
                    "--rate", "10"})["rules"]["lights"]["verdict"];
  };
  EXPECT_EQ(lights(table(), kStart), "clear");
  EXPECT_EQ(lights(table(), 0), "conflict");
  EXPECT_EQ(lights(solution(), kStart), "clear");
}

// The car is there from second 3 of the drive on, and at second (78 − 13.6767171) / 10 = 6.432 of
// the drive the front is at its rear: second 9.432 in absolute steps.

TEST_F(AuditClock, HasObstaclesWhereTheSolutionMeetsThem) {
  const std::string post = folder_.write("post.pcd", tests::post_pcd());
  const auto met_s = [&](const std::string& drive) {
    const auto json =
        json_of({"--occupancy", post, "--unknown", "free", "--trajectory", drive, "--rate", "10",
                 "--obstacles", scenario(standing_car() + problem_at(kStart))});
    for (const auto& conflict : json["conflicts"]) {
      if (conflict["obstacle"] == "42") return conflict["from_s"].get<double>();
    }
    return -1.0;
  };
  EXPECT_NEAR(met_s(table()), 6.432, 0.02);
  EXPECT_NEAR(met_s(solution()), 9.432, 0.02);
}

TEST_F(AuditClock, IsThatOfSavedObstaclesInACertificate) {
  const std::string post = folder_.write("post.pcd", tests::post_pcd());
  std::vector<std::string> question{
      "--occupancy",      post,
      "--unknown",        "free",
      "--trajectory",     solution(),
      "--rate",           "10",
      "--obstacles",      scenario(standing_car() + problem_at(kStart)),
      "--certificate",    folder_ / "proof.json",
      "--save-drive",     folder_ / "saved.csv",
      "--save-occupancy", folder_ / "post.bt"};
  const ProgramRun refused = audit(question);
  EXPECT_EQ(refused.status, 3);
  EXPECT_THAT(refused.err, testing::HasSubstr("--save-obstacles"));
  question.insert(question.end(), {"--save-obstacles", folder_ / "boxes.csv"});
  EXPECT_EQ(audit(question).status, 1);
  EXPECT_EQ(audit({"--check", folder_ / "proof.json"}).status, 0);
}

}  // namespace
}  // namespace roadbed::tools
