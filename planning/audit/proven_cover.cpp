#include "roadbed/planning/audit/proven_cover.h"

#include <algorithm>
#include <utility>

namespace roadbed::planning::inline audit {
namespace {

constexpr double kMostOver_m = 1.0;  // of what a span promises over its goal: more makes more spans
constexpr double kLeastMotion_m = 1e-7;  // motion bound of a span that is not halved any more

class Prover {
 public:
  Prover(const ClearanceProbe& probe, double goal_m, const std::vector<Stretch>& left_out)
      : probe_(probe), goal_m_(goal_m), left_out_(left_out) {}

  ProvenCover run() {
    for (std::size_t segment = 0; segment < probe_.segments();) {
      spare_m_ = -1.0;
      cover(segment);
      segment = cover_settled(segment, probe_.next_after(segment, spare_m_));
    }
    return std::move(cover_);
  }

 private:
  void cover(std::size_t segment) {
    to_come_.assign({{segment, 0.0, 1.0}});
    while (!to_come_.empty()) {
      const Span span = to_come_.back();
      to_come_.pop_back();
      if (settle(span)) continue;
      to_come_.push_back(span.second_half());
      to_come_.push_back(span.first_half());
    }
  }

  // Spans of the segments that are settled with another one, up to `next`.
  std::size_t cover_settled(std::size_t segment, std::size_t next) {
    for (++segment; segment < next; ++segment) {
      const Span span{segment, 0.0, 1.0};
      spare_m_ -= 2.0 * probe_.motion_bound_m(span);
      prove(span, goal_m_ + std::max(spare_m_, 0.0) + kOver_m);
    }
    return next;
  }

  Stretch time_of(const Span& span) const {
    return {probe_.time_at(span.segment, span.from), probe_.time_at(span.segment, span.to)};
  }

  bool is_left_out(const Stretch& time) {
    while (next_ < left_out_.size() && left_out_[next_].to_s < time.from_s) ++next_;
    for (std::size_t i = next_; i < left_out_.size() && left_out_[i].from_s <= time.from_s; ++i) {
      if (time.to_s <= left_out_[i].to_s) return true;
    }
    return false;
  }

  bool settle(const Span& span) {
    const Stretch time = time_of(span);
    if (is_left_out(time)) return true;
    const double motion_m = probe_.motion_bound_m(span);
    const double bound_m = probe_.lower_bound_m(span, goal_m_ + motion_m + kOver_m) - motion_m;
    if (prove(span, bound_m)) {
      if (span.to - span.from == 1.0) spare_m_ = bound_m - goal_m_ - kOver_m;
      return true;
    }
    const double within_m = std::min(goal_m_ + 2.0 * motion_m, probe_.horizon_m());
    const auto nearest = probe_.nearest(span, within_m);
    if (prove(span, (nearest ? nearest->distance_m : within_m) - motion_m)) return true;
    if (motion_m > kLeastMotion_m) return false;
    cover_.left.push_back(time);
    return true;
  }

  bool prove(const Span& span, double at_least_m) {
    if (!(at_least_m > 0.0 && at_least_m >= goal_m_)) return false;
    cover_.proven.push_back(
        {span.segment, span.from, span.to, std::min(at_least_m, goal_m_ + kMostOver_m)});
    return true;
  }

  const ClearanceProbe& probe_;
  double goal_m_;
  const std::vector<Stretch>& left_out_;  // in order of time
  std::size_t next_ = 0;
  double spare_m_ = 0.0;  // of the segment that is being covered, where one span does
  std::vector<Span> to_come_;
  ProvenCover cover_;
};

}  // namespace

ProvenCover proven_cover(const ClearanceProbe& probe, double goal_m,
                         const std::vector<Stretch>& left_out) {
  return Prover(probe, goal_m, left_out).run();
}

}  // namespace roadbed::planning::audit
