#include "roadbed/map/occupancy/outputs/occupancy_changes.h"

#include <fmt/format.h>

#include <cmath>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/outputs/cell_centres.h"

namespace roadbed::map::inline occupancy::inline outputs {
namespace {

constexpr double kSameGrid = 1e-6;  // of a cell

void check_grids(const OccupancyMap& before, const OccupancyMap& now) {
  const auto refuse = [](const std::string& found, const std::string& needed) {
    throw InputError({.file = "octrees",
                      .found = found,
                      .needed = needed,
                      .remedy = "build both with the same --resolution and in one system"});
  };
  if (before.resolution_m() != now.resolution_m()) {
    refuse(fmt::format("cells of {} m and of {} m", before.resolution_m(), now.resolution_m()),
           "cells of one size");
  }
  if (before.crs() != now.crs()) {
    refuse(fmt::format("\"{}\" and \"{}\"", before.crs(), now.crs()), "one coordinate system");
  }
  const Eigen::Vector3d apart =
      (now.origin_in_source() - before.origin_in_source()) / now.resolution_m();
  if ((apart - apart.array().round().matrix()).cwiseAbs().maxCoeff() > kSameGrid) {
    refuse("origins that are no whole cells apart", "cells in one grid");
  }
}

}  // namespace

OccupancyChanges changes_between(const OccupancyMap& before, const OccupancyMap& now) {
  check_grids(before, now);
  OccupancyChanges changes;
  for (const Eigen::Vector3d& centre : occupied_centres(now, "octree of now")) {
    if (before.at(centre) == CellState::occupied) {
      ++changes.stayed;
    } else {
      changes.appeared.push_back(centre);
    }
  }
  for (const Eigen::Vector3d& centre : occupied_centres(before, "octree of before")) {
    const CellState state = now.at(centre);
    if (state == CellState::free) changes.vanished.push_back(centre);
    if (state == CellState::unknown) ++changes.not_seen_again;
  }
  return changes;
}

}  // namespace roadbed::map::occupancy::outputs
