#include "roadbed/map/formats/open_drive_cross_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace roadbed::map::open_drive {
namespace {

// Shorter stretches hold no curve worth a point.
constexpr double kShortestStretchM = 1e-9;
// Records of real files meet within fractions of a millimetre, sometimes stepping back: rows this
// near to each other, as a share of the allowed error, are one. The chord takes the rest of it:
// (1 − u)(0.11 + 4 · 0.94 u) < 1 for every place u along a chord with one end moved.
constexpr double kSameRowShare = 0.11, kChordShare = 0.94;
// A step that just fits must not fail by its rounding.
constexpr double kAlmost = 1.0 - 1e-9;
// A bound that is no use (a curve that stands still) must not ask for endless points.
constexpr double kShortestStepM = 1e-3;
// Crossfalls beyond it are slips; their bound must not be infinite.
constexpr double kSteepestRad = 1.4;

class SideSampler {
 public:
  SideSampler(const RoadRecord& road, std::size_t road_index, const geometry::PlanView& plan_view,
              const SectionSide& side, double max_error_m, PointBudget& budget)
      : road_(road),
        road_index_(road_index),
        plan_view_(plan_view),
        side_(side),
        max_error_m_(max_error_m),
        budget_(budget) {}

  std::vector<CrossSection> sample() const {
    std::vector<CrossSection> rows;
    const std::vector<double> breaks = breakpoints();
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
      const double middle_s_m = 0.5 * (breaks[i] + breaks[i + 1]);
      for (const double s_m : stations(breaks[i], breaks[i + 1])) {
        CrossSection row = cross_section(s_m, middle_s_m);
        check(row);
        const bool is_end = i + 2 == breaks.size() && s_m == breaks.back();
        if (!rows.empty() && same(rows.back(), row)) {
          if (is_end && rows.size() > 1) rows.back() = std::move(row);  // ends stay where they are
        } else {
          rows.push_back(std::move(row));
        }
      }
    }
    return rows;
  }

 private:
  // Stations at which some record begins: between two of them everything is smooth.
  std::vector<double> breakpoints() const {
    std::vector<double> breaks{side_.from_s_m, side_.to_s_m};
    const auto add = [&](const auto& records) {
      auto record = std::lower_bound(records.begin(), records.end(), side_.from_s_m,
                                     [](const auto& r, double s_m) { return r.s_m < s_m; });
      for (; record != records.end() && record->s_m < side_.to_s_m; ++record) {
        breaks.push_back(record->s_m);
      }
    };
    add(plan_view_.pieces());
    add(road_.elevation.records());
    add(road_.superelevation.records());
    add(road_.lane_offset.records());
    add(road_.shape.profiles());
    add(crossfall().records());
    for (const LaneRecord* lane : side_.lanes) {
      add(lane->width.records());
      add(lane->border.records());
      add(lane->heights);
    }
    std::sort(breaks.begin(), breaks.end());
    std::vector<double> kept;
    for (const double s_m : breaks) {
      const bool inside = s_m >= side_.from_s_m && s_m <= side_.to_s_m;
      if (inside && (kept.empty() || s_m - kept.back() > kShortestStretchM)) kept.push_back(s_m);
    }
    if (kept.size() > 1) kept.back() = side_.to_s_m;
    return kept;
  }

  const geometry::PiecewiseCubic& crossfall() const {
    return side_.sign > 0 ? road_.crossfall_left : road_.crossfall_right;
  }

  std::vector<double> stations(double from_s_m, double to_s_m) const {
    const double chord_error_m = kChordShare * max_error_m_;
    std::vector<double> stations{from_s_m};
    double step_m = to_s_m - from_s_m;
    while (stations.back() < to_s_m) {
      const double s_m = stations.back();
      step_m = std::min(to_s_m - s_m, 2.0 * step_m);
      while (step_m > kShortestStepM) {
        const double bound = second_derivative_bound(s_m, s_m + step_m);
        if (step_m * step_m * bound <= 8.0 * chord_error_m) break;
        step_m = std::max(0.5 * step_m, kAlmost * std::sqrt(8.0 * chord_error_m / bound));
        step_m = std::max(step_m, kShortestStepM);
      }
      const bool at_end = to_s_m - s_m - step_m < kShortestStretchM;
      stations.push_back(at_end ? to_s_m : s_m + step_m);
      budget_.spend(side_.lanes.size() + 1, road_index_);
    }
    return stations;
  }

  void check(const CrossSection& row) const {
    constexpr double farthest_m = 1e8;
    for (std::size_t i = 0; i < row.border_in_map.size(); ++i) {
      // Written so that a value that is no number fails too.
      if (!(row.border_in_map[i].cwiseAbs().maxCoeff() < farthest_m) ||
          !(std::abs(row.z_m[i]) < farthest_m)) {
        throw RoadFault(road_index_,
                        fmt::format("at s = {} m a border lies more than 100,000 km off", row.s_m),
                        "check its widths, offsets and elevations");
      }
    }
  }

  // Bound of the border's second derivative, in plan and height. With τ = t·cos(roll) − h·sin(roll)
  // |(R + τ N)″| ≤ R″ + τ″ + 2 τ′θ′ + τ (θ″ + θ′²); where s is the arc length, its parts across and
  // along the road are τ″ + κ(1 − κτ) and κ′τ + 2κτ′. A kink k counts as 2 k over the stretch: a
  // chord over it is off by a quarter of the stretch times k.
  double second_derivative_bound(double from_s_m, double to_s_m) const {
    const geometry::PlanBounds plan = plan_view_.bounds(from_s_m, to_s_m);
    const geometry::CubicValue roll = road_.superelevation.bounds(from_s_m, to_s_m);
    const geometry::CubicValue t = offset_bounds(from_s_m, to_s_m);
    const LateralShape::Bounds shape = shape_bounds(from_s_m, to_s_m);
    const geometry::CubicValue rolled_t = rolled(t, roll), rolled_h = rolled(shape.height, roll);
    const double share = std::min(1.0, roll.value);
    const geometry::CubicValue side{t.value + share * shape.height.value, rolled_t.d1 + rolled_h.d1,
                                    rolled_t.d2 + rolled_h.d2};
    const double height = road_.elevation.bounds(from_s_m, to_s_m).d2 + rolled_t.d2 - t.d2 +
                          share * t.d2 + rolled_h.d2 + fall_d2(t, from_s_m, to_s_m);
    const double in_plan =
        plan.curvature
            ? bound_by_curvature(plan, side,
                                 sideways_range(from_s_m, to_s_m, t, share, shape.height.value))
            : plan.second_derivative_per_m + side.d2 + 2.0 * side.d1 * plan.heading_d1_per_m +
                  side.value *
                      (plan.heading_d2_per_m2 + plan.heading_d1_per_m * plan.heading_d1_per_m);
    return std::hypot(in_plan, height) + 2.0 * shape.kinks / (to_s_m - from_s_m);
  }

  struct Range {
    double low_m, high_m;
  };

  // Least and greatest τ of any border along the stretch.
  Range sideways_range(double from_s_m, double to_s_m, const geometry::CubicValue& t,
                       double roll_share, double height_m) const {
    const double middle_s_m = 0.5 * (from_s_m + to_s_m);
    const double offset_m = road_.lane_offset.at(middle_s_m).value;
    double t_m = offset_m;
    Range range{t_m, t_m};
    for (const LaneRecord* lane : side_.lanes) {
      t_m = outer_offset_m(*lane, t_m, offset_m, middle_s_m, middle_s_m);
      range = {std::min(range.low_m, t_m), std::max(range.high_m, t_m)};
    }
    // Leaning brings a border nearer to the reference line, by at most 1 − cos ≤ the share.
    const double reach_m = 0.5 * (to_s_m - from_s_m) * t.d1 + roll_share * (t.value + height_m);
    return {range.low_m - reach_m, range.high_m + reach_m};
  }

  static double bound_by_curvature(const geometry::PlanBounds& plan,
                                   const geometry::CubicValue& side, const Range& range) {
    const auto [low, high] = *plan.curvature;
    double across = 0.0;
    for (const double t_m : {range.low_m, range.high_m}) {
      const auto bend = [t_m](double curvature) {
        return std::abs(curvature * (1.0 - curvature * t_m));
      };
      across = std::max({across, bend(low), bend(high)});
      const double extreme = t_m == 0.0 ? low : 0.5 / t_m;  // of κ − κ² t
      if (extreme > low && extreme < high) across = std::max(across, bend(extreme));
    }
    const double along =
        plan.heading_d2_per_m2 * side.value + 2.0 * plan.heading_d1_per_m * side.d1;
    return std::hypot(across + side.d2, along);
  }

  // Of f·cos(roll) or f·sin(roll): bounds of its first two derivatives.
  static geometry::CubicValue rolled(const geometry::CubicValue& f,
                                     const geometry::CubicValue& roll) {
    return {f.value, f.d1 + f.value * roll.d1,
            f.d2 + 2.0 * f.d1 * roll.d1 + f.value * (roll.d2 + roll.d1 * roll.d1)};
  }

  // Of |t|·tan(crossfall).
  double fall_d2(const geometry::CubicValue& t, double from_s_m, double to_s_m) const {
    if (crossfall().empty()) return 0.0;
    const geometry::CubicValue fall = crossfall().bounds(from_s_m, to_s_m);
    const double slope = std::tan(std::min(fall.value, kSteepestRad));
    const double gain = 1.0 + slope * slope;
    return t.d2 * slope + 2.0 * t.d1 * gain * fall.d1 +
           t.value * gain * (fall.d2 + 2.0 * slope * fall.d1 * fall.d1);
  }

  LateralShape::Bounds shape_bounds(double from_s_m, double to_s_m) const {
    LateralShape::Bounds worst;
    if (road_.shape.empty()) return worst;
    const double middle_s_m = 0.5 * (from_s_m + to_s_m);
    geometry::CubicValue t = road_.lane_offset.bounds(from_s_m, to_s_m);
    const std::vector<double> t_m = offsets(middle_s_m, middle_s_m);
    for (std::size_t i = 0; i < t_m.size(); ++i) {
      if (i > 0) add_bounds(side_.lanes[i - 1]->outer().bounds(from_s_m, to_s_m), t);
      const LateralShape::Bounds bounds = road_.shape.bounds(from_s_m, to_s_m, t_m[i], t);
      worst.height.value = std::max(worst.height.value, bounds.height.value);
      worst.height.d1 = std::max(worst.height.d1, bounds.height.d1);
      worst.height.d2 = std::max(worst.height.d2, bounds.height.d2);
      worst.kinks = std::max(worst.kinks, bounds.kinks);
    }
    return worst;
  }

  static void add_bounds(const geometry::CubicValue& more, geometry::CubicValue& sum) {
    sum.value += more.value;
    sum.d1 += more.d1;
    sum.d2 += more.d2;
  }

  geometry::CubicValue offset_bounds(double from_s_m, double to_s_m) const {
    geometry::CubicValue sum = road_.lane_offset.bounds(from_s_m, to_s_m);
    for (const LaneRecord* lane : side_.lanes) {
      add_bounds(lane->outer().bounds(from_s_m, to_s_m), sum);
    }
    return sum;
  }

  CrossSection cross_section(double s_m, double record_s_m) const {
    const geometry::Pose2 pose = plan_view_.at(s_m, record_s_m).pose;
    const double roll_rad = road_.superelevation.at(s_m, record_s_m).value;
    const double elevation_m = road_.elevation.at(s_m, record_s_m).value;
    const double fall = std::tan(crossfall().at(s_m, record_s_m).value);
    const Eigen::Vector2d normal(-std::sin(pose.heading_rad), std::cos(pose.heading_rad));
    const std::vector<double> t_m = offsets(s_m, record_s_m);
    const double cos_roll = std::cos(roll_rad), sin_roll = std::sin(roll_rad);
    // Sideways and upward from the reference line.
    const auto on_surface = [&](double t) {
      const double h_m = road_.shape.height_m(s_m, t);
      return Eigen::Vector2d(t * cos_roll - h_m * sin_roll,
                             t * sin_roll + h_m * cos_roll - std::abs(t) * fall);
    };
    CrossSection row{s_m, {}, {}, raised(record_s_m)};
    row.border_in_map.reserve(t_m.size());
    row.z_m.reserve(t_m.size());
    Eigen::Vector2d before = on_surface(t_m[0]), place = before;
    for (std::size_t i = 0; i < t_m.size(); ++i) {
      if (i > 0) {
        const Eigen::Vector2d here = on_surface(t_m[i]);
        const bool level = side_.lanes[i - 1]->level;
        place += level ? Eigen::Vector2d(t_m[i] - t_m[i - 1], 0.0) : here - before;
        before = here;
      }
      row.border_in_map.emplace_back(pose.position() + place.x() * normal);
      row.z_m.push_back(elevation_m + place.y());
    }
    return row;
  }

  std::vector<LaneHeight> raised(double s_m) const {
    std::vector<LaneHeight> raised;
    for (std::size_t i = 0; i < side_.lanes.size(); ++i) {
      const auto& heights = side_.lanes[i]->heights;
      if (heights.empty()) continue;
      const auto after =
          std::upper_bound(heights.begin(), heights.end(), s_m,
                           [](double s, const LaneHeight& height) { return s < height.s_m; });
      raised.resize(side_.lanes.size());
      if (after != heights.begin()) raised[i] = *(after - 1);
    }
    return raised;
  }

  std::vector<double> offsets(double s_m, double record_s_m) const {
    const double offset_m = road_.lane_offset.at(s_m, record_s_m).value;
    std::vector<double> t_m{offset_m};
    t_m.reserve(side_.lanes.size() + 1);
    for (const LaneRecord* lane : side_.lanes) {
      t_m.push_back(outer_offset_m(*lane, t_m.back(), offset_m, s_m, record_s_m));
    }
    return t_m;
  }

  // Of a lane's outer border: its width from the inner one, or its border from the lane offset.
  double outer_offset_m(const LaneRecord& lane, double inner_m, double offset_m, double s_m,
                        double record_s_m) const {
    const bool by_width = lane.border.empty() || !lane.width.empty();
    const double value_m = lane.outer().at(s_m, record_s_m).value;
    return by_width ? inner_m + side_.sign * value_m : offset_m + value_m;
  }

  bool same(const CrossSection& a, const CrossSection& b) const {
    const double near_m = kSameRowShare * max_error_m_;
    for (std::size_t i = 0; i < a.border_in_map.size(); ++i) {
      if ((a.border_in_map[i] - b.border_in_map[i]).norm() > near_m) return false;
      if (std::abs(a.z_m[i] - b.z_m[i]) > near_m) return false;
    }
    return a.raised == b.raised;
  }

  const RoadRecord& road_;
  std::size_t road_index_;
  const geometry::PlanView& plan_view_;
  const SectionSide& side_;
  double max_error_m_;
  PointBudget& budget_;
};

}  // namespace

std::size_t next_section(const RoadRecord& road, std::size_t section, int sign) {
  return sign > 0 ? road.sections[section].next_left : road.sections[section].next_right;
}

SectionSide section_side(const RoadRecord& road, std::size_t section, int sign) {
  const std::size_t next = next_section(road, section, sign);
  SectionSide side{road.sections[section].s_m,
                   next < road.sections.size() ? road.sections[next].s_m : road.length_m,
                   sign,
                   {}};
  const auto& lanes = road.sections[section].lanes;
  if (sign > 0) {
    for (auto it = lanes.upper_bound(0); it != lanes.end(); ++it) side.lanes.push_back(&it->second);
  } else {
    for (auto it = std::make_reverse_iterator(lanes.lower_bound(0)); it != lanes.rend(); ++it) {
      side.lanes.push_back(&it->second);
    }
  }
  return side;
}

std::vector<CrossSection> sample_side(const RoadRecord& road, std::size_t road_index,
                                      const geometry::PlanView& plan_view, const SectionSide& side,
                                      double max_error_m, PointBudget& budget) {
  if (side.lanes.empty() || !(side.to_s_m - side.from_s_m > kShortestStretchM)) return {};
  return SideSampler(road, road_index, plan_view, side, max_error_m, budget).sample();
}

}  // namespace roadbed::map::open_drive
