#pragma once

#include <filesystem>
#include <string>

#include "roadbed/map/formats.h"
#include "roadbed/map/model/load_options.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map {

/// Reads any readable map, a compiled one too; the format is told by content.
/// @throws InputError if the file is missing, unreadable, of no known format or unusable.
RoadMap load_map(const std::filesystem::path& file, const LoadOptions& options = {});

/// The same from bytes; `name` stands for the file in messages.
RoadMap parse_map(std::string bytes, const std::string& name, const LoadOptions& options = {});

/// Writes a map in the format that the file's suffix names, over what is there: at every moment
/// there is the old file, or the new one, whole. Compiled maps are written by write_compiled_map().
/// @throws InputError if the suffix names none, or the format cannot hold the map.
/// @throws OutputError if the file cannot be written.
void save_map(const RoadMap& road_map, const std::filesystem::path& file,
              const SaveOptions& options = {});

/// Writes the files of an output beside each other: none is put in place before all are written.
/// @param file  that of the first part; its suffix is the first's, or its own.
/// @param inputs  never replaced.
/// @throws OutputError if one of them cannot be written, or is there without `force`.
void write_output_parts(const std::filesystem::path& file, const std::vector<OutputPart>& parts,
                        bool force, const std::vector<std::filesystem::path>& inputs = {});

/// A map file's bytes, XML in UTF-16 as UTF-8, and their format.
struct MapBytes {
  std::string bytes;
  const Format& format;
};

/// @throws InputError if they are of no known format.
MapBytes map_bytes(std::string bytes, const std::string& name);

}  // namespace roadbed::map
