#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::tools::inline audit {

/// A file that a certificate speaks of. What it proves, it proves of a file of this hash.
struct CertifiedFile {
  std::string name;    ///< as it was given on the command line
  std::string sha256;  ///< of its bytes, hexadecimal
};

/// Of a folder of tiles the hash is that of its index, which holds those of the tiles; of a vehicle
/// that is named (vehicle_file.h) that of its measures.
/// @throws InputError for a stream, which nobody can hash again, and as map::read_file does.
CertifiedFile certified_file(const std::filesystem::path& file);

/// The same of a file that these bytes are about to become.
CertifiedFile certified_bytes(const std::filesystem::path& file, std::string_view bytes);

/// The same for what is only shown: of a stream, too, the hash of what it gave.
CertifiedFile hashed_input(const std::filesystem::path& file);

/// The hash is that of the obstacles, not of the file's bytes, since a scenario names other files.
CertifiedFile certified_obstacles(const std::filesystem::path& file,
                                  const std::vector<planning::ObstacleInSource>& obstacles);

}  // namespace roadbed::tools::audit
