#include "roadbed/tools/report/svg_legend.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

namespace roadbed::tools {
namespace {

int brightness(const std::string& colour) {
  const auto part = [&](std::size_t at) { return std::stoi(colour.substr(at, 2), nullptr, 16); };
  return 299 * part(1) + 587 * part(3) + 114 * part(5);
}

TEST(SpeedColour, IsBrighterTheFasterItIs) {
  for (double fraction = 0.0; fraction < 0.99; fraction += 0.02) {
    EXPECT_LT(brightness(speed_colour(fraction)), brightness(speed_colour(fraction + 0.02)));
  }
  EXPECT_EQ(speed_colour(-1.0), "#440154");
  EXPECT_EQ(speed_colour(2.0), "#fde725");
}

// Numbers of an attribute, in order.
std::vector<double> all(const std::string& svg, const std::string& attribute) {
  std::vector<double> found;
  for (std::size_t at = 0; (at = svg.find(' ' + attribute + "=\"", at)) != std::string::npos;) {
    at += attribute.size() + 3;
    found.push_back(std::stod(svg.substr(at)));
  }
  return found;
}

TEST(SvgLegend, HasEntriesThatNoFontPushesIntoEachOther) {
  SvgLegend legend(20.0);
  for (const char* text : {"vehicle", "WWWWWWWW", "iiiiiiii", "größer als 1 m"}) {
    legend.add("class=\"ego\"", text);
  }
  std::string texts, swatches;
  std::istringstream lines(legend.svg());
  for (std::string line; std::getline(lines, line);) {
    (line.starts_with("<text") ? texts : swatches) += line;
  }
  const std::vector<double> from = all(texts, "x"), width = all(texts, "textLength");
  const std::vector<double> swatch = all(swatches, "x");
  ASSERT_EQ(from.size(), 4U);
  ASSERT_EQ(width.size(), 4U);
  for (std::size_t i = 0; i < from.size(); ++i) {
    EXPECT_GT(from[i], swatch[i] + 18.0);
    if (i > 0) {
      EXPECT_GT(swatch[i], from[i - 1] + width[i - 1]);
    }
  }
  EXPECT_GT(width[1], 2.0 * width[2]);
}

}  // namespace
}  // namespace roadbed::tools
