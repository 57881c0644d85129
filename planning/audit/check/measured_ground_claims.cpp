#include "roadbed/planning/audit/check/certificate_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>

#include "roadbed/geometry/index/point_index.h"

namespace roadbed::planning::inline audit {
namespace {

using Eigen::Vector2d;
using map::GroundPlace;

constexpr double kHitsAround_m = 2.0, kPointsApart_m = 1.0;
constexpr std::int64_t kHitTileSide = 32;  // columns of a tile

struct HitColumn {
  std::int64_t x, y;
};

std::int64_t whole_cells(double cells) { return static_cast<std::int64_t>(std::floor(cells)); }

std::int64_t hit_tile_of(std::int64_t column) {
  return whole_cells(static_cast<double>(column) / kHitTileSide);
}

std::int64_t hit_key(std::int64_t tile_x, std::int64_t tile_y) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(tile_x) << 32 |
                                   static_cast<std::uint32_t>(tile_y));
}

/// The middle of the lowest occupied cell of each column around places.
class LowestHits {
 public:
  LowestHits(const std::vector<GroundPlace>& places, const std::vector<map::OccupancyCell>& cells,
             double cell_m)
      : cell_m_(cell_m) {
    if (!cells.empty()) {
      corner_ = cells.front().centre_in_source.head<2>().array() - 0.5 * cells.front().size_m;
    }
    for (const GroundPlace& place : places) {
      for_columns(place.in_source,
                  [&](HitColumn at) { tiles_[hit_key(hit_tile_of(at.x), hit_tile_of(at.y))]; });
    }
    for (const map::OccupancyCell& cell : cells) {
      if (cell.state == map::CellState::occupied) add(cell);
    }
  }

  template <class Use>  // (horizontal offset, z)
  void for_hits_around(const Vector2d& point, const Use& use) const {
    for_columns(point, [&](HitColumn at) {
      const auto tile = tiles_.find(hit_key(hit_tile_of(at.x), hit_tile_of(at.y)));
      if (tile == tiles_.end() || tile->second.empty()) return;
      const double z_m = tile->second[place_in_tile(at)];
      const Vector2d off = middle(at) - point;
      if (std::isfinite(z_m) && off.norm() <= kHitsAround_m) use(off, z_m);
    });
  }

 private:
  static std::size_t place_in_tile(HitColumn at) {
    return static_cast<std::size_t>((at.y - hit_tile_of(at.y) * kHitTileSide) * kHitTileSide +
                                    at.x - hit_tile_of(at.x) * kHitTileSide);
  }

  Vector2d middle(HitColumn at) const {
    return corner_ +
           cell_m_ * Vector2d(static_cast<double>(at.x) + 0.5, static_cast<double>(at.y) + 0.5);
  }

  template <class Use>
  void for_columns(const Vector2d& point, const Use& use) const {
    const Vector2d from = ((point - corner_).array() - kHitsAround_m) / cell_m_;
    const Vector2d to = ((point - corner_).array() + kHitsAround_m) / cell_m_;
    for (std::int64_t y = whole_cells(from.y()); y <= whole_cells(to.y()); ++y) {
      for (std::int64_t x = whole_cells(from.x()); x <= whole_cells(to.x()); ++x)
        use(HitColumn{x, y});
    }
  }

  void add(const map::OccupancyCell& cell) {
    const Vector2d least = cell.centre_in_source.head<2>().array() - 0.5 * cell.size_m;
    const auto from_x =
        static_cast<std::int64_t>(std::llround((least.x() - corner_.x()) / cell_m_));
    const auto from_y =
        static_cast<std::int64_t>(std::llround((least.y() - corner_.y()) / cell_m_));
    const auto side = static_cast<std::int64_t>(std::llround(cell.size_m / cell_m_));
    const double z_m = cell.centre_in_source.z() - 0.5 * (cell.size_m - cell_m_);
    for (std::int64_t y = from_y; y < from_y + side; ++y) {
      for (std::int64_t x = from_x; x < from_x + side; ++x) {
        const auto tile = tiles_.find(hit_key(hit_tile_of(x), hit_tile_of(y)));
        if (tile == tiles_.end()) continue;
        if (tile->second.empty()) {
          tile->second.resize(kHitTileSide * kHitTileSide, std::numeric_limits<double>::infinity());
        }
        double& lowest_m = tile->second[place_in_tile({x, y})];
        lowest_m = std::min(lowest_m, z_m);
      }
    }
  }

  double cell_m_;
  Vector2d corner_{0.0, 0.0};
  std::unordered_map<std::int64_t, std::vector<double>> tiles_;
};

// Looser by a little than what `measured_under` asks for, as sides and inliers may be told apart a
// little differently here.
std::string fault_at(const GroundPlace& place, const LowestHits& hits, double within_m,
                     double heading_rad) {
  constexpr double few = 0.03, most = 0.4, spread = 0.6, biased = 0.2;
  constexpr int fewest = 3;
  struct Side {
    int all = 0, on = 0;
  };
  std::array<Side, 4> sides;
  int all = 0, below = 0, on = 0;
  double sum_m = 0.0, squares_m2 = 0.0;
  const Vector2d ahead(std::cos(heading_rad), std::sin(heading_rad));
  hits.for_hits_around(place.in_source, [&](const Vector2d& off, double z_m) {
    const double above_m = z_m - place.z_m - place.slope.dot(off);
    const bool is_ahead = off.dot(ahead) >= 0.0;
    const bool is_left = ahead.x() * off.y() - ahead.y() * off.x() >= 0.0;
    Side& side = sides[(is_ahead ? 2U : 0U) + (is_left ? 1U : 0U)];
    ++all;
    ++side.all;
    if (above_m < -within_m) ++below;
    if (std::abs(above_m) > within_m) return;
    ++on;
    ++side.on;
    sum_m += above_m;
    squares_m2 += above_m * above_m;
  });
  if (below > few * all) return fmt::format("{} of {} columns are lower", below, all);
  for (const Side& side : sides) {
    if (side.on >= fewest && side.on >= most * side.all) continue;
    return fmt::format("on one side {} of {} columns are at that height", side.on, side.all);
  }
  if (std::abs(sum_m) > biased * within_m * on) {
    return fmt::format("the surface lies {:.3f} m beside", sum_m / on);
  }
  if (squares_m2 > std::pow(spread * within_m, 2) * on) return "the surface lies on two levels";
  return {};
}

// Of a body on its way, a metre apart.
std::string gap_below(const std::vector<GroundPlace>& places, const geometry::Trajectory& drive,
                      const map::BodyReach& body) {
  std::vector<Vector2d> points;
  for (const GroundPlace& place : places) points.push_back(place.in_source);
  const geometry::PointIndex index(points);
  std::optional<Vector2d> last;
  for (const geometry::TrajectoryPoint& sample : drive.points()) {
    const Vector2d axle = sample.pose().position();
    if (last && (axle - *last).norm() < kPointsApart_m) continue;
    last = axle;
    const Vector2d ahead(std::cos(sample.heading_rad), std::sin(sample.heading_rad));
    for (double x_m = body.rear_m; x_m <= body.front_m; x_m += kPointsApart_m) {
      const Vector2d point = axle + x_m * ahead;
      if ((points[index.nearest(point)->index] - point).norm() <= kHitsAround_m) continue;
      return fmt::format("ground: nothing is said below the body at ({:.1f}, {:.1f})", point.x(),
                         point.y());
    }
  }
  return {};
}

}  // namespace

std::string measured_ground_fault(const std::vector<GroundPlace>& places,
                                  const std::vector<map::OccupancyCell>& cells, double cell_m,
                                  const geometry::Trajectory& drive_in_source,
                                  const map::BodyReach& body) {
  constexpr double least_within_m = 0.05;
  if (std::string gap = gap_below(places, drive_in_source, body); !gap.empty()) return gap;
  std::vector<Vector2d> positions;
  for (const auto& sample : drive_in_source.points()) positions.push_back(sample.pose().position());
  const geometry::PointIndex index(positions);
  const LowestHits hits(places, cells, cell_m);
  for (const GroundPlace& place : places) {
    const auto& sample = drive_in_source.points()[index.nearest(place.in_source)->index];
    const std::string fault =
        fault_at(place, hits, std::max(cell_m, least_within_m), sample.heading_rad);
    if (fault.empty()) continue;
    return fmt::format("ground: at ({:.1f}, {:.1f}), z {:.3f} m, {}", place.in_source.x(),
                       place.in_source.y(), place.z_m, fault);
  }
  return {};
}

}  // namespace roadbed::planning::audit
