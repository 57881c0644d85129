#include "roadbed/map/files/visible_text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "roadbed/map/files/json_text.h"

namespace roadbed::map {
namespace {

// Any code point as UTF-8, by the JSON library.
std::string utf8_of(char32_t code) {
  const auto unit = [](char32_t half) { return fmt::format("\\u{:04x}", static_cast<int>(half)); };
  const std::string escapes =
      code < 0x10000 ? unit(code) : unit(0xD7C0 + (code >> 10)) + unit(0xDC00 + (code & 0x3FF));
  return nlohmann::json::parse("\"" + escapes + "\"").get<std::string>();
}

bool is_surrogate(char32_t code) { return code >= 0xD800 && code <= 0xDFFF; }

TEST(VisibleText, OfAllCharactersTheseAreHidden) {
  std::string hidden;
  for (char32_t code = 0; code <= 0x10FFFF; ++code) {
    if (is_surrogate(code)) continue;
    const std::string text = "a" + utf8_of(code) + "z";
    const std::string shown = visible_text(text);
    if (shown == text) continue;
    ASSERT_EQ(shown, fmt::format("a\\u{:04x}z", static_cast<int>(code)));
    hidden += fmt::format("{:x} ", static_cast<int>(code));
  }
  std::string expected;
  const auto add = [&](int first, int last) {
    for (int code = first; code <= last; ++code) expected += fmt::format("{:x} ", code);
  };
  add(0, 8);
  add(0x0b, 0x1f);
  add(0x7f, 0x9f);
  add(0x61c, 0x61c);
  add(0x200e, 0x200f);
  add(0x2028, 0x202e);
  add(0x2066, 0x2069);
  EXPECT_EQ(hidden, expected);
}

TEST(VisibleText, BytesThatAreNoUtf8AreShownAsBytes) {
  EXPECT_EQ(visible_text("a\x9bz\xff"), "a\\x9bz\\xff");
  EXPECT_EQ(visible_text("\xc2"), "\\xc2");
  EXPECT_EQ(visible_text("\xe2\x80"), "\\xe2\\x80");
  EXPECT_EQ(visible_text("\xc0\x9b"), "\\xc0\\x9b");                    // too long a form
  EXPECT_EQ(visible_text("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // surrogate
  EXPECT_EQ(visible_text("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // past the last
}

TEST(VisibleText, JsonMeansTheSame) {
  std::mt19937 random(20261124);
  for (int round = 0; round < 2000; ++round) {
    std::string text;
    for (int i = 0; i < 8; ++i) {
      const auto code = static_cast<char32_t>(random() % (round % 2 == 0 ? 0x2100 : 0x110000));
      text += is_surrogate(code) ? "\\" : utf8_of(code);
    }
    const nlohmann::json document = {{text, text}};
    ASSERT_EQ(nlohmann::json::parse(json_text(document, round % 3)), document);
  }
}

TEST(VisibleText, TakenInPiecesOfWholeCharactersIsTheSame) {
  const std::string text = "a\xc2\x9b-\xe2\x80\xae-\xf0\x9f\x98\x80-\xff\xe2";
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    std::string pending = text.substr(0, cut), made;
    const std::size_t whole = size_of_whole_characters(pending);
    append_visible(std::string_view(pending).substr(0, whole), made);
    append_visible(pending.substr(whole) + text.substr(cut), made);
    EXPECT_EQ(made, visible_text(text)) << cut;
    EXPECT_LT(cut - whole, 4u);
  }
}

TEST(OneLine, HasNoBreakNoTabAndNoControlOfAscii) {
  EXPECT_EQ(one_line("road 7\nFORGED\r\n\tline"), "road 7 FORGED   line");
  EXPECT_EQ(one_line("\x1b[2J\x07\x7f"), "\\u001b[2J\\u0007\\u007f");
  EXPECT_EQ(one_line("ä→😀"), "ä→😀");
}

}  // namespace
}  // namespace roadbed::map
