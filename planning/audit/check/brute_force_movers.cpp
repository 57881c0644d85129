#include "roadbed/planning/audit/check/brute_force_movers.h"

#include <algorithm>
#include <cmath>

namespace roadbed::planning::inline audit {
namespace {

constexpr double kMoment_s = 1e-9;  // times nearer to each other are the same

}  // namespace

BruteForceMovers::BruteForceMovers(std::span<const ObstacleInSource> obstacles) {
  for (const ObstacleInSource& from : obstacles) {
    Mover mover{.id = from.id,
                .from_s = from.validity.from_s,
                .to_s = from.validity.to_s,
                .half_length_m = 0.5 * from.length_m,
                .half_width_m = 0.5 * from.width_m,
                .samples = {}};
    for (const auto& point : from.motion.points()) {
      mover.samples.push_back({point.t_s, point.x_m, point.y_m, point.heading_rad});
    }
    movers_.push_back(std::move(mover));
  }
}

// The one that a time lies in, else the first or the last.
std::size_t BruteForceMovers::Mover::segment_at(double t_s) const {
  const auto first = samples.begin() + 1, last = samples.end() - (samples.size() > 1 ? 1 : 0);
  const auto after = std::upper_bound(
      first, last, t_s, [](double t, const Sample& sample) { return t < sample.t_s; });
  return static_cast<std::size_t>(after - first);
}

BodyOutline::Corners BruteForceMovers::Mover::at(double t_s) const {
  Sample sample = samples.front();
  if (samples.size() > 1 && t_s >= sample.t_s) {
    const std::size_t i = segment_at(t_s);
    const Sample &a = samples[i], &b = samples[i + 1];
    const double fraction = std::min(1.0, (t_s - a.t_s) / (b.t_s - a.t_s));
    sample = {t_s, a.x_m + fraction * (b.x_m - a.x_m), a.y_m + fraction * (b.y_m - a.y_m),
              a.heading_rad + fraction * (b.heading_rad - a.heading_rad)};
  }
  const double c = std::cos(sample.heading_rad), s = std::sin(sample.heading_rad);
  const auto corner = [&](double ahead_m, double left_m) {
    return Eigen::Vector2d(sample.x_m + c * ahead_m - s * left_m,
                           sample.y_m + s * ahead_m + c * left_m);
  };
  return {corner(-half_length_m, -half_width_m), corner(half_length_m, -half_width_m),
          corner(half_length_m, half_width_m), corner(-half_length_m, half_width_m)};
}

// How far a point of it moves at most between two times.
double BruteForceMovers::Mover::way_m(double start_s, double end_s) const {
  double sum_m = 0.0;
  for (std::size_t i = segment_at(start_s); i + 1 < samples.size() && samples[i].t_s < end_s; ++i) {
    const Sample &a = samples[i], &b = samples[i + 1];
    const double common_s = std::min(end_s, b.t_s) - std::max(start_s, a.t_s);
    if (common_s <= 0.0) continue;
    sum_m += common_s / (b.t_s - a.t_s) *
             (std::hypot(b.x_m - a.x_m, b.y_m - a.y_m) +
              std::hypot(half_length_m, half_width_m) * std::abs(b.heading_rad - a.heading_rad));
  }
  return sum_m;
}

// At a moment of it, other than one at which the span ends and the drive goes on.
bool BruteForceMovers::Mover::is_there(const Time& time) const {
  const double least_s = time.to_s < time.drive_to_s - kMoment_s ? kMoment_s : -kMoment_s;
  const double most_s = time.from_s > time.drive_from_s + kMoment_s ? kMoment_s : -kMoment_s;
  return from_s < time.to_s - least_s && to_s > time.from_s + most_s;
}

std::optional<double> BruteForceMovers::distance_m(const std::string& id, double t_s,
                                                   const BodyOutline::Place& body) const {
  std::optional<double> least_m;
  for (const Mover& mover : movers_) {
    if (mover.id != id || t_s < mover.from_s - kMoment_s || t_s > mover.to_s + kMoment_s) continue;
    const double away_m = body.distance_m(mover.at(t_s));
    if (!least_m || away_m < *least_m) least_m = away_m;
  }
  return least_m;
}

bool BruteForceMovers::keep_away(const BodyOutline::Place& body, const Time& time,
                                 double least_m) const {
  const double middle_s = 0.5 * (time.from_s + time.to_s);
  return std::ranges::all_of(movers_, [&](const Mover& mover) {
    if (!mover.is_there(time)) return true;
    const double way_m =
        std::max(mover.way_m(time.from_s, middle_s), mover.way_m(middle_s, time.to_s));
    return body.distance_m(mover.at(middle_s)) >= least_m + way_m;
  });
}

}  // namespace roadbed::planning::audit
