#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/tools/town.h"

namespace roadbed::tools {
namespace {

using testing::HasSubstr;
using tests::kTown;
using tests::ProgramRun;
using tests::run_roadbed_reading;

const std::vector<std::string> kPilot{"pilot", kTown, "--goal", "lane:6/0/-1@100"};

std::string line(double t_s) {
  return R"({"t_s":)" + std::to_string(t_s) +
         R"(,"ego":{"x_m":270,"y_m":434.75,"heading_rad":0,"speed_mps":0}})" + "\n";
}

ProgramRun answers(const std::string& lines, const std::vector<std::string>& command = kPilot) {
  const tests::TemporaryFolder folder;
  return run_roadbed_reading(folder.write("lines.jsonl", lines), command);
}

TEST(PilotCommand, AnswersEachLineWithALine) {
  const ProgramRun run = answers(line(0.0) + line(0.1) + line(0.2));
  EXPECT_EQ(run.status, 0) << run.err;
  std::istringstream out(run.out);
  int lines = 0;
  for (std::string text; std::getline(out, text); ++lines) {
    const nlohmann::json answer = nlohmann::json::parse(text);
    EXPECT_FALSE(answer["reason"].get<std::string>().empty());
    EXPECT_EQ(answer["trajectory"].back()[4], 0.0);
  }
  EXPECT_EQ(lines, 3);
}

TEST(PilotCommand, SaysWhatIsWrongWithALineAndGoesOn) {
  const ProgramRun run = answers(line(0.0) + "{}\n" + line(0.1));
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.err, HasSubstr("1 line could not be used"));
  EXPECT_THAT(run.out, HasSubstr(R"("error":"line 2:)"));
}

TEST(PilotCommand, NeedsAGoalOnTheMap) {
  EXPECT_EQ(answers("", {"pilot", kTown}).status, 2);
  EXPECT_EQ(answers("", {"pilot", kTown, "--goal", "somewhere"}).status, 2);
  const ProgramRun off = answers("", {"pilot", kTown, "--goal", "1e6,1e6"});
  EXPECT_EQ(off.status, 3);
  EXPECT_THAT(off.err, HasSubstr("1e6,1e6"));
}

}  // namespace
}  // namespace roadbed::tools
