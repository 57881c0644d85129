#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/projection.h"
#include "roadbed/map/gis/layers.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/tools/commands/commands.h"

namespace roadbed::tools::inline commands {
namespace {

std::string suffixes_with_meaning() {
  std::string list;
  for (const map::Format& format : map::formats()) {
    if (format.write == nullptr) continue;
    list += fmt::format("{}{}: {}", list.empty() ? "" : "; ", format.suffix, format.what);
  }
  return list;
}

[[noreturn]] void refuse(const std::string& file, const std::string& found,
                         const std::string& needed, const std::string& remedy) {
  throw map::InputError({.file = file, .found = found, .needed = needed, .remedy = remedy});
}

void check_layers(const map::Format& format, const std::vector<std::string>& layers) {
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
    arguments.add("-o,--output", output_, suffixes_with_meaning()).required();
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
    const map::Format& format = map::format_to_write(output_);
    check_layers(format, layers_);
    map::check_writable(output_, force_);
    const map::RoadMap road_map = map::load_map(input_);
    std::vector<std::string> notes;
    const std::string bytes =
        format.write(road_map, {layers_, system_of(road_map), is_own_system(road_map), &notes});
    map::write_output(output_, bytes);
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

}  // namespace roadbed::tools::commands
