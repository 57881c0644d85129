#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "roadbed/planning/behaviour/path_profile.h"

namespace roadbed::planning::inline behaviour {

/// Speeds along a way, for those who ask very often: the sample before a distance is found by a
/// table of distances. As PathProfile::before().
class PathSpeedLimits {
 public:
  /// @param way  kept by reference.
  explicit PathSpeedLimits(const PathProfile& way) : way_(way) {
    const auto count = static_cast<std::size_t>(way.length_m() * kPerMetre) + 1;
    std::size_t sample = 0;
    for (std::size_t i = 0; i < count; ++i) {
      sample = from(sample, static_cast<double>(i) / kPerMetre);
      samples_.push_back(sample);
    }
  }

  double wanted_mps(double ahead_m) const { return way_.wanted_mps[before(ahead_m)]; }
  double most_mps(double ahead_m) const { return way_.most_mps[before(ahead_m)]; }

 private:
  static constexpr double kPerMetre = 4.0;

  std::size_t before(double ahead_m) const {
    const auto place = static_cast<std::size_t>(std::max(0.0, ahead_m) * kPerMetre);
    return from(samples_[std::min(place, samples_.size() - 1)], ahead_m);
  }

  std::size_t from(std::size_t sample, double ahead_m) const {
    while (sample + 1 < way_.ahead_m.size() && way_.ahead_m[sample + 1] <= ahead_m) ++sample;
    return sample;
  }

  const PathProfile& way_;
  std::vector<std::size_t> samples_;
};

}  // namespace roadbed::planning::behaviour
