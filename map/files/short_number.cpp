#include "roadbed/map/files/short_number.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace roadbed::map::inline files {

std::string short_number(double value) { return number_within(value, 5e-7); }

std::string number_within(double value, double tolerance) {
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(2.0 * tolerance))), 0, 15);
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (decimals > 0) text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

}  // namespace roadbed::map::files
