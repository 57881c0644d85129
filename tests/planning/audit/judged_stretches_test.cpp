#include "roadbed/planning/audit/audit_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace roadbed::planning {
namespace {

// The gravest verdict at one time, asked of every stretch.
Verdict verdict_at(const AuditReport& report, double t_s) {
  const auto covers = [t_s](const auto& stretch) {
    return stretch.from_s <= t_s && t_s <= stretch.to_s;
  };
  if (std::ranges::any_of(report.conflicts, covers)) return Verdict::conflict;
  if (std::ranges::any_of(report.unknown, covers)) return Verdict::unknown;
  return std::ranges::any_of(report.undecided, covers) ? Verdict::undecided : Verdict::clear;
}

TEST(JudgedStretches, CoverTheDriveWithoutGapAndSayTheGravestVerdictOfEachTime) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> time(10.0, 20.0);
  const auto stretch = [&] {
    const double a_s = time(random), b_s = time(random);
    return Stretch{std::min(a_s, b_s), std::max(a_s, b_s)};
  };
  for (int round = 0; round < 200; ++round) {
    AuditReport report;
    for (auto n = random() % 3; n > 0; --n) {
      const Stretch at = stretch();
      report.conflicts.push_back({.from_s = at.from_s, .to_s = at.to_s, .at = {}, .witness = {}});
    }
    for (auto n = random() % 4; n > 0; --n) report.unknown.push_back(stretch());
    for (auto n = random() % 4; n > 0; --n) report.undecided.push_back(stretch());
    const auto judged = judged_stretches(report, 10.0, 20.0);
    ASSERT_FALSE(judged.empty());
    EXPECT_EQ(judged.front().from_s, 10.0);
    EXPECT_EQ(judged.back().to_s, 20.0);
    for (std::size_t i = 0; i < judged.size(); ++i) {
      if (i > 0) {
        EXPECT_EQ(judged[i].from_s, judged[i - 1].to_s);
        EXPECT_NE(judged[i].verdict, judged[i - 1].verdict);
      }
      for (const double fraction : {0.01, 0.3, 0.5, 0.99}) {
        const double t_s = judged[i].from_s + fraction * (judged[i].to_s - judged[i].from_s);
        EXPECT_EQ(judged[i].verdict, verdict_at(report, t_s)) << t_s;
      }
    }
  }
}

TEST(JudgedStretches, OneRowHasTheVerdictOfTheReport) {
  AuditReport report;
  report.verdict = Verdict::conflict;
  const auto judged = judged_stretches(report, 4.0, 4.0);
  ASSERT_EQ(judged.size(), 1u);
  EXPECT_EQ(judged[0].verdict, Verdict::conflict);
}

TEST(JudgedStretches, BetweenPosesAreUnknownHoweverClearTheRestIs) {
  AuditReport clear;
  clear.verdict = Verdict::clear;
  const AuditReport report = judged_between_poses(clear, {{2.0, 3.0}});
  EXPECT_EQ(report.verdict, Verdict::unknown);
  const auto judged = judged_stretches(report, 0.0, 5.0);
  ASSERT_EQ(judged.size(), 3u);
  EXPECT_EQ(judged[1].from_s, 2.0);
  EXPECT_EQ(judged[1].to_s, 3.0);
  EXPECT_EQ(judged[1].verdict, Verdict::unknown);
  EXPECT_EQ(judged[2].verdict, Verdict::clear);
}

}  // namespace
}  // namespace roadbed::planning
