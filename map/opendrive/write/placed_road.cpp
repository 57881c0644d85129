#include "roadbed/map/opendrive/write/placed_road.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "roadbed/geometry/primitives/cross.h"
#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/map/opendrive/write/clothoid.h"
#include "roadbed/map/opendrive/write/reference_line.h"
#include "roadbed/map/opendrive/write/road_lines.h"

namespace roadbed::map::opendrive {
namespace {

constexpr double kScales_m[] = {0.7, 2.0, 6.0, 20.0};
constexpr double kReferenceTolerance_m = 0.004;
// Along a road of the map, which is one.
constexpr double kSourceScale_m = 0.05, kSourceTolerance_m = 1.5e-3, kSourceStep_m = 0.1;
constexpr double kLeastAcross_m = 0.2;  // between borders that say how a cross-section lies
constexpr double kLeastBend = 0.1;
constexpr double kBack_m = 0.005, kMissing_m = 0.005, kSideways_m = 2.0, kCrossing_m = 0.005;
constexpr double kShortest_m = 0.02;  // of a road between its ends
constexpr double kFine_m = 5e-4,
                 kCoarse_m = 0.01;  // of chords; to see soon that a line is no better

class RoadPlacer {
 public:
  RoadPlacer(const RoadMap& road_map, const PlannedRoad& road, std::size_t border,
             const std::array<EndLine, 2>& ends)
      : road_map_(road_map), road_(road) {
    for (const PlannedSection& section : road.sections) {
      auto& borders = borders_.emplace_back();
      for (std::size_t i = 0; i <= section.lanes.size(); ++i) {
        borders.push_back(border_along(road_map, section, i));
      }
    }
    for (const bool last : {false, true}) {
      may_end_[last] = borders_that_end(last, ends[last].is_rim);
      placed_.is_rim[last] = std::ranges::count(may_end_[last], true) > 0;
    }
    targets_.push_back(target(reference_along(road_map, road, border), ends));
    if (road.source) return;
    targets_.push_back(middle(ends));
    for (const std::size_t edge : {std::size_t{0}, borders_.front().size() - 1}) {
      if (edge != border) targets_.push_back(target(borders_.front()[edge], ends));
    }
  }

  PlacedRoad place(double most_m) {
    if (!place_source()) choose_reference(most_m);
    return std::move(placed_);
  }

 private:
  /// A reference line, and a bound of its fault.
  struct Try {
    std::vector<geometry::PlanPiece> line;
    double at_least_m;
  };

  // A road of the map, whose borders have a vertex at the same stations on a side: each
  // cross-section is known, and borders may turn back where the map's do.
  bool place_source() {
    if (!road_.source) return false;
    targets_.front().step_m = kSourceStep_m;
    take(fit_reference_line(targets_.front(), kSourceScale_m, kSourceTolerance_m));
    placed_.borders.clear();
    place_sections();
    for (std::size_t i = 0; i < road_.sections.size(); ++i) {
      const std::size_t middle = road_.sections[i].left_lanes,
                        count = road_.sections[i].lanes.size();
      placed_.borders.emplace_back(count + 1);
      // The border amid both sides is of the right one.
      const std::size_t left_borders = middle < count ? middle : count + 1;
      if (!place_side(i, {0, middle}, {0, left_borders}) ||
          !place_side(i, {middle, count}, {left_borders, count + 1})) {
        return false;
      }
    }
    return true;
  }

  // Which borders may end before the road does: all where it leads nowhere, else those of lanes
  // that lead nowhere, but the one from which others are measured.
  std::vector<bool> borders_that_end(bool last, bool is_rim) const {
    const PlannedSection& section = last ? road_.sections.back() : road_.sections.front();
    const auto& borders = last ? borders_.back() : borders_.front();
    std::vector<bool> may_end;
    for (std::size_t i = 0; i < borders.size(); ++i) {
      const bool goes_on =
          last ? borders[i].own_to + 1 < borders[i].points.size() : borders[i].own_from > 0;
      const bool is_joined = (i > 0 && leads_on(section.lanes[i - 1], last)) ||
                             (i < section.lanes.size() && leads_on(section.lanes[i], last));
      const bool is_own = road_.source || i == section.left_lanes || goes_on || is_joined;
      may_end.push_back(is_rim || !is_own);
    }
    return may_end;
  }

  bool leads_on(const PlannedLane& lane, bool last) const {
    const LaneLinks& links = road_map_.graph().of(lane.lane);
    return !(lane.forward == last ? links.successors : links.predecessors).empty();
  }

  using Places = std::pair<std::size_t, std::size_t>;  // from one up to before another

  bool place_side(std::size_t section, const Places& lanes, const Places& borders) {
    if (lanes.first == lanes.second) return true;
    const std::vector<double> s_m = stations(section, lanes);
    const double from_m = placed_.section_from_m[section],
                 to_m = placed_.section_from_m[section + 1];
    for (std::size_t i = borders.first; i < borders.second; ++i) {
      const RoadBorder& border = borders_[section][i];
      if (border.own_to - border.own_from + 1 != s_m.size()) return false;
      BesideLine& line = placed_.borders[section][i];
      for (std::size_t k = 0; k < s_m.size(); ++k) {
        const bool is_last = k + 1 == s_m.size();
        const double at_m = is_last ? to_m : k == 0 ? from_m : s_m[k];
        if (!line.empty() && (at_m <= line.back().s_m || (!is_last && at_m >= to_m))) continue;
        const Eigen::Vector3d& vertex = border.points[border.own_from + k];
        const ReferenceTable::Point point = reference_->at(at_m);
        line.push_back(
            {at_m, geometry::cross(point.along, vertex.head<2>() - point.in_map), vertex.z()});
      }
    }
    return true;
  }

  // Where the reference line meets each cross-section of a side, by its widest lane.
  std::vector<double> stations(std::size_t section, const Places& lanes) const {
    RoadBorder left, right;
    double widest_m = -1.0;
    for (std::size_t i = lanes.first; i < lanes.second; ++i) {
      const PlannedSection lane{{road_.sections[section].lanes[i]}, 0};
      RoadBorder edges[2] = {border_along(road_map_, lane, 0), border_along(road_map_, lane, 1)};
      const std::size_t amid = (edges[0].own_from + edges[0].own_to) / 2 - edges[0].own_from;
      const double width_m =
          (edges[0].points[edges[0].own_from + amid] - edges[1].points[edges[1].own_from + amid])
              .norm();
      if (width_m <= widest_m) continue;
      widest_m = width_m;
      left = std::move(edges[0]);
      right = std::move(edges[1]);
    }
    std::vector<double> s_m;
    double at_m = placed_.section_from_m[section];
    for (std::size_t i = left.own_from; i <= left.own_to; ++i) {
      const Eigen::Vector2d a = left.points[i].head<2>();
      if (i > left.own_from) {
        const Eigen::Vector2d step = a - left.points[i - 1].head<2>();
        const double on_m = std::min(at_m, reference_->end_s_m());
        at_m += std::max(0.0, reference_->at(on_m).along.dot(step));
      }
      const Eigen::Vector2d across = right.points[i - left.own_from + right.own_from].head<2>() - a;
      at_m = across.norm() > kLeastAcross_m ? on_cross_section(a, across.normalized(), at_m)
                                            : position_beside(*reference_, a, at_m).s_m;
      s_m.push_back(at_m);
    }
    return s_m;
  }

  // By Newton's method from a station nearby on.
  double on_cross_section(const Eigen::Vector2d& in_map, const Eigen::Vector2d& across,
                          double s_m) const {
    constexpr double longest_m = 1.0;
    for (int step = 0; step < 50; ++step) {
      const double on_m = std::clamp(s_m, 0.0, reference_->end_s_m());
      const ReferenceTable::Point point = reference_->at(on_m);
      const double off_m =
          geometry::cross(across, point.in_map + (s_m - on_m) * point.along - in_map);
      const double ahead_m = -off_m / std::max(0.1, geometry::cross(across, point.along));
      s_m += std::clamp(ahead_m, -longest_m, longest_m);
      if (std::abs(ahead_m) < 1e-7) break;
    }
    return s_m;
  }

  // The first sound one of: along the border, the middle, either edge (nothing folds inside of the
  // inner one in a bend), each ever smoother. Else the one with the least fault, those first that
  // have the least along coarse chords.
  void choose_reference(double most_m) {
    std::vector<Try> tries;
    for (const ReferenceTarget& target : targets_) {
      for (const double scale_m : kScales_m) {
        take(fit_reference_line(target, scale_m, kReferenceTolerance_m));
        judge(most_m, kCoarse_m);
        if (placed_.fault_m <= 0.0) judge(most_m, kFine_m);
        if (placed_.fault_m <= 0.0) return;
        if (placed_.fault_m < most_m) tries.push_back({placed_.plan_view, placed_.fault_m});
      }
    }
    std::ranges::stable_sort(tries, {}, &Try::at_least_m);
    double least_m = most_m;
    const Try* best = nullptr;
    for (const Try& one : tries) {
      if (one.at_least_m >= least_m) break;
      take(one.line);
      judge(least_m, kFine_m);
      if (placed_.fault_m >= least_m) continue;
      least_m = placed_.fault_m;
      best = &one;
    }
    placed_.fault_m = most_m;
    if (best == nullptr) return;
    take(best->line);
    judge(1e300, kFine_m);
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

  void take(std::vector<geometry::PlanPiece> line) {
    placed_.plan_view = std::move(line);
    reference_.emplace(placed_.plan_view);
  }

  // Stops where there are as many faults as may be. Along coarser chords it sees no more of them.
  void judge(double most_m, double chord_m) {
    placed_.faults = {};
    placed_.fault_m = 0.0;
    if (!place_borders(most_m, chord_m)) return;
    for (const auto& lines : placed_.borders) {
      for (std::size_t i = 1; i < lines.size(); ++i) note_crossing(lines[i - 1], lines[i]);
    }
    note_folds();
    sum_faults(chord_m);
  }

  static double uncertain_m(double chord_m) { return 2.0 * (chord_m - kFine_m); }

  void sum_faults(double chord_m) {
    const auto over = [](double fault, double allowed) { return std::max(0.0, fault - allowed); };
    placed_.fault_m = over(kLeastBend, placed_.faults.least_bend + uncertain_m(chord_m)) +
                      over(placed_.faults.back_m, kBack_m) +
                      over(placed_.faults.missing_m, kMissing_m) +
                      over(placed_.faults.sideways_m, kSideways_m) +
                      over(placed_.faults.crossing_m, kCrossing_m + uncertain_m(chord_m));
  }

  // Vertices of a border may lie on both sides of a fold: all along the line, too.
  void note_folds() {
    constexpr double step_m = 0.25;
    for (std::size_t i = 0; i < placed_.borders.size(); ++i) {
      for (const BesideLine* edge : {&placed_.borders[i].front(), &placed_.borders[i].back()}) {
        std::size_t hint = 0;
        for (const geometry::PlanPiece& piece : placed_.plan_view) {
          const double steps = std::ceil(piece.length_m / step_m);
          const auto [from_per_m, to_per_m] = curvatures_per_m(piece.curve);
          for (double k = 0.0; k <= steps; k += 1.0) {
            const double s_m = piece.s_m + k / steps * piece.length_m;
            if (s_m < placed_.section_from_m[i] || s_m > placed_.section_from_m[i + 1]) continue;
            const double curvature_per_m = from_per_m + k / steps * (to_per_m - from_per_m);
            placed_.faults.least_bend = std::min(
                placed_.faults.least_bend, 1.0 - curvature_per_m * point_at(*edge, s_m, hint).t_m);
          }
        }
      }
    }
  }

  void note_crossing(const BesideLine& left, const BesideLine& right) {
    std::size_t at_left = 0, at_right = 0;
    const auto note = [&](double s_m) {
      const double width_m = point_at(left, s_m, at_left).t_m - point_at(right, s_m, at_right).t_m;
      placed_.faults.crossing_m = std::max(placed_.faults.crossing_m, -width_m);
    };
    for (const BesidePoint& point : left) note(point.s_m);
    at_left = at_right = 0;
    for (const BesidePoint& point : right) note(point.s_m);
  }

  bool place_borders(double most_m, double chord_m) {
    placed_.borders.clear();
    placed_.reach.clear();
    place_sections();
    for (std::size_t i = 0; i < road_.sections.size(); ++i) {
      auto& lines = placed_.borders.emplace_back();
      auto& reach = placed_.reach.emplace_back();
      const bool is_first = i == 0, is_last = i + 1 == road_.sections.size();
      const double from_m = placed_.section_from_m[i], to_m = placed_.section_from_m[i + 1];
      for (std::size_t k = 0; k < borders_[i].size(); ++k) {
        const std::array<bool, 2> may_end{is_first && may_end_[0][k], is_last && may_end_[1][k]};
        const BesideOptions options{.chord_m = chord_m,
                                    .hopeless_bend = kLeastBend - most_m - uncertain_m(chord_m),
                                    .may_end = may_end};
        PlacedBorder placed =
            line_beside(*reference_, borders_[i][k], from_m, to_m, placed_.faults, options);
        lines.push_back(std::move(placed.line));
        reach.push_back({may_end[0] ? placed.from_m : from_m, may_end[1] ? placed.to_m : to_m});
        sum_faults(chord_m);
        if (placed_.fault_m >= most_m) return false;
      }
    }
    return true;
  }

  void place_sections() {
    placed_.section_from_m.clear();
    double hint_m = 0.0;
    for (std::size_t i = 0; i < road_.sections.size(); ++i) {
      if (i > 0) hint_m = boundary_s_m(i, hint_m);
      placed_.section_from_m.push_back(hint_m);
    }
    placed_.section_from_m.push_back(reference_->end_s_m());
  }

  // Where a section begins: at the foot of its middle border's first point.
  double boundary_s_m(std::size_t section, double from_m) const {
    const RoadBorder& border = borders_[section][road_.sections[section].left_lanes];
    const Eigen::Vector2d at = border.points[border.own_from].head<2>();
    double nearest_m = from_m, least_m = 1e300;
    for (double s_m = from_m; s_m <= reference_->end_s_m(); s_m += 1.0) {
      const double off_m = (reference_->at(s_m).in_map - at).norm();
      if (off_m < least_m) {
        least_m = off_m;
        nearest_m = s_m;
      }
    }
    const double s_m = position_beside(*reference_, at, nearest_m).s_m;
    return std::clamp(s_m, from_m + 1e-3, std::max(from_m + 1e-3, reference_->end_s_m() - 1e-3));
  }

  const RoadMap& road_map_;
  const PlannedRoad& road_;
  std::vector<std::vector<RoadBorder>> borders_;  // by section, from left to right
  std::array<std::vector<bool>, 2> may_end_;      // at each end, by border
  std::vector<ReferenceTarget> targets_;          // what the reference line may follow
  std::optional<ReferenceTable> reference_;
  PlacedRoad placed_;
};

}  // namespace

geometry::Pose2 PlacedRoad::end_pose(bool last) const {
  const geometry::PlanPiece& piece = last ? plan_view.back() : plan_view.front();
  return geometry::plan_point(piece, last ? piece.s_m + piece.length_m : piece.s_m).pose;
}

Eigen::Vector2d PlacedRoad::end_point(bool last, std::size_t border) const {
  const BesideLine& line = last ? borders.back()[border] : borders.front()[border];
  return end_pose(last) * Eigen::Vector2d(0.0, last ? line.back().t_m : line.front().t_m);
}

PlacedRoad place_road(const RoadMap& road_map, const PlannedRoad& road, std::size_t border,
                      const std::array<EndLine, 2>& ends, double most_m) {
  return RoadPlacer(road_map, road, border, ends).place(most_m);
}

}  // namespace roadbed::map::opendrive
