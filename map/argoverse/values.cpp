#include "roadbed/map/argoverse/values.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/visible_text.h"

namespace roadbed::map::argoverse {
namespace {

using Json = nlohmann::json;

constexpr double kFarthest_m = 1e8, kHighest_m = 1e5;  // beyond any road: a slip

double coordinate(const Entry& entry, const Json& point, const char* key, double most_m) {
  const auto found = point.find(key);
  if (found == point.end() || !found->is_number()) {
    entry.refuse(fmt::format("a point without the number \"{}\"", key), "x, y and z in metres");
  }
  const double value = found->get<double>();
  if (!(std::abs(value) <= most_m)) {
    entry.refuse(fmt::format("a point with {} = {}", key, value), "|x|, |y| ≤ 1e8 m, |z| ≤ 1e5 m");
  }
  return value;
}

std::int64_t whole_number(const Entry& entry, const Json& value, const char* key) {
  const bool fits = value.is_number_integer() &&
                    (!value.is_number_unsigned() ||
                     value.get<std::uint64_t>() <= std::numeric_limits<std::int64_t>::max());
  if (!fits) entry.refuse(fmt::format("\"{}\" is no id", key), "a whole number");
  return value.get<std::int64_t>();
}

}  // namespace

void Entry::refuse(const std::string& found, const std::string& needed) const {
  throw InputError({.file = file,
                    .element = element,
                    .found = found,
                    .needed = needed,
                    .remedy = "correct the entry, or remove it"});
}

const Json* Entry::find(const char* key) const {
  const auto found = json.find(key);
  return found == json.end() || found->is_null() ? nullptr : &*found;
}

std::int64_t Entry::id(const char* key) const {
  const Json* value = find(key);
  if (value == nullptr) refuse(fmt::format("no \"{}\"", key), "a whole number");
  return whole_number(*this, *value, key);
}

std::optional<std::int64_t> Entry::optional_id(const char* key) const {
  const Json* value = find(key);
  if (value == nullptr) return {};
  return whole_number(*this, *value, key);
}

std::vector<std::int64_t> Entry::ids(const char* key) const {
  const Json* list = find(key);
  if (list == nullptr) return {};
  if (!list->is_array()) refuse(fmt::format("\"{}\" is no list", key), "a list of ids");
  std::vector<std::int64_t> found;
  for (const Json& value : *list) found.push_back(whole_number(*this, value, key));
  return found;
}

std::string Entry::word(const char* key) const {
  const Json* value = find(key);
  return value != nullptr && value->is_string() ? one_line(value->get<std::string>()) : "";
}

bool Entry::truth(const char* key) const {
  const Json* value = find(key);
  return value != nullptr && value->is_boolean() && value->get<bool>();
}

Line3 Entry::line(const char* key) const {
  const Json* list = find(key);
  if (list == nullptr || !list->is_array()) {
    refuse(fmt::format("no list \"{}\"", key), "a list of points");
  }
  Line3 points;
  points.reserve(list->size());
  for (const Json& point : *list) {
    if (!point.is_object()) refuse("a point that is no object", "x, y and z in metres");
    const double x = coordinate(*this, point, "x", kFarthest_m);
    const double y = coordinate(*this, point, "y", kFarthest_m);
    const auto height = point.find("z");
    const bool has_height = height != point.end() && !height->is_null();
    const double z = has_height ? coordinate(*this, point, "z", kHighest_m)
                                : std::numeric_limits<double>::quiet_NaN();
    points.emplace_back(x, y, z);
  }
  return points;
}

}  // namespace roadbed::map::argoverse
