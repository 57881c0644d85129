#include "roadbed/map/opendrive/write/fit_cubics.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace roadbed::map::opendrive {
namespace {

// The cubic over [0, length] with both end values given and the slopes of least squares.
geometry::CubicRecord least_squares(std::span<const Sample> samples) {
  const Sample &first = samples.front(), &last = samples.back();
  const double length_m = last.s_m - first.s_m, rise = last.value - first.value;
  // p(u) = first + rise (3u² − 2u³) + m₀ h₀(u) + m₁ h₁(u), the m's slopes times length.
  double a00 = 1e-9, a01 = 0.0, a11 = 1e-9, b0 = 1e-9 * rise, b1 = 1e-9 * rise;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double step_m = samples[i].s_m - samples[i - 1].s_m;
    for (const double share : {0.5, 1.0}) {
      const double u = (samples[i - 1].s_m + share * step_m - first.s_m) / length_m;
      const double value = samples[i - 1].value + share * (samples[i].value - samples[i - 1].value);
      const double h0 = u * (1.0 - u) * (1.0 - u), h1 = -u * u * (1.0 - u);
      const double rest = value - first.value - rise * u * u * (3.0 - 2.0 * u);
      a00 += step_m * h0 * h0;
      a01 += step_m * h0 * h1;
      a11 += step_m * h1 * h1;
      b0 += step_m * h0 * rest;
      b1 += step_m * h1 * rest;
    }
  }
  const double determinant = a00 * a11 - a01 * a01;
  double m0 = rise, m1 = rise;
  if (determinant > 1e-12 * a00 * a11) {
    m0 = (b0 * a11 - b1 * a01) / determinant;
    m1 = (b1 * a00 - b0 * a01) / determinant;
  }
  const double per_m = 1.0 / length_m;
  return {first.s_m, first.value, m0 * per_m, (3.0 * rise - 2.0 * m0 - m1) * per_m * per_m,
          (m0 + m1 - 2.0 * rise) * per_m * per_m * per_m};
}

bool keeps(const geometry::CubicRecord& record, std::span<const Sample> samples, double tolerance,
           double at_least) {
  const auto fine = [&](double s_m, double value) {
    const double fitted = geometry::cubic_at(record, s_m).value;
    return std::abs(fitted - value) <= tolerance && fitted >= at_least;
  };
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const Sample &a = samples[i - 1], &b = samples[i];
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
      if (i + 1 == samples.size() && share == 1.0) break;  // the end is met
      if (!fine(a.s_m + share * (b.s_m - a.s_m), a.value + share * (b.value - a.value)))
        return false;
    }
  }
  return true;
}

geometry::CubicRecord straight(const Sample& a, const Sample& b) {
  return {a.s_m, a.value, (b.value - a.value) / (b.s_m - a.s_m), 0.0, 0.0};
}

std::optional<geometry::CubicRecord> record_over(std::span<const Sample> samples, double tolerance,
                                                 double at_least) {
  const geometry::CubicRecord line = straight(samples.front(), samples.back());
  if (keeps(line, samples, 0.5 * tolerance, at_least)) return line;
  if (samples.size() < 3) return line;
  const geometry::CubicRecord cubic = least_squares(samples);
  if (keeps(cubic, samples, tolerance, at_least)) return cubic;
  return {};
}

}  // namespace

double value_at(std::span<const Sample> samples, double s_m, std::size_t& hint) {
  hint = std::min(hint, samples.size() - 1);
  while (hint > 0 && samples[hint].s_m > s_m) --hint;
  while (hint + 1 < samples.size() && samples[hint + 1].s_m <= s_m) ++hint;
  const Sample& a = samples[hint];
  if (hint + 1 == samples.size() || s_m <= a.s_m) return a.value;
  const Sample& b = samples[hint + 1];
  return a.value + (s_m - a.s_m) / (b.s_m - a.s_m) * (b.value - a.value);
}

std::vector<geometry::CubicRecord> fit_cubics(std::span<const Sample> samples, double tolerance,
                                              double at_least) {
  std::vector<geometry::CubicRecord> records;
  if (samples.size() == 1) return {{samples[0].s_m, samples[0].value, 0.0, 0.0, 0.0}};
  std::size_t from = 0;
  while (from + 1 < samples.size()) {
    const auto over = [&](std::size_t to) {
      return record_over(samples.subspan(from, to - from + 1), tolerance, at_least);
    };
    std::size_t good = from + 1, bad = samples.size();
    std::optional<geometry::CubicRecord> best = over(good);
    for (std::size_t reach = 2; good < samples.size() - 1; reach *= 2) {
      const std::size_t to = std::min(from + reach, samples.size() - 1);
      auto record = over(to);
      if (!record) {
        bad = to;
        break;
      }
      good = to;
      best = record;
    }
    while (good + 1 < bad) {
      const std::size_t middle = good + (bad - good) / 2;
      if (auto record = over(middle)) {
        good = middle;
        best = record;
      } else {
        bad = middle;
      }
    }
    records.push_back(*best);
    from = good;
  }
  return records;
}

}  // namespace roadbed::map::opendrive
