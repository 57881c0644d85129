#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/map/validation/rule.h"

namespace roadbed::map {

/// Every rule, those of the sources and of the readers too, in order of id.
std::vector<validation::RuleInfo> rule_catalogue();

/// A map with its findings.
struct Validation {
  std::optional<RoadMap> road_map;  ///< none if the file cannot be read as a map
  std::string refusal;              ///< then: the reader's one line about it
  std::vector<validation::Finding>
      findings;                    ///< places are in the map's frame, else in the source's
  validation::ElementLines lines;  ///< empty of a compiled map without its source
  std::vector<validation::Finding> suppressed = {};  ///< those that the map itself says not to tell

  std::string note = {};  ///< what was not looked at, in one line; empty if all was

  /// Where a finding is, in the file's own coordinates.
  Eigen::Vector2d to_source(const Eigen::Vector2d& in_map) const {
    return road_map ? road_map->to_source(in_map) : in_map;
  }
};

/// Every fault of a map file: of its text, of the map that it makes, and what its reader says. A
/// file that names a known format but cannot be read is a finding, not an exception. A compiled map
/// is judged with the text of its source.
/// @param source  of a compiled map; empty: looked for beside it and in the working folder, under
/// its
///                name with another ending.
/// @throws InputError if the file is missing or of no known format, or `source` is not its source.
Validation validate_file(const std::filesystem::path& file,
                         const validation::ValidateOptions& options = {},
                         const std::filesystem::path& source = {});

/// The same from bytes; `name` stands for the file in messages.
Validation validate_bytes(std::string bytes, const std::string& name,
                          const validation::ValidateOptions& options = {});

}  // namespace roadbed::map
