#include "roadbed/map/opendrive/lateral_shape.h"

#include <algorithm>
#include <cmath>

namespace roadbed::map::opendrive {
namespace {

// Largest |value|, |slope| and |second derivative| of a profile over a range of t, with the jumps
// of its slope inside the range.
struct RangeBounds {
  geometry::CubicValue value;
  double kinks = 0.0;
};

RangeBounds range_bounds(const geometry::PiecewiseCubic& over_t, double from_t_m, double to_t_m) {
  RangeBounds range;
  const auto& records = over_t.records();
  for (std::size_t i = 0; i < records.size(); ++i) {
    const double low = i == 0 ? from_t_m : std::max(from_t_m, records[i].s_m);
    const double high = i + 1 < records.size() ? std::min(to_t_m, records[i + 1].s_m) : to_t_m;
    if (low > high) continue;
    const geometry::CubicValue piece = over_t.bounds(low, high);
    range.value.value = std::max(range.value.value, piece.value);
    range.value.d1 = std::max(range.value.d1, piece.d1);
    range.value.d2 = std::max(range.value.d2, piece.d2);
    const double t = records[i].s_m;
    if (i > 0 && t > from_t_m && t < to_t_m) {
      range.kinks += std::abs(over_t.at(t, t).d1 - over_t.at(t, records[i - 1].s_m).d1);
    }
  }
  return range;
}

}  // namespace

std::size_t LateralShape::profile_at(double s_m) const {
  const auto after = std::upper_bound(profiles_.begin(), profiles_.end(), s_m,
                                      [](double s, const Profile& p) { return s < p.s_m; });
  return after == profiles_.begin() ? 0 : static_cast<std::size_t>(after - profiles_.begin()) - 1;
}

double LateralShape::height_m(double s_m, double t_m) const {
  if (profiles_.empty()) return 0.0;
  const std::size_t i = profile_at(s_m);
  const double here_m = profiles_[i].over_t.at(t_m).value;
  if (i + 1 == profiles_.size() || s_m <= profiles_[i].s_m) return here_m;
  const double fraction = (s_m - profiles_[i].s_m) / (profiles_[i + 1].s_m - profiles_[i].s_m);
  return (1.0 - fraction) * here_m + fraction * profiles_[i + 1].over_t.at(t_m).value;
}

LateralShape::Bounds LateralShape::bounds(double from_s_m, double to_s_m, double t_m,
                                          const geometry::CubicValue& t_bounds) const {
  if (profiles_.empty()) return {};
  const double reach_m = 0.5 * (to_s_m - from_s_m) * t_bounds.d1;
  const double middle_s_m = 0.5 * (from_s_m + to_s_m);
  const std::size_t i = profile_at(middle_s_m);
  const bool between = i + 1 < profiles_.size() && middle_s_m > profiles_[i].s_m;
  const RangeBounds a = range_bounds(profiles_[i].over_t, t_m - reach_m, t_m + reach_m);
  if (!between) {
    return {{a.value.value, a.value.d1 * t_bounds.d1,
             a.value.d2 * t_bounds.d1 * t_bounds.d1 + a.value.d1 * t_bounds.d2},
            a.kinks * t_bounds.d1};
  }
  // h = (1 − λ) A(t) + λ B(t) with λ linear in s.
  const RangeBounds b = range_bounds(profiles_[i + 1].over_t, t_m - reach_m, t_m + reach_m);
  const double rate = 1.0 / (profiles_[i + 1].s_m - profiles_[i].s_m);
  const double slope = std::max(a.value.d1, b.value.d1);
  const double bend = std::max(a.value.d2, b.value.d2);
  const double change = a.value.value + b.value.value, turn = a.value.d1 + b.value.d1;
  return {
      {std::max(a.value.value, b.value.value), slope * t_bounds.d1 + rate * change,
       bend * t_bounds.d1 * t_bounds.d1 + slope * t_bounds.d2 + 2.0 * rate * turn * t_bounds.d1},
      (a.kinks + b.kinks) * t_bounds.d1};
}

}  // namespace roadbed::map::opendrive
