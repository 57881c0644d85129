#pragma once

// Private to map/occupancy.

#include <cstddef>
#include <string>
#include <vector>

#include "roadbed/map/occupancy/clouds/cloud_filter.h"

namespace roadbed::map::inline occupancy::inline clouds {

/// The part of a filter that looks at what a point says of itself, for the fields of one file.
class AttributeFilter {
 public:
  /// Keeps all points.
  AttributeFilter() = default;

  /// @param fields  what the points have, lower-case: intensity; classification, class or label;
  ///                return_number, number_of_returns; underscores and a `scalar_` in front do not
  ///                count.
  /// @throws InputError if the filter looks at a field that is not there.
  AttributeFilter(const CloudFilter& filter, const std::vector<std::string>& fields,
                  const std::string& file);

  bool keeps_all() const { return rules_.empty(); }

  /// @param value  the value of a field of the point, by its place in `fields`.
  template <class Value>
  bool keeps(const Value& value) const {
    for (const Rule& rule : rules_) {
      const double at = value(rule.field);
      if (rule.of ? at != value(*rule.of) : !rule.holds(at)) return false;
    }
    return true;
  }

 private:
  struct Rule {
    std::size_t field;
    std::optional<std::size_t> of = {};  // a field whose value it has to have
    ValueRange range = {};
    std::vector<int> only = {}, none = {};

    bool holds(double value) const;
  };

  std::vector<Rule> rules_;
};

}  // namespace roadbed::map::occupancy::clouds
