#include "roadbed/planning/audit/least_clearance.h"

#include <algorithm>
#include <utility>

namespace roadbed::planning::inline audit {

LeastClearanceSearch::LeastClearanceSearch(const ClearanceProbe& probe, double tolerance_m)
    : probe_(probe), tolerance_m_(tolerance_m), first_bound_m_(probe.horizon_m()) {
  best_.found_m = best_.proven_m = probe.horizon_m();
  best_.at = probe.state_at(0, 0.0);
}

LeastClearance LeastClearanceSearch::found() const {
  LeastClearance found = best_;
  found.proven_m = std::min(found.proven_m, found.found_m);
  return found;
}

void LeastClearanceSearch::seed(std::size_t segment) {
  const Span whole{segment, 0.0, 1.0};
  const double bound_m = probe_.lower_bound_m(whole, first_bound_m_);
  if (bound_m >= first_bound_m_) return;
  first_bound_m_ = bound_m;
  first_ = whole;
}

void LeastClearanceSearch::search(std::size_t from, std::size_t to) {
  if (first_) look_at(*std::exchange(first_, std::nullopt));
  if (probe_.is_continuous()) {
    open({from, 0.0, 1.0, to - from}, 0.0);
  } else {
    for (std::size_t segment = from; segment < to; ++segment) open({segment, 0.0, 1.0}, 0.0);
  }
  while (!queue_.empty() && !is_settled(queue_.top().lower_m)) {
    const Open lowest = queue_.top();
    queue_.pop();
    examine(lowest);
  }
  if (!queue_.empty()) best_.proven_m = std::min(best_.proven_m, queue_.top().lower_m);
  queue_ = {};
}

// Distance in the middle of the span, or what was found before if that is less.
double LeastClearanceSearch::look_at(const Span& span) {
  const auto nearest = probe_.nearest(span, best_.found_m);
  if (nearest && (nearest->distance_m < best_.found_m || !best_.witness)) {
    best_.found_m = nearest->distance_m;
    best_.at = probe_.middle_of(span);
    best_.witness = nearest->witness;
    best_.obstacle = nearest->obstacle;
  }
  return nearest ? nearest->distance_m : best_.found_m;
}

// Puts a span aside for good, or into the queue.
void LeastClearanceSearch::open(const Span& span, double known_lower_m) {
  const double motion_m = probe_.motion_bound_m(span);
  const double bound_m = probe_.lower_bound_m(span, best_.found_m + motion_m) - motion_m;
  const double lower_m = std::max({0.0, known_lower_m, bound_m});
  if (lower_m < best_.found_m) queue_.push({span, lower_m});
}

void LeastClearanceSearch::examine(const Open& lowest) {
  const Span& span = lowest.span;
  double lower_m = std::max(lowest.lower_m, probe_.swept_bound_m(span, best_.found_m));
  if (!is_settled(lower_m)) {
    lower_m = std::max(lower_m, look_at(span) - probe_.motion_bound_m(span));
  }
  if (is_settled(lower_m)) {
    best_.proven_m = std::min(best_.proven_m, lower_m);
    return;
  }
  open(span.first_half(), lower_m);
  open(span.second_half(), lower_m);
}

}  // namespace roadbed::planning::audit
