#include "roadbed/map/logs/log_gaps.h"

#include <algorithm>
#include <cstddef>

namespace roadbed::map::inline logs {

std::vector<LogGap> gaps_in(const std::vector<std::int64_t>& times_ns, std::int64_t& median_ns) {
  median_ns = 0;
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < times_ns.size(); ++i) steps.push_back(times_ns[i] - times_ns[i - 1]);
  if (steps.empty()) return {};
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  median_ns = *middle;
  std::vector<LogGap> gaps;
  for (std::size_t i = 1; i < times_ns.size(); ++i) {
    if ((times_ns[i] - times_ns[i - 1]) / 3 > median_ns) {
      gaps.push_back({times_ns[i - 1], times_ns[i]});
    }
  }
  return gaps;
}

}  // namespace roadbed::map::logs
