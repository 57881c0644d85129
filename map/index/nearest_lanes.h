#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "roadbed/map/elements/lane_match.h"
#include "roadbed/map/index/lane_index_data.h"

namespace roadbed::map::inline index::lane_index {

/// A lane that a search has met.
struct Candidate {
  std::uint32_t lane = 0;
  bool inside = false;
  double squared_m2 = std::numeric_limits<double>::infinity();  ///< to the lane's ring
};

/// A box of a level of the tree, and how far it is.
struct Visit {
  float squared_m2;
  std::uint32_t level;
  std::uint64_t at;
};

/// Memory that searches use one after the other.
struct Scratch {
  std::vector<const Cell*> around;  ///< cells whose box holds the point
  std::vector<Visit> beside;        ///< boxes next to those that hold the point
  std::vector<Candidate> candidates;
  std::vector<double> ranked;
  std::vector<LaneMatch> found;
};

/// Leaves in scratch.found what `LaneIndex::near` finds around one point.
/// @param levels     of the data: level_starts().
/// @param at_most_m  as many lanes as asked for are known to be no farther; may be infinite.
///                   What is found is the same, but sooner.
void find_nearest(const Data& data, const std::vector<std::uint64_t>& levels,
                  const LaneQuery& query, const Eigen::Vector2d& point, double at_most_m,
                  Scratch& scratch);

/// Whether `find_nearest` would find any lane, without its place.
bool is_any_near(const Data& data, const std::vector<std::uint64_t>& levels, const LaneQuery& query,
                 const Eigen::Vector2d& point, Scratch& scratch);

}  // namespace roadbed::map::index::lane_index
