#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/map/validation/rule.h"

// Rules about the text of a file: they see what a reader mends or refuses.

namespace roadbed::map {

/// A file of a format that has rules of its own: what its text shows, and the map that it makes.
struct JudgedFile {
  std::vector<validation::Finding> findings;  ///< places are in the source's coordinates
  validation::ElementLines lines;
  validation::Suppressions suppressions;  ///< what the file itself says not to look at
  std::optional<RoadMap> road_map;        ///< none if the file cannot be read as a map
  std::string refusal;                    ///< then: the reader's one line about it
};

JudgedFile judge_open_drive(std::string bytes, const std::string& name,
                            const validation::ValidateOptions& options);
JudgedFile judge_lanelet2(std::string bytes, const std::string& name,
                          const validation::ValidateOptions& options);
JudgedFile judge_common_road(std::string bytes, const std::string& name,
                             const validation::ValidateOptions& options);

/// A file whose root element is of no known format, but whose content is OpenDRIVE's; none if it is
/// not.
std::optional<JudgedFile> judge_unknown_root(const std::string& bytes, const std::string& name);

/// The rules of each, and those about files that are no XML, or have an unknown root.
std::vector<validation::RuleInfo> open_drive_rules();
std::vector<validation::RuleInfo> lanelet2_rules();
std::vector<validation::RuleInfo> common_road_rules();
std::vector<validation::RuleInfo> file_rules();

}  // namespace roadbed::map
