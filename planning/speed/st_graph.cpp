#include "roadbed/planning/speed/st_graph.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace roadbed::planning::inline speed {
namespace {

using geometry::Rectangle;

constexpr std::size_t kChunk = 16;
constexpr std::size_t kKeptSteps = 5;  // in time, from who crosses

/// What stands is looked at once.
bool is_same_place(const TrafficBodies::Body& a, const TrafficBodies::Body& b) {
  return a.obstacle == b.obstacle && a.at.centre == b.at.centre && a.at.axis == b.at.axis;
}

/// The bodies of a path, in chunks of consecutive ones with a box around their centres.
class BodiesOnPath {
 public:
  explicit BodiesOnPath(const PathProfile& profile) : profile_(profile) {
    for (std::size_t i = 0; i < profile.body.size(); ++i) {
      if (i % kChunk == 0) chunks_.emplace_back();
      chunks_.back().extend(profile.body[i].centre);
      whole_.extend(profile.body[i].centre);
      radius_m_ = std::max(radius_m_, profile.body[i].radius_m());
    }
  }

  /// The part of the path from the first to the last sample that touches.
  std::optional<StInterval> part(const TrafficBodies::Body& other, double margin_m) const {
    const double reach_m = radius_m_ + other.radius_m + margin_m;
    const double far = reach_m * reach_m;
    if (whole_.squaredExteriorDistance(other.at.centre) > far) return std::nullopt;
    const auto touches = [&](std::size_t i) {
      const Rectangle& body = profile_.body[i];
      return (body.centre - other.at.centre).squaredNorm() <= far &&
             geometry::distance_m(body, other.at) <= margin_m;
    };
    const auto is_far = [&](std::size_t chunk) {
      return chunks_[chunk].squaredExteriorDistance(other.at.centre) > far;
    };
    const auto first = first_that(touches, is_far);
    if (!first) return std::nullopt;
    const std::size_t last = last_that(touches, is_far);
    return StInterval{.from_m = *first > 0 ? profile_.ahead_m[*first - 1] : -1.0,
                      .to_m = profile_.ahead_m[std::min(last + 1, profile_.ahead_m.size() - 1)],
                      .obstacle = other.obstacle};
  }

 private:
  template <typename Touches, typename IsFar>
  std::optional<std::size_t> first_that(const Touches& touches, const IsFar& is_far) const {
    for (std::size_t chunk = 0; chunk < chunks_.size(); ++chunk) {
      if (is_far(chunk)) continue;
      const std::size_t end = std::min(profile_.body.size(), (chunk + 1) * kChunk);
      for (std::size_t i = chunk * kChunk; i < end; ++i) {
        if (touches(i)) return i;
      }
    }
    return std::nullopt;
  }

  /// @pre there is one
  template <typename Touches, typename IsFar>
  std::size_t last_that(const Touches& touches, const IsFar& is_far) const {
    for (std::size_t chunk = chunks_.size(); chunk-- > 0;) {
      if (is_far(chunk)) continue;
      for (std::size_t i = std::min(profile_.body.size(), (chunk + 1) * kChunk);
           i-- > chunk * kChunk;) {
        if (touches(i)) return i;
      }
    }
    return 0;
  }

  const PathProfile& profile_;
  std::vector<Eigen::AlignedBox2d> chunks_;
  Eigen::AlignedBox2d whole_;
  double radius_m_ = 0.0;
};

}  // namespace

TrafficBodies::TrafficBodies(const Traffic& traffic, double start_s, int steps,
                             const Crossing& crossing)
    : times_(static_cast<std::size_t>(steps) + 1) {
  for (std::size_t o = 0; o < traffic.obstacles.size(); ++o) {
    const bool crosses = !crossing.crosses.empty() && crossing.crosses[o];
    const double wider_m = crosses ? crossing.clearance_m : 0.0;
    for (std::size_t k = 0; k < times_; ++k) {
      const double t_s = start_s + kStep_s * static_cast<double>(k);
      if (!traffic.obstacles[o].is_there(t_s)) continue;
      Rectangle at = rectangle_at(traffic.obstacles[o], t_s);
      at.half_length_m += wider_m;
      at.half_width_m += wider_m;
      all_.push_back({o, k, at, at.radius_m()});
      if (crosses) add_around(Body(all_.back()));
    }
  }
}

/// The same at the times that are too near to it.
void TrafficBodies::add_around(const Body& body) {
  const auto kept_at = [](std::size_t step) { return std::min(kKeptSteps, step / 2); };
  const std::size_t first = body.step - std::min(body.step, kKeptSteps);
  for (std::size_t k = first; k < std::min(times_, body.step + kKeptSteps + 1); ++k) {
    const std::size_t apart = k > body.step ? k - body.step : body.step - k;
    if (apart > 0 && apart <= kept_at(k))
      all_.push_back({body.obstacle, k, body.at, body.radius_m});
  }
}

StGraph::StGraph(const PathProfile& profile, const TrafficBodies& bodies, double margin_m)
    : moments_(bodies.times()) {
  const BodiesOnPath on_profile(profile);
  const TrafficBodies::Body* before = nullptr;
  std::optional<StInterval> part;
  for (const TrafficBodies::Body& body : bodies.all()) {
    if (before == nullptr || !is_same_place(*before, body)) part = on_profile.part(body, margin_m);
    if (part) moments_[body.step].parts.push_back(*part);
    before = &body;
  }
  for (Moment& moment : moments_) set_lists(moment);
}

void StGraph::set_lists(Moment& moment) {
  for (const StInterval& part : moment.parts) {
    moment.blocked.push_back({part.from_m, part.to_m});
    moment.begins_m.push_back(part.from_m);
    moment.ends_m.push_back(part.to_m);
  }
  std::ranges::sort(moment.begins_m);
  std::ranges::sort(moment.ends_m);
  std::ranges::sort(moment.blocked, {}, &Interval::from_m);
  std::size_t kept = 0;  // a part is open at its ends: two that only meet leave a place between
  for (std::size_t i = 1; i < moment.blocked.size(); ++i) {
    Interval& last = moment.blocked[kept];
    const Interval& next = moment.blocked[i];
    if (next.from_m < last.to_m) {
      last.to_m = std::max(last.to_m, next.to_m);
    } else {
      moment.blocked[++kept] = next;
    }
  }
  if (!moment.blocked.empty()) moment.blocked.resize(kept + 1);
}

void StGraph::block(int step, double from_m, double to_m) {
  Moment& moment = moments_.at(static_cast<std::size_t>(step));
  moment.parts.push_back({from_m, to_m, StInterval::kNoObstacle});
  moment.blocked.clear();
  moment.begins_m.clear();
  moment.ends_m.clear();
  set_lists(moment);
}

double StGraph::gap_ahead_m(int step, double distance_m) const {
  const std::vector<double>& begins_m = of(step).begins_m;
  const auto next = std::ranges::lower_bound(begins_m, distance_m);
  return next == begins_m.end() ? std::numeric_limits<double>::infinity() : *next - distance_m;
}

double StGraph::gap_behind_m(int step, double distance_m) const {
  const std::vector<double>& ends_m = of(step).ends_m;
  const auto next = std::ranges::upper_bound(ends_m, distance_m);
  return next == ends_m.begin() ? std::numeric_limits<double>::infinity()
                                : distance_m - *std::prev(next);
}

}  // namespace roadbed::planning::speed
