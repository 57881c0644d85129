#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "roadbed/tests/support/log_bytes.h"
#include "roadbed/tests/support/made_log.h"
#include "roadbed/tests/support/packed.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class DriveLog : public testing::Test {
 protected:
  std::string in(const char* name) const { return (data_folder() / name).string(); }
  std::string out(const std::string& name) const { return (folder_ / name).string(); }

  // 45 m along the town's first street.
  std::string short_scenario() {
    return folder_.write("scenario.json",
                         json{{"roadbed_scenario", 1},
                              {"map", in("town.xodr")},
                              {"ego", {{"start", "lane:1/3/1@6"}, {"speed_mps", 8.0}}},
                              {"goal", "lane:1/3/1@45"},
                              {"duration_s", 20.0}}
                             .dump());
  }

  json info(const std::string& file) {
    const ProgramRun run = run_roadbed({"drive", "info", file, "--json"});
    EXPECT_EQ(run.status, 0) << run.err;
    return json::parse(run.out);
  }

  const TemporaryFolder folder_;
};

TEST_F(DriveLog, OfASimulatedDriveIsReadBackByteForByte) {
  ASSERT_EQ(run_roadbed({"simulate", short_scenario(), "--mcap", "-o", out("drive")}).status, 0);
  const std::string log = out("drive/drive.mcap"), saved = out("back.csv");
  const ProgramRun audit = run_roadbed({"audit", "--map", in("town.xodr"), "--on", "drivable",
                                        "--trajectory", log, "--save-drive", saved});
  ASSERT_LE(audit.status, 1) << audit.err;
  EXPECT_EQ(bytes_of(saved), bytes_of(out("drive/trajectory.csv")));
  EXPECT_EQ(info(log)["drive"], info(out("drive/trajectory.csv"))["drive"]);
}

TEST_F(DriveLog, HasATopicForEachThing) {
  ASSERT_EQ(run_roadbed({"simulate", short_scenario(), "--mcap", "-o", out("drive")}).status, 0);
  const json found = info(out("drive/drive.mcap"));
  const std::size_t rows = found["drive"]["rows"].get<std::size_t>();
  std::map<std::string, std::size_t> messages;
  for (const json& topic : found["topics"]) {
    EXPECT_EQ(topic["encoding"], "protobuf");
    messages[topic["topic"]] = topic["messages"].get<std::size_t>();
  }
  EXPECT_EQ(messages["/drive"], rows);
  EXPECT_EQ(messages["/tf"], rows + 1) << "and the scene in the map";
  EXPECT_EQ(messages["/fix"], rows) << "the town names its coordinate system";
  EXPECT_EQ(messages["/scene/lanes"], 1u);
  EXPECT_EQ(messages["/scene/vehicle"], 1u);
  EXPECT_EQ(messages["/drive/path"], 1u);
  EXPECT_GT(messages["/plan"], rows / 2);
  EXPECT_GT(messages["/log"], 1u);
}

TEST_F(DriveLog, DrawsCandidatesWhereTheyWereKept) {
  const auto messages_of = [&](const char* drive, std::vector<std::string> more) {
    std::vector<std::string> words{"simulate", short_scenario(), "--mcap", "-o", out(drive)};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(run_roadbed(words).status, 0);
    std::map<std::string, std::size_t> messages;
    const json found = info(out(std::string(drive) + "/drive.mcap"));
    for (const json& topic : found["topics"]) {
      messages[topic["topic"]] = topic["messages"].get<std::size_t>();
    }
    return messages;
  };
  auto with = messages_of("with", {"--candidates"}), without = messages_of("without", {});
  EXPECT_GT(with["/plan/candidates"], 10u);
  EXPECT_EQ(with["/plan/candidate_lines"], with["/plan/candidates"]);
  EXPECT_EQ(without["/plan/candidate_lines"], 0u);
}

TEST_F(DriveLog, OfAnEarlierDriveGoesWithIt) {
  ASSERT_EQ(run_roadbed({"simulate", short_scenario(), "--mcap", "-o", out("drive")}).status, 0);
  ASSERT_EQ(run_roadbed({"simulate", short_scenario(), "-o", out("drive"), "--force"}).status, 0);
  EXPECT_FALSE(std::filesystem::exists(out("drive/drive.mcap")));
}

TEST_F(DriveLog, OfAnAuditShowsItsStretchesAndIsTheSameAgain) {
  const std::vector<std::string> audit{"audit",         "--occupancy", in("town.bt"), "--map",
                                       in("town.xodr"), "--lane",      "lane:1/3/1@6"};
  for (const char* name : {"a.mcap", "b.mcap"}) {
    std::vector<std::string> words = audit;
    words.insert(words.end(), {"--mcap", out(name)});
    ASSERT_LE(run_roadbed(words).status, 1);
  }
  EXPECT_EQ(bytes_of(out("a.mcap")), bytes_of(out("b.mcap")));
  std::map<std::string, std::size_t> messages;
  const json found = info(out("a.mcap"));
  for (const json& topic : found["topics"]) {
    messages[topic["topic"]] = topic["messages"].get<std::size_t>();
  }
  EXPECT_EQ(messages["/audit"], 1u);
  EXPECT_EQ(messages["/occupancy"], 1u);
  EXPECT_EQ(messages["/audit/clearance"], messages["/drive"]);
}

TEST_F(DriveLog, OfAFolderIsRefused) {
  ASSERT_EQ(run_roadbed({"simulate", short_scenario(), "-o", out("drives/one")}).status, 0);
  const ProgramRun run = run_roadbed({"audit", "--occupancy", in("town.bt"), "--trajectory",
                                      out("drives"), "--mcap", out("all.mcap")});
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, HasSubstr("about one drive"));
  EXPECT_FALSE(std::filesystem::exists(out("all.mcap")));
}

TEST_F(DriveLog, OfCloudsIsAuditedByAPipe) {
  ASSERT_EQ(run_roadbed({"simulate", short_scenario(), "-o", out("drive")}).status, 0);
  const ProgramRun built = run_roadbed({"occupancy", "build", in("scans/scan_00.pcd"),
                                        in("scans/scan_01.pcd"), "-o", "-", "--format", "bt"});
  ASSERT_EQ(built.status, 0) << built.err;
  const ProgramRun audit = run_roadbed_reading(
      folder_.write("piped.bt", built.out),
      {"audit", "--occupancy", "-", "--trajectory", out("drive/trajectory.csv"), "--json"});
  EXPECT_LE(audit.status, 1) << audit.err;
  EXPECT_TRUE(json::parse(audit.out).contains("least_clearance_m"));
}

TEST_F(DriveLog, PackedToAThousandthIsRefusedBeforeItIsUnpacked) {
  const std::string bomb = "\x89MCAP0\r\n" + std::string(300'000'000, '\0');
  const ProgramRun run =
      run_roadbed({"drive", "info", folder_.write("bomb.mcap", zstandard(bomb))});
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, HasSubstr("bomb.mcap: unpacks to more than 24"));
}

/// Straight on at 10 m/s, a row every 0.1 s; 3 s are missing after 2 s, and from 7 s on all is 8 m
/// farther.
std::string gapped_csv() {
  std::string csv = "t_s,x_m,y_m,heading_rad,speed_mps\n";
  for (int i = 0; i <= 100; ++i) {
    if (i > 20 && i < 50) continue;
    csv += std::to_string(i / 10) + "." + std::to_string(i % 10) + "," +
           std::to_string(i + (i >= 70 ? 8 : 0)) + ",0,0,10\n";
  }
  return csv;
}

void expect_gap_and_jump(const json& drive) {
  ASSERT_EQ(drive["gaps"].size(), 1u) << drive["gaps"];
  EXPECT_NEAR(drive["gaps"][0]["after_s"].get<double>(), 2.0, 1e-9);
  EXPECT_NEAR(drive["gaps"][0]["length_s"].get<double>(), 3.0, 1e-9);
  ASSERT_EQ(drive["jumps"].size(), 1u) << drive["jumps"];
  EXPECT_NEAR(drive["jumps"][0]["t_s"].get<double>(), 7.0, 1e-9);
  EXPECT_NEAR(drive["jumps"][0]["step_m"].get<double>(), 9.0, 1e-9);
  // (10 m/s + 15 m/s² · 0.1 s) · 0.1 s + 0.1 m
  EXPECT_NEAR(drive["jumps"][0]["most_m"].get<double>(), 1.25, 1e-6);
}

TEST_F(DriveLog, InfoFindsTheGapAndTheJumpOfATable) {
  expect_gap_and_jump(info(folder_.write("gapped.csv", gapped_csv()))["drive"]);
}

TEST_F(DriveLog, InfoFindsTheGapAndTheJumpOfALogAndOfItsTopics) {
  constexpr std::int64_t start_ns = 1'700'000'000'000'000'000;
  std::vector<McapMessage> messages;
  for (int i = 0; i <= 100; ++i) {
    if (i > 20 && i < 50) continue;
    const std::int64_t t_ns = start_ns + std::int64_t{100'000'000} * i;
    messages.push_back({t_ns, odometry_message(t_ns, i + (i >= 70 ? 8.0 : 0.0), 0.0, 0.0, 10.0)});
  }
  std::swap(messages[5], messages[6]);  // recorded in another order
  const std::string file =
      folder_.write("gapped.mcap", mcap_bytes("/odom", "nav_msgs/msg/Odometry", messages, "zstd"));
  const json found = info(file);
  ASSERT_TRUE(found["no_drive"].is_null()) << found["no_drive"];
  expect_gap_and_jump(found["drive"]);
  ASSERT_EQ(found["topics"].size(), 1u);
  const json& topic = found["topics"][0];
  EXPECT_EQ(topic["messages"], 72);
  EXPECT_EQ(topic["backwards"], 1);
  EXPECT_NEAR(topic["rate_hz"].get<double>(), 10.0, 1e-9);
  ASSERT_EQ(topic["gaps"].size(), 1u);
  EXPECT_NEAR(topic["gaps"][0]["after_s"].get<double>(), 2.0, 1e-9);
  EXPECT_NEAR(topic["gaps"][0]["length_s"].get<double>(), 3.0, 1e-9);
}

/// Messages of /tf at 10 Hz from each of three publishers, 1 ms after each other; of the third some
/// are missing for half a second.
std::vector<McapMessage> three_publishers() {
  std::vector<McapMessage> messages;
  constexpr std::int64_t start_ns = 1'700'000'000'000'000'000;
  for (int i = 0; i <= 50; ++i) {
    const std::int64_t t_ns = start_ns + std::int64_t{100'000'000} * i;
    messages.push_back({t_ns, transform_message(t_ns, "map", "base_link", 1.0 * i, 0.0)});
    messages.push_back({t_ns + 1'000'000, transform_message(t_ns, "base_link", "wheel", 0.0, 0.0)});
    if (i > 20 && i < 25) continue;
    messages.push_back(
        {t_ns + 2'000'000, transform_message(t_ns, "base_link", "other_wheel", 0.0, 0.0)});
  }
  return messages;
}

TEST_F(DriveLog, InfoSaysRatesAndGapsOfTransformsByFrame) {
  const std::string file =
      folder_.write("tf.mcap", mcap_bytes("/tf", kTransforms, three_publishers(), ""));
  const json found = info(file);
  const json& topic = found["topics"][0];
  EXPECT_EQ(topic["messages"], 51 + 51 + 47);
  EXPECT_TRUE(topic["rate_hz"].is_null()) << topic["rate_hz"];
  EXPECT_TRUE(topic["gaps"].empty());
  ASSERT_EQ(topic["frames"].size(), 3u);
  const std::size_t gaps[] = {1, 0, 0};
  const std::string children[] = {"other_wheel", "wheel", "base_link"};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(topic["frames"][i]["child"], children[i]);
    EXPECT_NEAR(topic["frames"][i]["rate_hz"].get<double>(), 10.0, 1e-9);
    EXPECT_EQ(topic["frames"][i]["gaps"].size(), gaps[i]);
  }
  EXPECT_NEAR(topic["frames"][0]["gaps"][0]["length_s"].get<double>(), 0.5, 1e-9);
  const ProgramRun text = run_roadbed({"drive", "info", file});
  EXPECT_THAT(text.out, HasSubstr("\n  wheel in base_link: 51 transforms, 10 Hz\n"));
  EXPECT_THAT(text.out, HasSubstr("\n  other_wheel in base_link: 47 transforms, 10 Hz, 1 gap\n"));
}

TEST_F(DriveLog, InfoSaysTheRateOfTransformsOfOneFrameWithTheirTopic) {
  std::vector<McapMessage> messages = three_publishers();
  std::erase_if(messages, [](const McapMessage& m) { return m.time_ns % 100'000'000 != 0; });
  const json found = info(folder_.write("one.mcap", mcap_bytes("/tf", kTransforms, messages, "")));
  EXPECT_NEAR(found["topics"][0]["rate_hz"].get<double>(), 10.0, 1e-9);
}

/// Points 0.5 m apart of a way to a stop, at 1 m/s²: in front of it they are far apart in time.
std::string stopping_plan() {
  CdrWriter cdr;
  cdr.put(std::int32_t{5}).put(std::uint32_t{0}).text("map").put(std::uint32_t{51});
  for (int i = 0; i <= 50; ++i) {
    cdr.put(std::int32_t{0}).put(std::uint32_t{0});
    cdr.put(0.5 * i).put(0.0).put(0.0).put(0.0).put(0.0).put(0.0).put(1.0);
    cdr.put(static_cast<float>(std::sqrt(2.0 * (25.0 - 0.5 * i))));
    for (int k = 0; k < 5; ++k) cdr.put(0.0F);
  }
  return cdr.bytes();
}

TEST_F(DriveLog, InfoFindsNoGapsInAPlan) {
  const json found =
      info(folder_.write("plan.mcap", mcap_bytes("/plan", "autoware_planning_msgs/msg/Trajectory",
                                                 {{5, stopping_plan()}}, "")));
  EXPECT_EQ(found["drive"]["rows"], 51);
  EXPECT_TRUE(found["drive"]["gaps"].empty()) << found["drive"]["gaps"];
}

}  // namespace
}  // namespace roadbed::tests
