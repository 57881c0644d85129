#include "roadbed/map/index/lane_index.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "roadbed/geometry/index/hilbert.h"
#include "roadbed/map/index/nearest_lanes.h"

namespace roadbed::map::inline index {
namespace {

using lane_index::Box;
using lane_index::Cell;
using lane_index::Data;
using lane_index::Node;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_searchable(const Eigen::Vector2d& point, const LaneQuery& query) {
  return point.allFinite() && query.radius_m >= 0.0 && query.count > 0;
}

constexpr double kRounding_m = 1e-6;

// Distance of the farthest of as many lanes as asked for, infinite if there were fewer. From a
// point beside they are no farther than that and the way there.
double farthest_m(const std::vector<LaneMatch>& found, const LaneQuery& query) {
  return found.size() == query.count ? found.back().distance_m : kInfinity;
}

// Indices of points along a Hilbert curve through their bounding box.
std::vector<std::uint32_t> along_hilbert_curve(std::span<const Eigen::Vector2d> points) {
  Eigen::Vector2d low(kInfinity, kInfinity), high = -low;
  for (const Eigen::Vector2d& point : points) {
    if (!point.allFinite()) continue;
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  std::vector<std::uint32_t> keys;
  keys.reserve(points.size());
  for (const Eigen::Vector2d& point : points) {
    const Eigen::Vector2d fraction = (point - low).cwiseQuotient((high - low).cwiseMax(1e-9));
    const auto scaled = [](double value) {  // what is not finite goes anywhere
      return static_cast<std::uint32_t>(std::min(std::max(0.0, value), 1.0) * 65535.0);
    };
    keys.push_back(geometry::hilbert_index(scaled(fraction.x()), scaled(fraction.y())));
  }
  return geometry::order_of_keys(keys);
}

}  // namespace

LaneIndex::LaneIndex(lane_index::Data data)
    : data_(std::move(data)), level_starts_(lane_index::level_starts(data_.cells.size())) {
  if (data_.nodes.size() != level_starts_.back() || data_.order.size() != data_.cells.size()) {
    throw std::invalid_argument("LaneIndex: its arrays do not fit each other");
  }
}

std::vector<LaneMatch> LaneIndex::near(const Eigen::Vector2d& point_in_map,
                                       const LaneQuery& query) const {
  if (!is_searchable(point_in_map, query)) return {};
  static thread_local lane_index::Scratch scratch;
  lane_index::find_nearest(data_, level_starts_, query, point_in_map, kInfinity, scratch);
  return scratch.found;
}

bool LaneIndex::is_any_near(const Eigen::Vector2d& point_in_map, const LaneQuery& query) const {
  if (!is_searchable(point_in_map, query)) return false;
  static thread_local lane_index::Scratch scratch;
  return lane_index::is_any_near(data_, level_starts_, query, point_in_map, scratch);
}

LaneMatches LaneIndex::near(std::span<const Eigen::Vector2d> points_in_map,
                            const LaneQuery& query) const {
  LaneMatches matches;
  matches.ranges.resize(points_in_map.size());
  lane_index::Scratch scratch;
  Eigen::Vector2d last = Eigen::Vector2d::Constant(kInfinity);
  for (const std::uint32_t i : along_hilbert_curve(points_in_map)) {
    const Eigen::Vector2d& point = points_in_map[i];
    if (!is_searchable(point, query)) continue;
    const double at_most_m = farthest_m(scratch.found, query) + (point - last).norm();
    lane_index::find_nearest(data_, level_starts_, query, point, at_most_m + kRounding_m, scratch);
    last = point;
    matches.ranges[i].from = matches.all.size();
    matches.all.insert(matches.all.end(), scratch.found.begin(), scratch.found.end());
    matches.ranges[i].to = matches.all.size();
  }
  return matches;
}

std::vector<LaneId> LaneIndex::in_box(const Eigen::Vector2d& low_in_map,
                                      const Eigen::Vector2d& high_in_map,
                                      const LaneTypes& types) const {
  const auto meets = [&](const Box& box) {
    return box.low_x <= high_in_map.x() && box.low_y <= high_in_map.y() &&
           box.high_x >= low_in_map.x() && box.high_y >= low_in_map.y();
  };
  std::vector<LaneId> found;
  std::vector<std::pair<std::size_t, std::uint64_t>> todo;  // level, box
  if (data_.cells.size() > 0) todo.emplace_back(level_starts_.size() - 1, 0);
  while (!todo.empty()) {
    const auto [level, at] = todo.back();
    todo.pop_back();
    if (level == 0) {
      const Cell& cell = data_.cells[data_.order[at]];
      if (types.has(cell.lane_type)) found.push_back(LaneId{cell.lane});
      continue;
    }
    const Node& node = data_.nodes[level_starts_[level - 1] + at];
    for (std::size_t i = 0; i < Node::kWidth; ++i) {
      if (meets({node.low_x[i], node.low_y[i], node.high_x[i], node.high_y[i]})) {
        todo.emplace_back(level - 1, at * Node::kWidth + i);
      }
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

geometry::Box LaneIndex::box() const {
  geometry::Box box;
  if (data_.nodes.size() == 0) return box;
  const Node& root = data_.nodes[data_.nodes.size() - 1];
  for (std::size_t i = 0; i < Node::kWidth; ++i) {
    if (root.low_x[i] > root.high_x[i]) continue;  // nothing is there
    box.extend(Eigen::Vector2d(root.low_x[i], root.low_y[i]));
    box.extend(Eigen::Vector2d(root.high_x[i], root.high_y[i]));
  }
  return box;
}

}  // namespace roadbed::map::index
