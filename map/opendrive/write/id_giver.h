#pragma once

#include <charconv>
#include <set>
#include <string>

namespace roadbed::map::opendrive {

/// Gives out ids: whole numbers, none twice.
class IdGiver {
 public:
  std::string give(const std::string& wanted) {
    long long number = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
    const bool is_number = error == std::errc() && end == wanted.data() + wanted.size() &&
                           !wanted.empty() && number >= 0 && wanted == std::to_string(number);
    if (is_number && taken_.insert(wanted).second) return wanted;
    while (!taken_.insert(std::to_string(next_)).second) ++next_;
    return std::to_string(next_++);
  }

 private:
  std::set<std::string> taken_;
  long long next_ = 1;
};

}  // namespace roadbed::map::opendrive
