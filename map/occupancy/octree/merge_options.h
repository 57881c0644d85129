#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <string>

#include "roadbed/map/occupancy/octree/occupancy_source.h"

namespace roadbed::map::inline occupancy::inline octree {

/// An occupancy, and its name in messages.
struct NamedOccupancy {
  const OccupancySource* occupancy;
  std::string name;
};

/// How much of something stays.
enum class Stays { nothing, part, all };

/// The part of space that stays: cells of the finest size whose middle lies in it.
struct OccupancyPart {
  /// @param middle_in_source, radius_m  a disc in plan view; of radius 0 it is never `part`.
  using InPlan = std::function<Stays(const Eigen::Vector2d& middle_in_source, double radius_m)>;

  static constexpr double kAnywhere = std::numeric_limits<double>::infinity();

  Box3 box = {Eigen::Vector3d::Constant(-kAnywhere), Eigen::Vector3d::Constant(kAnywhere)};
  InPlan in_plan = {};  ///< what stays of the box; none: all
};

/// How occupancies become one.
struct MergeOptions {
  /// A cell is occupied where one of them says so, else free where one does. Off: the log-odds of
  /// all are added up and kept within OctoMap's limits; of a `.bt` these are the limits themselves.
  bool sticky_hits = true;
  OccupancyPart part = {};
};

}  // namespace roadbed::map::occupancy::octree
