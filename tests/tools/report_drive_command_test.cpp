// `report drive` as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "roadbed/tests/support/log_bytes.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class ReportDrive : public testing::Test {
 protected:
  // Along y = 198.25 in the town's first street, at 10 m/s.
  std::string log() const {
    std::vector<McapMessage> messages;
    for (int k = 0; k <= 50; ++k) {
      const std::int64_t stamp_ns = 1'700'000'000'000'000'000 + 100'000'000LL * k;
      messages.push_back({stamp_ns, odometry_message(stamp_ns, 120.0 + k, 198.25, 0.0, 10.0)});
    }
    return folder_.write("log.mcap",
                         mcap_bytes("/odom", "nav_msgs/msg/Odometry", messages, "zstd"));
  }

  ProgramRun report(const std::vector<std::string>& more) const {
    std::vector<std::string> words{"report", "drive", log(), "-o", page_, "--force"};
    words.insert(words.end(), more.begin(), more.end());
    return run_roadbed(words);
  }

  const TemporaryFolder folder_;
  const std::string page_ = folder_ / "page.html";
  const std::string town_ = (data_folder() / "town.xodr").string();
  const std::string cells_ = (data_folder() / "town.bt").string();
};

TEST_F(ReportDrive, ShowsALogAsItIsWithWhatPassengersBear) {
  const ProgramRun run = report({});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_THAT(bytes_of(page_),
              AllOf(HasSubstr("log.mcap"), HasSubstr("recorded; nothing was asked"),
                    HasSubstr("largest yaw rate"), HasSubstr("\"Curvature\"")));
}

TEST_F(ReportDrive, OnItsMapIsAskedWhetherItStaysOnTheRoadAndKeepsTheRules) {
  const ProgramRun run = report({"--map", town_});
  EXPECT_EQ(run.status, 0) << run.err << run.out;
  EXPECT_THAT(run.out, HasSubstr("surface          clear, on drivable"));
  EXPECT_THAT(bytes_of(page_), AllOf(HasSubstr("clear: least clearance"), HasSubstr("rule: speed"),
                                     HasSubstr("\"limit\"")));
  const ProgramRun tight = report({"--map", town_, "--margin", "1.5"});
  EXPECT_EQ(tight.status, 1);
  EXPECT_THAT(bytes_of(page_), HasSubstr("the edge of its surface"));
}

TEST_F(ReportDrive, IsAuditedAgainstOccupancyAndObstacles) {
  const ProgramRun run = report({"--map", town_, "--occupancy", cells_, "--unknown", "free"});
  EXPECT_THAT(run.out, HasSubstr("least clearance"));
  const std::string boxes = folder_.write(
      "boxes.csv", "t_s,id,x_m,y_m,heading_rad,length_m,width_m\n0,wall,160,198.25,0,1,4\n");
  const ProgramRun into =
      report({"--occupancy", cells_, "--unknown", "free", "--obstacles", boxes});
  EXPECT_EQ(into.status, 1);
  EXPECT_THAT(into.out, HasSubstr("obstacle wall"));
  EXPECT_THAT(bytes_of(page_), HasSubstr("conflict begins: obstacle wall"));
}

TEST_F(ReportDrive, AsALogHoldsTheRowsThatWereRecorded) {
  const std::string played = folder_ / "played.mcap";
  ASSERT_EQ(report({"--map", town_, "--mcap", played}).status, 0);
  const auto drive_in = [](const std::string& file) {
    return nlohmann::json::parse(run_roadbed({"drive", "info", file, "--json"}).out)["drive"];
  };
  EXPECT_EQ(drive_in(played), drive_in(log()));
  EXPECT_EQ(drive_in(played)["rows"], 51);
}

TEST_F(ReportDrive, RefusesWhatItCannotShowAndLeavesNoOutput) {
  const std::string none = folder_ / "none.csv";
  const ProgramRun missing = run_roadbed({"report", "drive", none, "-o", page_});
  EXPECT_EQ(missing.status, 3);
  EXPECT_THAT(missing.err, HasSubstr("none.csv"));
  EXPECT_EQ(report({"--topic", "/no"}).status, 3);
  EXPECT_EQ(report({"--margin", "1"}).status, 2);
  EXPECT_EQ(report({"--ground", "map"}).status, 2);
  EXPECT_FALSE(std::filesystem::exists(page_));
}

// As audit says it of the same log.
TEST_F(ReportDrive, OfARealDriveSaysWhatTheAuditSays) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  const auto log = real / "argoverse2/argoverse+av2-api/7fab2350";
  const std::string poses = log / "city_SE3_egovehicle.feather";
  const std::string map =
      log / "map/log_map_archive_7fab2350-7eaf-3b7e-a39d-6937a4c1bede____PIT_city_47896.json";
  const ProgramRun shown = run_roadbed({"report", "drive", poses, "--map", map, "-o", page_});
  const ProgramRun asked =
      run_roadbed({"audit", "--trajectory", poses, "--map", map, "--on", "drivable"});
  EXPECT_EQ(shown.status, 0) << shown.err;
  EXPECT_EQ(shown.out, asked.out);
  EXPECT_THAT(bytes_of(page_), Not(HasSubstr("failed</td>")));
}

}  // namespace
}  // namespace roadbed::tests
