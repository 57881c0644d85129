#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "roadbed/planning/obstacles/traffic.h"
#include "roadbed/planning/speed/path_profile.h"

namespace roadbed::planning::inline speed {

/// Part of a path on which the body would touch an obstacle.
struct StInterval {
  double from_m = 0.0, to_m = 0.0;  ///< of the rear axle, along the path
  std::size_t obstacle = 0;         ///< index in the world, or kNoObstacle

  static constexpr std::size_t kNoObstacle = static_cast<std::size_t>(-1);  ///< a red light
};

/// Where obstacles are from one time on, every 0.1 s: found once for all ways of a planning cycle.
class TrafficBodies {
 public:
  static constexpr double kStep_s = 0.1;

  TrafficBodies() = default;
  /// Those whom the vehicle meets only once, as they move across its path.
  struct Crossing {
    std::vector<bool> crosses = {};  ///< per obstacle; empty: none does
    double clearance_m = 0.0;        ///< kept from them
  };

  /// @param steps     of 0.1 s from `start_s` on; obstacles move as the world knows.
  /// @param crossing  from these some time is kept, too: half of that until they are met, 0.5 s at
  ///                  most.
  TrafficBodies(const Traffic& traffic, double start_s, int steps, const Crossing& crossing);
  TrafficBodies(const Traffic& traffic, double start_s, int steps)
      : TrafficBodies(traffic, start_s, steps, Crossing()) {}

  struct Body {
    std::size_t obstacle = 0, step = 0;
    geometry::Rectangle at;
    double radius_m = 0.0;
  };
  /// Those that are there, one obstacle after the other, by time.
  const std::vector<Body>& all() const { return all_; }
  std::size_t times() const { return times_; }  ///< one more than steps

 private:
  void add_around(const Body& body);

  std::vector<Body> all_;
  std::size_t times_ = 0;
};

/// Which parts of a path are blocked when: the s–t graph of the obstacles. Parts of one time are in
/// no order; those of different obstacles may overlap.
class StGraph {
 public:
  static constexpr double kStep_s = TrafficBodies::kStep_s;

  /// @param margin_m  an obstacle this near to the body counts as touched.
  StGraph(const PathProfile& profile, const TrafficBodies& bodies, double margin_m);
  StGraph(const PathProfile& profile, const Traffic& traffic, double start_s, int steps,
          double margin_m)
      : StGraph(profile, TrafficBodies(traffic, start_s, steps), margin_m) {}

  /// A part that no obstacle blocks, such as the place behind a line at a red light.
  void block(int step, double from_m, double to_m);

  std::size_t times() const { return moments_.size(); }  ///< one more than steps

  /// At `step` · 0.1 s after the start, clamped to the last one.
  const std::vector<StInterval>& at(int step) const { return of(step).parts; }

  bool is_blocked(int step, double distance_m) const {
    for (const Interval& interval : of(step).blocked) {
      if (distance_m <= interval.from_m) return false;
      if (distance_m < interval.to_m) return true;
    }
    return false;
  }

  /// From a distance to where the next part begins, and back to where the last one ends; infinite
  /// if there is none.
  double gap_ahead_m(int step, double distance_m) const;
  double gap_behind_m(int step, double distance_m) const;

 private:
  struct Interval {
    double from_m, to_m;
  };
  struct Moment {
    std::vector<StInterval> parts;
    std::vector<Interval> blocked;         // their union, ascending and disjoint
    std::vector<double> begins_m, ends_m;  // of the parts, ascending
  };

  const Moment& of(int step) const {
    return moments_[std::min(static_cast<std::size_t>(step), moments_.size() - 1)];
  }
  static void set_lists(Moment& moment);

  std::vector<Moment> moments_;
};

}  // namespace roadbed::planning::speed
