#include "roadbed/map/files/xml_characters.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <random>
#include <string>

#include "roadbed/map/files/visible_text.h"

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

TEST(HtmlText, ShowsWhatTurnsTheDirectionOfText) {
  EXPECT_EQ(html_text("a\xE2\x80\xAE-\xC2\x9B-\xE2\x81\xA6"), "a\\u202e-\\u009b-\\u2066");
}

TEST(XmlText, WritesWhatIsHiddenByNumberAndNothingThatXmlForbids) {
  EXPECT_EQ(xml_text("\xC2\x9B\x7F\xE2\x80\xAE"), "&#x9b;&#x7f;&#x202e;");
  EXPECT_EQ(xml_text("\xEF\xBF\xBE\xEF\xBF\xBF"), "\xEF\xBF\xBD\xEF\xBF\xBD");
}

// What pugixml makes of an attribute after without_controls, and whether it is one line.
std::string read_back(const std::string& value) {
  const std::string xml = without_controls("<a b=\"" + value + "\"/>");
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(xml.c_str())) << xml;
  return document.document_element().attribute("b").value();
}

TEST(WithoutControls, NoFormOfAControlComesThroughAnAttribute) {
  EXPECT_EQ(read_back("x&#27;y&#x1b;z&#x1B;"), "x\\u001by\\u001bz\\u001b");
  EXPECT_EQ(read_back("a&#10;b&#xD;c&#x0000000000000000009;d"), "a b c d");
  EXPECT_EQ(read_back("a&#4294967323;b"), "a\\u001bb");  // 2^32 + 27, which pugixml takes for 27
  EXPECT_EQ(read_back("a\x1b\x7f"), "a\\u001b\\u007f");
  EXPECT_EQ(read_back("&#228;&#x2028;&amp;#27;"), "ä\xE2\x80\xA8&#27;");
}

TEST(WithoutControls, OfAllNumbersNoneMakesAControl) {
  for (unsigned code = 1; code < 0x800; ++code) {
    for (const std::string& form : {fmt::format("&#{};", code), fmt::format("&#x{:X};", code)}) {
      const std::string text = read_back(form);
      const bool is_control = code < 0x20 || code == 0x7F;
      EXPECT_EQ(one_line(text), text) << form;
      EXPECT_EQ(text.size(), !is_control ? (code < 0x80 ? 1u : 2u) : text == " " ? 1u : 6u) << form;
    }
  }
}

TEST(WithoutControls, KeepsEverythingElseByteForByte) {
  const std::string xml = "<a>\r\n\t<b c='&#228;&lt;&#x41;&bogus;&#;&#x;&#12'/>\n</a>";
  EXPECT_EQ(without_controls(xml), xml);
}

TEST(WithoutControls, ReadsUtf16) {
  const std::u16string wide = u"<a b='\u00e4&#27;'/>";
  std::string bytes;
  for (const char16_t unit : wide) {
    bytes += static_cast<char>(unit & 0xFF);
    bytes += static_cast<char>(unit >> 8);
  }
  const std::string xml = without_controls(bytes);
  EXPECT_NE(xml.find("ä\\u001b"), std::string::npos) << xml;
}

TEST(XmlText, WritesOneLineThatAnAttributeMayHold) {
  EXPECT_EQ(xml_text("<a b=\"it's\">\n&\x01\xFF"),
            "&lt;a b=&quot;it's&quot;&gt; &amp; \xEF\xBF\xBD");
}

}  // namespace
}  // namespace roadbed::map
