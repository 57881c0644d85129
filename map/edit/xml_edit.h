#pragma once

#include <array>
#include <functional>
#include <pugixml.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/files/xml.h"

namespace roadbed::map::inline edit {

/// The number that an attribute is; 0 where there is none.
double number(pugi::xml_node node, const char* attribute);

/// The text of an attribute; empty where there is none.
std::string text(pugi::xml_node node, const char* attribute);

/// Writes a number so that reading it gives the same; the attribute is made where it is missing.
void set_number(pugi::xml_node node, const char* attribute, double value);
void set_text(pugi::xml_node node, const char* attribute, std::string_view value);

/// All children of that name, a list of its own: they may be removed one by one.
std::vector<pugi::xml_node> children(pugi::xml_node parent, const char* name);

/// Takes all children of that name off.
void remove_children(pugi::xml_node parent, const char* name);

/// The child of that name, made at the end where it is missing.
pugi::xml_node child_of(pugi::xml_node parent, const char* name);

/// The same, in the place that it has among children in this order.
pugi::xml_node ordered_child(pugi::xml_node parent, const char* name,
                             std::span<const std::string_view> order);

/// A copy of an element as a child, behind those of its name, else in the place that it has among
/// children in this order.
pugi::xml_node insert_ordered(pugi::xml_node parent, pugi::xml_node element,
                              std::span<const std::string_view> order);

/// Order of the children of OpenDRIVE's `<road>` and `<lane>`.
inline constexpr std::array<std::string_view, 11> kRoadOrder = {
    "link",    "type",    "planView", "elevationProfile", "lateralProfile", "lanes",
    "objects", "signals", "surface",  "railroad",         "userData"};
inline constexpr std::array<std::string_view, 11> kLaneOrder = {
    "link",  "border", "width",  "roadMark", "material", "visibility",
    "speed", "access", "height", "rule",     "userData"};

/// Whether two elements say the same: names, attributes, texts and children, in order. Attributes
/// and children of which `ignored` is true are left out.
using Ignored = std::function<bool(pugi::xml_node element)>;
bool say_the_same(pugi::xml_node a, pugi::xml_node b, const Ignored& ignored);

/// A whole document as text, comments included; blanks between elements are made anew with two or
/// more spaces, or tabs, as the file begins its second line of elements; without any where elements
/// are nested 100 deep.
/// @param indent  of one level, see indent_of.
std::string text_of(const XmlDocument& xml, const std::string& indent);
std::string text_of(pugi::xml_node root, const std::string& indent, std::size_t likely_bytes);

/// How a text indents its elements: the blanks before the first one inside the root.
std::string indent_of(std::string_view text);

}  // namespace roadbed::map::edit
