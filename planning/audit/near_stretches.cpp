#include "roadbed/planning/audit/near_stretches.h"

#include <algorithm>
#include <optional>

namespace roadbed::planning::inline audit {
namespace {

// In a drive that is too near all along; a segment may be any way long.
double most_spans(std::size_t segments) {
  constexpr double most = 1e6, free = 1e5, each = 100.0;
  return std::min(most, free + each * static_cast<double>(segments));
}

// Two conflicts with an undecided time between them are one.
void add(std::vector<Conflict>& conflicts, const Conflict& next) {
  if (conflicts.empty() || conflicts.back().to_s < next.from_s) {
    conflicts.push_back(next);
    return;
  }
  Conflict& last = conflicts.back();
  const double from_s = last.from_s;
  if (next.least_clearance_m < last.least_clearance_m) last = next;
  last.from_s = from_s;
  last.to_s = next.to_s;
}

}  // namespace

NearStretchSearch::NearStretchSearch(const ClearanceProbe& probe, double clearance_m,
                                     double tolerance_m)
    : probe_(probe), clearance_m_(clearance_m), tolerance_m_(tolerance_m) {
  double whole_m = 0.0;
  for (std::size_t i = 0; i < probe.segments(); ++i) whole_m += probe.motion_bound_m({i, 0.0, 1.0});
  tolerance_m_ = std::max(tolerance_m_, whole_m / most_spans(probe.segments()));
}

void NearStretchSearch::search(std::size_t to) {
  while (next_ < to) {
    spare_m_ = -1.0;
    label(next_);
    next_ = probe_.next_after(next_, spare_m_);
    runs_.back().time.to_s = probe_.time_at(next_ - 1, 1.0);  // what was skipped is clear as well
  }
}

// In order of time, with the spans that still have to come on a stack.
void NearStretchSearch::label(std::size_t segment) {
  std::vector<Span> to_come{{segment, 0.0, 1.0}};
  while (!to_come.empty()) {
    const Span span = to_come.back();
    to_come.pop_back();
    if (!settle(span)) {
      to_come.push_back(span.second_half());
      to_come.push_back(span.first_half());
    }
  }
}

// Labels the span unless it has to be halved.
bool NearStretchSearch::settle(const Span& span) {
  const double motion_m = probe_.motion_bound_m(span);
  const double enough_m = clearance_m_ + motion_m + kOver_m;
  const double bound_m = probe_.lower_bound_m(span, enough_m) - motion_m;
  if (is_far(bound_m)) {
    if (span.to - span.from == 1.0) spare_m_ = bound_m - clearance_m_ - kOver_m;
    return append(span, Label::clear);
  }
  const double within_m = std::min(clearance_m_ + motion_m, probe_.horizon_m());
  const auto nearest = probe_.nearest(span, within_m);
  const double distance_m = nearest ? nearest->distance_m : within_m;
  if (is_far(distance_m - motion_m) || (!nearest && within_m < probe_.horizon_m())) {
    return append(span, Label::clear);
  }
  if (nearest && !is_far(distance_m)) {
    if (motion_m > tolerance_m_) return false;
    return append(span, Label::near,
                  Conflict{.least_clearance_m = distance_m,
                           .at = probe_.middle_of(span),
                           .witness = nearest->witness,
                           .obstacle = nearest->obstacle});
  }
  return motion_m <= kLeastTold_m && append(span, Label::undecided);
}

bool NearStretchSearch::append(const Span& span, Label label,
                               const std::optional<Conflict>& worst) {
  const Stretch time{probe_.time_at(span.segment, span.from),
                     probe_.time_at(span.segment, span.to)};
  if (runs_.empty() || runs_.back().label != label) {
    runs_.push_back({label, time, worst});
    return true;
  }
  Run& run = runs_.back();
  run.time.to_s = time.to_s;
  if (worst && worst->least_clearance_m < run.worst->least_clearance_m) run.worst = worst;
  return true;
}

// Undecided times beside a conflict are its edges and belong to it.
NearStretches NearStretchSearch::found() const {
  NearStretches found;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const Run& run = runs_[i];
    const auto is = [this](std::size_t k, Label label) {
      return k < runs_.size() && runs_[k].label == label;
    };
    if (run.label == Label::near) {
      Conflict conflict = *run.worst;
      conflict.from_s = is(i - 1, Label::undecided) ? runs_[i - 1].time.from_s : run.time.from_s;
      conflict.to_s = is(i + 1, Label::undecided) ? runs_[i + 1].time.to_s : run.time.to_s;
      add(found.near, conflict);
    } else if (run.label == Label::undecided && !is(i - 1, Label::near) &&
               !is(i + 1, Label::near)) {
      found.undecided.push_back(run.time);
    }
  }
  return found;
}

}  // namespace roadbed::planning::audit
