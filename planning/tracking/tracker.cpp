#include "roadbed/planning/tracking/tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <stdexcept>
#include <utility>

#include "roadbed/planning/tracking/assignment.h"

namespace roadbed::planning::inline tracking {
namespace {

constexpr double kRemembered_s = 1.0;
constexpr double kSlotRests_s = 10.0;
constexpr std::ptrdiff_t kMostFits = 16;  // of a track, in a crowd

void refuse_twice(std::span<const Detection> detections) {
  std::set<std::string_view> ids;
  for (const Detection& detection : detections) {
    if (detection.id.empty() || ids.insert(detection.id).second) continue;
    throw std::invalid_argument("Tracker: two detections have the id " + detection.id);
  }
}

}  // namespace

void Tracker::observe(double t_s, std::span<const Detection> detections,
                      const IsHidden& is_hidden) {
  refuse_twice(detections);
  go_on(t_s);
  measured_s_ = t_s;
  std::vector<bool> is_taken(detections.size(), false);
  give_by_id(detections, is_taken);
  give_by_fit(detections, false, is_taken);
  give_by_fit(detections, true, is_taken);
  for (std::size_t i = 0; i < detections.size(); ++i) {
    if (!is_taken[i]) begin(detections, i);
  }
  expect(is_hidden);
  remember();
}

void Tracker::foresee(double t_s) {
  go_on(t_s);
  expect([](const Eigen::Vector2d&) { return true; });
  remember();
}

void Tracker::go_on(double t_s) {
  if (!std::isfinite(t_s) || (t_s_ && !(t_s > *t_s_))) {
    throw std::invalid_argument("Tracker: time does not increase");
  }
  t_s_ = t_s;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    std::optional<Track>& track = slots_[i];
    if (!track) continue;
    track->detection.reset();
    const bool is_old = t_s - track->expected_s > options_.coasts_for_s + 1e-9;
    if (is_old || (track->is_tentative() && track->last_measured_s < measured_s_)) {
      if (track->has_own_id) slot_of_id_.erase(track->id);
      track.reset();
      left_at_s_[i] = t_s;
    } else {
      track->filter.predict(t_s);
    }
  }
}

void Tracker::give_by_id(std::span<const Detection> detections, std::vector<bool>& is_taken) {
  for (std::size_t i = 0; i < detections.size(); ++i) {
    const auto at = slot_of_id_.find(detections[i].id);
    if (at == slot_of_id_.end()) continue;
    take(*slots_[at->second], detections, i);
    is_taken[i] = true;
  }
}

void Tracker::give_by_fit(std::span<const Detection> detections, bool to_tentative,
                          std::vector<bool>& is_taken) {
  std::vector<PossiblePair> pairs;
  for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
    if (!slots_[slot] || slots_[slot]->has_own_id) continue;
    if (slots_[slot]->is_tentative() != to_tentative) continue;
    std::vector<PossiblePair> fits;
    for (std::size_t i = 0; i < detections.size(); ++i) {
      if (!detections[i].id.empty() || is_taken[i]) continue;
      const double misfit = slots_[slot]->filter.misfit(measured(detections[i]));
      if (misfit <= options_.misfit_limit) fits.push_back({slot, i, misfit});
    }
    if (std::ssize(fits) > kMostFits) {
      std::ranges::nth_element(fits, fits.begin() + kMostFits, {}, &PossiblePair::cost);
      fits.resize(static_cast<std::size_t>(kMostFits));
    }
    pairs.insert(pairs.end(), fits.begin(), fits.end());
  }
  const auto given = assign(slots_.size(), detections.size(), pairs, options_.misfit_limit);
  for (std::size_t slot = 0; slot < given.size(); ++slot) {
    if (!given[slot]) continue;
    take(*slots_[slot], detections, *given[slot]);
    is_taken[*given[slot]] = true;
  }
}

/// One that cannot have come there by itself is another one of the same id, or was seen wrongly.
void Tracker::take(Track& track, std::span<const Detection> detections, std::size_t at) const {
  const Detection& detection = detections[at];
  const MeasuredMotion now = measured(detection);
  if (track.filter.misfit(now) > options_.misfit_limit) {
    track.filter = MotionFilter(now, options_.noise);
    track.past.clear();
  } else {
    track.filter.update(now);
  }
  track.kind = detection.kind;
  track.length_m = detection.length_m;
  track.width_m = detection.width_m;
  track.last_measured_s = *t_s_;
  ++track.measured;
  track.detection = at;
}

void Tracker::begin(std::span<const Detection> detections, std::size_t at) {
  const Detection& detection = detections[at];
  const bool has_own_id = !detection.id.empty();
  Track track{.id = has_own_id ? detection.id : fmt::format("track {}", ++named_),
              .kind = detection.kind,
              .length_m = detection.length_m,
              .width_m = detection.width_m,
              .filter = MotionFilter(measured(detection), options_.noise),
              .first_s = *t_s_,
              .last_measured_s = *t_s_,
              .past = {},
              .has_own_id = has_own_id,
              .detection = at};
  std::size_t slot = 0;
  while (slot < slots_.size() && (slots_[slot] || *t_s_ - left_at_s_[slot] < kSlotRests_s)) ++slot;
  if (slot == slots_.size()) {
    slots_.emplace_back();
    left_at_s_.push_back(0.0);
  }
  if (has_own_id) slot_of_id_[track.id] = slot;
  slots_[slot] = std::move(track);
}

/// Who is behind somebody or something is not gone.
void Tracker::expect(const IsHidden& is_hidden) {
  for (std::optional<Track>& track : slots_) {
    if (!track) continue;
    const double unmeasured_s = *t_s_ - track->last_measured_s;
    const bool may_be_hidden = is_hidden && unmeasured_s <= options_.hidden_for_s;
    if (track->detection || (may_be_hidden && is_hidden(track->filter.state().pose.position()))) {
      track->expected_s = *t_s_;
    }
  }
}

void Tracker::remember() {
  for (std::optional<Track>& track : slots_) {
    if (!track) continue;
    const SeenMotion now = track->filter.state();
    if (now.speed_mps != 0.0) track->moved_s = now.t_s;
    track->past.push_back({.t_s = now.t_s,
                           .x_m = now.pose.x_m,
                           .y_m = now.pose.y_m,
                           .heading_rad = now.pose.heading_rad,
                           .speed_mps = now.speed_mps,
                           .acceleration_mps2 = now.acceleration_mps2});
    while (track->past.front().t_s < now.t_s - kRemembered_s) track->past.pop_front();
  }
}

MeasuredMotion Tracker::measured(const Detection& detection) const {
  return {*t_s_, detection.centre, detection.speed_mps};
}

}  // namespace roadbed::planning::tracking
