#include "roadbed/map/opendrive/lane_borders.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace roadbed::map::opendrive {
namespace {

using geometry::CubicRecord;
using geometry::CubicValue;

// Crossfalls beyond it are slips; their bound must not be infinite.
constexpr double kSteepestRad = 1.4;

// Values that are not given are 0.
double value_at(const CubicRecord* record, double s_m) {
  return record == nullptr ? 0.0 : geometry::cubic_at(*record, s_m).value;
}

CubicValue bounds(const CubicRecord* record, double from_s_m, double to_s_m) {
  return record == nullptr ? CubicValue{} : geometry::cubic_bounds(*record, from_s_m, to_s_m);
}

void add_bounds(const CubicValue& more, CubicValue& sum) {
  sum.value += more.value;
  sum.d1 += more.d1;
  sum.d2 += more.d2;
}

// Of f·cos(roll) or f·sin(roll): bounds of its first two derivatives.
CubicValue rolled(const CubicValue& f, const CubicValue& roll) {
  return {f.value, f.d1 + f.value * roll.d1,
          f.d2 + 2.0 * f.d1 * roll.d1 + f.value * (roll.d2 + roll.d1 * roll.d1)};
}

double bound_by_curvature(const geometry::PlanBounds& plan, const CubicValue& side, double low_m,
                          double high_m) {
  const auto [low, high] = *plan.curvature;
  double across = 0.0;
  for (const double t_m : {low_m, high_m}) {
    const auto bend = [t_m](double curvature) {
      return std::abs(curvature * (1.0 - curvature * t_m));
    };
    across = std::max({across, bend(low), bend(high)});
    const double extreme = t_m == 0.0 ? low : 0.5 / t_m;  // of κ − κ² t
    if (extreme > low && extreme < high) across = std::max(across, bend(extreme));
  }
  const double along = plan.heading_d2_per_m2 * side.value + 2.0 * plan.heading_d1_per_m * side.d1;
  return std::hypot(across + side.d2, along);
}

// Where s runs unevenly along the road, a chord is off the border by what of the second derivative
// is across the chord; what is along it moves places along the chord only, and counts a tenth so
// that they stay near theirs. The chord points where the border points somewhere along the stretch,
// so the angle between it and the road is at most the road's turn and the border's slant to it. On
// a slope, a place moved along the chord is at another height.
double bound_by_parts(const geometry::PlanBounds& plan, const CubicValue& side, double length_m,
                      std::optional<double> slope, double height_d2) {
  constexpr double kUnseenFraction = 0.1;
  const double turn = plan.heading_d1_per_m;
  const double across = plan.across_per_m + side.d2 + side.value * turn * turn;
  const double along =
      plan.second_derivative_per_m + 2.0 * side.d1 * turn + side.value * plan.heading_d2_per_m2;
  const double forward = plan.slowest - side.value * turn;
  const double whole = std::hypot(across, along, height_d2);
  const double slant = length_m * turn + std::atan2(side.d1, forward);
  if (!slope || forward <= 0.0 || slant > 1.0) return whole;
  const double grade = *slope / (forward * std::cos(slant));
  const double seen =
      std::hypot(across + along * std::sin(slant), height_d2 + grade * (along + across));
  return std::min(whole, std::max(seen, kUnseenFraction * along));
}

}  // namespace

SideBorders::SideBorders(const RoadRecord& road, const geometry::PlanView& plan_view,
                         const SectionSide& side)
    : road_(road), plan_view_(plan_view), side_(side), outer_(side.lanes.size()) {}

void SideBorders::enter(double from_s_m, double to_s_m) {
  const double middle_s_m = middle_s_m_ = 0.5 * (from_s_m + to_s_m);
  piece_ = &plan_view_.piece_at(middle_s_m);
  elevation_ = road_.elevation.cubic.record_at(middle_s_m);
  roll_ = road_.superelevation.cubic.record_at(middle_s_m);
  fall_ = (side_.sign > 0 ? road_.crossfall_left : road_.crossfall_right).record_at(middle_s_m);
  offset_ = road_.lane_offset.cubic.record_at(middle_s_m);
  for (std::size_t i = 0; i < outer_.size(); ++i) {
    const LaneRecord& lane = *side_.lanes[i];
    outer_[i] = {lane.outer().record_at(middle_s_m), lane.goes_by_width()};
  }
  enter_raised(middle_s_m);
}

void SideBorders::enter_raised(double s_m) {
  raised_.clear();
  for (std::size_t i = 0; i < side_.lanes.size(); ++i) {
    const auto& heights = side_.lanes[i]->heights;
    if (heights.empty()) continue;
    const auto after =
        std::upper_bound(heights.begin(), heights.end(), s_m,
                         [](double s, const LaneHeight& height) { return s < height.s_m; });
    raised_.resize(side_.lanes.size());
    if (after != heights.begin()) raised_[i] = *(after - 1);
  }
}

// With τ = t·cos(roll) − h·sin(roll), |(R + τ N)″| ≤ R″ + τ″ + 2 τ′θ′ + τ (θ″ + θ′²); where s is
// the arc length, its parts across and along the road are τ″ + κ(1 − κτ) and κ′τ + 2κτ′. A kink k
// counts as 2 k over the stretch: a chord over it is off by a quarter of the stretch times k.
double SideBorders::second_derivative_bound(double from_s_m, double to_s_m) const {
  const geometry::PlanBounds plan = geometry::plan_bounds(*piece_, from_s_m, to_s_m);
  const CubicValue roll = bounds(roll_, from_s_m, to_s_m);
  const CubicValue t = offset_bounds(from_s_m, to_s_m);
  const LateralShape::Bounds shape = shape_bounds(from_s_m, to_s_m);
  const CubicValue rolled_t = rolled(t, roll), rolled_h = rolled(shape.height, roll);
  const double fraction = std::min(1.0, roll.value);
  const CubicValue side{t.value + fraction * shape.height.value, rolled_t.d1 + rolled_h.d1,
                        rolled_t.d2 + rolled_h.d2};
  const double height = bounds(elevation_, from_s_m, to_s_m).d2 + rolled_t.d2 - t.d2 +
                        fraction * t.d2 + rolled_h.d2 + fall_d2(t, from_s_m, to_s_m);
  const double kink = 2.0 * shape.kinks / (to_s_m - from_s_m);
  if (plan.curvature) {
    const Range range = sideways_range(from_s_m, to_s_m, t, fraction, shape.height.value);
    return std::hypot(bound_by_curvature(plan, side, range.low_m, range.high_m), height) + kink;
  }
  return bound_by_parts(plan, side, to_s_m - from_s_m, slope(t, from_s_m, to_s_m), height) + kink;
}

// Of the height along s; none where the cross-section leans, or falls off changingly.
std::optional<double> SideBorders::slope(const CubicValue& t, double from_s_m,
                                         double to_s_m) const {
  const bool leans = roll_ != nullptr || !road_.shape.empty() || !road_.strips.empty();
  if (leans || bounds(fall_, from_s_m, to_s_m).d1 != 0.0) return {};
  const double fall = std::abs(std::tan(value_at(fall_, from_s_m)));
  return bounds(elevation_, from_s_m, to_s_m).d1 + t.d1 * fall;
}

// Least and greatest τ of any border along the stretch.
SideBorders::Range SideBorders::sideways_range(double from_s_m, double to_s_m, const CubicValue& t,
                                               double roll_fraction, double height_m) const {
  const double middle_s_m = 0.5 * (from_s_m + to_s_m);
  const double offset_m = value_at(offset_, middle_s_m);
  double t_m = offset_m;
  Range range{t_m, t_m};
  for (const Outer& outer : outer_) {
    t_m = outer_offset_m(outer, t_m, offset_m, middle_s_m);
    range = {std::min(range.low_m, t_m), std::max(range.high_m, t_m)};
  }
  // Leaning brings a border nearer to the reference line, by at most 1 − cos ≤ the fraction.
  const double reach_m = 0.5 * (to_s_m - from_s_m) * t.d1 + roll_fraction * (t.value + height_m);
  return {range.low_m - reach_m, range.high_m + reach_m};
}

// Of |t|·tan(crossfall).
double SideBorders::fall_d2(const CubicValue& t, double from_s_m, double to_s_m) const {
  if (fall_ == nullptr) return 0.0;
  const CubicValue fall = bounds(fall_, from_s_m, to_s_m);
  const double slope = std::tan(std::min(fall.value, kSteepestRad));
  const double gain = 1.0 + slope * slope;
  return t.d2 * slope + 2.0 * t.d1 * gain * fall.d1 +
         t.value * gain * (fall.d2 + 2.0 * slope * fall.d1 * fall.d1);
}

LateralShape::Bounds SideBorders::shape_bounds(double from_s_m, double to_s_m) const {
  LateralShape::Bounds worst;
  if (road_.shape.empty() && road_.strips.empty()) return worst;
  const double middle_s_m = 0.5 * (from_s_m + to_s_m);
  const double offset_m = value_at(offset_, middle_s_m);
  double t_m = offset_m;
  CubicValue t = bounds(offset_, from_s_m, to_s_m);
  for (std::size_t i = 0; i <= outer_.size(); ++i) {
    if (i > 0) {
      t_m = outer_offset_m(outer_[i - 1], t_m, offset_m, middle_s_m);
      add_bounds(bounds(outer_[i - 1].record, from_s_m, to_s_m), t);
    }
    const LateralShape::Bounds shape = road_.shape.bounds(from_s_m, to_s_m, t_m, t);
    const LateralShape::Bounds strips = road_.strips.bounds(from_s_m, to_s_m, t_m, t, side_.sign);
    worst.height.value = std::max(worst.height.value, shape.height.value + strips.height.value);
    worst.height.d1 = std::max(worst.height.d1, shape.height.d1 + strips.height.d1);
    worst.height.d2 = std::max(worst.height.d2, shape.height.d2 + strips.height.d2);
    worst.kinks = std::max(worst.kinks, shape.kinks + strips.kinks);
  }
  return worst;
}

CubicValue SideBorders::offset_bounds(double from_s_m, double to_s_m) const {
  CubicValue sum = bounds(offset_, from_s_m, to_s_m);
  for (const Outer& outer : outer_) add_bounds(bounds(outer.record, from_s_m, to_s_m), sum);
  return sum;
}

double SideBorders::outer_offset_m(const Outer& outer, double inner_m, double offset_m,
                                   double s_m) const {
  const double value_m = value_at(outer.record, s_m);
  return outer.by_width ? inner_m + side_.sign * value_m : offset_m + value_m;
}

void SideBorders::evaluate(double s_m, CrossSection& row) const {
  const geometry::Pose2 pose = geometry::plan_point(*piece_, s_m).pose;
  const double elevation_m = value_at(elevation_, s_m), roll_rad = value_at(roll_, s_m);
  const double fall = std::tan(value_at(fall_, s_m));
  const double cos_roll = std::cos(roll_rad), sin_roll = std::sin(roll_rad);
  const Eigen::Vector2d normal(-std::sin(pose.heading_rad), std::cos(pose.heading_rad));
  // Sideways and upward from the reference line.
  const auto on_surface = [&](double t) {
    const double h_m =
        road_.shape.height_m(s_m, t) + road_.strips.height_m(s_m, t, middle_s_m_, side_.sign);
    return Eigen::Vector2d(t * cos_roll - h_m * sin_roll,
                           t * sin_roll + h_m * cos_roll - std::abs(t) * fall);
  };
  const double offset_m = value_at(offset_, s_m);
  double t_m = offset_m;
  Eigen::Vector2d before = on_surface(t_m), place = before;
  row.s_m = s_m;
  row.border_in_map.assign(1, pose.position() + place.x() * normal);
  row.z_m.assign(1, elevation_m + place.y());
  for (std::size_t i = 0; i < outer_.size(); ++i) {
    const double inner_m = t_m;
    t_m = outer_offset_m(outer_[i], inner_m, offset_m, s_m);
    const Eigen::Vector2d here = on_surface(t_m);
    const bool level = side_.lanes[i]->level;
    place += level ? Eigen::Vector2d(t_m - inner_m, 0.0) : here - before;
    before = here;
    row.border_in_map.emplace_back(pose.position() + place.x() * normal);
    row.z_m.push_back(elevation_m + place.y());
  }
}

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

}  // namespace roadbed::map::opendrive
