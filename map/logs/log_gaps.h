#pragma once

#include <cstdint>
#include <vector>

namespace roadbed::map::inline logs {

/// A time without messages.
struct LogGap {
  std::int64_t from_ns, to_ns;
};

/// Gaps of times in order, longer than three times the median interval, which is left in
/// `median_ns`; 0 of fewer than two.
std::vector<LogGap> gaps_in(const std::vector<std::int64_t>& times_ns, std::int64_t& median_ns);

}  // namespace roadbed::map::logs
