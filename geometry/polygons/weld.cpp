#include "roadbed/geometry/polygons/ring.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <unordered_map>
#include <utility>

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

  double cell_m() const { return cell_m_; }

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

/// Cells so large that each holds about one point, were they spread evenly.
double even_cell_m(const std::vector<Vector2d>& points, double least_m) {
  if (points.empty()) return least_m;
  Vector2d low = points.front(), high = points.front();
  for (const Vector2d& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const double fraction = 1.0 / std::sqrt(static_cast<double>(points.size()));
  return std::max(4.0 * least_m, (high - low).norm() * fraction);
}

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

/// Range of the edge's y where its x is within [from_x, to_x].
std::pair<double, double> y_range(const Vector2d& a, const Vector2d& b, double from_x,
                                  double to_x) {
  if (a.x() == b.x()) return std::minmax(a.y(), b.y());
  const auto y_at = [&](double x) {
    const double fraction = std::clamp((x - a.x()) / (b.x() - a.x()), 0.0, 1.0);
    return a.y() + fraction * (b.y() - a.y());
  };
  return std::minmax(y_at(from_x), y_at(to_x));
}

class EdgeSplitter {
 public:
  EdgeSplitter(const std::vector<Vector2d>& points, double weld_m)
      : weld_m_(weld_m), grid_(even_cell_m(points, weld_m)) {
    for (const Vector2d& point : points) grid_.add(point);
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
    const auto [low_x, high_x] = std::minmax(a.x(), b.x());
    const std::int64_t last = grid_.index(high_x + weld_m_);
    for (std::int64_t column = grid_.index(low_x - weld_m_); column <= last; ++column) {
      const double from_x = static_cast<double>(column) * grid_.cell_m();
      const auto [low_y, high_y] =
          y_range(a, b, from_x - weld_m_, from_x + grid_.cell_m() + weld_m_);
      const std::int64_t top = grid_.index(high_y + weld_m_);
      for (std::int64_t row = grid_.index(low_y - weld_m_); row <= top; ++row) {
        for (const Vector2d& point : grid_.cell(column, row)) add_if_near(a, b, point, found);
      }
    }
    std::sort(found.begin(), found.end(), [](const OnEdge& one, const OnEdge& other) {
      return one.fraction < other.fraction ||
             (one.fraction == other.fraction && before(one.point, other.point));
    });
    return found;
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

  double weld_m_;
  PointGrid grid_;
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
    for (Ring& ring : rings) {
      for (Vector2d& point : ring) note_move(point, *kept.find(point), welded);
      drop_repeated(ring);
      ring = splitter.split(ring, welded);
    }
  }
  welded.rings = std::move(rings);
  return welded;
}

}  // namespace roadbed::geometry::polygons
