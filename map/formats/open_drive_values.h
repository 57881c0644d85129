#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "roadbed/geometry/piecewise_cubic.h"
#include "roadbed/map/formats/xml.h"
#include "roadbed/map/lane.h"

namespace roadbed::map::open_drive {

/// Attributes a, b, c, d with the station `s_attribute`, to which `s_add_m` is added.
geometry::CubicRecord read_cubic(const XmlDocument& xml, pugi::xml_node node,
                                 const char* s_attribute, double s_add_m);

/// All children of that name, in order of station.
geometry::PiecewiseCubic read_cubics(const XmlDocument& xml, pugi::xml_node parent,
                                     const char* name, const char* s_attribute, double s_add_m);

std::vector<geometry::CubicRecord> sorted(std::vector<geometry::CubicRecord> records);

/// max with its unit; none for "no limit", "undefined" or where there is none.
/// @throws InputError if the unit is unknown or the speed negative.
std::optional<double> read_speed(const XmlDocument& xml, pugi::xml_node speed);

/// Who may use a lane of that type where the file does not say.
Participants participants_of(LaneType type);

/// OpenDRIVE's name of a lane type; `other` if it is not known.
LaneType lane_type(std::string_view word);

}  // namespace roadbed::map::open_drive
