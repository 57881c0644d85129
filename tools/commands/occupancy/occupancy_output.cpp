#include "roadbed/tools/commands/occupancy/occupancy_output.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <iostream>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/occupancy/octree/tile_builder.h"
#include "roadbed/map/occupancy/octree/tiled_occupancy.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/map/storage/output_folder.h"
#include "roadbed/tools/cli/output_format.h"

namespace roadbed::tools::inline commands::inline occupancy {

OccupancyInputs::OccupancyInputs(const std::vector<std::filesystem::path>& files) {
  for (const std::filesystem::path& file : files) {
    names_.push_back(map::input_name(file));
    occupancies_.push_back(map::open_occupancy(file));
  }
}

std::vector<map::NamedOccupancy> OccupancyInputs::sources() const {
  std::vector<map::NamedOccupancy> sources;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    sources.push_back({occupancies_[i].get(), names_[i]});
  }
  return sources;
}

std::optional<std::int64_t> OccupancyInputs::side_cells() const {
  for (const auto& occupancy : occupancies_) {
    const auto* tiled = dynamic_cast<const map::TiledOccupancy*>(occupancy.get());
    if (tiled != nullptr) return tiled->index().side_cells;
  }
  return std::nullopt;
}

void OccupancyOutput::declare(Arguments& arguments) {
  arguments
      .add("-o,--output", file_,
           "OctoMap file to write (.bt, or .ot with log-odds), or a folder (.tiles); - for "
           "standard output")
      .required()
      .writes(".bt");
  declare_format(arguments, format_, {".bt", ".ot"});
  arguments
      .add("--tiles", tiles_m_,
           "Sides of the tiles of a folder [m], or little longer (default: those of the input)")
      .within(1.0, 1e5);
  arguments.flag("-f,--force", force_, "Replace the output if it exists");
}

std::string OccupancyOutput::suffix() const { return suffix_of_output(file_, format_); }

std::string OccupancyOutput::fault() const {
  const std::string fault = standard_output_fault(file_, true, format_, "");
  if (!fault.empty()) return fault;
  if (suffix() != ".bt" && suffix() != ".ot" && suffix() != ".tiles") {
    return "--output: " + file_.string() + " ends in none of .bt, .ot and .tiles";
  }
  if (tiles_m_ && suffix() != ".tiles") return "--tiles needs an output that ends in .tiles";
  return {};
}

void OccupancyOutput::check() const {
  if (suffix() != ".tiles") map::check_writable(file_, force_);
}

Exit OccupancyOutput::write(const map::OccupancyMerge& merge, const OccupancyInputs& inputs,
                            const Streams& streams, const CommonOptions& common) const {
  std::size_t nodes = 0;
  const std::string said = suffix() == ".tiles" ? write_tiles(merge, side_cells(inputs), nodes)
                                                : write_octree(merge, nodes);
  if (!common.quiet) {
    fmt::print(streams.err, "{}: {}\n", output_name(file_), said);
    if (nodes == 0) fmt::print(streams.err, "nothing of the input is in it\n");
  }
  return nodes > 0 ? Exit::ok : Exit::no;
}

std::int64_t OccupancyOutput::side_cells(const OccupancyInputs& inputs) const {
  if (tiles_m_) return map::tile_side_cells(*tiles_m_, inputs.front().resolution_m());
  if (const auto side = inputs.side_cells()) return *side;
  throw map::InputError({.file = file_.string(),
                         .found = "no side of its tiles is known, as no input has any",
                         .needed = "one",
                         .remedy = "give --tiles SIDE"});
}

std::string OccupancyOutput::write_octree(const map::OccupancyMerge& merge,
                                          std::size_t& nodes) const {
  const map::OccupancyMap::File file = suffix() == ".ot" ? merge.ot() : merge.bt();
  map::write_output(file_, file.bytes, force_);
  nodes = file.nodes;
  return fmt::format("{} nodes, {} bytes", file.nodes, file.bytes.size());
}

std::string OccupancyOutput::write_tiles(const map::OccupancyMerge& merge, std::int64_t side_cells,
                                         std::size_t& nodes) const {
  map::OutputFolder folder(file_, {.force = force_, .is_dropped = map::is_tile_file_name});
  const map::TilesIndex index = merge.tiles(
      side_cells,
      [&](const std::string& name, std::string_view bytes) { folder.write(name, bytes); });
  folder.write(map::tiles_index_file("").string(), map::write_tiles_index(index));
  folder.commit();
  for (const map::OccupancyTile& tile : index.tiles) nodes += tile.nodes;
  return fmt::format("{} tiles of {} m", index.tiles.size(), index.side_m());
}

}  // namespace roadbed::tools::commands::occupancy
