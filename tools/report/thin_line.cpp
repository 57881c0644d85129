#include "roadbed/tools/report/thin_line.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace roadbed::tools::inline report {
namespace {

double distance_to_segment_m(const Eigen::Vector2d& point, const Eigen::Vector2d& from,
                             const Eigen::Vector2d& to) {
  const Eigen::Vector2d along = to - from;
  const double squared = along.squaredNorm();
  const double share = squared > 0.0 ? (point - from).dot(along) / squared : 0.0;
  return (point - from - std::clamp(share, 0.0, 1.0) * along).norm();
}

struct Farthest {
  std::size_t index;
  double distance_m;
};

Farthest farthest_between(const LineInSource& line, std::size_t first, std::size_t last) {
  Farthest farthest{first, 0.0};
  for (std::size_t i = first + 1; i < last; ++i) {
    const double distance_m = distance_to_segment_m(line[i], line[first], line[last]);
    if (distance_m > farthest.distance_m) farthest = {i, distance_m};
  }
  return farthest;
}

}  // namespace

LineInSource thin_line(const LineInSource& line, double tolerance_m) {
  if (line.size() < 3) return line;
  std::vector<bool> kept(line.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, line.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    const Farthest farthest = farthest_between(line, first, last);
    if (farthest.distance_m <= tolerance_m) continue;
    kept[farthest.index] = true;
    open.emplace_back(first, farthest.index);
    open.emplace_back(farthest.index, last);
  }
  LineInSource thinned;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (kept[i]) thinned.push_back(line[i]);
  }
  return thinned;
}

}  // namespace roadbed::tools
