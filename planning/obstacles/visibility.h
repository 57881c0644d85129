#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"

namespace roadbed::planning::inline obstacles {

/// What can be seen from a vehicle, in plan view: by two eyes where its mirrors are, up to a range,
/// past the bodies of others and occupied cells.
///
///            ▒▒▒▒▒▒▒▒▒▒▒▒▒▒▒▒▒▒▒  hidden
///        ┌─────┐▒▒▒▒▒▒▒▒▒▒▒▒▒
///     ╱──┤     │▒▒▒▒▒▒▒▒
///   ▭▶───┴─────┘
class Visibility {
 public:
  /// @param range_m  farther away nothing is seen.
  /// @param others   bodies that hide what is behind them.
  /// @param field    occupied cells that do; none: nothing is known of any.
  Visibility(const geometry::Rectangle& vehicle, double range_m,
             std::vector<geometry::Rectangle> others,
             std::shared_ptr<const map::ClearanceField> field, const map::RoadMap& road_map);

  /// Whether a point is seen. O(others).
  bool sees(const Eigen::Vector2d& point) const;

  /// Whether a point is on, or within 0.5 m of, the body of one of the others.
  bool is_on_body(const Eigen::Vector2d& point) const;

  /// Whether a corner or the middle of one of the others is seen, past the rest; occupied cells
  /// around its body may be its own.
  bool sees_other(std::size_t other) const;

 private:
  bool is_seen(const Eigen::Vector2d& point, std::size_t but) const;
  bool is_hidden_by_cells(const geometry::Rectangle& sight, double but_last_m) const;

  std::array<Eigen::Vector2d, 2> eyes_;
  double range_m_;
  std::vector<geometry::Rectangle> others_;
  std::shared_ptr<const map::ClearanceField> field_;
  const map::RoadMap& road_map_;
};

}  // namespace roadbed::planning::obstacles
