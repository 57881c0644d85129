#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "roadbed/map/opendrive/write/road_plan.h"

namespace roadbed::map::opendrive {

using Line3 = std::vector<Eigen::Vector3d>;

/// A border of a section along s, with what goes on before and behind it.
///
///       before        own         behind
///     ○────────●────────────●───────────○
struct RoadBorder {
  Line3 points;
  std::size_t own_from = 0, own_to = 0;  ///< places of the first and last own point
};

/// Border `place` of a section, 0 being the left edge, as one of the lanes beside it has it.
RoadBorder border_along(const RoadMap& road_map, const PlannedSection& section, std::size_t place);

/// The part of a road's source reference line, or the middle border's, that its sections span.
RoadBorder reference_along(const RoadMap& road_map, const PlannedRoad& road, std::size_t border);

/// Ends of roads that lanes join, by number: 2 · road, + 1 at its end. Of each its group.
std::vector<std::uint32_t> joined_ends(const RoadMap& road_map, const RoadPlan& plan);

/// The end of its road at which a lane is left; none in between sections.
std::optional<std::uint32_t> exit_end(const RoadPlan& plan, LaneId lane);
/// The end of its road at which a lane is entered.
std::optional<std::uint32_t> entry_end(const RoadPlan& plan, LaneId lane);

}  // namespace roadbed::map::opendrive
