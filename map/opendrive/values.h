#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/geometry/curves/piecewise_cubic.h"
#include "roadbed/map/elements/lane.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::opendrive {

/// Attributes a, b, c, d with the station `s_attribute`, to which `s_add_m` is added.
geometry::CubicRecord read_cubic(const XmlDocument& xml, pugi::xml_node node,
                                 const char* s_attribute, double s_add_m);

/// All children of that name, in order of station.
geometry::PiecewiseCubic read_cubics(const XmlDocument& xml, pugi::xml_node parent,
                                     const char* name, const char* s_attribute, double s_add_m);

std::vector<geometry::CubicRecord> sorted(std::vector<geometry::CubicRecord> records);

/// max with its unit (m/s if there is none); none for "no limit", "undefined" or where there is no
/// max. A value or unit that nobody can read is remarked and counts as none: a missing speed must
/// not make a road unusable.
std::optional<double> read_speed(const XmlDocument& xml, pugi::xml_node speed,
                                 std::vector<ImportRemark>& remarks);

/// Who may use a lane of that type where the file does not say.
Participants participants_of(LaneType type);

/// Whether the word is "true" or "1".
bool is_true(std::string_view word);

/// '+', '-', or 0 for everything else.
char orientation_of(std::string_view word);

/// <validity> children.
std::vector<std::pair<int, int>> read_lane_ranges(const XmlDocument& xml, pugi::xml_node node);

/// Adds those attributes that the element has, as they stand.
void keep_attributes(pugi::xml_node node, std::initializer_list<const char*> names,
                     Attributes& attributes);

/// A remark that an element could not be read and is left out.
ImportRemark left_out(const char* rule, const InputError& error);

/// Does what `read` does; an InputError becomes a remark, and the element is left out.
template <typename Read>
void read_or_remark(const char* rule, std::vector<ImportRemark>& remarks, const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    remarks.push_back(left_out(rule, error));
  }
}

/// All attributes of an element in one line: "id 5, type limitline".
std::string described(pugi::xml_node node);

/// OpenDRIVE's name of a lane type; `other` if it is not known.
LaneType lane_type(std::string_view word);

}  // namespace roadbed::map::opendrive
