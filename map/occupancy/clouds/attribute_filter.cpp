#include "roadbed/map/occupancy/clouds/attribute_filter.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "roadbed/map/occupancy/clouds/cloud_formats.h"

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

// "scalar_Return_Number" of CloudCompare is "returnnumber" of PDAL.
std::string plain_name(std::string_view field) {
  std::string name = lower(field);
  std::erase(name, '_');
  if (name.starts_with("scalar")) name.erase(0, 6);
  return name;
}

bool holds_one(const std::vector<int>& numbers, double value) {
  return std::ranges::any_of(numbers, [&](int number) { return value == number; });
}

}  // namespace

AttributeFilter::AttributeFilter(const CloudFilter& filter, const std::vector<std::string>& fields,
                                 const std::string& file) {
  const auto field_named = [&](const std::vector<std::string_view>& names) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (std::ranges::find(names, plain_name(fields[i])) != names.end()) return i;
    }
    refuse_cloud(file, "", "filter", fmt::format("its points have no {}", fmt::join(names, " or ")),
                 "what the filter looks at", "leave the filter out");
  };
  if (!filter.classes.empty() || !filter.left_out_classes.empty()) {
    rules_.push_back({.field = field_named({"classification", "class", "label"}),
                      .only = filter.classes,
                      .none = filter.left_out_classes});
  }
  if (!filter.returns.empty()) {
    rules_.push_back({.field = field_named({"returnnumber"}), .only = filter.returns});
  }
  if (filter.last_returns) {
    rules_.push_back(
        {.field = field_named({"returnnumber"}), .of = field_named({"numberofreturns"})});
  }
  if (filter.intensity) {
    rules_.push_back({.field = field_named({"intensity"}), .range = *filter.intensity});
  }
}

bool AttributeFilter::Rule::holds(double value) const {
  return range.holds(value) && (only.empty() || holds_one(only, value)) && !holds_one(none, value);
}

}  // namespace roadbed::map::occupancy::clouds
