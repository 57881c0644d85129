#include "roadbed/map/opendrive/write/number_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace roadbed::map::opendrive {
namespace {

constexpr double kLength_m = 5e-7;

}  // namespace

void add_records(const geometry::PiecewiseCubic& cubic, double from_m, double to_m, double zero_m,
                 const char* name, const char* station, std::string& text) {
  constexpr double least_m = 1e-6;
  const auto& records = cubic.records();
  for (std::size_t i = 0; i < records.size(); ++i) {
    const double next_m = i + 1 < records.size() ? records[i + 1].s_m : 1e300;
    if (next_m <= from_m + least_m || records[i].s_m >= to_m - least_m) continue;
    const double s_m = std::max(from_m, records[i].s_m);
    const geometry::CubicValue at = geometry::cubic_at(records[i], s_m);
    // Each digit that changes nothing by more than a micrometre over the record's length is left
    // out.
    const double length_m = std::max(0.1, std::min(next_m, to_m) - s_m);
    const auto coefficient = [&](double value, int power) {
      return number_within(value, kLength_m / std::pow(length_m, power));
    };
    fmt::format_to(std::back_inserter(text),
                   "<{} {}=\"{}\" a=\"{}\" b=\"{}\" c=\"{}\" d=\"{}\"/>\n", name, station,
                   short_number(s_m - zero_m), short_number(at.value), coefficient(at.d1, 1),
                   coefficient(0.5 * at.d2, 2), coefficient(records[i].d, 3));
  }
}

}  // namespace roadbed::map::opendrive
