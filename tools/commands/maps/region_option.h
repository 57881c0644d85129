#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/map/edit/clipping/region.h"
#include "roadbed/tools/cli/arguments.h"

namespace roadbed::tools::inline commands::inline maps {

/// The part of the plane that a command line names: `--bbox`, `--polygon` or `--within`.
class RegionOption {
 public:
  /// @param what  is cut: "map".
  void declare(Arguments& arguments, const std::string& what = "map");

  bool given() const { return count_given() > 0; }

  /// Whether it is around a lane or a route.
  bool needs_map() const { return !within_.empty(); }

  /// What is missing; nothing if just one of them is given.
  std::string fault() const;

  /// @param map_bytes, name  of the map, which is read where its lanes or its coordinate system
  ///                         tell where the region is.
  /// @throws InputError if the polygons are unusable, or cannot be placed on the map.
  map::Region region(const std::string& map_bytes, const std::string& name) const;

  /// The same in a coordinate system. @pre it does not need a map.
  /// @param crs   may be empty, where it is unknown.
  /// @param name  of the file that has it.
  /// @throws InputError as above.
  map::Region region_in(const std::string& crs, const std::string& name) const;

 private:
  using FromLonLat = std::function<void(std::span<Eigen::Vector2d> points)>;

  int count_given() const;
  map::Region box() const;
  map::Region from_polygons(const FromLonLat& from_lon_lat) const;
  map::Region around_line(const std::string& map_bytes, const std::string& name) const;

  std::vector<double> box_;
  std::filesystem::path polygon_file_;
  std::string within_;
};

}  // namespace roadbed::tools::commands::maps
