#include "roadbed/tools/report/escape.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>
#include <string>

namespace roadbed::tools {
namespace {

TEST(EscapeMarkup, WritesWhatHtmlReadsAsMarkupAsEntities) {
  EXPECT_EQ(escape_markup("<a href=\"x\">Tom & 'Jerry'</a>"),
            "&lt;a href=&quot;x&quot;&gt;Tom &amp; &#39;Jerry&#39;&lt;/a&gt;");
}

TEST(EscapeMarkup, KeepsUtf8OfEveryLength) { EXPECT_EQ(escape_markup("a\tß\n→😀"), "a\tß\n→😀"); }

TEST(EscapeMarkup, ReplacesControlCharactersAndBytesThatAreNoUtf8) {
  const std::string replaced = "\xEF\xBF\xBD";
  EXPECT_EQ(escape_markup("\x01"), replaced);
  EXPECT_EQ(escape_markup("\xFFz"), replaced + "z");
  EXPECT_EQ(escape_markup("\xC3"), replaced);                                // cut
  EXPECT_EQ(escape_markup("\xC0\xBC"), replaced + replaced);                 // overlong '<'
  EXPECT_EQ(escape_markup("\xED\xA0\x80"), replaced + replaced + replaced);  // surrogate
}

TEST(EscapeMarkup, LeavesNoMarkupOutOfAnyBytes) {
  std::mt19937 random(20261121);
  for (int round = 0; round < 2000; ++round) {
    std::string bytes(random() % 24, ' ');
    for (char& byte : bytes) byte = static_cast<char>(random() & 0xFF);
    const std::string escaped = escape_markup(bytes);
    EXPECT_EQ(escaped.find_first_of("<>\"'"), std::string::npos);
    EXPECT_NO_THROW((void)nlohmann::json(escaped).dump());  // throws on what is no UTF-8
  }
}

TEST(EscapeJsonForScript, CannotEndTheElementAndMeansTheSame) {
  const nlohmann::json json = {{"name", "</script><!-- & -->"}};
  const std::string escaped = escape_json_for_script(json.dump());
  EXPECT_EQ(escaped.find_first_of("<>&"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(escaped), json);
}

}  // namespace
}  // namespace roadbed::tools
