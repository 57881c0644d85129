#include "roadbed/tools/figures/rich_text.h"

#include <gtest/gtest.h>

#include <string>

namespace roadbed::tools {
namespace {

// "^" and "_" before what stands above and below.
std::string spelt(std::string_view text) {
  std::string all;
  for (const TextPiece& piece : pieces_of(text)) {
    all += piece.level == TextPiece::Level::line    ? ""
           : piece.level == TextPiece::Level::below ? "_"
                                                    : "^";
    all += "[" + piece.letters + "]";
  }
  return all;
}

TEST(RichText, TakesOneLetterOrWhatIsInBraces) {
  EXPECT_EQ(spelt("L_x(v)"), "[L]_[x][(v)]");
  EXPECT_EQ(spelt("e_{fa} [m/s^2]"), "[e]_[fa][ [m/s]^[2][]]");
  EXPECT_EQ(spelt("k_κ"), "[k]_[κ]");
}

TEST(RichText, KeepsMarksThatMarkNothing) {
  EXPECT_EQ(spelt("a_"), "[a_]");
  EXPECT_EQ(spelt("x_{open"), "[x]_[{][open]");
  EXPECT_EQ(spelt(""), "");
}

TEST(RichText, ComesBackToTheLine) {
  // 0.30 of the font down, in letters of 0.72 of it, and up again.
  EXPECT_EQ(rich_text_svg("c", {1.0, 2.0}, "a_b<"),
            "<text class=\"c\" x=\"1\" y=\"2\">a<tspan dy=\"0.42em\" font-size=\"0.72em\">b</tspan>"
            "<tspan dy=\"-0.30em\">&lt;</tspan></text>\n");
}

TEST(RichText, IsWrappedAtWords) {
  const auto lines = wrapped("one two three", 10.0, rich_text_width_px("one two", 10.0));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0], "one two");
  EXPECT_EQ(lines[1], "three");
  EXPECT_EQ(wrapped("unbreakable", 10.0, 1.0).size(), 1u);
}

}  // namespace
}  // namespace roadbed::tools
