#pragma once

// Private to tools/python: occupied space, and audits of drives against it.

#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/tools/python/motion.h"

namespace roadbed::tools::inline python {

/// Occupied and free space, the path that holds it, and fields of the heights that were asked for.
struct Occupancy {
  explicit Occupancy(std::shared_ptr<const map::OccupancySource> made,
                     std::filesystem::path from = {})
      : source(std::move(made)), file(std::move(from)) {}

  std::shared_ptr<const map::OccupancySource> source;
  std::filesystem::path file;  ///< empty: in no file

  /// Made when it is first asked for, and kept.
  std::shared_ptr<const map::ClearanceField> field(const map::HeightBand& band) const;

  /// The octree. @throws std::invalid_argument if it is a folder of tiles.
  const map::OccupancyMap& octree() const;

 private:
  mutable std::mutex mutex_;
  mutable std::map<std::pair<double, double>, std::shared_ptr<const map::ClearanceField>> fields_;
};

}  // namespace roadbed::tools::python
