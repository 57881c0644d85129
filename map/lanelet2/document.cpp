#include "roadbed/map/lanelet2/document.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "roadbed/map/files/xml_characters.h"

namespace roadbed::map::lanelet2 {
namespace {

// A number as most are written: a sign, digits, a point, digits. With at most 15 digits both the
// whole number that they are and the power of ten that divides it are exact, so that the quotient
// is the nearest double; none if the text is of another form.
std::optional<double> plain_decimal(std::string_view text) {
  constexpr std::array<double, 16> kPowers = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                              1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  if (text.empty() || text.size() > 16) return {};
  std::int64_t digits = 0;
  std::size_t point = text.size();
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto digit = static_cast<unsigned>(text[i] - '0');
    if (digit <= 9) {
      digits = 10 * digits + digit;
    } else if (text[i] == '.' && point == text.size()) {
      point = i;
    } else {
      return {};
    }
  }
  const bool has_point = point != text.size();
  const std::size_t decimals = has_point ? text.size() - point - 1 : 0;
  if (text.size() - (has_point ? 1 : 0) > 15 || point == 0 || (has_point && decimals == 0))
    return {};
  const double value = static_cast<double>(digits) / kPowers[decimals];
  return negative ? -value : value;
}

}  // namespace

Document::Document(std::string bytes, std::string file)
    : utf8(std::make_unique<const std::string>(in_utf8(std::move(bytes)))),
      text(*utf8),
      name(std::move(file)) {}

std::vector<Eigen::Vector3d> Document::points(const Way& way) const {
  std::vector<Eigen::Vector3d> found;
  found.reserve(way.nodes.size());
  for (const std::uint32_t node : way.nodes) found.push_back(nodes[node].in_map);
  return found;
}

Attributes attributes_of(Tags tags) { return {tags.begin(), tags.end()}; }

std::vector<Tag> views_of(const Attributes& tags) { return {tags.begin(), tags.end()}; }

Attributes Document::tags_of(std::size_t at) const {
  XmlScanner element(text, name, at);
  Attributes found;
  for (auto event = element.next(); event != XmlScanner::Event::done; event = element.next()) {
    if (event == XmlScanner::Event::start && element.depth() == 2 && element.name() == "tag") {
      found.emplace_back(element.value("k"), element.value("v"));
    }
  }
  return found;
}

std::string Document::written_reference(const Way& way, std::size_t index) const {
  XmlScanner element(text, name, way.at);
  std::size_t behind = index + 1;
  for (auto event = element.next(); event != XmlScanner::Event::done; event = element.next()) {
    const bool is_node =
        event == XmlScanner::Event::start && element.depth() == 2 && element.name() == "nd";
    if (is_node && --behind == 0) return std::string(element.value("ref"));
  }
  return {};
}

long Document::line_of(std::size_t at) const {
  std::call_once(lines_->once, [this] { lines_->starts.emplace(text); });
  return lines_->starts->line_at(at);
}

ImportDiagnostic Document::fault_at(std::size_t at, const char* rule, std::string message) const {
  XmlScanner element(text, name, at);
  element.next();
  return {rule, true, fmt::format("{} {}", element.name(), element.value("id")), line_of(at),
          std::move(message)};
}

ImportDiagnostic& Document::fault(std::size_t at, const char* rule, std::string message) {
  return remarks.emplace_back(fault_at(at, rule, std::move(message)));
}

std::optional<std::int64_t> id_in(std::string_view text) {
  std::int64_t id = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return id;
}

double number_in(std::string_view text) {
  if (const std::optional<double> plain = plain_decimal(text)) return *plain;
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return value;
}

}  // namespace roadbed::map::lanelet2
