#include "roadbed/map/opendrive/write/road_heights.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadbed/map/opendrive/write/beside_line.h"
#include "roadbed/map/opendrive/write/fit_cubics.h"

namespace roadbed::map::opendrive {
namespace {

constexpr double kHeightTolerance_m = 0.005;
constexpr double kStep_m = 1e-6;       // along the road, of a border that goes straight up
constexpr double kLeastStep_m = 0.01;  // between points that say how a border goes on

constexpr double kFlat_m = 0.004;  // what leans less lies flat

/// The lowest and highest of some values.
struct Span {
  double low = 1e300, high = -1e300;

  Span with(double value) const { return {std::min(low, value), std::max(high, value)}; }
  double size() const { return high - low; }
  double middle() const { return 0.5 * (low + high); }
};

/// Few records, each as long as the values of its stations differ by no more than `most_m`.
std::vector<LaneHeight> fit_steps(const std::vector<Sample>& inner,
                                  const std::vector<Sample>& outer, double from_m, double most_m) {
  std::vector<double> stations_m{from_m};
  for (const auto* samples : {&inner, &outer}) {
    for (const Sample& sample : *samples) stations_m.push_back(sample.s_m);
  }
  std::ranges::sort(stations_m);
  std::vector<LaneHeight> records;
  Span inside, outside;
  std::size_t at_inner = 0, at_outer = 0;
  for (const double s_m : stations_m) {
    const double inner_m = value_at(inner, s_m, at_inner), outer_m = value_at(outer, s_m, at_outer);
    const Span more_inside = inside.with(inner_m), more_outside = outside.with(outer_m);
    const bool goes_on = std::max(more_inside.size(), more_outside.size()) <= most_m;
    inside = goes_on ? more_inside : Span{inner_m, inner_m};
    outside = goes_on ? more_outside : Span{outer_m, outer_m};
    if (!goes_on || records.empty()) records.push_back({s_m});
    records.back().inner_m = inside.middle();
    records.back().outer_m = outside.middle();
  }
  return records;
}

class HeightFitter {
 public:
  HeightFitter(const RoadMap& road_map, const PlannedRoad& road, const PlacedRoad& placed,
               const ReferenceTable& reference)
      : road_map_(road_map), road_(road), placed_(placed), reference_(reference) {}

  RoadHeights fit() {
    for (const PlannedSection& section : road_.sections) {
      made_.lanes.emplace_back(section.lanes.size());
    }
    if (is_flat()) return std::move(made_);
    std::vector<std::vector<LaneLines>> lines;
    for (std::size_t i = 0; i < road_.sections.size(); ++i) lines.push_back(lines_of(i));
    fit_plane(lines);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      for (std::size_t lane = 0; lane < lines[i].size(); ++lane) {
        made_.lanes[i][lane] = fit_lane_heights(i, lane, lines[i][lane]);
      }
    }
    return std::move(made_);
  }

 private:
  /// Borders of a lane of the map beside the road, with its own heights.
  struct LaneLines {
    BesideLine left, right;
  };

  bool is_flat() const {
    const auto is_zero = [](const LaneLine& line) {
      return std::ranges::all_of(line.z_m, [](double z_m) { return z_m == 0.0; });
    };
    return std::ranges::all_of(road_.sections, [&](const PlannedSection& section) {
      return std::ranges::all_of(section.lanes, [&](const PlannedLane& planned) {
        const Lane& lane = road_map_.lane(planned.lane);
        return is_zero(lane.left) && is_zero(lane.right);
      });
    });
  }

  std::vector<LaneLines> lines_of(std::size_t section) const {
    std::vector<LaneLines> lines;
    for (const PlannedLane& planned : road_.sections[section].lanes) {
      const Lane& lane = road_map_.lane(planned.lane);
      LaneLines& made = lines.emplace_back();
      made.left = beside(planned.forward ? lane.left : lane.right, planned.forward, section);
      made.right = beside(planned.forward ? lane.right : lane.left, planned.forward, section);
    }
    return lines;
  }

  BesideLine beside(const LaneLine& line, bool forward, std::size_t section) const {
    const auto& points = line.in_map.points();
    BesideLine made;
    double hint_m = placed_.section_from_m[section];
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::size_t place = forward ? i : points.size() - 1 - i;
      const RoadPosition at = position_beside(reference_, points[place], hint_m);
      hint_m = at.s_m;
      const bool is_step = i > 0 && points[place] == points[forward ? place - 1 : place + 1];
      if (is_step) hint_m = std::max(hint_m, made.back().s_m + kStep_m);
      if (made.empty() || hint_m > made.back().s_m) {
        made.push_back({hint_m, at.t_m, line.z_m[place]});
      }
    }
    return spanned(std::move(made), placed_.section_from_m[section],
                   placed_.section_from_m[section + 1]);
  }

  // Over all of [from, to], straight on beyond its ends.
  static BesideLine spanned(BesideLine line, double from_m, double to_m) {
    const auto on = [](const BesidePoint& before, const BesidePoint& end, double s_m) {
      const double step_m = end.s_m - before.s_m;
      const double share = std::abs(step_m) < kLeastStep_m ? 0.0 : (s_m - end.s_m) / step_m;
      return BesidePoint{s_m, end.t_m + share * (end.t_m - before.t_m),
                         end.z_m + share * (end.z_m - before.z_m)};
    };
    if (line.size() > 1 && line.front().s_m > from_m) {
      line.insert(line.begin(), on(line[1], line[0], from_m));
    }
    if (line.size() > 1 && line.back().s_m < to_m) {
      line.push_back(on(line[line.size() - 2], line.back(), to_m));
    }
    return clipped(line, from_m, to_m);
  }

  void fit_plane(const std::vector<std::vector<LaneLines>>& lines) {
    std::vector<Sample> heights, slopes;
    double steepest = 0.0, farthest_m = 0.1;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      add_heights(decks(i, lines[i]), heights, slopes, steepest, farthest_m);
    }
    if (std::ranges::any_of(heights, [](const Sample& h) { return std::abs(h.value) > 1e-9; })) {
      made_.elevation = geometry::PiecewiseCubic(fit_cubics(heights, kHeightTolerance_m, -1e300));
    }
    if (steepest * farthest_m > kFlat_m) {
      made_.superelevation =
          geometry::PiecewiseCubic(fit_cubics(slopes, kHeightTolerance_m / farthest_m, -1e300));
    }
  }

  // The borders of lanes that one drives on, of all lanes where there is none.
  std::vector<BesideLine> decks(std::size_t section, const std::vector<LaneLines>& lines) const {
    const auto is_deck = [&](const PlannedLane& lane) {
      return is_drivable(road_map_.lane(lane.lane).type);
    };
    const auto& lanes = road_.sections[section].lanes;
    const bool all = std::ranges::none_of(lanes, is_deck);
    std::vector<BesideLine> found;
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      if (all || is_deck(lanes[i])) found.insert(found.end(), {lines[i].left, lines[i].right});
    }
    return found;
  }

  // Records hold until the next one. Lanes that one drives on have one record or none: else the
  // way over them would go by steps.
  std::vector<LaneHeight> fit_lane_heights(std::size_t section, std::size_t index,
                                           const LaneLines& lines) {
    const PlannedSection& planned = road_.sections[section];
    const bool is_left = index < planned.left_lanes;
    const std::vector<Sample> inner = above_plane(is_left ? lines.right : lines.left),
                              outer = above_plane(is_left ? lines.left : lines.right);
    std::vector<LaneHeight> records =
        fit_steps(inner, outer, placed_.section_from_m[section], 2.0 * kHeightTolerance_m);
    const bool is_driven = is_drivable(road_map_.lane(planned.lanes[index].lane).type);
    const bool is_low = std::ranges::all_of(records, [](const LaneHeight& record) {
      return std::max(std::abs(record.inner_m), std::abs(record.outer_m)) < kHeightTolerance_m;
    });
    if (is_low || (is_driven && records.size() > 1)) records.clear();
    note_errors(inner, records, &LaneHeight::inner_m);
    note_errors(outer, records, &LaneHeight::outer_m);
    return records;
  }

  std::vector<Sample> above_plane(const BesideLine& line) const {
    std::vector<Sample> samples;
    for (const BesidePoint& point : line) {
      const double plane_m = made_.elevation.at(point.s_m).value +
                             point.t_m * std::tan(made_.superelevation.at(point.s_m).value);
      samples.push_back({point.s_m, point.z_m - plane_m});
    }
    return samples;
  }

  void note_errors(const std::vector<Sample>& samples, const std::vector<LaneHeight>& records,
                   double LaneHeight::*height_m) {
    std::size_t record = 0;
    for (const Sample& sample : samples) {
      while (record + 1 < records.size() && records[record + 1].s_m <= sample.s_m) ++record;
      const double written_m = records.empty() ? 0.0 : records[record].*height_m;
      made_.error_m = std::max(made_.error_m, std::abs(sample.value - written_m));
    }
  }

  static void add_heights(const std::vector<BesideLine>& lines, std::vector<Sample>& heights,
                          std::vector<Sample>& slopes, double& steepest, double& farthest_m) {
    const auto longest = std::max_element(
        lines.begin(), lines.end(),
        [](const BesideLine& a, const BesideLine& b) { return a.size() < b.size(); });
    std::vector<std::size_t> hints(lines.size(), 0);
    for (const BesidePoint& at : *longest) {
      constexpr double least_m = 0.1;  // lanes begin and end at a section's, not heights
      if (!heights.empty() && at.s_m < heights.back().s_m + least_m) continue;
      double n = 0, t = 0, z = 0, tt = 0, tz = 0;
      for (std::size_t i = 0; i < lines.size(); ++i) {
        const auto [si, ti, zi] = point_at(lines[i], at.s_m, hints[i]);
        n += 1.0;
        t += ti;
        z += zi;
        tt += ti * ti;
        tz += ti * zi;
        farthest_m = std::max(farthest_m, std::abs(ti));
      }
      const double spread = tt - t * t / n;
      const double slope = spread > 0.25 ? (tz - t * z / n) / spread : 0.0;
      heights.push_back({at.s_m, (z - slope * t) / n});
      slopes.push_back({at.s_m, std::atan(slope)});
      steepest = std::max(steepest, std::abs(slope));
    }
  }

  const RoadMap& road_map_;
  const PlannedRoad& road_;
  const PlacedRoad& placed_;
  const ReferenceTable& reference_;
  RoadHeights made_;
};

}  // namespace

RoadHeights fit_heights(const RoadMap& road_map, const PlannedRoad& road, const PlacedRoad& placed,
                        const ReferenceTable& reference) {
  return HeightFitter(road_map, road, placed, reference).fit();
}

}  // namespace roadbed::map::opendrive
