// Autoware's vehicle_info.param.yaml, read as the small part of YAML that it is written in.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/visible_text.h"
#include "roadbed/tools/files/vehicle_file.h"

namespace roadbed::tools::inline files {
namespace {

/// A line `key: value` of a nested mapping.
struct YamlEntry {
  std::size_t line = 0, indent = 0;
  std::string_view key, value;  ///< no value: a mapping follows
};

/// A number that stands somewhere.
struct YamlNumber {
  double value = 0.0;
  std::size_t line = 0;
};

constexpr std::string_view kSpace = " \t\r";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kSpace) - begin + 1);
}

/// A comment begins with # at the line's begin or behind a blank.
std::string_view without_comment(std::string_view line) {
  for (std::size_t at = line.find('#'); at != std::string_view::npos; at = line.find('#', at + 1)) {
    if (at == 0 || kSpace.find(line[at - 1]) != std::string_view::npos) return line.substr(0, at);
  }
  return line;
}

std::string_view unquoted(std::string_view text) {
  const bool is_quoted = text.size() >= 2 && text.front() == text.back() &&
                         (text.front() == '"' || text.front() == '\'');
  return is_quoted ? text.substr(1, text.size() - 2) : text;
}

class AutowareVehicle {
 public:
  AutowareVehicle(std::string_view bytes, const std::string& name) : rest_(bytes), name_(name) {}

  Vehicle read() {
    while (auto entry = next()) take(*entry);
    if (depth_ < kPath) refuse(line_, "", "has no /**: ros__parameters:", "Autoware's parameters");
    const double left_m = number("left_overhang"), right_m = number("right_overhang");
    if (left_m != right_m) {
      refuse(numbers_.at("right_overhang").line, "right_overhang",
             fmt::format("is {}, left_overhang {}", right_m, left_m), "equal ones",
             "give the larger one for both");
    }
    Vehicle vehicle;
    geometry::VehicleShape& shape = vehicle.shape;
    shape.wheelbase_m = number("wheel_base");
    shape.rear_overhang_m = number("rear_overhang");
    shape.length_m = number("front_overhang") + shape.wheelbase_m + shape.rear_overhang_m;
    shape.width_m = number("wheel_tread") + left_m + right_m;
    shape.height_m = number("vehicle_height");
    shape.max_steering_rad = number("max_steer_angle");
    try {
      shape.check();
    } catch (const std::invalid_argument& error) {
      refuse(0, "", error.what(), "", "change the vehicle's measures");
    }
    return vehicle;
  }

 private:
  static constexpr std::size_t kPath = 2;  // a node's name, ros__parameters
  static constexpr std::array<std::string_view, 8> kKeys = {
      "wheel_base",    "wheel_tread",    "front_overhang", "rear_overhang",
      "left_overhang", "right_overhang", "vehicle_height", "max_steer_angle"};

  [[noreturn]] void refuse(std::size_t line, std::string_view element, const std::string& found,
                           const std::string& needed, const std::string& remedy = "mend it") const {
    throw map::InputError({.file = name_,
                           .place = line > 0 ? std::to_string(line) : "",
                           .element = map::one_line(std::string(element)),
                           .found = found,
                           .needed = needed,
                           .remedy = remedy});
  }

  std::optional<YamlEntry> next() {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      const std::string_view line = without_comment(rest_.substr(0, end));
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++line_;
      const std::string_view text = trimmed(line);
      const bool is_start = text == "---" && !is_begun_;
      if (text.empty() || is_start) continue;
      is_begun_ = true;
      return entry_of(line, text);
    }
    return std::nullopt;
  }

  YamlEntry entry_of(std::string_view line, std::string_view text) const {
    const std::size_t indent = line.find_first_not_of(' ');
    if (line[indent] == '\t') refuse(line_, "", "is indented by a tab", "blanks");
    const std::size_t colon = text.find(": ");
    const bool ends = text.ends_with(':');
    if (colon == std::string_view::npos && !ends) {
      refuse(line_, text.substr(0, 40), "is no \"key: value\"",
             "nested mappings of plain keys and scalars");
    }
    const std::string_view key =
        text.substr(0, colon == std::string_view::npos ? text.size() - 1 : colon);
    const std::string_view value =
        colon == std::string_view::npos ? std::string_view() : trimmed(text.substr(colon + 1));
    return {line_, indent, unquoted(trimmed(key)), value};
  }

  // First a node's name, below it ros__parameters, below that the numbers, all at one indent.
  void take(const YamlEntry& entry) {
    if (depth_ < kPath) {
      const bool is_below = depth_ == 0 ? entry.indent == 0 : entry.indent > indents_[depth_ - 1];
      const bool is_named =
          depth_ == 0 ? entry.key.starts_with('/') : entry.key == "ros__parameters";
      if (!is_below || !is_named || !entry.value.empty()) {
        refuse(entry.line, entry.key, "is not what parameters of a node begin with",
               depth_ == 0 ? "/**:" : "ros__parameters: below the node's name");
      }
      indents_[depth_++] = entry.indent;
      return;
    }
    if (entry.indent <= indents_[1]) {
      refuse(entry.line, entry.key, "stands beside ros__parameters", "one node's parameters");
    }
    if (indents_[2] == 0) indents_[2] = entry.indent;
    if (entry.indent < indents_[2]) refuse(entry.line, entry.key, "is indented otherwise", "alike");
    if (entry.indent == indents_[2]) take_parameter(entry);  // else below one that is passed over
  }

  void take_parameter(const YamlEntry& entry) {
    const auto key = std::ranges::find(kKeys, entry.key);
    if (key == kKeys.end()) return;
    double value = 0.0;
    const char* const end = entry.value.data() + entry.value.size();
    const auto parsed = std::from_chars(entry.value.data(), end, value);
    constexpr double most = 1000.0;
    if (parsed.ec != std::errc() || parsed.ptr != end || !(value >= 0.0 && value <= most)) {
      refuse(entry.line, entry.key,
             fmt::format("is \"{}\"", map::one_line(std::string(entry.value.substr(0, 40)))),
             fmt::format("a number from 0 to {}", most));
    }
    if (!numbers_.emplace(*key, YamlNumber{value, entry.line}).second) {
      refuse(entry.line, entry.key, "stands twice", "each once", "remove one");
    }
  }

  double number(std::string_view key) const {
    const auto found = numbers_.find(key);
    if (found == numbers_.end()) refuse(0, key, "is missing", "", "add it");
    return found->second.value;
  }

  std::string_view rest_;
  const std::string& name_;
  std::size_t line_ = 0, depth_ = 0;
  std::array<std::size_t, 3> indents_{};
  bool is_begun_ = false;
  std::map<std::string_view, YamlNumber> numbers_;
};

}  // namespace

Vehicle parse_autoware_vehicle(std::string_view bytes, const std::string& name) {
  return AutowareVehicle(bytes, name).read();
}

}  // namespace roadbed::tools::files
