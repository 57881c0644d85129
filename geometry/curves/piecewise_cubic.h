#pragma once

#include <cmath>
#include <vector>

namespace roadbed::geometry::inline curves {

/// a + b·ds + c·ds² + d·ds³ from `s_m` on, ds counted from there.
struct CubicRecord {
  double s_m = 0.0;
  double a = 0.0, b = 0.0, c = 0.0, d = 0.0;
};

/// A value with its first two derivatives.
struct CubicValue {
  double value = 0.0, d1 = 0.0, d2 = 0.0;
};

/// The cubic of one record at a station.
inline CubicValue cubic_at(const CubicRecord& r, double s_m) {
  const double ds = s_m - r.s_m;
  return {r.a + ds * (r.b + ds * (r.c + ds * r.d)), r.b + ds * (2.0 * r.c + ds * 3.0 * r.d),
          2.0 * r.c + 6.0 * r.d * ds};
}

/// Upper bounds of |value|, |first| and |second derivative| of one record's cubic over [from, to].
inline CubicValue cubic_bounds(const CubicRecord& r, double from_s_m, double to_s_m) {
  const double middle_s_m = 0.5 * (from_s_m + to_s_m), half_m = 0.5 * (to_s_m - from_s_m);
  // Taylor about the middle: every power of the distance is at most that of half the stretch.
  const CubicValue middle = cubic_at(r, middle_s_m);
  const double d1 = std::abs(middle.d1), d2 = std::abs(middle.d2), d3 = std::abs(6.0 * r.d);
  return {std::abs(middle.value) + half_m * (d1 + half_m * (d2 / 2.0 + half_m * d3 / 6.0)),
          d1 + half_m * (d2 + half_m * d3 / 2.0), d2 + half_m * d3};
}

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

  /// The record that holds at a station; none where there are no records. O(log N).
  const CubicRecord* record_at(double s_m) const;

 private:
  std::vector<CubicRecord> records_;
};

}  // namespace roadbed::geometry::curves
