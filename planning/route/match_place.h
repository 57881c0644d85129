#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/route/route_place.h"

namespace roadbed::planning::inline route {

/// What speaks for or against a lane as the place that a point means.
enum class MatchVerdict { chosen, possible, against_heading, not_for_participant, too_far };
std::string_view to_string(MatchVerdict verdict);

/// A lane that a point may mean.
struct PlaceCandidate {
  map::LanePlace place;
  double distance_m = 0.0;      ///< to the lane; 0 on it
  double heading_rad = 0.0;     ///< of the lane, as it is driven
  Sense sense = Sense::either;  ///< which way, where a heading is given and it may be both
  double misfit_m = 0.0;        ///< the lane with the least is chosen
  MatchVerdict verdict = MatchVerdict::possible;
};

/// How a point is matched to a lane.
struct MatchOptions {
  map::Participant participant = map::Participant::car;
  double reach_m = 0.5;            ///< a point belongs to lanes that are so near
  double metres_per_radian = 2.0;  ///< what a turn counts beside a distance from the lane
  double offset_weight = 0.1;      ///< and what a distance from the centreline does
};

/// Lanes that a point may belong to, the chosen one first. A lane may be used by the participant,
/// is within reach and, where a heading is given and any lane fits it, not against it by 90° or
/// more; of those the one with the least misfit is chosen, of equal ones the one with the lowest
/// id (a route takes any of them, see route_place_of):
///
///     misfit = distance to the lane + 2 m/rad · |turn| + 0.1 · |offset from the centreline|
///
/// A lane of both directions is taken the way that fits the heading better; without a heading it
/// may be driven either way. Where no lane is within reach the three nearest ones that may be used
/// are given as `too_far`.
std::vector<PlaceCandidate> match_place(const map::RoadMap& road_map, const Eigen::Vector2d& in_map,
                                        std::optional<double> heading_rad,
                                        const MatchOptions& options = {});

/// The place that such lanes mean to a route: the chosen one, or any other that fits as well within
/// a centimetre. @pre the first one is chosen
RoutePlace route_place_of(const std::vector<PlaceCandidate>& candidates);

/// Where a vehicle that stands on lanes of the map may set off: on each lane under it that it heads
/// along, within 20 degrees, the one with the least misfit first.
std::vector<RoutePlace> places_under(const map::RoadMap& road_map,
                                     const geometry::Pose2& map_from_vehicle);

/// The same; where there is none, the lane within 3 m that fits it best, as on a driveway or at an
/// angle in a lane, if it does not head against it.
std::vector<RoutePlace> places_to_set_off(const map::RoadMap& road_map,
                                          const geometry::Pose2& map_from_vehicle);

}  // namespace roadbed::planning::route
