#include "roadbed/map/opendrive/sample_borders.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "roadbed/map/files/coordinate_limits.h"

namespace roadbed::map::opendrive {
namespace {

// Shorter stretches hold no curve worth a point.
constexpr double kShortestStretchM = 1e-9;
// Records of real files meet within fractions of a millimetre, sometimes stepping back: rows this
// near to each other, as a fraction of the allowed error, are one. The chord takes the rest of it:
// (1 − u)(0.11 + 4 · 0.94 u) < 1 for every place u along a chord with one end moved.
constexpr double kSameRowFraction = 0.11, kChordFraction = 0.94;
// A step that just fits must not fail by its rounding.
constexpr double kAlmost = 1.0 - 1e-9;
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
        stretch_(road, plan_view, side),
        max_error_m_(max_error_m),
        budget_(budget) {
    lines_.borders.resize(side.lanes.size() + 1);
  }

  SideLines sample() {
    const std::vector<double> breaks = breakpoints();
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
      stretch_.enter(breaks[i], breaks[i + 1]);
      set_stations(breaks[i], breaks[i + 1]);
      for (const double s_m : stations_m_) {
        stretch_.evaluate(s_m, row_);
        check(row_);
        const bool is_end = i + 2 == breaks.size() && s_m == breaks.back();
        if (lines_.s_m.empty() || !is_same_as_last()) {
          add_row();
        } else if (is_end && lines_.s_m.size() > 1) {  // ends stay where they are
          remove_row();
          add_row();
        }
      }
    }
    return std::move(lines_);
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
    add(road_.elevation.cubic.records());
    add(road_.superelevation.cubic.records());
    add(road_.lane_offset.cubic.records());
    add(road_.shape.profiles());
    const auto& strips_m = road_.strips.stations_m();
    breaks.insert(breaks.end(), std::ranges::lower_bound(strips_m, side_.from_s_m),
                  std::ranges::upper_bound(strips_m, side_.to_s_m));
    add((side_.sign > 0 ? road_.crossfall_left : road_.crossfall_right).records());
    for (const LaneRecord* lane : side_.lanes) {
      add(lane->width.cubic.records());
      add(lane->border.cubic.records());
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

  // Stations along a stretch, as far apart as the error allows.
  void set_stations(double from_s_m, double to_s_m) {
    const double chord_error_m = kChordFraction * max_error_m_;
    stations_m_.assign(1, from_s_m);
    double step_m = to_s_m - from_s_m;
    while (stations_m_.back() < to_s_m) {
      const double s_m = stations_m_.back();
      step_m = std::min(to_s_m - s_m, 2.0 * step_m);
      while (step_m > kShortestStepM) {
        const double bound = stretch_.second_derivative_bound(s_m, s_m + step_m);
        if (step_m * step_m * bound <= 8.0 * chord_error_m) break;
        const double fitting_m = kAlmost * std::sqrt(8.0 * chord_error_m / bound);
        const double half_m = 0.5 * step_m;  // also of a bound that is no number
        step_m =
            std::max(fitting_m < step_m ? std::max(half_m, fitting_m) : half_m, kShortestStepM);
      }
      const bool at_end = to_s_m - s_m - step_m < kShortestStretchM;
      stations_m_.push_back(at_end ? to_s_m : s_m + step_m);
      budget_.spend(side_.lanes.size() + 1, road_index_);
    }
  }

  void check(const CrossSection& row) const {
    for (std::size_t i = 0; i < row.border_in_map.size(); ++i) {
      // Written so that a value that is no number fails too.
      if (!(row.border_in_map[i].cwiseAbs().maxCoeff() < kFarthestM) ||
          !(std::abs(row.z_m[i]) < kFarthestM)) {
        throw RoadFault(road_index_,
                        fmt::format("at s = {} m a border lies more than 100,000 km off", row.s_m),
                        "check its widths, offsets and elevations");
      }
    }
  }

  bool is_same_as_last() const {
    const double near_m = kSameRowFraction * max_error_m_;
    for (std::size_t i = 0; i < row_.border_in_map.size(); ++i) {
      const BorderLine& line = lines_.borders[i];
      if ((line.points.back() - row_.border_in_map[i]).norm() > near_m) return false;
      if (std::abs(line.z_m.back() - row_.z_m[i]) > near_m) return false;
    }
    return lines_.raised.empty() || lines_.raised.back() == stretch_.raised();
  }

  void add_row() {
    if (!stretch_.raised().empty()) lines_.raised.push_back(stretch_.raised());
    lines_.s_m.push_back(row_.s_m);
    for (std::size_t i = 0; i < row_.border_in_map.size(); ++i) {
      lines_.borders[i].points.push_back(row_.border_in_map[i]);
      lines_.borders[i].z_m.push_back(row_.z_m[i]);
    }
  }

  void remove_row() {
    if (!lines_.raised.empty()) lines_.raised.pop_back();
    lines_.s_m.pop_back();
    for (BorderLine& line : lines_.borders) {
      line.points.pop_back();
      line.z_m.pop_back();
    }
  }

  const RoadRecord& road_;
  std::size_t road_index_;
  const geometry::PlanView& plan_view_;
  const SectionSide& side_;
  SideBorders stretch_;
  double max_error_m_;
  PointBudget& budget_;
  std::vector<double> stations_m_;  // of the stretch that is being sampled
  CrossSection row_;
  SideLines lines_;
};

}  // namespace

SideLines sample_side(const RoadRecord& road, std::size_t road_index,
                      const geometry::PlanView& plan_view, const SectionSide& side,
                      double max_error_m, PointBudget& budget) {
  if (side.lanes.empty() || !(side.to_s_m - side.from_s_m > kShortestStretchM)) return {};
  return SideSampler(road, road_index, plan_view, side, max_error_m, budget).sample();
}

}  // namespace roadbed::map::opendrive
