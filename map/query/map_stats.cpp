#include "roadbed/map/query/map_stats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "roadbed/map/query/lane_strips.h"

namespace roadbed::map::inline query {
namespace {

constexpr std::array<double, 14> kWidths_m = {0.0, 0.5,  1.0, 1.5,  2.0, 2.5, 2.75,
                                              3.0, 3.25, 3.5, 3.75, 4.0, 5.0, 6.0};
constexpr std::array<double, 7> kSlopes_percent = {0.0, 1.0, 2.0, 4.0, 6.0, 8.0, 12.0};
constexpr std::array<double, 8> kCurvatures_per_m = {0.0,  0.001, 0.002, 0.005,
                                                     0.01, 0.02,  0.05,  0.1};

void add(StatsRow& row, const LaneStrip& strip, double part = 1.0) {
  row.length_m += part * strip.length_m();
  row.area_m2 += part * strip.area_m2;
}

/// A table with a row for each class of a number.
class Classes {
 public:
  Classes(std::string_view by, std::string_view unit, std::span<const double> limits)
      : table_{by, unit, true, {}}, limits_(limits), last_lane_(limits.size()) {
    for (std::size_t i = 0; i < limits.size(); ++i) {
      StatsRow row;
      row.from = limits[i];
      if (i + 1 < limits.size()) row.to = limits[i + 1];
      table_.rows.push_back(row);
    }
  }

  void add_strip(const Lane& lane, const LaneStrip& strip, double value) {
    const auto above = std::upper_bound(limits_.begin() + 1, limits_.end(), value);
    const auto i = static_cast<std::size_t>(above - limits_.begin()) - 1;
    add(table_.rows[i], strip);
    if (last_lane_[i] == lane.id) return;
    last_lane_[i] = lane.id;
    ++table_.rows[i].lanes;
  }

  StatsTable table() && {
    std::erase_if(table_.rows, [](const StatsRow& row) { return row.lanes == 0; });
    return std::move(table_);
  }

 private:
  StatsTable table_;
  std::span<const double> limits_;
  std::vector<std::optional<LaneId>> last_lane_;
};

/// A table with a row for each value; in order of the keys.
template <typename Key>
class Values {
 public:
  StatsRow& row(const Key& key, const std::string& value) {
    StatsRow& row = rows_[key];
    row.value = value;
    return row;
  }

  StatsTable table(std::string_view by, std::string_view unit) && {
    StatsTable table{by, unit, false, {}};
    for (auto& [key, row] : rows_) table.rows.push_back(std::move(row));
    return table;
  }

 private:
  std::map<Key, StatsRow> rows_;
};

constexpr double kUnknown = std::numeric_limits<double>::infinity();
constexpr double kNoLimit = std::numeric_limits<double>::max();

double kmh_of(std::optional<double> limit_mps) {
  if (!limit_mps) return kUnknown;
  return std::isfinite(*limit_mps) ? std::round(36.0 * *limit_mps) / 10.0 : kNoLimit;
}

/// Speed limits hold from a station on, within strips too.
class Speeds {
 public:
  void add_lane(const Lane& lane, const std::vector<LaneStrip>& strips) {
    const std::vector<SpeedLimit>& limits = lane.speed_limits;
    std::set<double> seen;
    std::size_t next = 0;
    std::optional<double> limit_mps;
    for (const LaneStrip& strip : strips) {
      for (double from_s_m = strip.from_s_m; from_s_m < strip.to_s_m;) {
        while (next < limits.size() && limits[next].from_s_m <= from_s_m) {
          limit_mps = limits[next++].limit_mps;
        }
        const double to_s_m =
            next < limits.size() ? std::min(limits[next].from_s_m, strip.to_s_m) : strip.to_s_m;
        const double kmh = kmh_of(limit_mps);
        StatsRow& row = values_.row(kmh, kmh == kUnknown   ? "unknown"
                                         : kmh == kNoLimit ? "no limit"
                                                           : fmt::format("{}", kmh));
        add(row, strip, (to_s_m - from_s_m) / strip.length_m());
        row.lanes += seen.insert(kmh).second ? 1 : 0;
        from_s_m = to_s_m;
      }
    }
  }

  StatsTable table() && { return std::move(values_).table("speed", "km/h"); }

 private:
  Values<double> values_;
};

}  // namespace

MapStats map_stats(const RoadMap& road_map, std::span<const LaneId> lanes) {
  Values<LaneType> types;
  Speeds speeds;
  Classes widths("width", "m", kWidths_m), slopes("slope", "%", kSlopes_percent),
      curvatures("curvature", "1/m", kCurvatures_per_m);
  MapStats stats;
  for (const LaneId id : lanes) {
    const Lane& lane = road_map.lane(id);
    const std::vector<LaneStrip> strips = lane_strips(lane);
    StatsRow& of_type = types.row(lane.type, std::string(to_string(lane.type)));
    ++of_type.lanes;
    ++stats.all.lanes;
    for (const LaneStrip& strip : strips) {
      add(stats.all, strip);
      add(of_type, strip);
      widths.add_strip(lane, strip, strip.width_m);
      slopes.add_strip(lane, strip, 100.0 * std::abs(strip.slope));
      curvatures.add_strip(lane, strip, std::abs(strip.curvature_per_m));
    }
    speeds.add_lane(lane, strips);
  }
  stats.tables = {std::move(types).table("type", ""), std::move(speeds).table(),
                  std::move(widths).table(), std::move(slopes).table(),
                  std::move(curvatures).table()};
  return stats;
}

}  // namespace roadbed::map::query
