#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "roadbed/map/edit/edited.h"
#include "roadbed/tools/cli/command.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline maps {

/// Nobody wants a map under the name of another format.
/// @throws OutputError if the file's suffix is that of a format that the map is not of.
void refuse_other_format(const std::filesystem::path& file, const std::string& map_bytes);

/// Where a command that edits a map writes it, and how it says what it did.
class EditOutput {
 public:
  /// `-o`, `--force` and `--json`.
  void declare(Arguments& arguments);

  /// What is wrong with them together.
  std::string fault() const;

  /// Looks before the work begins whether the file can be written.
  void check() const;

  /// Writes the map, or says why there is none, and prints what was done.
  /// @param kind  of the JSON document: "map_clip".
  /// @param more  goes into it, too.
  /// @param beside  files that are put in place with the map, by their names.
  Exit finish(const map::Edited& edited, const std::string& kind, const Streams& streams,
              const CommonOptions& common, const Json& more = Json::object(),
              const std::map<std::filesystem::path, std::string>& beside = {}) const;

  const std::filesystem::path& file() const { return file_; }
  bool force() const { return force_; }
  bool prints_json() const { return json_; }

 private:
  std::filesystem::path file_;
  bool force_ = false, json_ = false;
};

}  // namespace roadbed::tools::commands::maps
