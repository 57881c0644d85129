#include "roadbed/map/opendrive/write/beside_line.h"

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/primitives/cross.h"
#include "roadbed/map/opendrive/write/clothoid.h"

namespace roadbed::map::opendrive {
namespace {

constexpr double kChord_m = 5e-4;  // how far a straight chord may be from its points' line

class BorderPlacer {
 public:
  BorderPlacer(const geometry::PlanView& plan_view, double& least_bend)
      : plan_view_(plan_view), least_bend_(least_bend) {}

  BesideLine place(const RoadBorder& border, double from_m, double to_m) {
    BesideLine line;
    double hint_m = from_m;
    for (std::size_t i = 0; i < border.points.size(); ++i) {
      const RoadPosition at = foot(border.points[i].head<2>(), hint_m);
      if (i > 0) add_between(border.points[i - 1], border.points[i], line.back(), at, 0, line);
      line.push_back({at.s_m, at.t_m, border.points[i].z()});
      hint_m = at.s_m;
    }
    return cut(line, from_m, to_m);
  }

 private:
  RoadPosition foot(const Eigen::Vector2d& at, double hint_m) {
    const RoadPosition position = position_beside(plan_view_, at, hint_m);
    least_bend_ = std::min(least_bend_, position.bend);
    return position;
  }

  void add_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const BesidePoint from,
                   const RoadPosition& to, int depth, BesideLine& line) {
    if (depth > 9 || to.s_m - from.s_m < 0.05) return;
    const Eigen::Vector3d middle = 0.5 * (a + b);
    const RoadPosition at = foot(middle.head<2>(), 0.5 * (from.s_m + to.s_m));
    const double share = (at.s_m - from.s_m) / (to.s_m - from.s_m);
    const double off_m = at.t_m - from.t_m - share * (to.t_m - from.t_m);
    if (std::abs(off_m) < kChord_m) return;
    add_between(a, middle, from, at, depth + 1, line);
    const BesidePoint here{at.s_m, at.t_m, middle.z()};
    line.push_back(here);
    add_between(middle, b, here, to, depth + 1, line);
  }

  static BesideLine cut(const BesideLine& line, double from_m, double to_m) {
    BesideLine kept;
    const auto between = [](const BesidePoint& a, const BesidePoint& b, double s_m) {
      const double share = (s_m - a.s_m) / (b.s_m - a.s_m);
      return BesidePoint{s_m, a.t_m + share * (b.t_m - a.t_m), a.z_m + share * (b.z_m - a.z_m)};
    };
    constexpr double least_m = 1e-4;
    const BesidePoint* before = nullptr;
    for (const BesidePoint& point : line) {
      if (before != nullptr && point.s_m <= before->s_m) continue;  // runs back
      if (kept.empty() && point.s_m >= from_m) {
        kept.push_back(before == nullptr || point.s_m - from_m < 1e-9
                           ? BesidePoint{from_m, point.t_m, point.z_m}
                           : between(*before, point, from_m));
      }
      if (!kept.empty() && point.s_m > kept.back().s_m + least_m && point.s_m < to_m - least_m) {
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

  const geometry::PlanView& plan_view_;
  double& least_bend_;
};

}  // namespace

RoadPosition position_beside(const geometry::PlanView& plan_view, const Eigen::Vector2d& in_map,
                             double s_m) {
  const double end_m = plan_view.end_s_m();
  RoadPosition position;
  for (int step = 0; step < 30; ++step) {
    const double on_m = std::clamp(s_m, 0.0, end_m);
    const geometry::PlanPoint point = plan_view.at(on_m);
    const Eigen::Vector2d along = unit(point.pose.heading_rad);
    const Eigen::Vector2d off = in_map - point.pose.position() - (s_m - on_m) * along;
    position = {s_m, geometry::cross(along, off), 1.0};
    if (on_m == s_m) position.bend -= point.curvature_per_m * position.t_m;
    const double ahead_m = along.dot(off) / std::max(0.05, position.bend);
    if (std::abs(ahead_m) < 1e-10) break;
    s_m += std::clamp(ahead_m, -5.0, 5.0);
  }
  return position;
}

BesideLine line_beside(const geometry::PlanView& plan_view, const RoadBorder& border, double from_m,
                       double to_m, double& least_bend) {
  return BorderPlacer(plan_view, least_bend).place(border, from_m, to_m);
}

}  // namespace roadbed::map::opendrive
