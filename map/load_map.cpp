#include "roadbed/map/load_map.h"

#include <fmt/format.h>

#include <utility>

#include "roadbed/map/compiled/compiled_map.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/map/storage/output_file.h"

namespace roadbed::map {
namespace {

[[noreturn]] void refuse(std::string bytes, const std::string& name) {
  if (!looks_like_xml(bytes)) {
    throw InputError(
        {.file = name,
         .found = "neither XML nor a compiled map nor JSON",
         .needed =
             "an OpenDRIVE, Lanelet2, CommonRoad, Argoverse 2 or GeoJSON file, or a compiled map",
         .remedy = "check whether it is the right file"});
  }
  const XmlDocument xml(std::move(bytes), name);
  throw InputError(
      {.file = name,
       .place = std::to_string(xml.line_of(xml.root())),
       .found = fmt::format("root element <{}>", xml.root().name()),
       .needed = "<OpenDRIVE>, <osm> or <commonRoad>",
       .remedy = "give an OpenDRIVE, Lanelet2, CommonRoad or GeoJSON file, or a compiled map"});
}

}  // namespace

MapBytes map_bytes(std::string bytes, const std::string& name) {
  if (!looks_like_xml(bytes)) bytes = in_utf8(std::move(bytes));  // UTF-16
  const Format* format = format_of(bytes);
  if (format == nullptr) refuse(std::move(bytes), name);
  return {std::move(bytes), *format};
}

RoadMap parse_map(std::string bytes, const std::string& name, const LoadOptions& options) {
  MapBytes map = map_bytes(std::move(bytes), name);
  return map.format.read(std::move(map.bytes), name, options);
}

RoadMap load_map(const std::filesystem::path& file, const LoadOptions& options) {
  if (is_compiled_map(stored_start(file, 16))) return open_compiled_map(file);
  return parse_map(read_file(file), input_name(file), options);
}

void save_map(const RoadMap& road_map, const std::filesystem::path& file,
              const SaveOptions& options) {
  write_output(file, format_to_write(file).write(road_map, options), true);
}

}  // namespace roadbed::map
