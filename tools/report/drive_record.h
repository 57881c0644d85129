#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roadbed::tools::inline report {

/// A file that a drive was made from.
struct DriveSource {
  std::string role;  ///< one of kDriveRoles
  std::filesystem::path file;
  std::string sha256;  ///< of its bytes, hexadecimal
};

inline constexpr std::string_view kDriveRoles[] = {
    "scenario", "map", "cloud", "vehicle", "noise", "planner options", "obstacles"};

/// How a drive is done again: `replay.json` in its folder.
struct DriveRecord {
  std::string program;               ///< name and version of what drove it
  std::vector<DriveSource> sources;  ///< the scenario first
  bool predicts = false, drops_ego_recording = false;
  bool is_outside = false;  ///< driven by a planner of the user's, which nobody can ask again
  std::optional<std::uint64_t> seed = {};  ///< in place of the scenario's

  /// The file of a role that no two have; empty if none has it.
  std::filesystem::path file_of(std::string_view role) const;
};

inline constexpr std::string_view kDriveRecordName = "replay.json";

/// The JSON of a record. Files are named relative to the folder, so that both can be moved
/// together.
std::string write_drive_record(const DriveRecord& record, const std::filesystem::path& folder);

/// @throws InputError naming the place as a JSON pointer; also where there is no such folder, or
///         no drive in it.
DriveRecord read_drive_record(const std::filesystem::path& folder);

/// The same from bytes; `file` stands for the record in messages and gives the folder.
DriveRecord parse_drive_record(std::string_view bytes, const std::filesystem::path& file);

/// @throws InputError naming the first file that is missing or has changed since the drive.
void check_sources(const DriveRecord& record);

}  // namespace roadbed::tools::report
