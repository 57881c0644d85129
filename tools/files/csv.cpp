#include "roadbed/tools/files/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "roadbed/map/files/input_error.h"

namespace roadbed::tools::inline files {
namespace {

constexpr std::string_view kCsvSpace = " \t\r";

// Takes a field in quotes off the line, up to the comma behind it; two quotes stand for one.
std::string take_quoted(std::string_view& line) {
  std::string field;
  line.remove_prefix(1);
  for (;;) {
    const std::size_t quote = std::min(line.find('"'), line.size());
    field += line.substr(0, quote);
    line.remove_prefix(std::min(quote + 1, line.size()));
    if (!line.starts_with('"')) break;
    field += '"';
    line.remove_prefix(1);
  }
  line.remove_prefix(std::min(line.find(','), line.size()));
  return field;
}

std::string take_plain(std::string_view& line) {
  const std::string_view field = line.substr(0, line.find(','));
  line.remove_prefix(field.size());
  return std::string(field.substr(0, field.find_last_not_of(kCsvSpace) + 1));
}

}  // namespace

std::vector<std::string> csv_fields(std::string_view line) {
  std::vector<std::string> fields;
  for (;;) {
    line.remove_prefix(std::min(line.find_first_not_of(kCsvSpace), line.size()));
    fields.push_back(line.starts_with('"') ? take_quoted(line) : take_plain(line));
    if (line.empty()) return fields;
    line.remove_prefix(1);  // the comma
  }
}

CsvReader::CsvReader(std::string_view bytes, std::string name)
    : rest_(bytes), name_(std::move(name)) {
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
  names_ = csv_fields(take_line());
}

std::string_view CsvReader::take_line() {
  const std::string_view line = rest_.substr(0, rest_.find('\n'));
  rest_.remove_prefix(std::min(line.size() + 1, rest_.size()));
  ++line_;
  return line;
}

std::optional<std::size_t> CsvReader::find_column(std::string_view name) const {
  const auto found = std::ranges::find(names_, name);
  if (found == names_.end()) return {};
  if (std::find(found + 1, names_.end(), name) != names_.end()) {
    refuse(fmt::format("column {}", name), "is there twice", "", "remove one");
  }
  return static_cast<std::size_t>(found - names_.begin());
}

std::size_t CsvReader::column(std::string_view name, std::string_view header_that_would_do) const {
  if (const auto found = find_column(name)) return *found;
  refuse(fmt::format("column {}", name), "is missing from the header",
         fmt::format("a first line like {}", header_that_would_do), "add or rename the column");
}

bool CsvReader::next_row() {
  while (!rest_.empty()) {
    const std::string_view line = take_line();
    if (line.find_first_not_of(kCsvSpace) == std::string_view::npos) continue;
    fields_ = csv_fields(line);
    return true;
  }
  return false;
}

void CsvReader::check_width() const {
  if (fields_.size() == names_.size()) return;
  refuse("row", fmt::format("has {} fields", fields_.size()),
         fmt::format("{} as the header has", names_.size()));
}

double CsvReader::number(std::size_t column, double least, double most) const {
  const std::string_view text = fields_.at(column);
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool is_whole = error == std::errc() && end == digits.data() + digits.size();
  if (!is_whole || !(value >= least && value <= most)) {
    refuse(fmt::format("column {}", names_[column]), fmt::format("\"{}\"", text),
           fmt::format("a number from {:g} to {:g}", least, most));
  }
  return value;
}

void CsvReader::refuse(const std::string& element, const std::string& found,
                       const std::string& needed, const std::string& remedy) const {
  throw map::InputError({.file = name_,
                         .place = std::to_string(line_),
                         .element = element,
                         .found = found,
                         .needed = needed,
                         .remedy = remedy});
}

}  // namespace roadbed::tools::files
