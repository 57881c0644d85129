#include "roadbed/tests/support/slips.h"

#include "roadbed/map/formats.h"
#include "roadbed/map/validate_file.h"

namespace roadbed::tests {

std::string with_slip(std::string text, const Slip& slip) {
  const std::size_t at = text.find(slip.from);
  EXPECT_NE(at, std::string::npos) << slip.rule << ": not in the file: " << slip.from;
  return at == std::string::npos ? text : text.replace(at, slip.from.size(), slip.to);
}

std::vector<map::validation::Finding> source_findings(const std::string& text,
                                                      const std::string& file,
                                                      const std::string& rule) {
  auto findings = map::format_of(text)->judge(text, file, {}).findings;
  std::erase_if(findings,
                [&](const map::validation::Finding& finding) { return finding.rule != rule; });
  return findings;
}

void expect_each_is_found(const std::vector<Slip>& slips, const std::string& faultless,
                          const std::string& file) {
  for (const Slip& slip : slips) {
    SCOPED_TRACE(slip.rule);
    EXPECT_TRUE(source_findings(faultless, file, slip.rule).empty());
    const auto findings = source_findings(with_slip(faultless, slip), file, slip.rule);
    EXPECT_FALSE(findings.empty());
    for (const map::validation::Finding& finding : findings) {
      EXPECT_FALSE(finding.element.empty());
      EXPECT_GT(finding.line, 0);
      EXPECT_GT(finding.message.size(), 20u);
    }
  }
}

void expect_each_is_found_once(const std::set<std::string>& rules, const std::vector<Slip>& slips,
                               const std::string& faultless, const std::string& file) {
  const auto remarks_of = [&](const std::string& text) {
    std::set<std::string> remarks;
    for (const auto& finding : map::validate_bytes(text, file).findings) {
      if (finding.rule.starts_with("import.")) remarks.insert(finding.message);
    }
    return remarks;
  };
  const std::set<std::string> usual = remarks_of(faultless);
  for (const Slip& slip : slips) {
    if (!rules.contains(slip.rule)) continue;
    for (const std::string& remark : remarks_of(with_slip(faultless, slip))) {
      EXPECT_TRUE(usual.contains(remark)) << slip.rule << ": " << remark;
    }
  }
}

}  // namespace roadbed::tests
