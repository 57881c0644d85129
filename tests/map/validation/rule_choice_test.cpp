#include "roadbed/map/validation/rule_choice.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace roadbed::map::validation {
namespace {

/// By the definition: a star stands for nothing, or for a letter and another star.
bool fits_slowly(std::string_view pattern, std::string_view text) {
  if (pattern.empty()) return text.empty();
  if (pattern[0] == '*') {
    return fits_slowly(pattern.substr(1), text) ||
           (!text.empty() && fits_slowly(pattern, text.substr(1)));
  }
  return !text.empty() && (pattern[0] == '?' || pattern[0] == text[0]) &&
         fits_slowly(pattern.substr(1), text.substr(1));
}

TEST(FitsPattern, AgreesWithTheDefinition) {
  std::mt19937 random(20261125);
  const auto word = [&](std::string_view letters, std::size_t most) {
    std::string made(std::uniform_int_distribution<std::size_t>(0, most)(random), ' ');
    std::uniform_int_distribution<std::size_t> letter(0, letters.size() - 1);
    for (char& one : made) one = letters[letter(random)];
    return made;
  };
  std::size_t fitting = 0;
  for (int i = 0; i < 20'000; ++i) {
    const std::string pattern = word("ab*?", 6), text = word("ab", 8);
    const bool fits = fits_slowly(pattern, text);
    EXPECT_EQ(fits_pattern(pattern, text), fits) << pattern << " on " << text;
    fitting += fits ? 1 : 0;
  }
  EXPECT_GT(fitting, 1000u);
}

TEST(FitsPattern, TakesNoLongerForManyStars) {
  std::string pattern;
  for (int i = 0; i < 2000; ++i) pattern += "*a";
  EXPECT_FALSE(fits_pattern(pattern + "b", std::string(20'000, 'a')));
}

constexpr RuleInfo kGap = {"geometry.gap", "asam.net:xodr:1.7.0:lane.gap", Severity::warning, ""};
constexpr RuleInfo kSharing = {
    "autoware.lane.border-sharing", {}, Severity::error, "", "Lane.BorderSharing"};
constexpr RuleInfo kShortWay = {"lanelet2.short-way", {}, Severity::warning, ""};

Finding finding_of(const RuleInfo& rule, const std::string& issue = {}) {
  Finding finding;
  finding.rule = rule.id;
  finding.asam_rule = rule.asam_rule;
  finding.severity = rule.severity;
  finding.autoware_issue = issue;
  return finding;
}

TEST(RuleChoice, OfNothingIsAllRulesButAutowares) {
  const RuleChoice choice;
  EXPECT_TRUE(choice.asks_for(kGap));
  EXPECT_TRUE(choice.asks_for(kShortWay));
  EXPECT_FALSE(choice.asks_for(kSharing));
}

TEST(RuleChoice, OfAProfileIsWhatItIsFor) {
  RuleChoice asam, autoware;
  asam.profile = Profile::asam;
  autoware.profile = Profile::autoware;
  EXPECT_TRUE(asam.asks_for(kGap));
  EXPECT_FALSE(asam.asks_for(kShortWay));
  EXPECT_FALSE(autoware.asks_for(kGap));
  EXPECT_TRUE(autoware.asks_for(kShortWay));
  EXPECT_TRUE(autoware.asks_for(kSharing));
}

TEST(RuleChoice, TakesEveryNameOfARule) {
  for (const std::string pattern : {"autoware.lane.*", "Lane.BorderSharing", "Lane.*-002"}) {
    RuleChoice choice;
    choice.only = {pattern};
    EXPECT_TRUE(choice.asks_for(kSharing)) << pattern;
    EXPECT_FALSE(choice.asks_for(kGap)) << pattern;
  }
  for (const std::string pattern : {"asam.net:*lane.gap", "1.7.0:lane.gap", "1.7.0:*"}) {
    RuleChoice choice;
    choice.only = {pattern};
    EXPECT_TRUE(choice.asks_for(kGap)) << pattern;
    EXPECT_FALSE(choice.asks_for(kSharing)) << pattern;
  }
}

TEST(RuleChoice, LeavesOutSingleIssues) {
  RuleChoice choice;
  choice.profile = Profile::autoware;
  choice.disabled = {"Lane.BorderSharing-001"};
  std::vector<Finding> findings = {finding_of(kSharing, "Lane.BorderSharing-001"),
                                   finding_of(kSharing, "Lane.BorderSharing-002")};
  choice.apply(findings);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].autoware_issue, "Lane.BorderSharing-002");
}

TEST(RuleChoice, GivesTheLastSeverityThatFits) {
  RuleChoice choice;
  choice.severities = {{"geometry.*", Severity::error}, {"*.gap", Severity::info}};
  std::vector<Finding> findings = {finding_of(kGap)};
  choice.apply(findings);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::info);
  choice.severities.emplace_back("geometry.gap", std::nullopt);
  choice.apply(findings);
  EXPECT_TRUE(findings.empty());
}

}  // namespace
}  // namespace roadbed::map::validation
