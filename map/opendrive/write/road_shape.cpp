#include "roadbed/map/opendrive/write/road_shape.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace roadbed::map::opendrive {
namespace {

constexpr double kHeightTolerance_m = 0.005;
constexpr double kStep_m = 1e-6;       // along the road, of a border that goes straight up
constexpr double kLeastStep_m = 0.01;  // between points that say how a border goes on

constexpr double kFlat_m = 0.004;  // what leans less lies flat

constexpr double kSameRim_m = 0.005;         // ends of borders that are nearer are one
constexpr double kLeastBetweenRims_m = 0.1;  // rims at both ends of a road

/// A part of a section through which the same borders go.
struct Strip {
  std::size_t section = 0;
  double from_m = 0.0, to_m = 0.0;
  std::vector<bool> has_border{};  ///< empty: all

  bool has(std::size_t border) const { return has_border.empty() || has_border[border]; }

  /// The border itself, or the next one that is there, towards the middle first.
  std::size_t standing(std::size_t border, std::size_t middle) const {
    if (has(border)) return border;
    const std::size_t count = has_border.size();
    for (std::size_t off = 1; off < count; ++off) {
      const std::size_t before = border >= off ? border - off : count, behind = border + off;
      const bool look_ahead = border < middle;
      for (const std::size_t one : {look_ahead ? behind : before, look_ahead ? before : behind}) {
        if (one < count && has(one)) return one;
      }
    }
    return border;
  }
};

BesideLine clipped(const BesideLine& line, double from_m, double to_m) {
  std::size_t hint = 0;
  BesideLine kept{point_at(line, from_m, hint)};
  for (const BesidePoint& point : line) {
    if (point.s_m > from_m + 1e-6 && point.s_m < to_m - 1e-6) kept.push_back(point);
  }
  kept.push_back(point_at(line, to_m, hint));
  return kept;
}

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

/// The stretches of a road, by s, at whose ends borders end.
class StripFinder {
 public:
  explicit StripFinder(const PlacedRoad& placed) : placed_(placed) {}

  /// Rims before the first section, the sections, rims behind the last one.
  std::array<std::vector<Strip>, 3> find() const {
    std::array<std::vector<double>, 2> ends_m{ends(0), ends(1)};
    const double begin_m = placed_.section_from_m.front(), end_m = placed_.section_from_m.back();
    const auto first_m = [&] { return ends_m[0].empty() ? begin_m : ends_m[0].back(); };
    const auto last_m = [&] { return ends_m[1].empty() ? end_m : ends_m[1].front(); };
    const double low_m = placed_.section_from_m[1], high_m = *(placed_.section_from_m.end() - 2);
    if (last_m() - std::max(high_m, first_m()) < kLeastBetweenRims_m) ends_m[1].clear();
    if (std::min(low_m, last_m()) - first_m() < kLeastBetweenRims_m) ends_m[0].clear();
    std::array<std::vector<Strip>, 3> strips;
    const std::size_t sections = placed_.borders.size();
    double from_m = begin_m;
    for (const double to_m : ends_m[0]) {
      strips[0].push_back(rim(0, from_m, to_m));
      from_m = to_m;
    }
    for (std::size_t i = 0; i < sections; ++i) {
      const double to_m = i + 1 < sections ? placed_.section_from_m[i + 1] : last_m();
      strips[1].push_back({i, i == 0 ? first_m() : placed_.section_from_m[i], to_m});
    }
    for (std::size_t i = 0; i < ends_m[1].size(); ++i) {
      const double to_m = i + 1 < ends_m[1].size() ? ends_m[1][i + 1] : end_m;
      strips[2].push_back(rim(sections - 1, ends_m[1][i], to_m));
    }
    return strips;
  }

 private:
  // Where borders end inside the road, by s.
  std::vector<double> ends(std::size_t at) const {
    std::vector<double> ends_m;
    if (!placed_.is_rim[at]) return ends_m;
    const auto& reach = at == 0 ? placed_.reach.front() : placed_.reach.back();
    for (const StationRange& range : reach)
      ends_m.push_back(at == 0 ? range.from_s_m : range.to_s_m);
    std::sort(ends_m.begin(), ends_m.end());
    // The last one is the road's.
    ends_m.erase(at == 0 ? ends_m.begin() : ends_m.end() - 1);
    const double rim_m = at == 0 ? placed_.section_from_m.front() : placed_.section_from_m.back();
    const double same_m = kSameRim_m / widest_bend(at);
    std::erase_if(ends_m, [&](double s_m) { return std::abs(s_m - rim_m) < same_m; });
    const auto same = [&](double a, double b) { return b - a < same_m; };
    ends_m.erase(std::unique(ends_m.begin(), ends_m.end(), same), ends_m.end());
    return ends_m;
  }

  // How much longer than along the reference line a way beside it may be at an end.
  double widest_bend(std::size_t at) const {
    const geometry::PlanPiece& piece =
        at == 0 ? placed_.plan_view.front() : placed_.plan_view.back();
    const auto [start_per_m, end_per_m] = curvatures_per_m(piece.curve);
    double widest = 1.0;
    for (const BesideLine& line : at == 0 ? placed_.borders.front() : placed_.borders.back()) {
      const double t_m = at == 0 ? line.front().t_m : line.back().t_m;
      widest = std::max(widest, 1.0 - (at == 0 ? start_per_m : end_per_m) * t_m);
    }
    return widest;
  }

  Strip rim(std::size_t section, double from_m, double to_m) const {
    Strip strip{section, from_m, to_m};
    const double middle_m = 0.5 * (from_m + to_m);
    const auto beyond_m = [&](const StationRange& range) {
      return std::max(range.from_s_m - middle_m, middle_m - range.to_s_m);
    };
    const auto& reach = placed_.reach[section];
    const StationRange& longest = *std::ranges::min_element(reach, {}, beyond_m);
    for (const StationRange& range : reach) {
      strip.has_border.push_back(beyond_m(range) <= std::max(0.0, beyond_m(longest)));
    }
    return strip;
  }

  const PlacedRoad& placed_;
};

class RoadShaper {
 public:
  RoadShaper(const RoadMap& road_map, const PlannedRoad& road, const PlacedRoad& placed)
      : road_map_(road_map), road_(road), placed_(placed), reference_(placed.plan_view) {
    shape_.plan_view = placed.plan_view;
    shape_.length_m = reference_.end_s_m();
  }

  RoadShape shape() {
    const auto strips = StripFinder(placed_).find();
    fit_heights();
    fit_lane_offset(strips);
    for (const Strip& strip : strips[0]) shape_.rims[0].push_back(shape_of(strip));
    for (const Strip& strip : strips[1]) {
      shape_.sections.push_back(shape_of(strip));
      shape_.sections.back().heights = std::move(heights_[strip.section]);
    }
    for (const Strip& strip : strips[2]) shape_.rims[1].push_back(shape_of(strip));
    return std::move(shape_);
  }

 private:
  /// Borders of a lane of the map beside the road, with its own heights.
  struct LaneLines {
    BesideLine left, right;
  };

  // Elevation and superelevation: at each station the straight line across the borders of all
  // lanes that one drives on. Where lanes lie above or below it, that is their own height.
  void fit_heights() {
    heights_.resize(road_.sections.size());
    for (std::size_t i = 0; i < heights_.size(); ++i) {
      heights_[i].resize(road_.sections[i].lanes.size());
    }
    if (is_flat()) return;
    std::vector<std::vector<LaneLines>> lines;
    for (std::size_t i = 0; i < heights_.size(); ++i) lines.push_back(lines_of(i));
    fit_plane(lines);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      for (std::size_t lane = 0; lane < lines[i].size(); ++lane) {
        heights_[i][lane] = fit_lane_heights(i, lane, lines[i][lane]);
      }
    }
  }

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
      shape_.elevation = geometry::PiecewiseCubic(fit_cubics(heights, kHeightTolerance_m, -1e300));
    }
    if (steepest * farthest_m > kFlat_m) {
      shape_.superelevation =
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
      const double plane_m = shape_.elevation.at(point.s_m).value +
                             point.t_m * std::tan(shape_.superelevation.at(point.s_m).value);
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
      shape_.height_error_m = std::max(shape_.height_error_m, std::abs(sample.value - written_m));
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

  // What is seen from above is t times the cosine of how far the road leans.
  double leaning(double s_m, double t_m) const {
    return shape_.superelevation.empty() ? t_m
                                         : t_m / std::cos(shape_.superelevation.at(s_m).value);
  }

  std::vector<Sample> samples_of(const BesideLine& line) const {
    std::vector<Sample> samples;
    samples.reserve(line.size());
    for (const BesidePoint& p : line) samples.push_back({p.s_m, leaning(p.s_m, p.t_m)});
    return samples;
  }

  // A border of the road's section along a strip.
  BesideLine along(const Strip& strip, std::size_t border) const {
    const auto& lines = placed_.borders[strip.section];
    const std::size_t middle = road_.sections[strip.section].left_lanes;
    return clipped(lines[strip.standing(border, middle)], strip.from_m, strip.to_m);
  }

  void fit_lane_offset(const std::array<std::vector<Strip>, 3>& strips) {
    std::vector<geometry::CubicRecord> records;
    bool is_needed = false;
    const auto fit = [&](const Strip& strip) {
      const auto samples = samples_of(along(strip, road_.sections[strip.section].left_lanes));
      for (const Sample& sample : samples) {
        is_needed = is_needed || std::abs(sample.value) > 0.6 * kBorderTolerance_m;
      }
      // Their ends are met, so that lanes of roads that join do, too.
      is_needed = is_needed || std::abs(samples.front().value) > 1e-4 ||
                  std::abs(samples.back().value) > 1e-4;
      const auto fitted = fit_cubics(samples, kBorderTolerance_m, -1e300);
      records.insert(records.end(), fitted.begin(), fitted.end());
    };
    for (const std::vector<Strip>& some : strips) std::ranges::for_each(some, fit);
    if (is_needed) shape_.lane_offset = geometry::PiecewiseCubic(std::move(records));
  }

  SectionShape shape_of(const Strip& strip) {
    const PlannedSection& section = road_.sections[strip.section];
    SectionShape made;
    made.s_m = strip.from_m;
    made.left_lanes = section.left_lanes;
    made.widths.resize(section.lanes.size());
    const double from_m = made.s_m;
    for (const int side : {1, -1}) {
      std::vector<const geometry::PiecewiseCubic*> inner{&shape_.lane_offset};
      std::size_t border = section.left_lanes;
      while (side > 0 ? border > 0 : border < section.lanes.size()) {
        const std::size_t lane = side > 0 ? border - 1 : border;
        border = side > 0 ? border - 1 : border + 1;
        made.widths[lane] = fit_width(along(strip, border), inner, side, from_m);
        inner.push_back(&made.widths[lane]);
      }
    }
    for (std::size_t lane = 0; lane < section.lanes.size(); ++lane) {
      if (strip.has_border.empty()) {
        made.s_of_station.push_back(stations(strip.section, lane));
      } else {
        // Where the lane offset steps aside no lane goes on.
        const bool goes_on = strip.has(section.left_lanes);
        made.has_lane.push_back(goes_on && strip.has(lane) && strip.has(lane + 1));
      }
    }
    return made;
  }

  // The width out to a border, from where the borders inside it were put.
  geometry::PiecewiseCubic fit_width(const BesideLine& line,
                                     const std::vector<const geometry::PiecewiseCubic*>& inner,
                                     int side, double from_m) {
    const auto outer = samples_of(line);
    std::vector<double> s_m;
    for (const Sample& sample : outer) s_m.push_back(sample.s_m);
    for (const auto* cubic : inner) {
      for (const auto& record : cubic->records()) {
        if (record.s_m > from_m && record.s_m < outer.back().s_m) s_m.push_back(record.s_m);
      }
    }
    std::sort(s_m.begin(), s_m.end());
    const auto inside = [&](double at_m, double record_m) {
      double t_m = inner[0]->at(at_m, record_m).value;
      for (std::size_t i = 1; i < inner.size(); ++i) {
        t_m += side * inner[i]->at(at_m, record_m).value;
      }
      return t_m;
    };
    std::vector<Sample> widths;
    std::size_t hint = 0;
    for (const double at_m : s_m) {
      if (!widths.empty() && at_m < widths.back().s_m + 1e-6) continue;
      // At a section's end its own records count, not those of the next one.
      const double record_m = std::min(at_m, outer.back().s_m - 1e-6);
      const double width_m = side * (value_at(outer, at_m, hint) - inside(at_m, record_m));
      widths.push_back({at_m, width_m < 1e-6 ? 0.0 : width_m});
    }
    return geometry::PiecewiseCubic(fit_cubics(widths, kBorderTolerance_m, -1e-9));
  }

  // The road's s by a lane's stations, from its left border's points.
  std::vector<Sample> stations(std::size_t section, std::size_t index) {
    const PlannedLane& planned = road_.sections[section].lanes[index];
    const Lane& lane = road_map_.lane(planned.lane);
    const double from_m = placed_.section_from_m[section],
                 to_m = placed_.section_from_m[section + 1];
    const bool plain =
        lane.left_marks.size() < 2 && lane.right_marks.size() < 2 && lane.speed_limits.size() < 2;
    std::vector<Sample> samples{{0.0, planned.forward ? from_m : to_m}};
    if (!plain) {
      double hint_m = samples[0].value;
      for (std::size_t i = 0; i < lane.centre.in_map.points().size(); ++i) {
        hint_m = position_beside(reference_, lane.centre.in_map.points()[i], hint_m).s_m;
        const double s_m = std::clamp(hint_m, from_m, to_m);
        const bool on = planned.forward ? s_m > samples.back().value : s_m < samples.back().value;
        if (on && lane.centre.station_m[i] > samples.back().s_m) {
          samples.push_back({lane.centre.station_m[i], s_m});
        }
      }
    }
    if (lane.length_m() > samples.back().s_m) {
      samples.push_back({lane.length_m(), planned.forward ? to_m : from_m});
    }
    return samples;
  }

  const RoadMap& road_map_;
  const PlannedRoad& road_;
  const PlacedRoad& placed_;
  ReferenceTable reference_;
  RoadShape shape_;
  std::vector<std::vector<std::vector<LaneHeight>>> heights_;  // by section and lane
};

}  // namespace

bool SectionShape::has_width(std::size_t lane, double at_m) const {
  constexpr double inside_m = 1e-6;  // so that the section's own record counts at its end
  return widths[lane].at(at_m, at_m - inside_m).value > 1e-5;
}

double SectionShape::road_s_m(std::size_t lane, double station_m) const {
  std::size_t hint = 0;
  return value_at(s_of_station[lane], station_m, hint);
}

std::vector<WrittenSection> written_sections(const RoadShape& shape) {
  std::vector<WrittenSection> sections;
  for (const SectionShape& rim : shape.rims[0]) sections.push_back({&rim, 0});
  for (std::size_t i = 0; i < shape.sections.size(); ++i) {
    sections.push_back({&shape.sections[i], i});
  }
  for (const SectionShape& rim : shape.rims[1]) {
    sections.push_back({&rim, shape.sections.size() - 1});
  }
  for (std::size_t i = 0; i < sections.size(); ++i) {
    sections[i].from_m = sections[i].shape->s_m;
    sections[i].to_m = i + 1 < sections.size() ? sections[i + 1].shape->s_m : shape.length_m;
  }
  return sections;
}

std::size_t section_before(const RoadShape& shape, double s_m) {
  std::size_t index = shape.sections.size() - 1;
  while (index > 0 && shape.sections[index].s_m >= s_m) --index;
  return index;
}

RoadShape shape_road(const RoadMap& road_map, const PlannedRoad& road, const PlacedRoad& placed) {
  return RoadShaper(road_map, road, placed).shape();
}

}  // namespace roadbed::map::opendrive
