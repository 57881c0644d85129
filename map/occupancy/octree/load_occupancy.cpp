#include "roadbed/map/occupancy/octree/load_occupancy.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"

#include <string>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"

namespace roadbed::map::inline occupancy::inline octree {

OccupancyMap load_occupancy(std::span<const std::filesystem::path> files,
                            const OccupancyOptions& options) {
  std::vector<PointCloud> clouds;
  for (const std::filesystem::path& file : files) {
    const std::string bytes = read_file(file);
    if (!is_occupancy_file(bytes)) {
      clouds.push_back(parse_point_cloud(bytes, file.string()));
      check_is_in_metres(clouds.back());
    } else if (files.size() == 1) {
      return OccupancyMap::parse(bytes, file.string());
    } else {
      throw InputError({.file = file.string(),
                        .found = "is an octree beside other files",
                        .needed = "one octree alone, or point clouds",
                        .remedy = "give the clouds that the octree was built from"});
    }
  }
  return OccupancyMap::build(clouds, options);
}

}  // namespace roadbed::map::occupancy::octree
