#include "roadbed/tools/report/svg_legend.h"

#include <gtest/gtest.h>

#include <string>

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

}  // namespace
}  // namespace roadbed::tools
