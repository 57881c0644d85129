#pragma once

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "roadbed/map/validation/rule.h"

namespace roadbed::tests {

/// One slip in the text of a faultless file, and the rule that has to find it.
struct Slip {
  std::string rule, from, to;
};

/// The text with the slip made; fails the test where `from` is not in it.
std::string with_slip(std::string text, const Slip& slip);

/// What a rule about the text of a file of that name finds there.
std::vector<map::validation::Finding> source_findings(const std::string& text,
                                                      const std::string& file,
                                                      const std::string& rule);

/// Fails for every slip whose rule speaks up without it, stays silent at it, or does not say which
/// element, on which line and what.
void expect_each_is_found(const std::vector<Slip>& slips, const std::string& faultless,
                          const std::string& file);

/// Fails where the reader remarks what one of these rules finds, too.
void expect_each_is_found_once(const std::set<std::string>& rules, const std::vector<Slip>& slips,
                               const std::string& faultless, const std::string& file);

/// Fails for every rule that no slip is about.
template <class Slips, class Rules>
void expect_all_are_tried(const Slips& slips, const Rules& rules) {
  std::set<std::string, std::less<>> tried;
  for (const auto& slip : slips) tried.insert(slip.rule);
  for (const auto& rule : rules) EXPECT_TRUE(tried.contains(rule.info.id)) << rule.info.id;
}

}  // namespace roadbed::tests
