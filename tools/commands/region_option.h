#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "roadbed/map/edit/clipping/region.h"
#include "roadbed/tools/cli/arguments.h"

namespace roadbed::tools::inline commands {

/// The part of the plane that a command line names: `--bbox`, `--polygon` or `--within`.
class RegionOption {
 public:
  void declare(Arguments& arguments);

  /// What is missing; nothing if just one of them is given.
  std::string fault() const;

  /// @param map_bytes, name  of the map, which is read where its lanes or its coordinate system
  ///                         tell where the region is.
  /// @throws InputError if the polygons are unusable, or cannot be placed on the map.
  map::Region region(const std::string& map_bytes, const std::string& name) const;

 private:
  map::Region from_polygons(const std::string& map_bytes, const std::string& name) const;
  map::Region around_lane(const std::string& map_bytes, const std::string& name) const;

  std::vector<double> box_;
  std::filesystem::path polygon_file_;
  std::string within_;
};

}  // namespace roadbed::tools::commands
