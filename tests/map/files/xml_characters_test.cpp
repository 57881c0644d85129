#include "roadbed/map/files/xml_characters.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>
#include <string>

namespace roadbed::map {
namespace {

TEST(HtmlText, WritesWhatHtmlReadsAsMarkupAsEntities) {
  EXPECT_EQ(html_text("<a href=\"x\">Tom & 'Jerry'</a>"),
            "&lt;a href=&quot;x&quot;&gt;Tom &amp; &#39;Jerry&#39;&lt;/a&gt;");
}

TEST(HtmlText, KeepsUtf8OfEveryLength) { EXPECT_EQ(html_text("a\tß\n→😀"), "a\tß\n→😀"); }

TEST(HtmlText, ReplacesControlCharactersAndBytesThatAreNoUtf8) {
  const std::string replaced = "\xEF\xBF\xBD";
  EXPECT_EQ(html_text("\x01"), replaced);
  EXPECT_EQ(html_text("\xFFz"), replaced + "z");
  EXPECT_EQ(html_text("\xC3"), replaced);                                // cut
  EXPECT_EQ(html_text("\xC0\xBC"), replaced + replaced);                 // overlong '<'
  EXPECT_EQ(html_text("\xED\xA0\x80"), replaced + replaced + replaced);  // surrogate
}

TEST(HtmlText, LeavesNoMarkupOutOfAnyBytes) {
  std::mt19937 random(20261121);
  for (int round = 0; round < 2000; ++round) {
    std::string bytes(random() % 24, ' ');
    for (char& byte : bytes) byte = static_cast<char>(random() & 0xFF);
    const std::string escaped = html_text(bytes);
    EXPECT_EQ(escaped.find_first_of("<>\"'"), std::string::npos);
    EXPECT_NO_THROW((void)nlohmann::json(escaped).dump());  // throws on what is no UTF-8
  }
}

TEST(XmlText, WritesOneLineThatAnAttributeMayHold) {
  EXPECT_EQ(xml_text("<a b=\"it's\">\n&\x01\xFF"),
            "&lt;a b=&quot;it's&quot;&gt; &amp; \xEF\xBF\xBD");
}

}  // namespace
}  // namespace roadbed::map
