#include <fmt/format.h>
#include <fmt/ostream.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "roadbed/map/compiled/compiled_map.h"
#include "roadbed/map/derived/map_totals.h"
#include "roadbed/map/files/in_threads.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/lane_table/read.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/planning/route/route_network.h"
#include "roadbed/tools/cli/freed_memory.h"
#include "roadbed/tools/cli/output_format.h"
#include "roadbed/tools/commands/maps/commands.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline maps {
namespace {

constexpr std::uintptr_t kHugePage = std::uintptr_t{1} << 21;
constexpr std::uintptr_t kMapPerFile = 8;  // of memory, a file's size of bytes
// Huge pages that the system has to find first cost more than they save.
constexpr std::uintptr_t kMostHugeBytes = std::uintptr_t{1} << 27;
// Of a larger file, lists that grew out of their place would be too much to keep.
constexpr std::uintmax_t kMostKeptBytes = std::uintmax_t{1} << 27;

// Makes ready the heap for a map that is read from `input`: kept when it is freed, as reading a
// map takes and frees memory of many times the file's size, and for files of up to 16 MB in huge
// pages where the system has them. Touching memory for the first time page by page is a fifth of
// an import. Does nothing for files of more than 128 MB, or where the file is not there.
void keep_heap_in_huge_pages(const std::filesystem::path& input) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(input, error);
  if (error || size > kMostKeptBytes) return;
  keep_freed_memory();
  if (size > kMostHugeBytes / kMapPerFile) return;
  const std::uintptr_t wanted = kMapPerFile * size + kHugePage;
  void* block = std::malloc(wanted);
  if (block == nullptr) return;
  const auto from = (reinterpret_cast<std::uintptr_t>(block) + kHugePage - 1) & ~(kHugePage - 1);
  const auto to = (reinterpret_cast<std::uintptr_t>(block) + wanted) & ~(kHugePage - 1);
  if (to > from) ::madvise(reinterpret_cast<void*>(from), to - from, MADV_HUGEPAGE);
  std::free(block);
}

// The process's end gives memory back at once, which a map does line by line.
void leave_to_the_end(std::unique_ptr<const map::RoadMap> road_map) {
  [[maybe_unused]] static const map::RoadMap* left =
      nullptr;  // still known, so that no checker calls it lost
  left = road_map.release();
}

// A CRS of the user's own in place of the file's.
map::RoadMap with_crs(map::RoadMap road_map, const std::string& crs) {
  if (crs.empty()) return road_map;
  map::RoadMapParts parts = road_map.parts();
  parts.crs = crs == "unknown" ? "" : crs;
  return map::RoadMap(std::move(parts));
}

class ImportCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Read a digital road map and write it as a compiled map");
    arguments
        .add("IN", input_,
             "Map file: OpenDRIVE, Lanelet2, CommonRoad, Argoverse 2, GeoJSON, or a compiled one")
        .required()
        .reads()
        .ending(kMapEndings);
    arguments.add("-o,--output", output_, "Compiled map to write (.rbm); - for standard output")
        .required()
        .writes(".rbm");
    arguments.add("--crs", crs_,
                  "CRS of the map's coordinates (PROJ string, EPSG:CODE, or \"unknown\"), "
                  "where the file gives none or a wrong one; nothing is reprojected");
    arguments
        .add("--columns", columns_,
             "What the columns of a GeoJSON or GeoPackage of lanes of your own mean: a JSON file, "
             "see map/lane_table/README.md")
        .reads();
    arguments
        .add("--max-error", max_error_m_,
             "Largest distance between a sampled border and the true curve [m]")
        .within(1e-6, 1.0)
        .with_default();
    arguments.flag("-j,--json", json_, "Print what was imported as one JSON document");
    arguments.flag("-f,--force", force_, "Replace the output if it exists");
    arguments.require(
        [this] { return standard_output_fault(output_, false, "", json_ ? "--json" : ""); });
    arguments.example(
        "  roadbed import town.xodr -o town.rbm\n"
        "  roadbed import lanes.geojson --columns lanes_columns.json -o lanes.rbm");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    refuse_other_formats();
    map::check_writable(output_, force_);
    if (common.is_alone) keep_heap_in_huge_pages(input_);
    const int threads = common.several_threads();
    auto road_map = std::make_unique<const map::RoadMap>(with_crs(load(threads), crs_));
    write(*road_map, threads);
    if (json_) print_json(streams.out, *road_map);
    if (!common.quiet) report(streams.err, *road_map);
    if (common.is_alone) leave_to_the_end(std::move(road_map));
    return Exit::ok;
  }

 private:
  map::RoadMap load(int threads) {
    if (!columns_.empty()) return load_lane_table();
    const map::LoadOptions options{.max_error_m = max_error_m_, .threads = threads};
    if (map::is_compiled_map(map::stored_start(input_, 16))) return map::load_map(input_, options);
    std::string bytes = map::read_file(input_);
    source_ = map::source_of_content(bytes);
    return map::parse_map(std::move(bytes), map::input_name(input_), options);
  }

  map::RoadMap load_lane_table() const {
    const auto mapping =
        map::lane_table::read_mapping(map::read_file(columns_), map::input_name(columns_));
    return map::RoadMap(
        map::lane_table::read(map::read_file(input_), map::input_name(input_), mapping));
  }

  // Nobody wants a compiled map under the name of another format.
  void refuse_other_formats() const {
    const std::string suffix = map::format_suffix(output_);
    for (const map::Format& format : map::formats()) {
      if (!format.is_written() || format.suffix != suffix) continue;
      throw map::OutputError({.file = output_.string(),
                              .found = "a compiled map is not " + std::string(format.name),
                              .needed = ".rbm",
                              .remedy = "rename the output, or see: roadbed convert"});
    }
  }

  void write(const map::RoadMap& road_map, int threads) const {
    std::string network;
    std::optional<map::MapTotals> totals;
    map::in_threads(2, threads, [&](std::size_t task) {
      if (task == 0) network = planning::write_route_network(planning::route_network_of(road_map));
      if (task == 1) totals = map::totals_of(road_map, threads);
    });
    if (map::is_standard_stream(output_)) {
      return map::write_to_standard_output(
          map::write_compiled_map(road_map, network, source_, totals));
    }
    map::OutputFile output(output_, force_);
    map::write_compiled_map(road_map, network, output, source_, totals);
    output.commit();
  }

  static std::ptrdiff_t faults_of(const map::RoadMap& road_map) {
    return std::ranges::count_if(road_map.import_diagnostics(), &map::ImportDiagnostic::is_fault);
  }

  static void print_json(std::ostream& out, const map::RoadMap& road_map) {
    const Json json{{"format", road_map.format()},
                    {"crs", road_map.crs().empty() ? Json() : Json(road_map.crs())},
                    {"roads", road_map.roads().size()},
                    {"lanes", road_map.lanes().size()},
                    {"junctions", road_map.junctions().size()},
                    {"signals", road_map.signals().size()},
                    {"faults", faults_of(road_map)}};
    out << map::json_text(versioned("import", json), 2) << '\n';
  }

  void report(std::ostream& err, const map::RoadMap& road_map) const {
    const std::ptrdiff_t faults = faults_of(road_map);
    fmt::print(err, "{}: {}, {} roads, {} lanes, {} junctions, {} signals\n", output_name(output_),
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

  std::filesystem::path input_, output_, columns_;
  std::optional<map::MapSource> source_;
  std::string crs_;
  double max_error_m_ = 1e-3;
  bool json_ = false, force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_import_command() { return std::make_unique<ImportCommand>(); }

}  // namespace roadbed::tools::commands::maps
