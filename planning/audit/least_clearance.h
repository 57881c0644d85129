#pragma once

// Private to planning/audit.

#include <cstddef>
#include <optional>
#include <queue>
#include <string>
#include <tuple>

#include "roadbed/planning/audit/clearance_probe.h"

namespace roadbed::planning::inline audit {

/// The least distance over a drive, bracketed.
struct LeastClearance {
  double found_m = 0.0;   ///< attained at `at`
  double proven_m = 0.0;  ///< nowhere less; found − proven ≤ tolerance
  geometry::TrajectoryPoint at;
  std::optional<map::Box2> witness;  ///< none: nothing within the horizon
  std::string obstacle = {};         ///< the witness's id, if it moves
};

/// Looks for the least distance over the parts of a drive that it is given, best first in each: the
/// span that may hold the least distance, at first all of a part, is halved until a bound closes
/// the bracket: distance as a function of time is Lipschitz with the motion bound [Piyavskii 1972,
/// doi:10.1016/0041-5553(72)90115-2], and no less than from all that the body sweeps over.
class LeastClearanceSearch {
 public:
  LeastClearanceSearch(const ClearanceProbe& probe, double tolerance_m);

  /// Seeds the search with a segment: it begins where the least room is found so, as a low distance
  /// to begin with puts most others aside at once.
  void seed(std::size_t segment);

  /// Segments from one on up to another, without that one.
  void search(std::size_t from, std::size_t to);

  LeastClearance found() const;

 private:
  struct Open {
    Span span;
    double lower_m;  // no time of the span has less

    // For a queue that hands out the lowest bound first, ties in order of time.
    friend bool operator<(const Open& a, const Open& b) {
      return std::tie(b.lower_m, b.span.segment, b.span.from) <
             std::tie(a.lower_m, a.span.segment, a.span.from);
    }
  };

  double look_at(const Span& span);
  bool is_settled(double lower_m) const { return lower_m >= best_.found_m - tolerance_m_; }
  void open(const Span& span, double known_lower_m);
  void examine(const Open& lowest);

  const ClearanceProbe& probe_;
  double tolerance_m_;
  LeastClearance best_;
  std::optional<Span> first_;  // where to begin
  double first_bound_m_;
  std::priority_queue<Open> queue_;
};

}  // namespace roadbed::planning::audit
