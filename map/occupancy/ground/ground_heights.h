#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "roadbed/map/occupancy/clouds/point_cloud.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"

namespace roadbed::map::inline occupancy::inline ground {

/// Heights of the ground at points, as it was measured around each of them.
///
///        ♣  ♣             what stands on the ground, or above it
///      ▪ · · · ▪ · · ▪    ▪ lowest layer of a column: the ground, or of what hides it
///      ────────●──────    plane of least squares at the point, near ones weigh more
///
/// Space is divided into columns of 0.25 m (cells of an octree where they are larger). Of each
/// column counts the mean of what lies at most 0.2 m above its lowest point. Through the columns
/// within 2 m goes a plane: first level, at the height that a quarter of them stays below, then in
/// rounds by those ever nearer to the last plane, down to 0.1 m or a cell, each weighted with
/// (1 − (d/2 m)²)² by its distance d [Cleveland 1979, doi:10.1080/01621459.1979.10481038]. So
/// walls, trees and cars may stand around, and of surfaces above one another the lowest is taken.
///
/// None where there are fewer than 8 columns, fewer than 3 in 10 are on the plane, they are in
/// fewer than 6 of the 8 directions around, or the plane is steeper than 0.35. What covers most of
/// the ground around and is level, as the roof of a lorry, counts as ground.
///
/// O(P log P + N) for P measured points near N asked for.
std::vector<std::optional<double>> ground_heights(std::span<const map::PointCloud> clouds,
                                                  std::span<const Eigen::Vector2d> at_in_source);

/// The same from occupied cells; heights are those of middles of cells, so they are off by up to
/// half a cell where the ground is level.
std::vector<std::optional<double>> ground_heights(const map::OccupancySource& occupancy,
                                                  std::span<const Eigen::Vector2d> at_in_source);

}  // namespace roadbed::map::occupancy::ground
