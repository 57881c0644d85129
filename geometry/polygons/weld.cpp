#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/geometry/index/hilbert.h"
#include "roadbed/geometry/polygons/ring.h"
#include "roadbed/geometry/primitives/work_limit.h"

namespace roadbed::geometry::inline polygons {
namespace {

using Eigen::Vector2d;

bool before(const Vector2d& a, const Vector2d& b) {
  return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
}

void drop_repeated(Ring& ring) {
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  if (ring.size() < 3) ring.clear();
}

/// Points by square cells. Only looked up, never iterated: its order is nobody's business.
class PointGrid {
 public:
  explicit PointGrid(double cell_m) : cell_m_(cell_m) {}

  std::int64_t index(double coordinate_m) const {
    return static_cast<std::int64_t>(std::floor(coordinate_m / cell_m_));
  }

  void add(const Vector2d& point) { cells_[{index(point.x()), index(point.y())}].push_back(point); }

  const std::vector<Vector2d>& cell(std::int64_t column, std::int64_t row) const {
    static const std::vector<Vector2d> kNone;
    const auto found = cells_.find({column, row});
    return found == cells_.end() ? kNone : found->second;
  }

 private:
  using Key = std::pair<std::int64_t, std::int64_t>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      const auto x = static_cast<std::uint64_t>(key.first);
      const auto y = static_cast<std::uint64_t>(key.second);
      return static_cast<std::size_t>((x * 0x9E3779B97F4A7C15ULL) ^ (y * 0xC2B2AE3D27D4EB4FULL));
    }
  };
  double cell_m_;
  std::unordered_map<Key, std::vector<Vector2d>, Hash> cells_;
};

std::vector<Vector2d> sorted_points(const std::vector<Ring>& rings) {
  std::vector<Vector2d> points;
  for (const Ring& ring : rings) points.insert(points.end(), ring.begin(), ring.end());
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

/// The points that are kept, by cells of the weld distance.
class KeptPoints {
 public:
  KeptPoints(const std::vector<Vector2d>& sorted, double weld_m) : weld_m_(weld_m), grid_(weld_m) {
    for (const Vector2d& point : sorted) {
      if (find(point) == nullptr) {
        grid_.add(point);
        kept_.push_back(point);
      }
    }
  }

  /// The nearest kept point within the weld distance, the lexicographically first of equally near.
  const Vector2d* find(const Vector2d& point) const {
    const std::int64_t column = grid_.index(point.x()), row = grid_.index(point.y());
    const Vector2d* nearest = nullptr;
    for (std::int64_t c = column - 1; c <= column + 1; ++c) {
      for (std::int64_t r = row - 1; r <= row + 1; ++r) {
        for (const Vector2d& candidate : grid_.cell(c, r))
          nearest = nearer(point, candidate, nearest);
      }
    }
    return nearest;
  }

  const std::vector<Vector2d>& points() const { return kept_; }

 private:
  const Vector2d* nearer(const Vector2d& point, const Vector2d& candidate,
                         const Vector2d* nearest) const {
    const double distance_m = (candidate - point).norm();
    if (distance_m > weld_m_) return nearest;
    if (nearest == nullptr) return &candidate;
    const double least_m = (*nearest - point).norm();
    const bool wins =
        distance_m < least_m || (distance_m == least_m && before(candidate, *nearest));
    return wins ? &candidate : nearest;
  }

  double weld_m_;
  PointGrid grid_;
  std::vector<Vector2d> kept_;
};

// Points that edges pass: few in maps, whose neighbours share their borders' vertices.
constexpr std::size_t kFewAdded = 50'000, kFewAddedEach = 2;

struct OnEdge {
  double fraction;  ///< of the edge's length from its start
  Vector2d point;
  double off_m;  ///< from the edge
};

void note(double moved_m, Welded& welded) {
  if (moved_m <= 0.0) return;
  ++welded.moved_points;
  welded.most_moved_m = std::max(welded.most_moved_m, moved_m);
}

void note_move(Vector2d& point, const Vector2d& to, Welded& welded) {
  note((to - point).norm(), welded);
  point = to;
}

// Points beside each other along the Hilbert curve through a grid of their ranks by x and by y: a
// tree of them has small boxes however unevenly they lie. @param sorted  by x
std::vector<Vector2d> in_hilbert_order(const std::vector<Vector2d>& sorted) {
  std::vector<std::uint32_t> by_y(sorted.size()), keys(sorted.size());
  std::iota(by_y.begin(), by_y.end(), 0U);
  std::ranges::stable_sort(by_y, {}, [&](std::uint32_t i) { return sorted[i].y(); });
  const auto cell = [&](std::size_t rank) {
    return static_cast<std::uint32_t>(rank * 65'536 / sorted.size());
  };
  for (std::size_t rank = 0; rank < by_y.size(); ++rank) {
    keys[by_y[rank]] = hilbert_index(cell(by_y[rank]), cell(rank));
  }
  std::vector<Vector2d> ordered;
  ordered.reserve(sorted.size());
  for (const std::uint32_t i : order_of_keys(keys)) ordered.push_back(sorted[i]);
  return ordered;
}

/// Whether the edge from a to b comes into the box.
bool enters(const Vector2d& a, const Vector2d& b, const Box& box) {
  if ((a.cwiseMax(b).array() < box.min().array()).any() ||
      (a.cwiseMin(b).array() > box.max().array()).any()) {
    return false;
  }
  double from = 0.0, to = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double low = box.min()[axis] - a[axis], high = box.max()[axis] - a[axis];
    const double along = b[axis] - a[axis];
    if (along == 0.0) {
      if (low > 0.0 || high < 0.0) return false;
      continue;
    }
    from = std::max(from, std::min(low / along, high / along));
    to = std::min(to, std::max(low / along, high / along));
  }
  return from <= to;
}

class EdgeSplitter {
 public:
  EdgeSplitter(const std::vector<Vector2d>& sorted, double weld_m)
      : weld_m_(weld_m), points_(in_hilbert_order(sorted)) {
    std::vector<Box> leaves;
    for (std::size_t i = 0; i < points_.size(); i += kInLeaf) {
      const Box box =
          box_around(std::span(points_).subspan(i, std::min(kInLeaf, points_.size() - i)));
      // Twice as far around as asked for, so that no rounding matters.
      leaves.emplace_back(box.min().array() - 2.0 * weld_m, box.max().array() + 2.0 * weld_m);
    }
    if (!leaves.empty()) levels_ = packed_levels(std::move(leaves), kChildren);
  }

  Ring split(const Ring& ring, Welded& welded) const {
    Ring result;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
      result.push_back(a);
      for (const OnEdge& on : passed(a, b)) {
        note(on.off_m, welded);
        result.push_back(on.point);
      }
    }
    return result;
  }

 private:
  /// Points within the weld distance of the edge's inside, in its direction.
  std::vector<OnEdge> passed(const Vector2d& a, const Vector2d& b) const {
    std::vector<OnEdge> found;
    if (!levels_.empty()) look_in(levels_.size() - 1, 0, a, b, found);
    std::sort(found.begin(), found.end(), [](const OnEdge& one, const OnEdge& other) {
      return one.fraction < other.fraction ||
             (one.fraction == other.fraction && before(one.point, other.point));
    });
    return found;
  }

  void look_in(std::size_t level, std::size_t node, const Vector2d& a, const Vector2d& b,
               std::vector<OnEdge>& found) const {
    if (!enters(a, b, levels_[level][node])) return;
    const std::size_t width = level > 0 ? kChildren : kInLeaf;
    const std::size_t size = level > 0 ? levels_[level - 1].size() : points_.size();
    const std::size_t end = std::min(size, (node + 1) * width);
    for (std::size_t i = node * width; i < end; ++i) {
      if (level > 0) {
        look_in(level - 1, i, a, b, found);
      } else {
        add_if_near(a, b, points_[i], found);
      }
    }
  }

  void add_if_near(const Vector2d& a, const Vector2d& b, const Vector2d& point,
                   std::vector<OnEdge>& found) const {
    if (point == a || point == b) return;
    const Vector2d along = b - a;
    const double fraction = (point - a).dot(along) / along.squaredNorm();
    if (!(fraction > 0.0 && fraction < 1.0)) return;
    const double off_m = (a + fraction * along - point).norm();
    if (off_m <= weld_m_) found.push_back({fraction, point, off_m});
  }

  static constexpr std::size_t kInLeaf = 8, kChildren = 8;

  double weld_m_;
  std::vector<Vector2d> points_;
  std::vector<std::vector<Box>> levels_;  // around runs of points, the root last
};

}  // namespace

Welded weld(std::vector<Ring> rings, double weld_m) {
  if (!(weld_m >= 0.0) || !std::isfinite(weld_m)) {
    throw std::invalid_argument(
        fmt::format("weld: distance must be finite and not negative, got {} m", weld_m));
  }
  Welded welded;
  for (Ring& ring : rings) drop_repeated(ring);
  if (weld_m > 0.0) {
    const KeptPoints kept(sorted_points(rings), weld_m);
    const EdgeSplitter splitter(kept.points(), weld_m);
    WorkBudget added(kFewAdded + kFewAddedEach * kept.points().size());
    for (Ring& ring : rings) {
      for (Vector2d& point : ring) note_move(point, *kept.find(point), welded);
      drop_repeated(ring);
      const std::size_t before = ring.size();
      ring = splitter.split(ring, welded);
      if (!added.spend(ring.size() - before)) {
        throw TooMuchWork(
            "so many edges nearly lie on others that their outline has endless corners");
      }
    }
  }
  welded.rings = std::move(rings);
  return welded;
}

}  // namespace roadbed::geometry::polygons
