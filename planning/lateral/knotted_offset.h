#pragma once

#include <vector>

#include "roadbed/planning/lateral/candidates.h"

namespace roadbed::planning::inline lateral {

/// d(s) through several knots: between two of them the quintic that has the offset, slope and
/// second derivative of both. One quintic alone cannot swing out, in and out again.
class KnottedOffset {
 public:
  /// @param knots  at ascending stations.
  /// @throws std::invalid_argument if there are less than two, or their stations do not ascend.
  explicit KnottedOffset(std::vector<LateralState> knots);

  /// Before the first knot and past the last one d stays.
  LateralState at(double s_m) const;

  const std::vector<LateralState>& knots() const { return knots_; }

 private:
  std::vector<LateralState> knots_;
  std::vector<geometry::Quintic> pieces_;  ///< from each knot to the next
};

}  // namespace roadbed::planning::lateral
