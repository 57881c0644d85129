#pragma once

#include <vector>

namespace roadbed::geometry {

/// a + b·ds + c·ds² + d·ds³ from `s_m` on, ds counted from there.
struct CubicRecord {
  double s_m = 0.0;
  double a = 0.0, b = 0.0, c = 0.0, d = 0.0;
};

/// A value with its first two derivatives.
struct CubicValue {
  double value = 0.0, d1 = 0.0, d2 = 0.0;
};

/// OpenDRIVE's records of widths, offsets, elevations …: the last one that starts at or before s
/// holds. Before the first record that one holds; without records the value is 0.
class PiecewiseCubic {
 public:
  PiecewiseCubic() = default;

  /// @throws std::invalid_argument if the records are not in order of s or not finite.
  explicit PiecewiseCubic(std::vector<CubicRecord> records);

  bool empty() const { return records_.empty(); }
  const std::vector<CubicRecord>& records() const { return records_; }

  /// O(log N).
  CubicValue at(double s_m) const { return at(s_m, s_m); }

  /// The record that holds at `record_s_m`, evaluated at s: the limit from one side where two meet.
  CubicValue at(double s_m, double record_s_m) const;

  /// Upper bounds of |value|, |first| and |second derivative| over [from, to], proven; the record
  /// that holds in the middle is taken for the whole stretch.
  CubicValue bounds(double from_s_m, double to_s_m) const;

 private:
  const CubicRecord& record_at(double s_m) const;
  std::vector<CubicRecord> records_;
};

}  // namespace roadbed::geometry
