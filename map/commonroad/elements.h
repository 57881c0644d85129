#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "roadbed/map/files/xml.h"

/// Elements that lanelets, signs and scenarios of CommonRoad share.
namespace roadbed::map::commonroad {

/// Where the map's local coordinates begin: (0, 0), or a whole kilometre near the first point where
/// that is more than 20 km out.
Eigen::Vector2d find_origin(const XmlDocument& xml);

/// A `point`: x and y from the origin, and z, 0 where there is none [m].
/// @throws InputError if a number is missing, not finite or beyond any road.
Eigen::Vector3d read_point(const XmlDocument& xml, pugi::xml_node point,
                           const Eigen::Vector2d& origin_in_source);

/// All points of an element, in order.
std::vector<Eigen::Vector3d> read_points(const XmlDocument& xml, pugi::xml_node parent,
                                         const Eigen::Vector2d& origin_in_source);

/// What the children of that name refer to by their attribute `ref`.
std::vector<std::string> references(pugi::xml_node parent, const char* child);

/// The text of an element, blanks at its ends taken off.
std::string text_of(pugi::xml_node node);

/// The texts of the children of that name.
std::vector<std::string> texts(pugi::xml_node parent, const char* child);

}  // namespace roadbed::map::commonroad
