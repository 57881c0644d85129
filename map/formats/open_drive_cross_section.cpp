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
// (1 − u)(0.35 + 4 · 0.8 u) < 1 for every place u along a chord with one end moved.
constexpr double kSameRowShare = 0.35, kChordShare = 0.8;
// A bound that is no use (a curve that stands still) must not ask for endless points.
constexpr double kShortestStepM = 1e-3;

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
    const auto add = [&](const geometry::PiecewiseCubic& cubic) {
      for (const auto& record : cubic.records()) breaks.push_back(record.s_m);
    };
    for (const auto& piece : plan_view_.pieces()) breaks.push_back(piece.s_m);
    add(road_.elevation);
    add(road_.superelevation);
    add(road_.lane_offset);
    add(crossfall());
    for (const LaneRecord* lane : side_.lanes) {
      add(lane->width);
      add(lane->border);
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
        step_m = std::max(0.5 * step_m, 0.95 * std::sqrt(8.0 * chord_error_m / bound));
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

  // |position″ + (t·normal)″| ≤ R″ + t″ + 2 t′θ′ + t (θ″ + θ′²), with t·cos(roll) for t; and the
  // height's second derivative beside it.
  double second_derivative_bound(double from_s_m, double to_s_m) const {
    const geometry::PlanBounds plan = plan_view_.bounds(from_s_m, to_s_m);
    const geometry::CubicValue roll = road_.superelevation.bounds(from_s_m, to_s_m);
    const geometry::CubicValue t = offset_bounds(from_s_m, to_s_m);
    const double roll_d2 = 2.0 * t.d1 * roll.d1 + t.value * (roll.d2 + roll.d1 * roll.d1);
    const double t_d1 = t.d1 + t.value * roll.d1, t_d2 = t.d2 + roll_d2;
    const double turning = plan.heading_d2_per_m2 + plan.heading_d1_per_m * plan.heading_d1_per_m;
    const double in_plan = plan.second_derivative_per_m + t_d2 +
                           2.0 * t_d1 * plan.heading_d1_per_m + t.value * turning;
    const double roll_share = std::min(1.0, roll.value);
    const double height = road_.elevation.bounds(from_s_m, to_s_m).d2 + roll_d2 + roll_share * t.d2;
    return std::hypot(in_plan, height);
  }

  geometry::CubicValue offset_bounds(double from_s_m, double to_s_m) const {
    geometry::CubicValue sum = road_.lane_offset.bounds(from_s_m, to_s_m);
    for (const LaneRecord* lane : side_.lanes) {
      const auto& cubic = lane->border.empty() ? lane->width : lane->border;
      const geometry::CubicValue lane_bounds = cubic.bounds(from_s_m, to_s_m);
      sum.value += lane_bounds.value;
      sum.d1 += lane_bounds.d1;
      sum.d2 += lane_bounds.d2;
    }
    return sum;
  }

  CrossSection cross_section(double s_m, double record_s_m) const {
    const geometry::Pose2 pose = plan_view_.at(s_m, record_s_m).pose;
    const double roll_rad = road_.superelevation.at(s_m, record_s_m).value;
    const double elevation_m = road_.elevation.at(s_m, record_s_m).value;
    const double fall = std::tan(crossfall().at(s_m, record_s_m).value);
    const Eigen::Vector2d normal(-std::sin(pose.heading_rad), std::cos(pose.heading_rad));
    CrossSection row{s_m, {}, {}};
    for (const double t_m : offsets(s_m, record_s_m)) {
      row.border_in_map.emplace_back(pose.position() + t_m * std::cos(roll_rad) * normal);
      row.z_m.push_back(elevation_m + t_m * std::sin(roll_rad) - std::abs(t_m) * fall);
    }
    return row;
  }

  std::vector<double> offsets(double s_m, double record_s_m) const {
    const double offset_m = road_.lane_offset.at(s_m, record_s_m).value;
    std::vector<double> t_m{offset_m};
    for (const LaneRecord* lane : side_.lanes) {
      const double outer_m = lane->border.empty()
                                 ? t_m.back() + side_.sign * lane->width.at(s_m, record_s_m).value
                                 : offset_m + lane->border.at(s_m, record_s_m).value;
      t_m.push_back(outer_m);
    }
    return t_m;
  }

  bool same(const CrossSection& a, const CrossSection& b) const {
    const double near_m = kSameRowShare * max_error_m_;
    for (std::size_t i = 0; i < a.border_in_map.size(); ++i) {
      if ((a.border_in_map[i] - b.border_in_map[i]).norm() > near_m) return false;
      if (std::abs(a.z_m[i] - b.z_m[i]) > near_m) return false;
    }
    return true;
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
  for (std::size_t i = section + 1; i < road.sections.size(); ++i) {
    const auto& lanes = road.sections[i].lanes;
    const bool has_side =
        !lanes.empty() && (sign > 0 ? lanes.rbegin()->first > 0 : lanes.begin()->first < 0);
    if (!road.sections[i].single_side || has_side) return i;
  }
  return road.sections.size();
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
