#include "roadbed/tools/audit/certified_file.h"

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/sha256.h"
#include "roadbed/map/occupancy/octree/tiles_index.h"
#include "roadbed/tools/files/obstacles_csv.h"
#include "roadbed/tools/files/vehicle_file.h"

namespace roadbed::tools::inline audit {

CertifiedFile certified_file(const std::filesystem::path& file) {
  if (const auto vehicle = named_vehicle(file.string())) {
    return {.name = file.string(), .sha256 = map::sha256_of_bytes(measures_text(vehicle->shape))};
  }
  const bool is_tiled = map::is_tiled_occupancy(file);
  return {.name = file.string(),
          .sha256 = map::sha256_of_file(is_tiled ? map::tiles_index_file(file) : file)};
}

CertifiedFile certified_bytes(const std::filesystem::path& file, std::string_view bytes) {
  return {.name = file.string(), .sha256 = map::sha256_of_bytes(bytes)};
}

CertifiedFile hashed_input(const std::filesystem::path& file) {
  if (!map::is_stream(file)) return certified_file(file);
  return {.name = map::input_name(file), .sha256 = map::stream_sha256(file)};
}

CertifiedFile certified_obstacles(const std::filesystem::path& file,
                                  const std::vector<planning::ObstacleInSource>& obstacles) {
  return {.name = file.string(), .sha256 = map::sha256_of_bytes(obstacles_text(obstacles))};
}

}  // namespace roadbed::tools::audit
