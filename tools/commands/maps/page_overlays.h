#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "roadbed/map/page/map_page.h"
#include "roadbed/tools/cli/arguments.h"
#include "roadbed/tools/cli/drive_arguments.h"

namespace roadbed::tools::inline commands::inline maps {

/// What a map's page shows over the map, by options that each name files of other commands.
class PageOverlays {
 public:
  void declare(Arguments& arguments);
  bool empty() const;

  /// Adds them to what a page shows.
  /// @throws InputError if a file is not what its option asks for, or is of another map.
  void add_to(map::MapPageOptions& page, const map::RoadMap& road_map) const;

 private:
  std::vector<std::filesystem::path> routes_, trajectories_, reached_;
  std::filesystem::path occupancy_, findings_;
  std::vector<double> slice_m_ = {0.2, 1.5};
  DriveArguments of_drive_;
};

}  // namespace roadbed::tools::commands::maps
