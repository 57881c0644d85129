#include "roadbed/map/load_map.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "roadbed/map/compiled/compiled_map.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/map/storage/output_place.h"

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
  SaveOptions named = options;
  named.name = file.filename().string();
  named.name.resize(named.name.size() - format_suffix(file).size());
  write_output_parts(file, format_to_write(file).output(road_map, named), true);
}

void write_output_parts(const std::filesystem::path& file, const std::vector<OutputPart>& parts,
                        bool force, const std::vector<std::filesystem::path>& inputs) {
  if (parts.size() == 1) return write_output(file, parts.front().bytes, force);
  std::string stem = file.string();
  const std::string& own = parts.front().suffix;
  stem.resize(stem.size() - (stem.ends_with(own) ? own : file.extension().string()).size());
  std::vector<std::unique_ptr<OutputFile>> files;
  for (const OutputPart& part : parts) {
    const std::filesystem::path name = &part == &parts.front() ? file
                                       : part.name.empty()
                                           ? std::filesystem::path(stem + part.suffix)
                                           : file.parent_path() / part.name;
    check_writable(name, force);
    refuse_input(name, inputs);
    files.push_back(std::make_unique<OutputFile>(name, force));
    files.back()->write(0, part.bytes);
  }
  for (const auto& one : files) one->commit();
}

}  // namespace roadbed::map
