#include "roadbed/planning/least_clearance.h"

#include <algorithm>
#include <queue>
#include <tuple>
#include <vector>

namespace roadbed::planning {
namespace {

struct Open {
  Span span;
  double lower_m;  // no time of the span has less

  // For a queue that hands out the lowest bound first, ties in order of time.
  friend bool operator<(const Open& a, const Open& b) {
    return std::tie(b.lower_m, b.span.segment, b.span.from) <
           std::tie(a.lower_m, a.span.segment, a.span.from);
  }
};

class Search {
 public:
  Search(const Probe& probe, double tolerance_m) : probe_(probe), tolerance_m_(tolerance_m) {
    best_.found_m = best_.proven_m = probe.horizon_m();
    best_.at = probe.state_at(0, 0.0);
  }

  LeastClearance run() {
    // Part by part of the drive, so that what lies around it is looked at place by place.
    constexpr std::size_t part = 1024;
    guess();
    for (std::size_t from = 0; from < probe_.segments(); from += part) {
      search(from, std::min(from + part, probe_.segments()));
    }
    best_.proven_m = std::min(best_.proven_m, best_.found_m);
    return best_;
  }

 private:
  void search(std::size_t from, std::size_t to) {
    for (std::size_t segment = from; segment < to;) {
      const double lower_m = open({segment, 0.0, 1.0}, 0.0);
      segment = probe_.next_after(segment, lower_m - best_.found_m);
    }
    while (!queue_.empty() && !is_settled(queue_.top().lower_m)) {
      const Open lowest = queue_.top();
      queue_.pop();
      examine(lowest);
    }
    if (!queue_.empty()) best_.proven_m = std::min(best_.proven_m, queue_.top().lower_m);
    queue_ = {};
  }

  // A low distance to begin with keeps most spans out of the queue.
  void guess() {
    constexpr std::size_t looks = 64;
    const std::size_t step = 1 + probe_.segments() / looks;
    Span lowest;
    double lowest_m = probe_.horizon_m();
    for (std::size_t segment = 0; segment < probe_.segments(); segment += step) {
      const Span whole{segment, 0.0, 1.0};
      const double bound_m = probe_.lower_bound_m(whole, lowest_m);
      if (bound_m >= lowest_m) continue;
      lowest_m = bound_m;
      lowest = whole;
    }
    look_at(lowest);
  }

  // Distance in the middle of the span, or what was found before if that is less.
  double look_at(const Span& span) {
    const auto nearest = probe_.nearest(span, best_.found_m);
    if (nearest && (nearest->distance_m < best_.found_m || !best_.witness)) {
      best_.found_m = nearest->distance_m;
      best_.at = probe_.middle_of(span);
      best_.witness = nearest->witness;
      best_.obstacle = nearest->obstacle;
    }
    return nearest ? nearest->distance_m : best_.found_m;
  }

  bool is_settled(double lower_m) const { return lower_m >= best_.found_m - tolerance_m_; }

  // Puts a span aside for good, or into the queue; returns its bound.
  double open(const Span& span, double known_lower_m) {
    const double motion_m = probe_.motion_bound_m(span);
    const double bound_m = probe_.lower_bound_m(span, best_.found_m + motion_m) - motion_m;
    const double lower_m = std::max({0.0, known_lower_m, bound_m});
    if (lower_m < best_.found_m) queue_.push({span, lower_m});
    return lower_m;
  }

  void examine(const Open& lowest) {
    const double distance_m = look_at(lowest.span);
    const double lower_m =
        std::max(lowest.lower_m, distance_m - probe_.motion_bound_m(lowest.span));
    if (is_settled(lower_m)) {
      best_.proven_m = std::min(best_.proven_m, lower_m);
      return;
    }
    open(lowest.span.first_half(), lower_m);
    open(lowest.span.second_half(), lower_m);
  }

  const Probe& probe_;
  double tolerance_m_;
  LeastClearance best_;
  std::priority_queue<Open> queue_;
};

}  // namespace

LeastClearance find_least_clearance(const Probe& probe, double tolerance_m) {
  return Search(probe, tolerance_m).run();
}

}  // namespace roadbed::planning
