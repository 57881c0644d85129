#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "roadbed/planning/speed/path_profile.h"

namespace roadbed::planning::inline speed {

/// Speeds along a path, for those who ask very often: the sample before a distance is found by a
/// table of distances. As PathProfile::before().
class PathSpeedLimits {
 public:
  /// @param profile  kept by reference.
  explicit PathSpeedLimits(const PathProfile& profile) : profile_(profile) {
    const auto count = static_cast<std::size_t>(profile.length_m() * kPerMetre) + 1;
    std::size_t sample = 0;
    for (std::size_t i = 0; i < count; ++i) {
      sample = from(sample, static_cast<double>(i) / kPerMetre);
      samples_.push_back(sample);
    }
  }

  double wanted_mps(double ahead_m) const { return profile_.wanted_mps[before(ahead_m)]; }
  double most_mps(double ahead_m) const { return profile_.most_mps[before(ahead_m)]; }

 private:
  static constexpr double kPerMetre = 4.0;

  std::size_t before(double ahead_m) const {
    const auto place = static_cast<std::size_t>(std::max(0.0, ahead_m) * kPerMetre);
    return from(samples_[std::min(place, samples_.size() - 1)], ahead_m);
  }

  std::size_t from(std::size_t sample, double ahead_m) const {
    while (sample + 1 < profile_.ahead_m.size() && profile_.ahead_m[sample + 1] <= ahead_m)
      ++sample;
    return sample;
  }

  const PathProfile& profile_;
  std::vector<std::size_t> samples_;
};

}  // namespace roadbed::planning::speed
