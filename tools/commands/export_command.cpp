#include <fmt/format.h>
#include <fmt/ostream.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/commonroad/write.h"
#include "roadbed/map/drawing/write_svg.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/projection.h"
#include "roadbed/map/gis/layer_frame.h"
#include "roadbed/map/gis/layers.h"
#include "roadbed/map/gis/write_csv.h"
#include "roadbed/map/gis/write_flatgeobuf.h"
#include "roadbed/map/gis/write_geojson.h"
#include "roadbed/map/gis/write_geopackage.h"
#include "roadbed/map/lanelet2/write.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tools/commands/commands.h"
#include "roadbed/tools/files/output_file.h"

namespace roadbed::tools::inline commands {
namespace {

/// What a writer may ask for besides the map.
struct ExportOptions {
  std::vector<std::string> layers;            ///< none: what suits the format
  std::string crs;                            ///< of the output's coordinates, empty if unknown
  bool is_own_crs = false;                    ///< the map's: its offset counts
  std::vector<std::string>* notes = nullptr;  ///< takes what the user should know, a line each
};

/// Coordinates of the CRS where it is known, else the source's raw ones.
std::vector<map::Layer> placed_layers(const map::RoadMap& road_map, const ExportOptions& options) {
  std::vector<map::Layer> layers = map::make_layers(road_map, options.layers);
  map::to_source(road_map, layers);
  if (options.is_own_crs) map::source_to_crs(road_map, layers);
  return layers;
}

std::string geojson(const map::RoadMap& road_map, const ExportOptions& options) {
  std::vector<map::Layer> layers = placed_layers(road_map, options);
  const bool lon_lat = !options.crs.empty();
  if (lon_lat) map::to_lon_lat(options.crs, layers);
  return map::write_geojson(layers, {lon_lat, road_map.format(), road_map.crs()});
}

std::string geopackage(const map::RoadMap& road_map, const ExportOptions& options) {
  return map::write_geopackage(placed_layers(road_map, options), options.crs);
}

std::string flatgeobuf(const map::RoadMap& road_map, const ExportOptions& options) {
  ExportOptions one = options;
  if (one.layers.empty()) one.layers = {"lanes"};
  return map::write_flatgeobuf(placed_layers(road_map, one).front(), options.crs);
}

std::string lanelet2(const map::RoadMap& road_map, const ExportOptions& options) {
  const auto offset = options.is_own_crs ? road_map.offset_in_crs() : map::CrsOffset{};
  map::lanelet2::Lanelet2File file = map::lanelet2::write_lanelet2(road_map, {options.crs, offset});
  if (options.notes != nullptr) *options.notes = std::move(file.notes);
  return std::move(file.bytes);
}

struct Format {
  std::string_view suffix;
  std::string (*write)(const map::RoadMap&, const ExportOptions&);
  std::size_t most_layers;  ///< that may be named for one file
  std::string_view what;    ///< for the help
};

constexpr std::array<Format, 7> kFormats = {{
    {".geojson", geojson, 100, "layers, in longitude and latitude where the system is known"},
    {".gpkg", geopackage, 100, "layers with colours for QGIS (GeoPackage)"},
    {".fgb", flatgeobuf, 1, "one layer (FlatGeobuf)"},
    {".svg",
     [](const map::RoadMap& road_map, const ExportOptions&) { return map::write_svg(road_map); }, 0,
     "a picture"},
    {".csv",
     [](const map::RoadMap& road_map, const ExportOptions&) { return map::write_csv(road_map); }, 0,
     "all lane lines, a row per vertex"},
    {".osm", lanelet2, 0, "lanelets that other programs route on (Lanelet2)"},
    {".xml",
     [](const map::RoadMap& road_map, const ExportOptions&) {
       return map::commonroad::write_common_road(road_map);
     },
     0, "lanes, links and rules (CommonRoad 2020a)"},
}};

template <typename Items, typename Text>
std::string suffixes_listed(const Items& items, std::string_view between, const Text& text) {
  std::string list;
  for (const auto& item : items) {
    if (!list.empty()) list += between;
    list += text(item);
  }
  return list;
}

[[noreturn]] void refuse(const std::string& file, const std::string& found,
                         const std::string& needed, const std::string& remedy) {
  throw map::InputError({.file = file,
                         .place = {},
                         .element = {},
                         .found = found,
                         .needed = needed,
                         .remedy = remedy});
}

/// The format that the output's suffix names.
const Format& format_for(const std::filesystem::path& output) {
  const std::string suffix = output.extension().string();
  for (const Format& format : kFormats) {
    if (format.suffix == suffix) return format;
  }
  refuse(output.string(), fmt::format("the suffix \"{}\" names no format", suffix),
         suffixes_listed(kFormats, ", ",
                         [](const Format& format) { return std::string(format.suffix); }),
         "rename the output");
}

void check_layers(const Format& format, const std::vector<std::string>& layers) {
  if (layers.size() <= format.most_layers) return;
  refuse("--layer", fmt::format("{} given", layers.size()),
         fmt::format("at most {} for {}", format.most_layers, format.suffix),
         "leave some out, or write .gpkg");
}

class ExportCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Write a map in another format, told by the output's suffix");
    arguments.add("MAP", input_, "Any readable map").required();
    arguments
        .add("-o,--output", output_,
             suffixes_listed(kFormats, "; ",
                             [](const Format& format) {
                               return fmt::format("{}: {}", format.suffix, format.what);
                             }))
        .required();
    const std::vector<std::string> names = map::layer_names();
    arguments.add("--layer", layers_, "Only these layers; .fgb holds one, lanes if none is named")
        .one_of(names);
    arguments
        .add("--anchor", anchor_deg_,
             "Latitude and longitude of the map's origin, where its system is unknown")
        .values(2)
        .separated_by(',');
    arguments.add("--crs", crs_,
                  "Coordinate system of the map, in place of what it says itself: EPSG:25832, a "
                  "PROJ string, or \"unknown\"");
    arguments.flag("--force", force_, "Replace the output if it exists");
    arguments.require([this] { return anchor_fault(); });
    arguments.example(
        "  roadbed export town.xodr -o town.svg\n"
        "  roadbed export town.xodr -o town.gpkg\n"
        "  roadbed export town.xodr -o town.geojson --layer lanes --anchor 48.78,9.18");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    const Format& format = format_for(output_);
    check_layers(format, layers_);
    check_writable(output_, force_);
    const map::RoadMap road_map = map::load_map(input_);
    std::vector<std::string> notes;
    const std::string bytes =
        format.write(road_map, {layers_, system_of(road_map), is_own_system(road_map), &notes});
    write_output(output_, bytes);
    if (!common.quiet) {
      fmt::print(streams.err, "{}: {} lanes, {} bytes\n", output_.string(), road_map.lanes().size(),
                 bytes.size());
      for (const std::string& note : notes) fmt::print(streams.err, "note: {}\n", note);
    }
    return Exit::ok;
  }

 private:
  std::string anchor_fault() const {
    if (anchor_deg_.empty()) return {};
    if (std::abs(anchor_deg_[0]) <= 90.0 && std::abs(anchor_deg_[1]) <= 180.0) return {};
    return "--anchor: latitude is within ±90, longitude within ±180";
  }

  std::string system_of(const map::RoadMap& road_map) const {
    const std::string own = crs_.empty() ? road_map.crs() : crs_ == "unknown" ? "" : crs_;
    if (anchor_deg_.empty()) return own;
    if (own.empty()) return map::system_anchored_at(anchor_deg_[0], anchor_deg_[1]);
    refuse(input_.string(), fmt::format("the coordinate system is known: \"{}\"", own),
           "a map of unknown system for --anchor",
           "leave --anchor out, or say --crs unknown if it is wrong");
  }

  bool is_own_system(const map::RoadMap& road_map) const {
    return anchor_deg_.empty() && crs_ != "unknown" && !(crs_.empty() && road_map.crs().empty());
  }

  std::filesystem::path input_, output_;
  std::vector<std::string> layers_;
  std::vector<double> anchor_deg_;
  std::string crs_;
  bool force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_export_command() { return std::make_unique<ExportCommand>(); }

}  // namespace roadbed::tools
