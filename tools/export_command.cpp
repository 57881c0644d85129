#include <fmt/format.h>
#include <fmt/ostream.h>

#include <filesystem>
#include <iostream>

#include "roadbed/map/formats/write_csv.h"
#include "roadbed/map/formats/write_geojson.h"
#include "roadbed/map/formats/write_svg.h"
#include "roadbed/map/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tools/command.h"
#include "roadbed/tools/support/output_file.h"

namespace roadbed::tools {
namespace {

using Writer = std::string (*)(const map::RoadMap&);

std::string write_svg(const map::RoadMap& road_map) { return map::write_svg(road_map); }

/// The format that the output's suffix names.
Writer writer_for(const std::filesystem::path& output) {
  const std::string suffix = output.extension().string();
  if (suffix == ".geojson") return map::write_geojson;
  if (suffix == ".svg") return write_svg;
  if (suffix == ".csv") return map::write_csv;
  throw map::InputError({.file = output.string(),
                         .place = {},
                         .element = {},
                         .found = fmt::format("the suffix \"{}\" names no format", suffix),
                         .needed = ".geojson, .svg or .csv",
                         .remedy = "rename the output"});
}

class ExportCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Write a map in another format, told by the output's suffix");
    arguments.add("MAP", input_, "Any readable map").required();
    arguments
        .add("-o,--output", output_,
             ".geojson: lanes, centrelines, signals; .svg: a picture; .csv: all lane lines")
        .required();
    arguments.flag("--force", force_, "Replace the output if it exists");
    arguments.example("  roadbed export town.xodr -o town.svg");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    const Writer write = writer_for(output_);
    check_writable(output_, force_);
    const map::RoadMap road_map = map::load_map(input_);
    const std::string bytes = write(road_map);
    write_output(output_, bytes);
    if (!common.quiet) {
      fmt::print(streams.err, "{}: {} lanes, {} bytes\n", output_.string(), road_map.lanes().size(),
                 bytes.size());
    }
    return Exit::ok;
  }

 private:
  std::filesystem::path input_, output_;
  bool force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_export_command() { return std::make_unique<ExportCommand>(); }

}  // namespace roadbed::tools
