#pragma once

#include <string>
#include <string_view>

#include "roadbed/geometry/pose2.h"
#include "roadbed/map/road_map.h"

namespace roadbed::tools {

/// A place on the map, as the user named it.
struct Place {
  map::LanePlace on_lane;            ///< the lane it is on, and where
  geometry::Pose2 map_from_vehicle;  ///< of a vehicle whose rear axle is there
};

/// Where the text of a place stood, for messages.
struct PlaceOrigin {
  std::string file;     ///< "scenario.json", or the option: "--from"
  std::string pointer;  ///< JSON pointer in the file; empty for an option
};

/// Farthest from a drivable lane that a point may be [m].
inline constexpr double kMostOffLane_m = 3.0;

/// Finds a place written as one of
///
///     X,Y           source coordinates [m]; on the nearest drivable lane, along it
///     X,Y,HEADING   heading in degrees, counter-clockwise from the x axis; the lane is the one
///                   that is near and points the same way: least distance + 2 m per radian off,
///                   among those less than 90° off
///     lane:NAME     a lane's start
///     lane:NAME@S   a station along it [m]
///
/// @throws InputError if the text is none of these, the lane is not there or too short, or the
///         point is off the road.
Place find_place(const map::RoadMap& road_map, std::string_view text, const PlaceOrigin& origin);

}  // namespace roadbed::tools
