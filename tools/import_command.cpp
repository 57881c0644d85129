#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "roadbed/map/compiled_map.h"
#include "roadbed/map/load_map.h"
#include "roadbed/planning/stored_network.h"
#include "roadbed/tools/command.h"
#include "roadbed/tools/support/heap.h"
#include "roadbed/tools/support/output_file.h"

namespace roadbed::tools {
namespace {

// A CRS of the user's own in place of the file's.
map::RoadMap with_crs(map::RoadMap road_map, const std::string& crs) {
  if (crs.empty()) return road_map;
  map::RoadMapParts parts = road_map.parts();
  parts.crs = crs;
  return map::RoadMap(std::move(parts));
}

class ImportCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Read a digital road map and write it as a compiled map");
    arguments
        .add("IN", input_, "Map file: OpenDRIVE, Lanelet2, CommonRoad, GeoJSON, or a compiled one")
        .required();
    arguments.add("-o,--output", output_, "Compiled map to write (.rbm)").required();
    arguments.add("--crs", crs_,
                  "CRS of the map's coordinates (PROJ string or EPSG:CODE), where "
                  "the file gives none or a wrong one; nothing is reprojected");
    arguments
        .add("--max-error", max_error_m_,
             "Largest distance between a sampled border and the true curve [m]")
        .within(1e-6, 1.0)
        .with_default();
    arguments.flag("--force", force_, "Replace the output if it exists");
    arguments.example("  roadbed import town.xodr -o town.rbm");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    check_writable(output_, force_);
    keep_heap_in_huge_pages(input_);
    const map::RoadMap road_map =
        with_crs(map::load_map(input_, {.max_error_m = max_error_m_}), crs_);
    const std::string network = planning::write_route_network(planning::route_network_of(road_map));
    OutputFile output(output_);
    map::write_compiled_map(road_map, network, output);
    output.commit();
    if (!common.quiet) report(streams.err, road_map);
    return Exit::ok;
  }

 private:
  void report(std::ostream& err, const map::RoadMap& road_map) const {
    const auto& remarks = road_map.remarks();
    const auto faults = std::count_if(remarks.begin(), remarks.end(),
                                      [](const map::ImportRemark& r) { return r.is_fault; });
    fmt::print(err, "{}: {}, {} roads, {} lanes, {} junctions, {} signals\n", output_.string(),
               road_map.format(), road_map.roads().size(), road_map.lanes().size(),
               road_map.junctions().size(), road_map.signals().size());
    if (road_map.crs().empty()) {
      fmt::print(err, "note: the file names no CRS; give --crs if you know it\n");
    }
    if (faults > 0) {
      fmt::print(err,
                 "note: {} faults of the file were mended or left out; see: roadbed validate\n",
                 faults);
    }
  }

  std::filesystem::path input_, output_;
  std::string crs_;
  double max_error_m_ = 1e-3;
  bool force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_import_command() { return std::make_unique<ImportCommand>(); }

}  // namespace roadbed::tools
