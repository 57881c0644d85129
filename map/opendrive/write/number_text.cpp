#include "roadbed/map/opendrive/write/number_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace roadbed::map::opendrive {

std::string short_number(double value) {
  const double rounded = std::round(value * 1e9) / 1e9;
  return fmt::format("{}", rounded == 0.0 ? 0.0 : rounded);
}

void add_records(const geometry::PiecewiseCubic& cubic, double from_m, double to_m, double zero_m,
                 const char* name, const char* station, std::string& text) {
  constexpr double least_m = 1e-6;
  const auto& records = cubic.records();
  for (std::size_t i = 0; i < records.size(); ++i) {
    const double next_m = i + 1 < records.size() ? records[i + 1].s_m : 1e300;
    if (next_m <= from_m + least_m || records[i].s_m >= to_m - least_m) continue;
    const double s_m = std::max(from_m, records[i].s_m);
    const geometry::CubicValue at = geometry::cubic_at(records[i], s_m);
    fmt::format_to(std::back_inserter(text),
                   "<{} {}=\"{}\" a=\"{}\" b=\"{:.9g}\" c=\"{:.9g}\" d=\"{:.9g}\"/>\n", name,
                   station, short_number(s_m - zero_m), short_number(at.value), at.d1, 0.5 * at.d2,
                   records[i].d);
  }
}

}  // namespace roadbed::map::opendrive
