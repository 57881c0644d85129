#include "roadbed/geometry/piecewise_cubic.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace roadbed::geometry {

PiecewiseCubic::PiecewiseCubic(std::vector<CubicRecord> records) : records_(std::move(records)) {
  for (std::size_t i = 0; i < records_.size(); ++i) {
    const CubicRecord& r = records_[i];
    if (!std::isfinite(r.s_m + r.a + r.b + r.c + r.d)) {
      throw std::invalid_argument(fmt::format("PiecewiseCubic: record {} is not finite", i));
    }
    if (i > 0 && r.s_m < records_[i - 1].s_m) {
      throw std::invalid_argument(fmt::format(
          "PiecewiseCubic: record {} starts at {} m, before its predecessor", i, r.s_m));
    }
  }
}

const CubicRecord& PiecewiseCubic::record_at(double s_m) const {
  const auto after =
      std::upper_bound(records_.begin(), records_.end(), s_m,
                       [](double s, const CubicRecord& record) { return s < record.s_m; });
  return after == records_.begin() ? records_.front() : *(after - 1);
}

CubicValue PiecewiseCubic::at(double s_m, double record_s_m) const {
  if (records_.empty()) return {};
  const CubicRecord& r = record_at(record_s_m);
  const double ds = s_m - r.s_m;
  return {r.a + ds * (r.b + ds * (r.c + ds * r.d)), r.b + ds * (2.0 * r.c + ds * 3.0 * r.d),
          2.0 * r.c + 6.0 * r.d * ds};
}

CubicValue PiecewiseCubic::bounds(double from_s_m, double to_s_m) const {
  if (records_.empty()) return {};
  const double middle_s_m = 0.5 * (from_s_m + to_s_m), half_m = 0.5 * (to_s_m - from_s_m);
  const CubicRecord& r = record_at(middle_s_m);
  // Taylor about the middle: every power of the distance is at most that of half the stretch.
  const double ds = middle_s_m - r.s_m;
  const double value = std::abs(r.a + ds * (r.b + ds * (r.c + ds * r.d)));
  const double d1 = std::abs(r.b + ds * (2.0 * r.c + ds * 3.0 * r.d));
  const double d2 = std::abs(2.0 * r.c + 6.0 * r.d * ds);
  const double d3 = std::abs(6.0 * r.d);
  return {value + half_m * (d1 + half_m * (d2 / 2.0 + half_m * d3 / 6.0)),
          d1 + half_m * (d2 + half_m * d3 / 2.0), d2 + half_m * d3};
}

}  // namespace roadbed::geometry
