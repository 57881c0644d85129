#include "roadbed/map/index/nearest_lanes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <tuple>

namespace roadbed::map::inline index::lane_index {
namespace {

constexpr double kNoBound_m = std::numeric_limits<double>::infinity();

/// Nearer to its border than this a point is on it, and so inside the lane.
constexpr double kOnBorder_m2 = 1e-18;

/// Nearest place of a centreline.
struct Foot {
  double squared_m2 = kNoBound_m;
  std::uint64_t segment = 0;
  double fraction = 0.0;
};

double squared_distance(const Point& a, const Point& b, const Eigen::Vector2d& p,
                        double& fraction) {
  const double x = b.x - a.x, y = b.y - a.y;
  const double squared = x * x + y * y;
  const double along = (p.x() - a.x) * x + (p.y() - a.y) * y;
  fraction = squared > 0.0 ? std::clamp(along / squared, 0.0, 1.0) : 0.0;
  const double off_x = p.x() - a.x - fraction * x, off_y = p.y() - a.y - fraction * y;
  return off_x * off_x + off_y * off_y;
}

double squared_distance(const Point* points, std::uint64_t count, const Eigen::Vector2d& p) {
  double least = kNoBound_m, fraction = 0.0;
  for (std::uint64_t i = 1; i < count; ++i) {
    least = std::min(least, squared_distance(points[i - 1], points[i], p, fraction));
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

  /// Of all boxes of a node at once.
  using Squares = Eigen::Array<float, Node::kWidth, 1>;
  Squares squared_to(const Node& node) const {
    const auto beyond = [](const auto& lows, const auto& highs, float low, float high) {
      const Eigen::Map<const Squares> box_low(std::data(lows)), box_high(std::data(highs));
      return Squares((box_low - high).max(low - box_high).max(0.0F));
    };
    const Squares x = beyond(node.low_x, node.high_x, low_x_, high_x_);
    const Squares y = beyond(node.low_y, node.high_y, low_y_, high_y_);
    return x * x + y * y;
  }

 private:
  float squared(float low_x, float low_y, float high_x, float high_y) const {
    const float x = std::max(std::max(low_x - high_x_, low_x_ - high_x), 0.0F);
    const float y = std::max(std::max(low_y - high_y_, low_y_ - high_y), 0.0F);
    return x * x + y * y;
  }

  float low_x_, low_y_, high_x_, high_y_;
};

/// One search around one point.
class Search {
 public:
  /// @param at_most_m  as many lanes as asked for are known to be no farther; may be infinite.
  Search(const Data& data, const std::vector<std::uint64_t>& levels, const LaneQuery& query,
         const Eigen::Vector2d& point, double at_most_m, Scratch& scratch)
      : data_(data), levels_(levels), query_(query), point_(point), box_(point), scratch_(scratch) {
    scratch_.around.clear();
    scratch_.beside.clear();
    scratch_.candidates.clear();
    scratch_.found.clear();
    const double radius_m = std::min(query.radius_m, at_most_m);
    limit(radius_m * radius_m);
  }

  /// Leaves what it finds in scratch.found.
  void run() {
    collect();
    for (const Candidate& candidate : scratch_.candidates) {
      if (is_within(candidate)) scratch_.found.push_back(match(candidate));
    }
    std::sort(scratch_.found.begin(), scratch_.found.end(), [](const auto& a, const auto& b) {
      const auto key = [](const LaneMatch& m) {
        return std::tuple(m.distance_m, std::abs(m.place.d_m), m.place.lane);
      };
      return key(a) < key(b);
    });
    if (scratch_.found.size() > query_.count) scratch_.found.resize(query_.count);
    if (query_.budget) query_.budget->spend(looked_at());
  }

  /// Whether run() would find any lane.
  bool finds_any() {
    collect();
    return std::ranges::any_of(scratch_.candidates,
                               [this](const Candidate& found) { return is_within(found); });
  }

 private:
  void collect() {
    visit_around();
    if (count_inside() >= query_.count) return;
    for (const Cell* cell : scratch_.around) measure(*cell);
    visit_beside();
  }

  std::size_t looked_at() const {
    constexpr std::size_t at_once = 16;  // boxes of a lane's pieces, beside a piece
    std::size_t pieces = scratch_.around.size();
    for (const LaneMatch& match : scratch_.found) {
      pieces += data_.lanes[match.place.lane.index].cells / at_once;
    }
    return pieces;
  }

  bool is_within(const Candidate& candidate) const {
    return candidate.squared_m2 <= bound_m2_ && candidate.squared_m2 < kNoBound_m;
  }

  void limit(double squared_m2) {
    bound_m2_ = squared_m2;
    // Never infinite: boxes of nothing are infinitely far.
    bound_ = std::min(static_cast<float>(squared_m2) * FloatPoint::kSlack,
                      std::numeric_limits<float>::max());
  }

  static constexpr std::size_t kDeepest = 128;  // 11 levels at most, each leaves 7 behind

  const Node& node_at(const Visit& visit) const {
    return data_.nodes[levels_[visit.level - 1] + visit.at];
  }

  // A bit for each box of a node that is not farther than the bound.
  unsigned near_boxes(const FloatPoint::Squares& squared) const {
    unsigned near = 0;
    for (int i = 0; i < squared.size(); ++i) near |= (squared[i] <= bound_ ? 1U : 0U) << i;
    return near;
  }

  // Finds out which lanes the point is inside of; keeps what is only near for visit_beside().
  void visit_around() {
    if (data_.cells.size() == 0) return;
    std::array<Visit, kDeepest> stack;
    std::size_t size = 0;
    stack[size++] = {0.0F, static_cast<std::uint32_t>(levels_.size() - 1), 0};
    while (size > 0) {
      const Visit next = stack[--size];
      if (next.level == 0) {
        const Cell& cell = data_.cells[data_.order[next.at]];
        if (!query_.types.has(cell.lane_type)) continue;
        scratch_.around.push_back(&cell);
        toggle_inside(cell);
        continue;
      }
      const FloatPoint::Squares squared = box_.squared_to(node_at(next));
      for (unsigned near = near_boxes(squared); near != 0; near &= near - 1) {
        const int i = std::countr_zero(near);
        const Visit child{squared[i], next.level - 1,
                          next.at * Node::kWidth + static_cast<unsigned>(i)};
        if (squared[i] <= 0.0F) {
          stack[size++] = child;
        } else {
          scratch_.beside.push_back(child);
        }
      }
    }
  }

  // Measures the cells with boxes not farther than the bound, which shrinks meanwhile.
  void visit_beside() {
    auto& beside = scratch_.beside;
    const auto nearest = std::min_element(
        beside.begin(), beside.end(),
        [](const Visit& a, const Visit& b) { return a.squared_m2 < b.squared_m2; });
    if (nearest != beside.end()) std::iter_swap(nearest, beside.begin());
    for (const Visit& from : beside) {
      if (from.squared_m2 <= bound_) visit_below(from);
    }
  }

  // Nearer boxes mostly first.
  void visit_below(const Visit& from) {
    std::array<Visit, kDeepest> stack;
    std::size_t size = 0;
    stack[size++] = from;
    while (size > 0) {
      const Visit next = stack[--size];
      if (!(next.squared_m2 <= bound_)) continue;
      if (next.level == 0) {
        const Cell& cell = data_.cells[data_.order[next.at]];
        if (query_.types.has(cell.lane_type)) measure(cell);
      } else {
        size = push_children(next, stack, size);
      }
    }
  }

  std::size_t push_children(const Visit& parent, std::array<Visit, kDeepest>& stack,
                            std::size_t size) const {
    const FloatPoint::Squares squared = box_.squared_to(node_at(parent));
    const std::size_t first = size;
    for (unsigned near = near_boxes(squared); near != 0; near &= near - 1) {
      const int i = std::countr_zero(near);
      const Visit child{squared[i], parent.level - 1,
                        parent.at * Node::kWidth + static_cast<unsigned>(i)};
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
    double fraction = 0.0;
    if ((cell.ends & 1U) != 0) {
      squared = std::min(squared, squared_distance(ring.left[ring.left_count - 1], ring.right[0],
                                                   point_, fraction));
    }
    if ((cell.ends & 2U) != 0) {
      squared = std::min(squared, squared_distance(ring.right[ring.right_count - 1], ring.left[0],
                                                   point_, fraction));
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
      foot.squared_m2 = squared_distance(points[i], points[i + 1], point_, foot.fraction);
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
    const double s_m = stations_m[0] + nearest.fraction * (stations_m[1] - stations_m[0]);
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
  double bound_m2_ = kNoBound_m;
  float bound_ = std::numeric_limits<float>::infinity();
};

}  // namespace

void find_nearest(const Data& data, const std::vector<std::uint64_t>& levels,
                  const LaneQuery& query, const Eigen::Vector2d& point, double at_most_m,
                  Scratch& scratch) {
  Search(data, levels, query, point, at_most_m, scratch).run();
}

bool is_any_near(const Data& data, const std::vector<std::uint64_t>& levels, const LaneQuery& query,
                 const Eigen::Vector2d& point, Scratch& scratch) {
  return Search(data, levels, query, point, kNoBound_m, scratch).finds_any();
}

}  // namespace roadbed::map::index::lane_index
