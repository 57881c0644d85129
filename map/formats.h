#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/judged_file.h"
#include "roadbed/map/model/load_options.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/page/map_page.h"
#include "roadbed/map/validation/rule.h"

namespace roadbed::map {

/// What an output does not hold, and how many of it.
using Losses = std::vector<std::pair<std::string, std::size_t>>;

/// A file of an output that consists of several, by its suffix.
struct OutputPart {
  std::string suffix, bytes;
  std::string name = {};  ///< its whole name, where that is always the same
};

/// What a writer may ask for besides the map.
struct SaveOptions {
  std::vector<std::string> layers;            ///< none: what suits the format
  std::string crs;                            ///< of the output's coordinates, empty if unknown
  bool is_own_crs = false;                    ///< the map's: its offset counts
  std::vector<std::string>* notes = nullptr;  ///< takes what the user should know, a line each
  Losses* lost = nullptr;                     ///< takes what the file cannot say
  std::string name = "map";                   ///< of the output before its suffix
  MapPageOptions page;                        ///< what else a page shows
};

/// What tells formats apart.
struct FileContent {
  std::string_view bytes;
  std::string_view root;  ///< name of its first element, empty if it is no XML
};

/// A format of map files; what it cannot do is null. One that is read is told by content, one that
/// is written by the suffix of the file.
struct Format {
  std::string_view name;  ///< "OpenDRIVE": RoadMap::format() begins with it

  /// Whether a file is of this format.
  bool (*sniff)(const FileContent& content) = nullptr;
  /// Reads it; `name` stands for the file in messages.
  RoadMap (*read)(std::string bytes, const std::string& name, const LoadOptions& options) = nullptr;

  /// Reads it and judges its text by the format's own rules.
  JudgedFile (*judge)(std::string bytes, const std::string& name,
                      const validation::ValidateOptions& options) = nullptr;
  std::vector<validation::RuleInfo> (*rules)() = nullptr;  ///< of its text

  std::string_view suffix = {};  ///< ".osm", empty if it is not written
  /// The bytes of a file.
  std::string (*write)(const RoadMap& road_map, const SaveOptions& options) = nullptr;
  /// In its place where there are several files: all of them, the one of the suffix first.
  std::vector<OutputPart> (*write_parts)(const RoadMap& road_map,
                                         const SaveOptions& options) = nullptr;
  std::size_t most_layers = 0;  ///< that may be named for one file
  std::string_view what = {};   ///< for a help: what is written

  bool is_written() const { return write != nullptr || write_parts != nullptr; }
  /// The files of an output.
  std::vector<OutputPart> output(const RoadMap& road_map, const SaveOptions& options) const;
};

/// All formats.
std::span<const Format> formats();

/// The format of a file that begins with these bytes, null if it is none that is read.
const Format* format_of(const std::string& bytes);

/// The same of a file, by its first 100 KB; null if there is no such file, or nothing in it.
const Format* format_of(const std::filesystem::path& file);

/// The format that a map was read from, null of one that was made otherwise.
const Format* format_of(const RoadMap& road_map);

/// The part of a file's name that tells its format: ".net.xml", ".xml".
std::string format_suffix(const std::filesystem::path& file);

/// The format that a suffix names, in place of the file's if one is given.
/// @throws InputError if it names none that is written.
const Format& format_to_write(const std::filesystem::path& file, const std::string& suffix);
inline const Format& format_to_write(const std::filesystem::path& file) {
  return format_to_write(file, format_suffix(file));
}

}  // namespace roadbed::map
