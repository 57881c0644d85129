// `report compare` as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"

namespace roadbed::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class ReportCommand : public testing::Test {
 protected:
  ReportCommand() {
    a_ = folder_.write("a.json", R"({"outcome": "goal reached", "collision": false,
      "driven_m": 40.5, "least_headway_s": null, "comfort": {"jerk": 3.0}, "events": [1, 2]})");
    b_ = folder_.write("b.json", R"({"outcome": "collision", "collision": true,
      "driven_m": 38.0, "least_headway_s": 1.5, "comfort": {"jerk": 5.0}})");
  }

  ProgramRun compare(std::vector<std::string> more) const {
    std::vector<std::string> arguments{"report", "compare", a_, b_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_roadbed(arguments);
  }

  const TemporaryFolder folder_;
  std::string a_, b_;
};

TEST_F(ReportCommand, SetsEveryNumberOfTwoRunsSideBySide) {
  const ProgramRun run = compare({"--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  const json metrics = json::parse(run.out)["metrics"];
  EXPECT_EQ(metrics, json::parse(R"({
    "collision": {"a": 0.0, "b": 1.0}, "comfort.jerk": {"a": 3.0, "b": 5.0},
    "driven_m": {"a": 40.5, "b": 38.0}, "least_headway_s": {"a": null, "b": 1.5}})"));
  EXPECT_THAT(compare({}).out, HasSubstr("-2.5\n"));
}

TEST_F(ReportCommand, StatusIsOneWhereTheSecondRunExceedsABound) {
  EXPECT_EQ(compare({"--max", "driven_m=38"}).status, 0);
  EXPECT_EQ(compare({"--max", "driven_m=38", "--max", "comfort.jerk=4.13"}).status, 1);
  const ProgramRun run = compare({"--max", "collision=0"});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.out, HasSubstr("B does not keep collision at 0 or less\n"));
  // A metric that has no value is not within a bound.
  EXPECT_EQ(run_roadbed({"report", "compare", b_, a_, "--max", "least_headway_s=9"}).status, 1);
}

TEST_F(ReportCommand, RefusesWhatItCannotCompare) {
  EXPECT_EQ(compare({"--max", "jerk"}).status, 2);
  EXPECT_EQ(compare({"--max", "jerk=much"}).status, 2);
  const ProgramRun unknown = compare({"--max", "jerk=3"});
  EXPECT_EQ(unknown.status, 3);
  EXPECT_EQ(unknown.out, "");
  EXPECT_THAT(unknown.err, HasSubstr("no metric of the name jerk"));
  const std::string empty = folder_.write("empty.json", "{}");
  EXPECT_THAT(run_roadbed({"report", "compare", empty, b_}).err, HasSubstr("no metric"));
  EXPECT_EQ(run_roadbed({"report", "compare", "missing", b_}).status, 3);
  EXPECT_EQ(run_roadbed({"report"}).status, 2);
}

}  // namespace
}  // namespace roadbed::tests
