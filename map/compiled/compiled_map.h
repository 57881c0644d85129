#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "roadbed/map/derived/map_totals.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/storage/chunked_file.h"

namespace roadbed::map::inline compiled {

/// The compiled form of a map (`.rbm`): everything of it, with the index that locates points,
/// ready to use. map/README.md shows its layout. The second form puts a routing section in place of
/// the map's own, see RoadMapIndex.
std::string write_compiled_map(const RoadMap& road_map);
std::string write_compiled_map(const RoadMap& road_map, std::string_view routing);

/// What the file held, unpacked, that a map was compiled from: `validate` knows by it the file
/// whose text it looks at again. It does not say where the file was.
struct MapSource {
  std::uint64_t bytes = 0;
  std::uint64_t hash = 0;  ///< XXH3

  bool operator==(const MapSource&) const = default;
};

/// Of the content of a map file.
MapSource source_of_content(std::string_view content);

/// A compiled map that names its source.
/// @param totals  `totals_of` the map, where they have been added up before.
std::string write_compiled_map(const RoadMap& road_map, std::string_view routing,
                               const std::optional<MapSource>& source,
                               const std::optional<MapTotals>& totals = {});

/// The same into a sink, piece by piece: the file never stands in memory.
void write_compiled_map(const RoadMap& road_map, std::string_view routing, ByteSink& sink,
                        const std::optional<MapSource>& source = {},
                        const std::optional<MapTotals>& totals = {});

/// What a compiled map says of its source; none if it says nothing.
/// @throws InputError if the file is no compiled map, or damaged there.
std::optional<MapSource> source_of_compiled_map(const std::filesystem::path& file);

/// Whether the bytes begin as a compiled map does.
bool is_compiled_map(std::string_view bytes);

/// Opens a compiled map without reading it: header and section table are checked now, chunks of
/// 64 KiB with what is in them when they are first touched. From then on every function of the
/// map that touches a damaged place throws InputError.
/// @throws InputError if the header is cut, changed or of another version.
RoadMap open_compiled_map(const std::filesystem::path& file);

/// The same of bytes in memory; `name` stands for the file in messages.
RoadMap read_compiled_map(std::string bytes, const std::string& name);

/// How much of a map's compiled file has been loaded so far, in chunks of 64 KiB; nothing of a map
/// that is not of one.
struct LoadedChunks {
  std::size_t loaded = 0, of = 0;
};
LoadedChunks loaded_chunks(const RoadMap& road_map);

/// What has been looked at.
struct VerifiedMap {
  std::size_t chunks = 0, records = 0;
};

/// Checks all of a compiled map: every chunk, every record of every list, the index, and the totals
/// but areas. Goes through the file piece by piece: what it keeps in memory is 32 MiB of chunks
/// and, of each lane, its name and the boxes of its cells in the index.
/// @throws InputError if anything is wrong.
VerifiedMap verify_compiled_map(const std::filesystem::path& file);
VerifiedMap verify_compiled_map(std::string bytes, const std::string& name);

}  // namespace roadbed::map::compiled
