#pragma once

#include <vector>

#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/planning/route/route.h"

namespace roadbed::planning::inline obstacles {

/// Where other roads pass over or under a route, and so who drives there is not in its way. What is
/// measured has a place in the plane only: it is taken to be on the road along which it heads, if
/// all such roads are on another level.
///
///              ║ ▲ ║
///     ═════════╬═│═╬═══════
///       ×──▶   ║ × ║           heads along the bridge: away
///     ═════════╬═══╬═══════
///              ║   ║
class OtherLevels {
 public:
  /// None.
  OtherLevels() = default;

  /// @param headroom_m  heights that differ by more are levels.
  /// O(length of the route); next to nothing on a flat map.
  OtherLevels(const map::RoadMap& road_map, const Route& route, double headroom_m = 2.5);

  /// Says of each that drives when, from now on, it is first over or under the next 200 m of the
  /// route, or the last 50 m: then it is not there. Who walks may be on any level.
  /// O(length of the route + obstacles × points of their motions).
  void leave_out(const geometry::Pose2& map_from_vehicle, double t_s,
                 std::vector<Obstacle>& obstacles) const;

 private:
  struct Place {
    geometry::Pose2 on_route;
    std::vector<double> same_level_rad, other_level_rad;  ///< headings of lanes around
  };
  using Places = std::vector<const Place*>;

  Places near_other_levels(const geometry::Pose2& map_from_vehicle) const;
  static bool hold(const Places& places, const geometry::Pose2& centre);
  static TimeSpan time_away(const Places& places, double t_s, const Obstacle& obstacle);

  std::vector<Place> places_;  ///< every few metres of the route; none if all is on one level
};

}  // namespace roadbed::planning::obstacles
