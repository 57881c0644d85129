#include "roadbed/geometry/curves/piecewise_cubic.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace roadbed::geometry::inline curves {

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

const CubicRecord* PiecewiseCubic::record_at(double s_m) const {
  if (records_.empty()) return nullptr;
  const auto after =
      std::upper_bound(records_.begin(), records_.end(), s_m,
                       [](double s, const CubicRecord& record) { return s < record.s_m; });
  return after == records_.begin() ? &records_.front() : &*(after - 1);
}

CubicValue PiecewiseCubic::at(double s_m, double record_s_m) const {
  const CubicRecord* record = record_at(record_s_m);
  return record == nullptr ? CubicValue{} : cubic_at(*record, s_m);
}

CubicValue PiecewiseCubic::bounds(double from_s_m, double to_s_m) const {
  const CubicRecord* record = record_at(0.5 * (from_s_m + to_s_m));
  return record == nullptr ? CubicValue{} : cubic_bounds(*record, from_s_m, to_s_m);
}

}  // namespace roadbed::geometry::curves
