#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace roadbed::map::inline occupancy::inline clearance {
class ClearanceField;
}

namespace roadbed::map::inline occupancy::inline clouds {
struct CloudFilter;
}

namespace roadbed::map::inline occupancy::inline octree {
class OccupancyMap;
class OccupancySource;
}  // namespace roadbed::map::occupancy::octree

namespace roadbed::map::inline model {
class RoadMap;
}

namespace roadbed::tools::inline cli {

/// Where a command gets what it reads and many runs may share: maps, occupancies and what is made
/// of them. This one makes each thing whenever it is asked for; others may keep it. May be asked by
/// several threads; what it gives is immutable.
class Inputs {
 public:
  virtual ~Inputs() = default;

  /// As `map::load_map`.
  std::shared_ptr<const map::RoadMap> road_map(const std::filesystem::path& file) const;

  /// As `map::open_occupancy`: an octree, or a folder of tiles; or made of a cloud, or of the
  /// clouds of a log, as `occupancy build` does with cells of 0.1 m.
  std::shared_ptr<const map::OccupancySource> occupancy(const std::filesystem::path& path) const;

  /// The same of the points that a filter of clouds leaves.
  /// @param words  of the filter; as they are different, so are filters.
  /// @throws InputError if it is no cloud and no log of clouds, or no point is left.
  std::shared_ptr<const map::OccupancySource> filtered_occupancy(const std::filesystem::path& path,
                                                                 const map::CloudFilter& filter,
                                                                 const std::string& words) const;

  /// As `map::load_occupancy`: an octree, or clouds.
  std::shared_ptr<const map::OccupancyMap> occupancy_of(
      const std::vector<std::filesystem::path>& files) const;

  /// Its clearance field up to a vehicle's height.
  std::shared_ptr<const map::ClearanceField> field_of(
      const std::vector<std::filesystem::path>& files, double height_m) const;

  /// A thing that is made of files and nothing else. Throws what `make` throws.
  /// @param what  names the kind of thing, and all but the files that it depends on.
  template <class T>
  std::shared_ptr<const T> of(const std::string& what,
                              const std::vector<std::filesystem::path>& files,
                              const std::function<std::shared_ptr<const T>()>& make) const {
    return std::static_pointer_cast<const T>(get(what, files, make));
  }

 protected:
  using Thing = std::shared_ptr<const void>;

  virtual Thing get(const std::string& what, const std::vector<std::filesystem::path>& files,
                    const std::function<Thing()>& make) const;
};

}  // namespace roadbed::tools::cli
