#include "roadbed/map/opendrive/write/road_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "roadbed/map/opendrive/write/road_heights.h"

namespace roadbed::map::opendrive {
namespace {

constexpr double kChord_m = 0.0005;          // how straight a cubic is between samples
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
    RoadHeights heights = fit_heights(road_map_, road_, placed_, reference_);
    shape_.elevation = std::move(heights.elevation);
    shape_.superelevation = std::move(heights.superelevation);
    shape_.height_error_m = heights.error_m;
    fit_lane_offset(strips);
    for (const Strip& strip : strips[0]) shape_.rims[0].push_back(shape_of(strip));
    for (const Strip& strip : strips[1]) {
      shape_.sections.push_back(shape_of(strip));
      shape_.sections.back().heights = std::move(heights.lanes[strip.section]);
    }
    for (const Strip& strip : strips[2]) shape_.rims[1].push_back(shape_of(strip));
    return std::move(shape_);
  }

 private:
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

  // Stations between those there are, so that the cubics are straight from one to the next.
  static void add_where_bent(std::vector<double>& s_m,
                             const std::vector<const geometry::PiecewiseCubic*>& cubics) {
    const std::size_t count = s_m.size();
    for (std::size_t i = 1; i < count; ++i) {
      const double from_m = s_m[i - 1], length_m = s_m[i] - from_m;
      double bend_per_m = 0.0;
      for (const auto* cubic : cubics) bend_per_m += cubic->bounds(from_m, s_m[i]).d2;
      const double steps = std::ceil(length_m * std::sqrt(bend_per_m / (8.0 * kChord_m)));
      for (double step = 1.0; step < steps; ++step) {
        s_m.push_back(from_m + step / steps * length_m);
      }
    }
    std::sort(s_m.begin(), s_m.end());
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
    add_where_bent(s_m, inner);
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
