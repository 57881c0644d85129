#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/files/xml.h"

namespace roadbed::map::commonroad {

using ElementsById = std::map<std::string_view, pugi::xml_node>;

/// A CommonRoad file (2018b, 2020a) as it stands, faults and all.
struct Document {
  /// @throws InputError if the bytes are no XML.
  Document(std::string bytes, std::string name);

  auto lanelets() const { return xml.root().children("lanelet"); }

  XmlDocument xml;
  ElementsById lanelet_by_id, sign_by_id, light_by_id;  ///< the first of each id
};

/// Whether a link of a lanelet (`successor`, `predecessor`, `adjacentLeft`, `adjacentRight`) has
/// its counterpart in the other one, for adjacent ones in the same direction.
bool is_answered(pugi::xml_node lanelet, pugi::xml_node link, pugi::xml_node other);

/// What the counterpart of a link is called: "predecessor" of "successor".
const char* counterpart(pugi::xml_node link);

/// Whether an adjacent lanelet is driven in the same direction.
bool is_same_direction(pugi::xml_node adjacent);

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
