#include "roadbed/map/formats.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "roadbed/map/argoverse/read.h"
#include "roadbed/map/commonroad/read.h"
#include "roadbed/map/commonroad/write.h"
#include "roadbed/map/compiled/compiled_map.h"
#include "roadbed/map/drawing/write_svg.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/projection.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/map/files/xml_scanner.h"
#include "roadbed/map/geojson/read.h"
#include "roadbed/map/gis/layers.h"
#include "roadbed/map/gis/write.h"
#include "roadbed/map/lanelet2/read.h"
#include "roadbed/map/lanelet2/write/write.h"
#include "roadbed/map/opendrive/read.h"
#include "roadbed/map/opendrive/write/write.h"
#include "roadbed/map/sumo/netconvert.h"
#include "roadbed/map/sumo/write.h"

namespace roadbed::map {
namespace {

/// Whether the root has this name in any namespace.
bool has_root(const FileContent& content, std::string_view name) {
  return content.root.substr(content.root.find(':') + 1) == name;
}

/// Coordinates of the CRS where it is known, else the source's raw ones.
std::vector<Layer> placed_layers(const RoadMap& road_map, const SaveOptions& options) {
  std::vector<Layer> layers = make_layers(road_map, options.layers);
  to_source(road_map, layers);
  if (options.is_own_crs) source_to_crs(road_map, layers);
  return layers;
}

/// Without the system that the map names where PROJ cannot use it, which is noted. One that the
/// user names is not left out.
SaveOptions in_usable_system(const RoadMap& road_map, SaveOptions options) {
  if (options.crs.empty() || options.crs != road_map.crs()) return options;
  const std::string fault = projection_fault(options.crs);
  if (fault.empty()) return options;
  if (options.notes != nullptr) {
    options.notes->push_back(fmt::format(
        "PROJ cannot use the map's coordinate system \"{}\": {}; coordinates are the map's own, of "
        "unknown system (name it with --crs)",
        options.crs, fault));
  }
  options.crs.clear();
  options.is_own_crs = false;
  return options;
}

std::string geojson_bytes(const RoadMap& road_map, const SaveOptions& given) {
  const SaveOptions options = in_usable_system(road_map, given);
  std::vector<Layer> layers = placed_layers(road_map, options);
  const bool lon_lat = !options.crs.empty();
  if (lon_lat) to_lon_lat(options.crs, layers);
  return write_geojson(layers, {lon_lat, road_map.format(), road_map.crs()});
}

std::string geopackage_bytes(const RoadMap& road_map, const SaveOptions& given) {
  const SaveOptions options = in_usable_system(road_map, given);
  return write_geopackage(placed_layers(road_map, options), options.crs);
}

std::string flatgeobuf_bytes(const RoadMap& road_map, const SaveOptions& options) {
  SaveOptions one = in_usable_system(road_map, options);
  if (one.layers.empty()) one.layers = {"lanes"};
  return write_flatgeobuf(placed_layers(road_map, one).front(), one.crs);
}

std::string lanelet2_bytes(const RoadMap& road_map, const SaveOptions& options) {
  const auto offset = options.is_own_crs ? road_map.offset_in_crs() : CrsOffset{};
  lanelet2::Lanelet2File file = lanelet2::write_lanelet2(road_map, {options.crs, offset});
  if (options.notes != nullptr) *options.notes = std::move(file.notes);
  if (options.lost != nullptr) *options.lost = std::move(file.lost);
  return std::move(file.bytes);
}

std::string common_road_bytes(const RoadMap& road_map, const SaveOptions& options) {
  if (options.lost != nullptr) *options.lost = commonroad::lost_in_common_road(road_map);
  return commonroad::write_common_road(road_map);
}

std::string open_drive_bytes(const RoadMap& road_map, const SaveOptions& options) {
  const auto offset = options.is_own_crs ? road_map.offset_in_crs() : CrsOffset{};
  opendrive::OpenDriveFile file = opendrive::write_open_drive(road_map, {options.crs, offset});
  if (options.notes != nullptr) *options.notes = std::move(file.notes);
  if (options.lost != nullptr) *options.lost = std::move(file.lost);
  return std::move(file.bytes);
}

sumo::SumoFiles sumo_files(const RoadMap& road_map, const SaveOptions& given,
                           const std::string& name) {
  const SaveOptions options = in_usable_system(road_map, given);
  const auto offset = options.is_own_crs ? road_map.offset_in_crs() : CrsOffset{};
  sumo::SumoFiles files = sumo::write_sumo(road_map, {name, options.crs, offset});
  if (given.notes != nullptr) {
    given.notes->insert(given.notes->end(), files.notes.begin(), files.notes.end());
  }
  if (given.lost != nullptr) *given.lost = std::move(files.lost);
  return files;
}

std::vector<OutputPart> sumo_parts(const RoadMap& road_map, const SaveOptions& options) {
  sumo::SumoFiles files = sumo_files(road_map, options, options.name);
  return {{".nod.xml", std::move(files.nodes)},
          {".edg.xml", std::move(files.edges)},
          {".con.xml", std::move(files.connections)},
          {".tll.xml", std::move(files.traffic_lights)},
          {".netccfg", std::move(files.configuration)}};
}

std::string sumo_net(const RoadMap& road_map, const SaveOptions& options) {
  sumo::ConvertedNet net = sumo::run_netconvert(sumo_files(road_map, options, "net"));
  if (options.notes != nullptr) {
    for (const std::string& line : net.warnings) options.notes->push_back("netconvert: " + line);
  }
  return std::move(net.bytes);
}

std::string page_bytes(const RoadMap& road_map, const SaveOptions& options) {
  MapPageOptions page = options.page;
  page.crs = options.crs;
  page.is_own_crs = options.is_own_crs;
  page.notes = options.notes;
  return write_map_page(road_map, page);
}

constexpr std::array<Format, 13> kFormats = {{
    {.name = "compiled map",
     .sniff = [](const FileContent& content) { return is_compiled_map(content.bytes); },
     .read = [](std::string bytes, const std::string& name,
                const LoadOptions&) { return read_compiled_map(std::move(bytes), name); }},
    {.name = "OpenDRIVE",
     .sniff = [](const FileContent& content) { return has_root(content, "OpenDRIVE"); },
     .read =
         [](std::string bytes, const std::string& name, const LoadOptions& options) {
           return RoadMap(opendrive::read(XmlDocument(std::move(bytes), name), options),
                          options.threads);
         },
     .judge = judge_open_drive,
     .rules = open_drive_rules,
     .suffix = ".xodr",
     .write = open_drive_bytes,
     .what = "roads with their reference lines, lanes and junctions (OpenDRIVE)"},
    {.name = "Argoverse 2",
     .sniff = [](const FileContent& content) { return argoverse::is_argoverse(content.bytes); },
     .read = [](std::string bytes, const std::string& name,
                const LoadOptions&) { return RoadMap(argoverse::read(bytes, name)); }},
    {.name = "GeoJSON",
     .sniff = [](const FileContent& content) { return geojson::is_geojson(content.bytes); },
     .read = [](std::string bytes, const std::string& name,
                const LoadOptions&) { return RoadMap(geojson::read(bytes, name)); },
     .suffix = ".geojson",
     .write = geojson_bytes,
     .most_layers = 100,
     .what = "layers, in longitude and latitude where the system is known"},
    {.name = "GeoPackage",
     .suffix = ".gpkg",
     .write = geopackage_bytes,
     .most_layers = 100,
     .what = "layers with colours for QGIS (GeoPackage)"},
    {.name = "FlatGeobuf",
     .suffix = ".fgb",
     .write = flatgeobuf_bytes,
     .most_layers = 1,
     .what = "one layer (FlatGeobuf)"},
    {.name = "SVG",
     .suffix = ".svg",
     .write = [](const RoadMap& road_map, const SaveOptions&) { return write_svg(road_map); },
     .what = "a picture"},
    {.name = "page",
     .suffix = ".html",
     .write = page_bytes,
     .what = "a page to look at the map in a browser, without a server"},
    {.name = "CSV",
     .suffix = ".csv",
     .write = [](const RoadMap& road_map, const SaveOptions&) { return write_csv(road_map); },
     .what = "all lane lines, a row per vertex"},
    {.name = "Lanelet2",
     .sniff = [](const FileContent& content) { return content.root == "osm"; },
     .read =
         [](std::string bytes, const std::string& name, const LoadOptions& options) {
           return RoadMap(lanelet2::read(std::move(bytes), name, options.threads), options.threads);
         },
     .judge = judge_lanelet2,
     .rules = lanelet2_rules,
     .suffix = ".osm",
     .write = lanelet2_bytes,
     .what = "lanelets that other programs route on (Lanelet2)"},
    {.name = "CommonRoad",
     .sniff = [](const FileContent& content) { return has_root(content, "commonRoad"); },
     .read =
         [](std::string bytes, const std::string& name, const LoadOptions&) {
           return RoadMap(commonroad::read(commonroad::Document(std::move(bytes), name)));
         },
     .judge = judge_common_road,
     .rules = common_road_rules,
     .suffix = ".xml",
     .write = common_road_bytes,
     .what = "lanes, links and rules (CommonRoad 2020a)"},
    {.name = "SUMO net",
     .suffix = ".net.xml",
     .write = sumo_net,
     .what = "a net for SUMO, by its netconvert"},
    {.name = "SUMO plain files",
     .suffix = ".nod.xml",
     .write_parts = sumo_parts,
     .what = "what netconvert makes a net of: .edg.xml .con.xml .tll.xml .netccfg beside it"},
}};

template <typename Fits>
const Format* find_format(const Fits& fits) {
  const auto found = std::find_if(kFormats.begin(), kFormats.end(), fits);
  return found == kFormats.end() ? nullptr : &*found;
}

}  // namespace

std::span<const Format> formats() { return kFormats; }

const Format* format_of(const std::string& bytes) {
  const FileContent content{bytes, looks_like_xml(bytes) ? root_element(bytes) : ""};
  return find_format(
      [&](const Format& format) { return format.sniff != nullptr && format.sniff(content); });
}

const Format* format_of(const std::filesystem::path& file) {
  try {
    return format_of(read_file_start(file, 100'000));
  } catch (const InputError&) {
    return nullptr;
  }
}

const Format* format_of(const RoadMap& road_map) {
  return find_format(
      [&](const Format& format) { return road_map.format().starts_with(format.name); });
}

std::vector<OutputPart> Format::output(const RoadMap& road_map, const SaveOptions& options) const {
  if (write_parts != nullptr) return write_parts(road_map, options);
  std::vector<OutputPart> one;
  one.push_back({std::string(suffix), write(road_map, options)});
  return one;
}

std::string format_suffix(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  std::string longest = file.extension().string();
  for (const Format& one : kFormats) {
    const bool fits = name.size() > one.suffix.size() && name.ends_with(one.suffix);
    if (fits && one.suffix.size() > longest.size()) longest = one.suffix;
  }
  return longest;
}

const Format& format_to_write(const std::filesystem::path& file, const std::string& suffix) {
  const Format* format =
      find_format([&](const Format& one) { return one.is_written() && one.suffix == suffix; });
  if (format != nullptr) return *format;
  std::string known;
  for (const Format& one : kFormats) {
    if (one.is_written()) known += fmt::format("{}{}", known.empty() ? "" : ", ", one.suffix);
  }
  throw InputError({.file = file.string(),
                    .found = fmt::format("the suffix \"{}\" names no format", suffix),
                    .needed = known,
                    .remedy = suffix == ".rbm" ? "see: roadbed import" : "rename the output"});
}

}  // namespace roadbed::map
