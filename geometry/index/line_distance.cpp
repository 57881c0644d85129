#include "roadbed/geometry/index/line_distance.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "roadbed/geometry/primitives/segment.h"

namespace roadbed::geometry::inline index {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kRun = 8;         // segments
constexpr std::size_t kFewPoints = 48;  // that are all looked at sooner than a tree is made

double distance_m(std::span<const Vector2d> line, const Vector2d& point) {
  double least_m = HUGE_VAL;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    least_m = std::min(least_m, distance_to_segment_m(point, line[i], line[i + 1]));
  }
  return least_m;
}

}  // namespace

LineDistance::LineDistance(const Polyline& line) : line_(line) {
  const std::span<const Vector2d> points = line.points();
  if (points.size() <= kFewPoints) return;
  std::vector<Box> boxes;
  for (std::size_t i = 0; i + 1 < points.size(); i += kRun) {
    boxes.push_back(box_around(points.subspan(i, std::min(kRun + 1, points.size() - i))));
  }
  runs_ = BoxTree(boxes);
}

double LineDistance::to_run_m(std::size_t run, const Vector2d& point) const {
  const std::span<const Vector2d> points = line_.points();
  const std::size_t first = run * kRun;
  return distance_m(points.subspan(first, std::min(kRun + 1, points.size() - first)), point);
}

double LineDistance::operator()(const Vector2d& point) const {
  if (runs_.size() == 0) return distance_m(line_.points(), point);
  double least_m = HUGE_VAL;
  runs_.nearest(point, HUGE_VAL, [&](std::size_t run) {
    const double away_m = to_run_m(run, point);
    least_m = std::min(least_m, away_m);
    return away_m;
  });
  return least_m;
}

double farthest_m(const Polyline& from, const Polyline& to) {
  const LineDistance distance_m(to);
  double farthest = 0.0;
  for (const Vector2d& point : from.points()) farthest = std::max(farthest, distance_m(point));
  return farthest;
}

}  // namespace roadbed::geometry::index
