#include "roadbed/map/edit/elevation/profile_cubics.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roadbed::map::inline edit::inline elevation {
namespace {

using geometry::CubicRecord;

class Fit {
 public:
  Fit(std::span<const double> s_m, std::span<const double> values, double within)
      : s_m_(s_m), values_(values), within_(within) {}

  std::vector<CubicRecord> run() {
    if (s_m_.size() < 2) return {{s_m_[0], values_[0], 0.0, 0.0, 0.0}};
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, s_m_.size() - 1}};
    std::vector<CubicRecord> records;
    while (!open.empty()) {
      const auto [from, to] = open.back();
      open.pop_back();
      const CubicRecord record = between(from, to);
      if (to - from == 1 || fits(record, from, to)) {
        records.push_back(record);
        continue;
      }
      const std::size_t middle = (from + to) / 2;
      open.emplace_back(middle, to);
      open.emplace_back(from, middle);
    }
    return records;
  }

 private:
  double chord_slope(std::size_t i) const {
    return (values_[i + 1] - values_[i]) / (s_m_[i + 1] - s_m_[i]);
  }

  double slope(std::size_t i) const {
    const std::size_t last = s_m_.size() - 1;
    if (last == 1) return chord_slope(0);
    const std::size_t middle = std::clamp<std::size_t>(i, 1, last - 1);
    const double before = chord_slope(middle - 1), after = chord_slope(middle);
    const double bend = (after - before) / (s_m_[middle + 1] - s_m_[middle - 1]);
    return before + bend * (2.0 * s_m_[i] - s_m_[middle - 1] - s_m_[middle]);
  }

  CubicRecord between(std::size_t from, std::size_t to) const {
    const double length_m = s_m_[to] - s_m_[from], rise = values_[to] - values_[from];
    const double first = slope(from), second = slope(to);
    return {s_m_[from], values_[from], first,
            (3.0 * rise / length_m - 2.0 * first - second) / length_m,
            (first + second - 2.0 * rise / length_m) / (length_m * length_m)};
  }

  bool fits(const CubicRecord& record, std::size_t from, std::size_t to) const {
    for (std::size_t i = from + 1; i < to; ++i) {
      if (std::abs(geometry::cubic_at(record, s_m_[i]).value - values_[i]) > within_) return false;
    }
    return true;
  }

  std::span<const double> s_m_, values_;
  double within_;
};

}  // namespace

std::vector<CubicRecord> cubics_through(std::span<const double> s_m, std::span<const double> values,
                                        double within) {
  return Fit(s_m, values, within).run();
}

}  // namespace roadbed::map::edit::elevation
