#include "roadbed/tools/support/od_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "roadbed/map/input_error.h"

namespace roadbed::tools {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& found) {
  throw map::InputError({.file = name,
                         .place = "1",
                         .element = {},
                         .found = found,
                         .needed = "a header line with the columns from and to, then a row a pair",
                         .remedy = "mend the file"});
}

// The next line without its end; none behind the last one.
std::optional<std::string_view> take_line(std::string_view& rest) {
  if (rest.empty()) return {};
  const std::size_t end = rest.find('\n');
  std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::size_t column(const std::vector<std::string>& names, const char* wanted,
                   const std::string& file) {
  const auto found = std::find(names.begin(), names.end(), wanted);
  if (found == names.end()) refuse(file, fmt::format("no column {}", wanted));
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace

std::vector<std::string> csv_fields(std::string_view line) {
  std::vector<std::string> fields(1);
  bool in_quotes = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char sign = line[i];
    if (in_quotes && sign == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += '"';
      ++i;
    } else if (sign == '"') {
      in_quotes = !in_quotes;
    } else if (sign == ',' && !in_quotes) {
      fields.emplace_back();
    } else {
      fields.back() += sign;
    }
  }
  return fields;
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string made = "\"";
  for (const char sign : text) made += sign == '"' ? "\"\"" : std::string(1, sign);
  return made + "\"";
}

std::vector<OdRow> parse_od_csv(std::string_view bytes, const std::string& name) {
  const std::vector<std::string> names = csv_fields(take_line(bytes).value_or(""));
  const std::size_t from = column(names, "from", name), to = column(names, "to", name);
  std::vector<OdRow> rows;
  std::size_t number = 1;
  while (const auto line = take_line(bytes)) {
    ++number;
    if (line->empty()) continue;
    std::vector<std::string> fields = csv_fields(*line);
    OdRow& row = rows.emplace_back();
    row.line = number;
    if (fields.size() == names.size()) {
      row.from = fields[from];
      row.to = fields[to];
    } else {
      row.fault = fmt::format("{} fields, the header has {}; put places with commas in quotes",
                              fields.size(), names.size());
    }
  }
  if (rows.empty()) refuse(name, "no row");
  return rows;
}

}  // namespace roadbed::tools
