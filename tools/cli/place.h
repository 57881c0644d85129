#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/route/match_place.h"

namespace roadbed::tools::inline cli {

/// How places are written, for help texts.
inline constexpr const char* kPlaceSyntax =
    "X,Y[,HEADING] in the map's coordinates, heading from their x axis in radians or as 90deg; "
    "lonlat:LON,LAT[,HEADING] in degrees (WGS 84), the same heading; or lane:NAME[@S]";

/// A point, and which way is meant there, in source coordinates.
struct PointPlace {
  Eigen::Vector2d in_source{0, 0};
  std::optional<double> heading_rad;  ///< of any size
};

/// A place on a drivable lane.
struct Place {
  map::LanePlace on_lane;
  geometry::Pose2 map_from_vehicle;  ///< as given; heading of the lane where none is given
  bool has_heading = false;          ///< given, not the lane's
  planning::Sense sense = planning::Sense::either;   ///< which way, on a lane of both directions
  std::vector<planning::PlaceCandidate> candidates;  ///< of a point; the chosen one first

  planning::RoutePlace for_route() const {
    return candidates.empty() ? planning::RoutePlace(on_lane, sense)
                              : planning::route_place_of(candidates);
  }

  /// Takes the candidate that a route has taken.
  void choose(map::LaneId lane);
};

/// What is wrong with the writing of a place, empty if nothing is. Needs no map.
std::string place_syntax_fault(const std::string& text);

/// The same of a point, "X,Y" or "lonlat:LON,LAT".
std::string point_syntax_fault(const std::string& text);

/// Where a point is, in source coordinates; it need not be on the road.
/// @throws InputError, whose element is the text, if it is no point, or longitude and latitude mean
///         nothing on this map.
Eigen::Vector2d find_point(const map::RoadMap& road_map, const std::string& text);

/// Finds a place on the map. Which lane a point belongs to says planning::match_place().
/// @throws InputError, whose element is the text, if it is no place, its lane is not there or not
///         that long, or there is no drivable lane near the point; it names the nearest.
Place find_place(const map::RoadMap& road_map, const std::string& text,
                 map::Participant participant = map::Participant::car);
Place find_place(const map::RoadMap& road_map, const PointPlace& point,
                 map::Participant participant = map::Participant::car);

}  // namespace roadbed::tools::cli
