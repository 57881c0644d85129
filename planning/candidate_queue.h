#pragma once

#include <cstddef>
#include <vector>

#include "roadbed/planning/candidates.h"

namespace roadbed::planning {

/// Costs that differ by less than this share are equal.
inline constexpr double kEqualCost = 1e-12;

/// Feasible candidates of a priced grid, the cheapest first. A heap: few of them are looked at.
class CandidateQueue {
 public:
  /// @param cost, rejection  one per candidate; kept by reference. Rejected ones are left out.
  CandidateQueue(const std::vector<double>& cost, const std::vector<Rejection>& rejection);

  bool empty() const { return heap_.empty(); }

  /// Takes out the cheapest candidate and all that cost the same, in no particular order.
  /// @pre not empty
  std::vector<std::size_t> pop_equals();

 private:
  const std::vector<double>& cost_;
  std::vector<std::size_t> heap_;
};

}  // namespace roadbed::planning
