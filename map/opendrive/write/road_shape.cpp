#include "roadbed/map/opendrive/write/road_shape.h"

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/map/opendrive/write/clothoid.h"
#include "roadbed/map/opendrive/write/reference_line.h"
#include "roadbed/map/opendrive/write/road_lines.h"

namespace roadbed::map::opendrive {
namespace {

constexpr double kScales_m[] = {0.7, 1.4, 2.5, 4.0, 8.0, 16.0, 40.0};
constexpr double kReferenceTolerance_m = 0.004;
constexpr double kLeastBend = 0.1;
constexpr double kBack_m = 0.005, kMissing_m = 0.01, kSideways_m = 0.3, kCrossing_m = 0.005;
constexpr double kHeightTolerance_m = 0.005;
constexpr double kShortest_m = 0.02;  // of a road between its ends
constexpr double kFlat_m = 0.004;     // what leans less lies flat

/// Where a border crosses the line across the road's end.
struct Crossing {
  Eigen::Vector2d in_map;
  std::size_t inside = 0;  ///< the next point of the border in the road
};

// From the border's end inwards to the line; a border that ends before it goes straight on.
Crossing crossing(const RoadBorder& border, const EndLine& line, bool last) {
  const Line3& points = border.points;
  const Eigen::Vector2d ahead = (last ? 1.0 : -1.0) * unit(line.heading_rad);
  const auto place = [&](std::size_t i) { return last ? points.size() - 1 - i : i; };
  const auto at = [&](std::size_t i) { return Eigen::Vector2d(points[place(i)].head<2>()); };
  const auto beyond_m = [&](std::size_t i) { return ahead.dot(at(i) - line.in_map); };
  std::size_t i = 0;
  while (i + 1 < points.size() && beyond_m(i) > 1e-9) ++i;
  if (i == 0) {
    const Eigen::Vector2d along = (at(0) - at(1)).normalized();
    const double cosine = ahead.dot(along);
    const Eigen::Vector2d step = cosine < 0.3 ? ahead : Eigen::Vector2d(along / cosine);
    return {at(0) - beyond_m(0) * step, place(0)};
  }
  const double a = beyond_m(i), b = beyond_m(i - 1);
  if (a > 0.0) return {at(i) - a * ahead, place(i)};  // all of it lies beyond
  return {at(i) + a / (a - b) * (at(i - 1) - at(i)), place(i)};
}

class RoadShaper {
 public:
  RoadShaper(const RoadMap& road_map, const PlannedRoad& road, std::size_t border,
             const std::array<EndLine, 2>& ends)
      : road_map_(road_map), road_(road) {
    for (const PlannedSection& section : road.sections) {
      auto& borders = borders_.emplace_back();
      for (std::size_t i = 0; i <= section.lanes.size(); ++i) {
        borders.push_back(border_along(road_map, section, i));
      }
    }
    targets_.push_back(target(reference_along(road_map, road, border), ends));
    if (!road.source) targets_.push_back(middle(ends));
  }

  RoadShape shape() {
    choose_reference();
    shape_.error_m = std::max({faults_.back_m, faults_.missing_m, faults_.crossing_m});
    fit_heights();
    fit_lane_offset();
    for (std::size_t i = 0; i < road_.sections.size(); ++i) fit_widths(i);
    return std::move(shape_);
  }

 private:
  // The first sound one of: along the border, along the middle, both ever smoother.
  void choose_reference() {
    std::pair<std::size_t, double> best{0, 0.0};
    double least_m = 1e300;
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      for (const double scale_m : kScales_m) {
        try_reference(targets_[i], scale_m);
        if (shape_.fault_m < least_m) {
          least_m = shape_.fault_m;
          best = {i, scale_m};
        }
        if (least_m <= 0.0) return;
      }
    }
    try_reference(targets_[best.first], best.second);
  }

  // Midway between the outer borders of a road with one section, by shares of their length.
  ReferenceTarget middle(const std::array<EndLine, 2>& ends) const {
    const auto edge = [&](const RoadBorder& border) {
      return geometry::Polyline(target(border, ends).in_map);
    };
    const auto left = edge(borders_.front().front()), right = edge(borders_.front().back());
    ReferenceTarget line{{}, ends[0].heading_rad, ends[1].heading_rad};
    const double steps = std::ceil(std::max(left.length_m(), right.length_m())) + 1.0;
    for (double i = 0.0; i <= steps; i += 1.0) {
      line.in_map.push_back(
          0.5 * (left.at(i / steps * left.length_m()) + right.at(i / steps * right.length_m())));
    }
    return line;
  }

  static ReferenceTarget target(const RoadBorder& line, const std::array<EndLine, 2>& ends) {
    const Eigen::Vector2d own_first = line.points[line.own_from].head<2>();
    const Eigen::Vector2d own_last = line.points[line.own_to].head<2>();
    const Crossing first = crossing(line, ends[0], false), last = crossing(line, ends[1], true);
    const Eigen::Vector2d own = own_last - own_first;
    const bool turns_back = own.dot(last.in_map - first.in_map) < kShortest_m * own.norm();
    if (own.norm() > kShortest_m && turns_back) {  // the end lines cross in it
      return {{own_first, own_last}, std::atan2(own.y(), own.x()), std::atan2(own.y(), own.x())};
    }
    ReferenceTarget target{{first.in_map}, ends[0].heading_rad, ends[1].heading_rad};
    for (std::size_t i = first.inside; i <= last.inside; ++i) {
      target.in_map.emplace_back(line.points[i].head<2>());
    }
    target.in_map.push_back(last.in_map);
    return target;
  }

  void try_reference(const ReferenceTarget& target, double scale_m) {
    shape_.plan_view = fit_reference_line(target, scale_m, kReferenceTolerance_m);
    view_.emplace(shape_.plan_view);
    shape_.length_m = view_->end_s_m();
    faults_ = {};
    place_borders();
    for (const auto& lines : beside_) {
      for (std::size_t i = 1; i < lines.size(); ++i) note_crossing(lines[i - 1], lines[i]);
    }
    note_folds();
    const auto over = [](double fault, double allowed) { return std::max(0.0, fault - allowed); };
    shape_.fault_m = over(kLeastBend, faults_.least_bend) + over(faults_.back_m, kBack_m) +
                     over(faults_.missing_m, kMissing_m) + over(faults_.sideways_m, kSideways_m) +
                     over(faults_.crossing_m, kCrossing_m);
  }

  // Vertices of a border may lie on both sides of a fold: all along the line, too.
  void note_folds() {
    constexpr double step_m = 0.25;
    for (std::size_t i = 0; i < beside_.size(); ++i) {
      for (const BesideLine* edge : {&beside_[i].front(), &beside_[i].back()}) {
        std::size_t hint = 0;
        for (const geometry::PlanPiece& piece : shape_.plan_view) {
          const double steps = std::ceil(piece.length_m / step_m);
          for (double k = 0.0; k <= steps; k += 1.0) {
            const double s_m = piece.s_m + k / steps * piece.length_m;
            if (s_m < section_from_m_[i] || s_m > section_from_m_[i + 1]) continue;
            const double curvature_per_m = geometry::plan_point(piece, s_m).curvature_per_m;
            faults_.least_bend = std::min(faults_.least_bend,
                                          1.0 - curvature_per_m * point_at(*edge, s_m, hint).first);
          }
        }
      }
    }
  }

  void note_crossing(const BesideLine& left, const BesideLine& right) {
    std::size_t at_left = 0, at_right = 0;
    const auto note = [&](double s_m) {
      const double width_m =
          point_at(left, s_m, at_left).first - point_at(right, s_m, at_right).first;
      faults_.crossing_m = std::max(faults_.crossing_m, -width_m);
    };
    for (const BesidePoint& point : left) note(point.s_m);
    at_left = at_right = 0;
    for (const BesidePoint& point : right) note(point.s_m);
  }

  void place_borders() {
    beside_.clear();
    section_from_m_.clear();
    double hint_m = 0.0;
    for (std::size_t i = 0; i < road_.sections.size(); ++i) {
      if (i > 0) hint_m = boundary_s_m(i, hint_m);
      section_from_m_.push_back(hint_m);
    }
    section_from_m_.push_back(shape_.length_m);
    for (std::size_t i = 0; i < road_.sections.size(); ++i) {
      auto& lines = beside_.emplace_back();
      for (const RoadBorder& border : borders_[i]) {
        lines.push_back(
            line_beside(*view_, border, section_from_m_[i], section_from_m_[i + 1], faults_));
      }
    }
  }

  // Where a section begins: at the foot of its middle border's first point.
  double boundary_s_m(std::size_t section, double from_m) const {
    const RoadBorder& border = borders_[section][road_.sections[section].left_lanes];
    const Eigen::Vector2d at = border.points[border.own_from].head<2>();
    double nearest_m = from_m, least_m = 1e300;
    for (double s_m = from_m; s_m <= shape_.length_m; s_m += 1.0) {
      const double off_m = (view_->at(s_m).pose.position() - at).norm();
      if (off_m < least_m) {
        least_m = off_m;
        nearest_m = s_m;
      }
    }
    const double s_m = position_beside(*view_, at, nearest_m).s_m;
    return std::clamp(s_m, from_m + 1e-3, std::max(from_m + 1e-3, shape_.length_m - 1e-3));
  }

  // Elevation and superelevation: at each station the straight line across all borders.
  void fit_heights() {
    std::vector<Sample> heights, slopes;
    double steepest = 0.0, farthest_m = 0.1;
    for (const auto& lines : beside_) add_heights(lines, heights, slopes, steepest, farthest_m);
    if (std::any_of(heights.begin(), heights.end(), [](const Sample& h) { return h.value != 0; })) {
      shape_.elevation = geometry::PiecewiseCubic(fit_cubics(heights, kHeightTolerance_m, -1e300));
    }
    if (steepest * farthest_m > kFlat_m) {
      shape_.superelevation =
          geometry::PiecewiseCubic(fit_cubics(slopes, kHeightTolerance_m / farthest_m, -1e300));
    }
    for (const auto& lines : beside_) {
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
        const auto [ti, zi] = point_at(lines[i], at.s_m, hints[i]);
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

  static std::pair<double, double> point_at(const BesideLine& line, double s_m, std::size_t& hint) {
    while (hint + 2 < line.size() && line[hint + 1].s_m <= s_m) ++hint;
    const BesidePoint &a = line[hint], &b = line[std::min(hint + 1, line.size() - 1)];
    const double share =
        b.s_m > a.s_m ? std::clamp((s_m - a.s_m) / (b.s_m - a.s_m), 0.0, 1.0) : 0.0;
    return {a.t_m + share * (b.t_m - a.t_m), a.z_m + share * (b.z_m - a.z_m)};
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
    for (std::size_t i = 0; i < beside_.size(); ++i) {
      const auto samples = samples_of(beside_[i][road_.sections[i].left_lanes]);
      for (const Sample& sample : samples) {
        is_needed = is_needed || std::abs(sample.value) > 0.6 * kBorderTolerance_m;
      }
      // Their ends are met, so that lanes of roads that join do, too.
      is_needed = is_needed || std::abs(samples.front().value) > 1e-4 ||
                  std::abs(samples.back().value) > 1e-4;
      const auto fitted = fit_cubics(samples, kBorderTolerance_m, -1e300);
      records.insert(records.end(), fitted.begin(), fitted.end());
      const geometry::PiecewiseCubic cubic(fitted);
      note_error(samples, [&](double s_m) { return cubic.at(s_m).value; });
    }
    if (is_needed) shape_.lane_offset = geometry::PiecewiseCubic(std::move(records));
  }

  template <typename Fitted>
  void note_error(const std::vector<Sample>& samples, const Fitted& fitted) {
    for (const Sample& sample : samples) {
      shape_.error_m = std::max(shape_.error_m, std::abs(fitted(sample.s_m) - sample.value));
    }
  }

  void fit_widths(std::size_t index) {
    const PlannedSection& section = road_.sections[index];
    SectionShape& made = shape_.sections.emplace_back();
    made.s_m = section_from_m_[index];
    made.widths.resize(section.lanes.size());
    const double from_m = made.s_m;
    for (const int side : {1, -1}) {
      std::vector<const geometry::PiecewiseCubic*> inner{&shape_.lane_offset};
      std::size_t border = section.left_lanes;
      while (side > 0 ? border > 0 : border < section.lanes.size()) {
        const std::size_t lane = side > 0 ? border - 1 : border;
        border = side > 0 ? border - 1 : border + 1;
        made.widths[lane] = fit_width(beside_[index][border], inner, side, from_m);
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
      shape_.error_m = std::max(shape_.error_m, -width_m);
      widths.push_back({at_m, width_m < 1e-6 ? 0.0 : width_m});
    }
    const geometry::PiecewiseCubic fitted(fit_cubics(widths, kBorderTolerance_m, -1e-9));
    note_error(widths, [&](double at_m) {
      return fitted.at(at_m, std::min(at_m, outer.back().s_m - 1e-6)).value;
    });
    return fitted;
  }

  // The road's s by a lane's stations, from its left border's points.
  std::vector<Sample> stations(std::size_t section, std::size_t index) {
    const PlannedLane& planned = road_.sections[section].lanes[index];
    const Lane& lane = road_map_.lane(planned.lane);
    const double from_m = section_from_m_[section], to_m = section_from_m_[section + 1];
    const bool plain =
        lane.left_marks.size() < 2 && lane.right_marks.size() < 2 && lane.speed_limits.size() < 2;
    std::vector<Sample> samples{{0.0, planned.forward ? from_m : to_m}};
    if (!plain) {
      double hint_m = samples[0].value;
      for (std::size_t i = 0; i < lane.centre.in_map.points().size(); ++i) {
        hint_m = position_beside(*view_, lane.centre.in_map.points()[i], hint_m).s_m;
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
  std::vector<std::vector<RoadBorder>> borders_;  // by section, from left to right
  std::vector<ReferenceTarget> targets_;          // what the reference line may follow
  std::optional<geometry::PlanView> view_;
  BesideFaults faults_;
  std::vector<double> section_from_m_;
  std::vector<std::vector<BesideLine>> beside_;
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

RoadShape shape_road(const RoadMap& road_map, const PlannedRoad& road, std::size_t border,
                     const std::array<EndLine, 2>& ends) {
  return RoadShaper(road_map, road, border, ends).shape();
}

}  // namespace roadbed::map::opendrive
