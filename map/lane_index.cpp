#include "roadbed/map/lane_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace roadbed::map {
namespace {

using lane_index::Box;
using lane_index::Cell;
using lane_index::Data;
using lane_index::LaneRecord;
using lane_index::Node;
using lane_index::Point;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Nearer to its border than this a point is on it, and so inside the lane.
constexpr double kOnBorder_m2 = 1e-18;

struct Candidate {
  std::uint32_t lane = 0;
  bool inside = false;
  double squared_m2 = kInfinity;  ///< to the lane's ring
};

/// Nearest place of a centreline.
struct Foot {
  double squared_m2 = kInfinity;
  std::uint64_t segment = 0;
  double share = 0.0;
};

double squared_distance(const Point& a, const Point& b, const Eigen::Vector2d& p, double& share) {
  const double x = b.x - a.x, y = b.y - a.y;
  const double squared = x * x + y * y;
  const double along = (p.x() - a.x) * x + (p.y() - a.y) * y;
  share = squared > 0.0 ? std::clamp(along / squared, 0.0, 1.0) : 0.0;
  const double off_x = p.x() - a.x - share * x, off_y = p.y() - a.y - share * y;
  return off_x * off_x + off_y * off_y;
}

double squared_distance(const Point* points, std::uint64_t count, const Eigen::Vector2d& p) {
  double least = kInfinity, share = 0.0;
  for (std::uint64_t i = 1; i < count; ++i) {
    least = std::min(least, squared_distance(points[i - 1], points[i], p, share));
  }
  return least;
}

// Whether a ray from the point to +x crosses the edge; the same for both directions of the edge.
bool crosses(const Point& from, const Point& to, const Eigen::Vector2d& p) {
  if ((from.y > p.y()) == (to.y > p.y())) return false;
  const Point& low = from.y < to.y ? from : to;
  const Point& high = from.y < to.y ? to : from;
  return (high.x - low.x) * (p.y() - low.y) - (p.x() - low.x) * (high.y - low.y) > 0.0;
}

bool crosses_odd(const Point* points, std::uint64_t count, const Eigen::Vector2d& p) {
  bool odd = false;
  for (std::uint64_t i = 1; i < count; ++i) odd ^= crosses(points[i - 1], points[i], p);
  return odd;
}

/// Two runs of a lane's ring.
struct Runs {
  const Point* right;
  const Point* left;
  std::uint64_t right_count, left_count;
};

/// The point as a box of floats that is sure to hold it, and squared distances from it to boxes,
/// too great by less than kSlack.
class FloatPoint {
 public:
  static constexpr float kSlack = 1.000002F;

  explicit FloatPoint(const Eigen::Vector2d& p) {
    const auto x = static_cast<float>(p.x()), y = static_cast<float>(p.y());
    const float slack_x = std::abs(x) * 1.2e-7F, slack_y = std::abs(y) * 1.2e-7F;
    low_x_ = x - slack_x;
    high_x_ = x + slack_x;
    low_y_ = y - slack_y;
    high_y_ = y + slack_y;
  }

  float squared_to(const Box& box) const {
    return squared(box.low_x, box.low_y, box.high_x, box.high_y);
  }

  std::array<float, Node::kWidth> squared_to(const Node& node) const {
    std::array<float, Node::kWidth> made;
    for (std::size_t i = 0; i < Node::kWidth; ++i) {
      made[i] = squared(node.low_x[i], node.low_y[i], node.high_x[i], node.high_y[i]);
    }
    return made;
  }

 private:
  float squared(float low_x, float low_y, float high_x, float high_y) const {
    const float x = std::max(std::max(low_x - high_x_, low_x_ - high_x), 0.0F);
    const float y = std::max(std::max(low_y - high_y_, low_y_ - high_y), 0.0F);
    return x * x + y * y;
  }

  float low_x_, low_y_, high_x_, high_y_;
};

/// Memory that searches use one after the other.
struct Scratch {
  std::vector<Candidate> candidates;
  std::vector<double> ranked;
  std::vector<LaneMatch> found;
};

/// One search around one point.
class Search {
 public:
  Search(const Data& data, const std::vector<std::uint64_t>& levels, const LaneQuery& query,
         const Eigen::Vector2d& point, Scratch& scratch)
      : data_(data), levels_(levels), query_(query), point_(point), box_(point), scratch_(scratch) {
    scratch_.candidates.clear();
    scratch_.found.clear();
    limit(query.radius_m * query.radius_m);
  }

  /// Leaves what it finds in scratch.found.
  void run() {
    visit(0.0F, [this](const Cell& cell) { toggle_inside(cell); });
    if (count_inside() < query_.count) {
      visit(bound_, [this](const Cell& cell) { measure(cell); });
    }
    for (const Candidate& candidate : scratch_.candidates) {
      if (candidate.squared_m2 <= bound_m2_ && candidate.squared_m2 < kInfinity)
        scratch_.found.push_back(match(candidate));
    }
    std::sort(scratch_.found.begin(), scratch_.found.end(), [](const auto& a, const auto& b) {
      const auto key = [](const LaneMatch& m) {
        return std::tuple(m.distance_m, std::abs(m.place.d_m), m.place.lane);
      };
      return key(a) < key(b);
    });
    if (scratch_.found.size() > query_.count) scratch_.found.resize(query_.count);
  }

 private:
  struct Visit {
    float squared_m2;
    std::uint32_t level;
    std::uint64_t at;  ///< box of the level
  };

  void limit(double squared_m2) {
    bound_m2_ = squared_m2;
    // Never infinite: boxes of nothing are infinitely far.
    bound_ = std::min(static_cast<float>(squared_m2) * FloatPoint::kSlack,
                      std::numeric_limits<float>::max());
  }

  // Cells with boxes not farther than the bound, nearer ones mostly first; the bound may shrink.
  template <typename Take>
  void visit(const float& bound, const Take& take) {
    if (data_.cells.size() == 0) return;
    std::array<Visit, 128> stack;  // 11 levels at most, each leaves 7 behind
    std::size_t size = 0;
    stack[size++] = {0.0F, static_cast<std::uint32_t>(levels_.size() - 1), 0};
    while (size > 0) {
      const Visit next = stack[--size];
      if (!(next.squared_m2 <= bound)) continue;
      if (next.level == 0) {
        const Cell& cell = data_.cells[data_.order[next.at]];
        if (query_.types.has(cell.lane_type)) take(cell);
      } else {
        size = push_children(next, bound, stack, size);
      }
    }
  }

  std::size_t push_children(const Visit& parent, float bound, std::array<Visit, 128>& stack,
                            std::size_t size) const {
    const Node& node = data_.nodes[levels_[parent.level - 1] + parent.at];
    const auto squared = box_.squared_to(node);
    const std::size_t first = size;
    for (std::size_t i = 0; i < Node::kWidth; ++i) {
      if (!(squared[i] <= bound)) continue;
      const Visit child{squared[i], parent.level - 1, parent.at * Node::kWidth + i};
      std::size_t place = size++;  // farthest first: the stack gives back the nearest
      for (; place > first && stack[place - 1].squared_m2 < child.squared_m2; --place) {
        stack[place] = stack[place - 1];
      }
      stack[place] = child;
    }
    return size;
  }

  Runs runs(const Cell& cell) const {
    const std::uint64_t first = data_.lanes[cell.lane].first_ring_point;
    const std::uint64_t right = std::uint64_t{cell.right_to} - cell.right_from + 1;
    const std::uint64_t left = std::uint64_t{cell.left_from} - cell.left_to + 1;
    return {data_.ring_points.span(first + cell.right_from, right),
            data_.ring_points.span(first + cell.left_to, left), right, left};
  }

  Candidate& candidate(std::uint32_t lane) {
    for (Candidate& there : scratch_.candidates) {
      if (there.lane == lane) return there;
    }
    return scratch_.candidates.emplace_back(Candidate{.lane = lane});
  }

  void toggle_inside(const Cell& cell) {
    const Runs ring = runs(cell);
    if (ring.right_count == 0 || ring.left_count == 0) return;
    const bool odd = crosses_odd(ring.right, ring.right_count, point_) ^
                     crosses_odd(ring.left, ring.left_count, point_) ^
                     crosses(ring.right[ring.right_count - 1], ring.left[0], point_) ^
                     crosses(ring.left[ring.left_count - 1], ring.right[0], point_);
    if (odd) candidate(cell.lane).inside ^= true;
  }

  std::size_t count_inside() {
    std::size_t inside = 0;
    for (Candidate& there : scratch_.candidates) {
      if (!there.inside) continue;
      there.squared_m2 = 0.0;
      ++inside;
    }
    if (inside >= query_.count) limit(0.0);
    return inside;
  }

  void measure(const Cell& cell) {
    const Runs ring = runs(cell);
    if (ring.right_count == 0 || ring.left_count == 0) return;
    double squared = std::min(squared_distance(ring.right, ring.right_count, point_),
                              squared_distance(ring.left, ring.left_count, point_));
    double share = 0.0;
    if ((cell.ends & 1U) != 0) {
      squared = std::min(
          squared, squared_distance(ring.left[ring.left_count - 1], ring.right[0], point_, share));
    }
    if ((cell.ends & 2U) != 0) {
      squared = std::min(
          squared, squared_distance(ring.right[ring.right_count - 1], ring.left[0], point_, share));
    }
    if (squared <= kOnBorder_m2) squared = 0.0;
    if (!(squared <= bound_m2_)) return;
    Candidate& lane = candidate(cell.lane);
    if (squared >= lane.squared_m2) return;
    lane.squared_m2 = squared;
    shrink();
  }

  // No lane farther than the count-th nearest one so far can be among the nearest.
  void shrink() {
    const auto& candidates = scratch_.candidates;
    if (candidates.size() < query_.count) return;
    std::vector<double>& ranked = scratch_.ranked;
    ranked.clear();
    for (const Candidate& there : candidates) ranked.push_back(there.squared_m2);
    const auto last = ranked.begin() + static_cast<std::ptrdiff_t>(query_.count - 1);
    std::nth_element(ranked.begin(), last, ranked.end());
    if (*last < bound_m2_) limit(*last);
  }

  Foot foot(const LaneRecord& lane) const {
    const Cell* cells = data_.cells.span(lane.first_cell, lane.cells);
    const auto nearest =
        std::min_element(cells, cells + lane.cells, [this](const Cell& a, const Cell& b) {
          return box_.squared_to(a.centre) < box_.squared_to(b.centre);
        });
    Foot best;
    improve(best, lane, *nearest);
    for (const Cell* cell = cells; cell != cells + lane.cells; ++cell) {
      const auto bound = static_cast<float>(best.squared_m2) * FloatPoint::kSlack;
      if (cell != nearest && box_.squared_to(cell->centre) <= bound) improve(best, lane, *cell);
    }
    return best;
  }

  void improve(Foot& best, const LaneRecord& lane, const Cell& cell) const {
    const std::uint64_t count = std::uint64_t{cell.centre_to} - cell.centre_from + 1;
    const Point* points =
        data_.centre_points.span(lane.first_centre_point + cell.centre_from, count);
    for (std::uint64_t i = 0; i + 1 < count; ++i) {
      Foot foot{0.0, cell.centre_from + i, 0.0};
      foot.squared_m2 = squared_distance(points[i], points[i + 1], point_, foot.share);
      if (std::tie(foot.squared_m2, foot.segment) < std::tie(best.squared_m2, best.segment)) {
        best = foot;
      }
    }
  }

  LaneMatch match(const Candidate& found) const {
    const LaneRecord& lane = data_.lanes[found.lane];
    if (lane.cells == 0) return {};
    const Foot nearest = foot(lane);
    const std::uint64_t at = lane.first_centre_point + nearest.segment;
    const Point* points = data_.centre_points.span(at, 2);
    const double* stations_m = data_.centre_stations_m.span(at, 2);
    const double x = points[1].x - points[0].x, y = points[1].y - points[0].y;
    const double side =
        x * (point_.y() - points[0].y) - y * (point_.x() - points[0].x) < 0.0 ? -1.0 : 1.0;
    const double s_m = stations_m[0] + nearest.share * (stations_m[1] - stations_m[0]);
    return {{LaneId{found.lane}, s_m, side * std::sqrt(nearest.squared_m2)},
            std::sqrt(found.squared_m2),
            std::atan2(y, x)};
  }

  const Data& data_;
  const std::vector<std::uint64_t>& levels_;
  const LaneQuery& query_;
  const Eigen::Vector2d point_;
  const FloatPoint box_;
  Scratch& scratch_;
  double bound_m2_ = kInfinity;
  float bound_ = std::numeric_limits<float>::infinity();
};

bool is_searchable(const Eigen::Vector2d& point, const LaneQuery& query) {
  return point.allFinite() && query.radius_m >= 0.0 && query.count > 0;
}

// Indices of points along a Hilbert curve through their bounding box.
std::vector<std::uint32_t> along_hilbert_curve(std::span<const Eigen::Vector2d> points) {
  Eigen::Vector2d low(kInfinity, kInfinity), high = -low;
  for (const Eigen::Vector2d& point : points) {
    if (!point.allFinite()) continue;
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  std::vector<std::uint64_t> keys;
  keys.reserve(points.size());
  for (const Eigen::Vector2d& point : points) {
    const Eigen::Vector2d share = (point - low).cwiseQuotient((high - low).cwiseMax(1e-9));
    const auto scaled = [](double value) {  // what is not finite goes anywhere
      return static_cast<std::uint32_t>(std::min(std::max(0.0, value), 1.0) * 65535.0);
    };
    const std::uint64_t place = lane_index::hilbert_place(scaled(share.x()), scaled(share.y()));
    keys.push_back(place << 32 | keys.size());
  }
  std::sort(keys.begin(), keys.end());
  return {keys.begin(), keys.end()};
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
  static thread_local Scratch scratch;
  Search(data_, level_starts_, query, point_in_map, scratch).run();
  return scratch.found;
}

LaneMatches LaneIndex::near(std::span<const Eigen::Vector2d> points_in_map,
                            const LaneQuery& query) const {
  LaneMatches matches;
  matches.ranges.resize(points_in_map.size());
  Scratch scratch;
  for (const std::uint32_t i : along_hilbert_curve(points_in_map)) {
    if (!is_searchable(points_in_map[i], query)) continue;
    Search(data_, level_starts_, query, points_in_map[i], scratch).run();
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

}  // namespace roadbed::map
