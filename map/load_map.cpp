#include "roadbed/map/load_map.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "roadbed/map/commonroad/read.h"
#include "roadbed/map/compiled/compiled_map.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/map/files/xml_scanner.h"
#include "roadbed/map/geojson/read.h"
#include "roadbed/map/lanelet2/read.h"
#include "roadbed/map/opendrive/document.h"
#include "roadbed/map/opendrive/read.h"

namespace roadbed::map {
namespace {

// A Lanelet2 map, read without a tree of its elements; none if the text is of another kind.
std::optional<RoadMapParts> read_lanelet2(const std::string& bytes, const std::string& name) {
  const std::string converted = is_other_encoding(bytes) ? to_utf8(bytes) : std::string();
  const std::string& text = converted.empty() ? bytes : converted;
  if (!lanelet2::is_lanelet2(root_element(text))) return {};
  return lanelet2::read(text, name);
}

}  // namespace

RoadMap parse_map(std::string bytes, const std::string& name, const LoadOptions& options) {
  if (is_compiled_map(bytes)) return read_compiled_map(std::move(bytes), name);
  if (geojson::is_geojson(bytes)) return RoadMap(geojson::read(bytes, name));
  if (!looks_like_xml(bytes) && is_other_encoding(bytes)) {  // UTF-16
    if (std::string converted = to_utf8(bytes); !converted.empty()) bytes = std::move(converted);
  }
  if (!looks_like_xml(bytes)) {
    throw InputError(
        {.file = name,
         .place = {},
         .element = {},
         .found = "neither XML nor a compiled map nor JSON",
         .needed = "an OpenDRIVE, Lanelet2, CommonRoad or GeoJSON file, or a compiled map",
         .remedy = "check whether it is the right file"});
  }
  if (auto parts = read_lanelet2(bytes, name)) {
    bytes = {};
    return RoadMap(*std::move(parts));
  }
  XmlDocument xml(std::move(bytes), name);
  if (commonroad::is_common_road(xml.root().name())) return RoadMap(commonroad::read(xml));
  if (!opendrive::is_open_drive(xml.root().name())) {
    throw InputError(
        {.file = name,
         .place = std::to_string(xml.line_of(xml.root())),
         .element = {},
         .found = fmt::format("root element <{}>", xml.root().name()),
         .needed = "<OpenDRIVE>, <osm> or <commonRoad>",
         .remedy = "give an OpenDRIVE, Lanelet2, CommonRoad or GeoJSON file, or a compiled map"});
  }
  return RoadMap(opendrive::read(std::move(xml), options));
}

RoadMap load_map(const std::filesystem::path& file, const LoadOptions& options) {
  if (is_compiled_map(read_file_start(file, 16))) return open_compiled_map(file);
  return parse_map(read_file(file), file.string(), options);
}

}  // namespace roadbed::map
