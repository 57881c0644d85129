#include "roadbed/map/files/csv_field.h"

#include <algorithm>
#include <charconv>

#include "roadbed/map/files/visible_text.h"

namespace roadbed::map::inline files {
namespace {

bool is_one_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

// "-12", or a place: "-12.5,7".
bool are_numbers(std::string_view text) {
  for (;;) {
    const std::size_t comma = std::min(text.find(','), text.size());
    if (!is_one_number(text.substr(0, comma))) return false;
    if (comma == text.size()) return true;
    text.remove_prefix(comma + 1);
  }
}

bool may_be_formula(std::string_view text) {
  constexpr std::string_view begins_formula = "=+-@";
  const std::size_t first = text.find_first_not_of(' ');
  return first != text.npos && begins_formula.find(text[first]) != text.npos && !are_numbers(text);
}

}  // namespace

std::string csv_field(std::string_view text) {
  std::string shown = visible_text(one_line(std::string(text)));
  if (may_be_formula(shown)) shown.insert(0, 1, '\'');
  if (shown.find_first_of(",\"") == std::string::npos) return shown;
  std::string made = "\"";
  for (const char sign : shown) made += sign == '"' ? "\"\"" : std::string(1, sign);
  return made + "\"";
}

}  // namespace roadbed::map::files
