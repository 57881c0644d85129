#include "roadbed/map/opendrive/write/beside_line.h"

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/primitives/cross.h"

namespace roadbed::map::opendrive {
namespace {

constexpr double kLongest_m = 10.0;  // of a chord: over more, the road may bend both ways
constexpr double kShortestChord_m = 0.05;
constexpr int kMostHalvings = 9;
constexpr double kAtEnd_m = 1e-4;  // a border that ends so near to the road's end ends there

class BorderPlacer {
 public:
  BorderPlacer(const ReferenceTable& reference, BesideFaults& faults, const BesideOptions& options)
      : reference_(reference), faults_(faults), options_(options) {}

  // From the border's own start on, and before it, as far as the road goes.
  PlacedBorder place(const RoadBorder& border, double from_m, double to_m) {
    const Line3& points = border.points;
    const RoadPosition start = foot(points[border.own_from].head<2>(), from_m);
    const BesidePoint first{start.s_m, start.t_m, points[border.own_from].z()};
    BesideLine before{first}, line{first};
    for (std::size_t i = border.own_from; i > 0 && before.back().s_m > from_m + kAtEnd_m; --i) {
      add(points[i], points[i - 1], -1.0, before);
    }
    for (std::size_t i = border.own_from + 1;
         i < points.size() && (i <= border.own_to || line.back().s_m < to_m - kAtEnd_m); ++i) {
      add(points[i - 1], points[i], 1.0, line);
    }
    std::reverse(before.begin(), before.end());
    line.insert(line.begin(), before.begin(), before.end() - 1);
    judge(line, border, from_m, to_m);
    double farthest_m = line.front().s_m;
    for (const BesidePoint& point : line) farthest_m = std::max(farthest_m, point.s_m);
    return {cut(line, from_m, to_m), std::max(from_m, line.front().s_m),
            std::min(to_m, farthest_m)};
  }

 private:
  void add(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double sense, BesideLine& line) {
    const double ahead_m = sense * (to - from).head<2>().norm();
    const RoadPosition at = foot(to.head<2>(), line.back().s_m + ahead_m);
    add_between(from, to, line.back(), at, 0, line);
    line.push_back({at.s_m, at.t_m, to.z()});
  }

  RoadPosition foot(const Eigen::Vector2d& at, double hint_m) {
    const RoadPosition position = position_beside(reference_, at, hint_m);
    faults_.least_bend = std::min(faults_.least_bend, position.bend);
    return position;
  }

  void add_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const BesidePoint from,
                   const RoadPosition& to, int depth, BesideLine& line) {
    const double length_m = std::abs(to.s_m - from.s_m);
    if (length_m < kShortestChord_m || faults_.least_bend < options_.hopeless_bend) return;
    // Where the reference line goes on as another curve, else in the middle.
    const double low_m = std::min(from.s_m, to.s_m), high_m = std::max(from.s_m, to.s_m);
    const auto joint_m =
        reference_.joint_between(low_m + kShortestChord_m, high_m - kShortestChord_m);
    if (depth > (joint_m ? kMostHalvings + 3 : kMostHalvings)) return;
    const double split_m = joint_m.value_or(0.5 * (from.s_m + to.s_m));
    if (!joint_m && length_m < kLongest_m && is_straight(a, b, from, to)) return;
    const Eigen::Vector3d middle = a + (split_m - from.s_m) / (to.s_m - from.s_m) * (b - a);
    const RoadPosition at = foot(middle.head<2>(), split_m);
    add_between(a, middle, from, at, depth + 1, line);
    const BesidePoint here{at.s_m, at.t_m, middle.z()};
    line.push_back(here);
    add_between(middle, b, here, to, depth + 1, line);
  }

  // Whether what is straight in (s, t) is so in the map.
  bool is_straight(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const BesidePoint& from,
                   const RoadPosition& to) const {
    const Eigen::Vector2d along = (b - a).head<2>().normalized();
    for (const double share : {0.25, 0.5, 0.75}) {
      const double s_m = from.s_m + share * (to.s_m - from.s_m);
      const double t_m = from.t_m + share * (to.t_m - from.t_m);
      const double on_m = std::clamp(s_m, 0.0, reference_.end_s_m());
      const ReferenceTable::Point point = reference_.at(on_m);
      const Eigen::Vector2d beside = point.beside(t_m) + (s_m - on_m) * point.along;
      if (std::abs(geometry::cross(along, beside - a.head<2>())) > options_.chord_m) return false;
    }
    return true;
  }

  static BesideLine cut(const BesideLine& line, double from_m, double to_m) {
    BesideLine kept;
    const auto between = [](const BesidePoint& a, const BesidePoint& b, double s_m) {
      const double share = (s_m - a.s_m) / (b.s_m - a.s_m);
      return BesidePoint{s_m, a.t_m + share * (b.t_m - a.t_m), a.z_m + share * (b.z_m - a.z_m)};
    };
    const BesidePoint* before = nullptr;
    for (const BesidePoint& point : line) {
      if (before != nullptr && point.s_m <= before->s_m) continue;  // runs back
      if (kept.empty() && point.s_m >= from_m) {
        kept.push_back(before == nullptr || point.s_m - from_m < 1e-9
                           ? BesidePoint{from_m, point.t_m, point.z_m}
                           : between(*before, point, from_m));
      }
      if (!kept.empty() && point.s_m > kept.back().s_m + kAtEnd_m && point.s_m < to_m - kAtEnd_m) {
        kept.push_back(point);
      }
      if (before != nullptr && point.s_m >= to_m) {
        if (kept.empty()) kept.push_back(between(*before, point, from_m));
        kept.push_back(between(*before, point, to_m));
        return kept;
      }
      before = &point;
    }
    const BesidePoint last = line.empty() ? BesidePoint{0, 0, 0} : line.back();
    if (kept.empty()) kept.push_back({from_m, last.t_m, last.z_m});
    kept.push_back({to_m, last.t_m, last.z_m});
    return kept;
  }

  void judge(const BesideLine& line, const RoadBorder& border, double from_m, double to_m) {
    constexpr double steepest = 3.0;
    double sideways_m = 0.0, farthest_m = line.front().s_m;
    for (std::size_t i = 1; i < line.size(); ++i) {
      const BesidePoint &a = line[i - 1], &b = line[i];
      const bool inside = std::max(a.s_m, b.s_m) > from_m && std::min(a.s_m, b.s_m) < to_m;
      if (!inside) continue;
      const double along_m = std::max(0.0, b.s_m - a.s_m);
      sideways_m = std::max(0.0, sideways_m + std::abs(b.t_m - a.t_m) - steepest * along_m);
      faults_.sideways_m = std::max(faults_.sideways_m, sideways_m);
      farthest_m = std::max(farthest_m, a.s_m);
      faults_.back_m = std::max(faults_.back_m, std::min(farthest_m, to_m) - b.s_m);
    }
    farthest_m = std::max(farthest_m, line.back().s_m);
    // What reaches beyond the road is lost where it does not go on.
    const bool begins = border.own_from == 0, ends = border.own_to + 1 == border.points.size();
    faults_.missing_m =
        std::max({faults_.missing_m, options_.may_end[0] ? 0.0 : line.front().s_m - from_m,
                  options_.may_end[1] ? 0.0 : to_m - farthest_m,
                  begins ? from_m - line.front().s_m : 0.0, ends ? line.back().s_m - to_m : 0.0});
  }

  const ReferenceTable& reference_;
  BesideFaults& faults_;
  const BesideOptions options_;
};

}  // namespace

RoadPosition position_beside(const ReferenceTable& reference, const Eigen::Vector2d& in_map,
                             double s_m) {
  const double end_m = reference.end_s_m();
  RoadPosition position;
  for (int step = 0; step < 30; ++step) {
    const double on_m = std::clamp(s_m, 0.0, end_m);
    const ReferenceTable::Point point = reference.at(on_m);
    const Eigen::Vector2d off = in_map - point.in_map - (s_m - on_m) * point.along;
    position = {s_m, geometry::cross(point.along, off), 1.0};
    if (on_m == s_m) position.bend -= point.curvature_per_m * position.t_m;
    const double ahead_m = point.along.dot(off) / std::max(0.05, position.bend);
    const double next_m = s_m + std::clamp(ahead_m, -5.0, 5.0);
    // The road bends where it ends, too, so that no step leads from the straight beyond into it.
    const bool enters = on_m != s_m && (next_m > on_m) == (on_m > s_m);
    s_m = enters ? on_m : next_m;
    if (std::abs(ahead_m) < 1e-5) {  // what is left is smaller by as much again
      position.s_m = s_m;
      break;
    }
  }
  return position;
}

BesidePoint point_at(const BesideLine& line, double s_m, std::size_t& hint) {
  while (hint + 2 < line.size() && line[hint + 1].s_m <= s_m) ++hint;
  const BesidePoint &a = line[hint], &b = line[std::min(hint + 1, line.size() - 1)];
  const double share = b.s_m > a.s_m ? std::clamp((s_m - a.s_m) / (b.s_m - a.s_m), 0.0, 1.0) : 0.0;
  return {s_m, a.t_m + share * (b.t_m - a.t_m), a.z_m + share * (b.z_m - a.z_m)};
}

BesideLine clipped(const BesideLine& line, double from_m, double to_m) {
  std::size_t hint = 0;
  BesideLine kept{point_at(line, from_m, hint)};
  for (const BesidePoint& point : line) {
    if (point.s_m > from_m + 1e-6 && point.s_m < to_m - 1e-6) kept.push_back(point);
  }
  kept.push_back(point_at(line, to_m, hint));
  return kept;
}

PlacedBorder line_beside(const ReferenceTable& reference, const RoadBorder& border, double from_m,
                         double to_m, BesideFaults& faults, const BesideOptions& options) {
  return BorderPlacer(reference, faults, options).place(border, from_m, to_m);
}

}  // namespace roadbed::map::opendrive
