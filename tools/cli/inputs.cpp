#include "roadbed/tools/cli/inputs.h"

#include <fmt/format.h>

#include <span>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/logs/log.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/map/occupancy/clouds/cloud_filter.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/map/occupancy/octree/tiled_occupancy.h"

namespace roadbed::tools::inline cli {
namespace {

namespace fs = std::filesystem;

/// A field refers to its occupancy.
struct FieldWithOccupancy {
  std::shared_ptr<const map::OccupancyMap> occupancy;
  map::ClearanceField field;
};

std::unique_ptr<map::OccupancySource> occupancy_in(const fs::path& path,
                                                   const map::CloudFilter& filter = {}) {
  if (map::is_log(path)) {
    return std::make_unique<map::OccupancyMap>(map::load_occupancy_of_log(path, filter));
  }
  if (map::is_folder(path)) {
    if (!filter.keeps_all()) map::refuse_to_filter(map::input_name(path));
    return map::open_occupancy(path);
  }
  return std::make_unique<map::OccupancyMap>(map::load_occupancy(std::span(&path, 1), {}, filter));
}

}  // namespace

std::shared_ptr<const map::RoadMap> Inputs::road_map(const fs::path& file) const {
  return of<map::RoadMap>(
      "map", {file}, [&] { return std::make_shared<const map::RoadMap>(map::load_map(file)); });
}

std::shared_ptr<const map::OccupancySource> Inputs::occupancy(const fs::path& path) const {
  return of<map::OccupancySource>("octree or tiles", {path}, [&] { return occupancy_in(path); });
}

std::shared_ptr<const map::OccupancySource> Inputs::filtered_occupancy(
    const fs::path& path, const map::CloudFilter& filter, const std::string& words) const {
  return of<map::OccupancySource>("octree of points " + words, {path},
                                  [&] { return occupancy_in(path, filter); });
}

std::shared_ptr<const map::OccupancyMap> Inputs::occupancy_of(
    const std::vector<fs::path>& files) const {
  return of<map::OccupancyMap>("octree or clouds", files, [&] {
    return std::make_shared<const map::OccupancyMap>(map::load_occupancy(files));
  });
}

std::shared_ptr<const map::ClearanceField> Inputs::field_of(const std::vector<fs::path>& files,
                                                            double height_m) const {
  return of<map::ClearanceField>(fmt::format("field up to {} m", height_m), files,
                                 [&]() -> std::shared_ptr<const map::ClearanceField> {
                                   auto occupancy = occupancy_of(files);
                                   map::ClearanceField field(*occupancy, {.to_m = height_m});
                                   auto both = std::make_shared<const FieldWithOccupancy>(
                                       FieldWithOccupancy{std::move(occupancy), std::move(field)});
                                   return {both, &both->field};
                                 });
}

Inputs::Thing Inputs::get(const std::string&, const std::vector<fs::path>&,
                          const std::function<Thing()>& make) const {
  return make();
}

}  // namespace roadbed::tools::cli
