#include "roadbed/map/opendrive/write/road_shape.h"

#include <algorithm>
#include <cmath>

namespace roadbed::map::opendrive {
namespace {

constexpr double kHeightTolerance_m = 0.005;

constexpr double kFlat_m = 0.004;  // what leans less lies flat

class RoadShaper {
 public:
  RoadShaper(const RoadMap& road_map, const PlannedRoad& road, const PlacedRoad& placed)
      : road_map_(road_map), road_(road), placed_(placed), reference_(placed.plan_view) {
    shape_.plan_view = placed.plan_view;
    shape_.length_m = reference_.end_s_m();
  }

  RoadShape shape() {
    fit_heights();
    fit_lane_offset();
    for (std::size_t i = 0; i < road_.sections.size(); ++i) fit_widths(i);
    return std::move(shape_);
  }

 private:
  // Elevation and superelevation: at each station the straight line across all borders.
  void fit_heights() {
    std::vector<Sample> heights, slopes;
    double steepest = 0.0, farthest_m = 0.1;
    for (const auto& lines : placed_.borders)
      add_heights(lines, heights, slopes, steepest, farthest_m);
    if (std::any_of(heights.begin(), heights.end(), [](const Sample& h) { return h.value != 0; })) {
      shape_.elevation = geometry::PiecewiseCubic(fit_cubics(heights, kHeightTolerance_m, -1e300));
    }
    if (steepest * farthest_m > kFlat_m) {
      shape_.superelevation =
          geometry::PiecewiseCubic(fit_cubics(slopes, kHeightTolerance_m / farthest_m, -1e300));
    }
    for (const auto& lines : placed_.borders) {
      for (const BesideLine& line : lines) {
        for (const BesidePoint& point : line) {
          const double height_m = shape_.elevation.at(point.s_m).value +
                                  point.t_m * std::tan(shape_.superelevation.at(point.s_m).value);
          shape_.height_error_m = std::max(shape_.height_error_m, std::abs(height_m - point.z_m));
        }
      }
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

  void fit_lane_offset() {
    std::vector<geometry::CubicRecord> records;
    bool is_needed = false;
    for (std::size_t i = 0; i < placed_.borders.size(); ++i) {
      const auto samples = samples_of(placed_.borders[i][road_.sections[i].left_lanes]);
      for (const Sample& sample : samples) {
        is_needed = is_needed || std::abs(sample.value) > 0.6 * kBorderTolerance_m;
      }
      // Their ends are met, so that lanes of roads that join do, too.
      is_needed = is_needed || std::abs(samples.front().value) > 1e-4 ||
                  std::abs(samples.back().value) > 1e-4;
      const auto fitted = fit_cubics(samples, kBorderTolerance_m, -1e300);
      records.insert(records.end(), fitted.begin(), fitted.end());
    }
    if (is_needed) shape_.lane_offset = geometry::PiecewiseCubic(std::move(records));
  }

  void fit_widths(std::size_t index) {
    const PlannedSection& section = road_.sections[index];
    SectionShape& made = shape_.sections.emplace_back();
    made.s_m = placed_.section_from_m[index];
    made.left_lanes = section.left_lanes;
    made.widths.resize(section.lanes.size());
    const double from_m = made.s_m;
    for (const int side : {1, -1}) {
      std::vector<const geometry::PiecewiseCubic*> inner{&shape_.lane_offset};
      std::size_t border = section.left_lanes;
      while (side > 0 ? border > 0 : border < section.lanes.size()) {
        const std::size_t lane = side > 0 ? border - 1 : border;
        border = side > 0 ? border - 1 : border + 1;
        made.widths[lane] = fit_width(placed_.borders[index][border], inner, side, from_m);
        inner.push_back(&made.widths[lane]);
      }
    }
    for (std::size_t lane = 0; lane < section.lanes.size(); ++lane) {
      made.s_of_station.push_back(stations(index, lane));
    }
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

std::size_t section_before(const RoadShape& shape, double s_m) {
  std::size_t index = shape.sections.size() - 1;
  while (index > 0 && shape.sections[index].s_m >= s_m) --index;
  return index;
}

RoadShape shape_road(const RoadMap& road_map, const PlannedRoad& road, const PlacedRoad& placed) {
  return RoadShaper(road_map, road, placed).shape();
}

}  // namespace roadbed::map::opendrive
