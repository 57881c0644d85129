#include "roadbed/map/opendrive/element_readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "roadbed/map/files/visible_text.h"

namespace roadbed::map::opendrive {
namespace {

void read_revision(AttributeReader& in, pugi::xml_node header, Document& document) {
  const std::string major = header.attribute("revMajor").value();
  const std::string minor = header.attribute("revMinor").value();
  if (!major.empty() && major != "1") {
    in.refuse(header, fmt::format("OpenDRIVE revision {}.{}", major, minor), "revision 1.4 to 1.8",
              "convert the file to a 1.x revision");
  }
  document.version = major.empty() ? "of unknown revision" : major + "." + minor;
  if (major.empty() || minor.empty()) {
    document.remarks.push_back({"import.version", true, "header", in.xml.line_of(header),
                                "revMajor or revMinor is missing; state the revision"});
  }
}

// All text and CDATA of an element, without the space around it.
std::string text_of(pugi::xml_node node) {
  std::string text = node.value();  // what stands first is kept in the element itself
  for (const auto child : node.children()) {
    if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata) {
      text += child.value();
    }
  }
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return {};
  return one_line(text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1));
}

// Whether the text is of a kind that names a CRS at all: a PROJ string, a code, or WKT.
bool names_a_crs(std::string_view text) {
  static constexpr std::array<std::string_view, 12> beginnings = {
      "EPSG:",    "epsg:",     "urn:",    "PROJCS[",      "PROJCRS[",  "GEOGCS[",
      "GEOGCRS[", "COMPD_CS[", "GEOCCS[", "COMPOUNDCRS[", "BOUNDCRS[", "GEODCRS["};
  const bool begins = std::any_of(beginnings.begin(), beginnings.end(),
                                  [&](std::string_view b) { return text.starts_with(b); });
  return begins || text.starts_with("proj=") || text.find("+proj=") != std::string_view::npos ||
         text.find("+init=") != std::string_view::npos;
}

void read_crs(const XmlDocument& xml, pugi::xml_node header, Document& document) {
  const auto node = header.child("geoReference");
  document.crs = text_of(node);
  if (!document.crs.empty() && !names_a_crs(document.crs)) {
    document.remarks.push_back(
        {"import.crs", true, "geoReference", xml.line_of(node),
         "names no projection (+proj=…, EPSG:… or WKT); it is kept as text and nothing is "
         "reprojected by it, correct it or set one with import --crs"});
  }
}

void read_offset(const XmlDocument& xml, pugi::xml_node header, Document& document) {
  const auto node = header.child("offset");
  if (!node) return;
  const auto value = [&](const char* name) { return xml.optional_number(node, name); };
  const auto x = value("x"), y = value("y"), z = value("z"), heading = value("hdg");
  if (!x || !y) {
    document.remarks.push_back({"import.crs", true, "offset", xml.line_of(node),
                                "x or y is no number; the offset is left out, correct it"});
    return;
  }
  document.offset_in_crs = {*x, *y, z.value_or(0.0), heading.value_or(0.0)};
}

}  // namespace

void read_header(AttributeReader& in, Document& document) {
  const pugi::xml_node header = in.xml.root().child("header");
  read_revision(in, header, document);
  read_crs(in.xml, header, document);
  read_offset(in.xml, header, document);
}

}  // namespace roadbed::map::opendrive
