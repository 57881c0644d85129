#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace roadbed::map::inline repair {

/// Finds things by a point of the plan, all those within a distance of another point. O(1) where
/// they do not lie on each other.
class NearPoints {
 public:
  explicit NearPoints(double reach_m) : reach_m_(reach_m) {}

  void add(const Eigen::Vector2d& point, std::size_t thing) {
    cells_[key(cell(point.x()), cell(point.y()))].push_back({point, thing});
  }

  /// Calls `found(thing)` for those within reach, at most 64, in the order in which they came.
  template <typename Found>
  void visit(const Eigen::Vector2d& point, const Found& found) const {
    std::size_t left = 64;
    for (std::int64_t x = cell(point.x()) - 1; x <= cell(point.x()) + 1; ++x) {
      for (std::int64_t y = cell(point.y()) - 1; y <= cell(point.y()) + 1; ++y) {
        const auto things = cells_.find(key(x, y));
        if (things == cells_.end()) continue;
        for (const auto& [place, thing] : things->second) {
          if (left == 0) return;
          if ((place - point).norm() > reach_m_) continue;
          found(thing);
          --left;
        }
      }
    }
  }

 private:
  std::int64_t cell(double coordinate_m) const {
    return static_cast<std::int64_t>(std::floor(coordinate_m / reach_m_));
  }
  static std::uint64_t key(std::int64_t x, std::int64_t y) {
    return static_cast<std::uint64_t>(x) << 32U ^ (static_cast<std::uint64_t>(y) & 0xffffffffU);
  }

  double reach_m_;
  std::unordered_map<std::uint64_t, std::vector<std::pair<Eigen::Vector2d, std::size_t>>> cells_;
};

}  // namespace roadbed::map::repair
