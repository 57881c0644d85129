#include "roadbed/map/lane_table/shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "roadbed/map/elements/side.h"

namespace roadbed::map::lane_table {
namespace {

using Eigen::Vector2d;

Vector2d left_of(const Vector2d& along) { return Vector2d(-along.y(), along.x()).normalized(); }

Line3 without_repeats(const Line3& line) {
  Line3 kept;
  for (const Eigen::Vector3d& point : line) {
    if (kept.empty() || (point - kept.back()).head<2>().norm() > 1e-6) kept.push_back(point);
  }
  return kept;
}

/// Towards the left at a vertex, so long that both segments beside it are a unit away.
Vector2d offset_at(const Line3& line, std::size_t i) {
  const auto normal = [&](std::size_t from) {
    return left_of((line[from + 1] - line[from]).head<2>());
  };
  if (i == 0) return normal(0);
  if (i + 1 == line.size()) return normal(i - 1);
  const Vector2d sum = normal(i - 1) + normal(i);
  constexpr double longest = 2.0;
  const double scale = 2.0 / std::max(sum.squaredNorm(), 1e-12);
  const Vector2d offset = scale * sum;
  return offset.norm() <= longest ? offset : Vector2d(longest * normal(i));
}

/// Finds ends by where they are.
class Ends {
 public:
  explicit Ends(double reach_m) : reach_m_(reach_m) {}

  void add(const Vector2d& point, LaneId lane) {
    auto& lanes = cells_[key(cell(point.x()), cell(point.y()))];
    if (lanes.size() < kMost) lanes.push_back(lane);  // more do not meet anywhere on earth
  }

  template <typename Visit>
  void visit(const Vector2d& point, const Visit& visit_lane) const {
    for (std::int64_t x = cell(point.x()) - 1; x <= cell(point.x()) + 1; ++x) {
      for (std::int64_t y = cell(point.y()) - 1; y <= cell(point.y()) + 1; ++y) {
        const auto found = cells_.find(key(x, y));
        if (found == cells_.end()) continue;
        for (const LaneId lane : found->second) visit_lane(lane);
      }
    }
  }

 private:
  static constexpr std::size_t kMost = 64;

  std::int64_t cell(double at_m) const {
    return static_cast<std::int64_t>(std::floor(at_m / reach_m_));
  }
  static std::uint64_t key(std::int64_t x, std::int64_t y) {
    return static_cast<std::uint64_t>(x) << 32U ^ (static_cast<std::uint64_t>(y) & 0xffffffffU);
  }

  double reach_m_;
  std::unordered_map<std::uint64_t, std::vector<LaneId>> cells_;
};

const Vector2d& first(const LaneLine& line) { return line.in_map.points().front(); }
const Vector2d& last(const LaneLine& line) { return line.in_map.points().back(); }

bool share_users(const Lane& a, const Lane& b) {
  return (a.participants.bits() & b.participants.bits()) != 0 || a.type == b.type;
}

}  // namespace

std::optional<Borders> borders_beside(const Line3& centre, double width_m) {
  const Line3 line = without_repeats(centre);
  if (line.size() < 2) return {};
  Borders borders{{}, {}, line};
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vector2d offset = 0.5 * width_m * offset_at(line, i);
    Eigen::Vector3d left = line[i], right = line[i];
    left.head<2>() += offset;
    right.head<2>() -= offset;
    borders.left.push_back(left);
    borders.right.push_back(right);
  }
  return borders;
}

std::optional<Borders> borders_of_ring(const Line3& ring, double heading_rad) {
  const Line3 points = without_repeats(ring);
  const std::size_t n = points.size();
  if (n < 4) return {};
  const Vector2d ahead(std::sin(heading_rad), std::cos(heading_rad));
  double area = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d &a = points[i], &b = points[(i + 1) % n];
    area += a.x() * b.y() - a.y() * b.x();
  }
  // Counter-clockwise, the last edge runs to the left and the first one to the right.
  const double turn = area > 0.0 ? 1.0 : -1.0;
  Vector2d middle(0.0, 0.0);
  for (const Eigen::Vector3d& point : points) middle += point.head<2>() / static_cast<double>(n);
  std::optional<std::size_t> begin, end;
  double most_back = 0.0, most_ahead = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d a = points[i].head<2>(), b = points[(i + 1) % n].head<2>();
    const double across = turn * left_of(ahead).dot((b - a).normalized());
    const double along = ahead.dot(0.5 * (a + b) - middle);
    if (across > 0.7 && along > most_ahead) {
      end = i;
      most_ahead = along;
    }
    if (across < -0.7 && along < most_back) {
      begin = i;
      most_back = along;
    }
  }
  if (!begin || !end) return {};
  const auto run = [&](std::size_t from, std::size_t to) {
    Line3 line;
    for (std::size_t i = from; i != to; i = (i + 1) % n) line.push_back(points[i]);
    line.push_back(points[to]);
    return line;
  };
  Line3 one = run((*begin + 1) % n, *end), other = run((*end + 1) % n, *begin);
  std::reverse(other.begin(), other.end());
  if (turn > 0.0) return Borders{std::move(other), std::move(one), {}};
  return Borders{std::move(one), std::move(other), {}};
}

void link_ends(const std::vector<Lane>& lanes, double most_m, std::vector<LaneLinks>& links) {
  Ends starts(most_m);
  for (const Lane& lane : lanes) starts.add(first(lane.left), lane.id);
  for (const Lane& lane : lanes) {
    starts.visit(last(lane.left), [&](LaneId id) {
      const Lane& next = lanes[id.index];
      const bool meets = (first(next.left) - last(lane.left)).norm() <= most_m &&
                         (first(next.right) - last(lane.right)).norm() <= most_m;
      if (!meets || id == lane.id || !share_users(lane, next)) return;
      links[lane.id.index].successors.push_back(id);
      links[id.index].predecessors.push_back(lane.id);
    });
  }
}

void link_beside(const std::vector<Lane>& lanes, double most_m, std::vector<LaneLinks>& links) {
  Ends rights(most_m);
  for (const Lane& lane : lanes) rights.add(first(lane.right), lane.id);
  for (const Lane& lane : lanes) {
    rights.visit(first(lane.left), [&](LaneId id) {
      const Lane& left = lanes[id.index];
      const bool meets = (first(left.right) - first(lane.left)).norm() <= most_m &&
                         (last(left.right) - last(lane.left)).norm() <= most_m;
      if (!meets || id == lane.id || links[lane.id.index].left || links[id.index].right) return;
      links[lane.id.index].left =
          Neighbour{id, true, joined_ranges(lane, Side::left, left, true, most_m)};
      links[id.index].right =
          Neighbour{lane.id, true, joined_ranges(left, Side::right, lane, true, most_m)};
    });
  }
}

}  // namespace roadbed::map::lane_table
