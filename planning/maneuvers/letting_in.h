#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/planning/maneuvers/zip_merge.h"
#include "roadbed/planning/obstacles/movers_on_line.h"
#include "roadbed/planning/speed/lead.h"
#include "roadbed/planning/task/driving_task.h"

namespace roadbed::planning::inline maneuvers {

/// Whom the vehicle lets in where a lane ends beside its own: one, in turn with the others who
/// drive there, so far as is known of them (ZipMerge).
class LettingIn {
 public:
  struct Decision {
    std::optional<Lead> behind = {};  ///< the other, to be followed as if it were in the lane
    std::string reason = {};          ///< empty: nobody
  };

  LettingIn(const geometry::VehicleShape& vehicle, const DrivingTask& task);

  /// One cycle of 0.1 s. O(obstacles · points of the lane) within 100 m of such an end.
  /// @param view  beside the route's line.
  Decision look(const ViewOnLine& view);

 private:
  struct End {
    double s_m;               ///< station of the route's line
    geometry::Polyline lane;  ///< middle of the lane that ends, and of what leads to it
  };
  std::vector<ZipBody> drivers(const End& end, const ViewOnLine& view, double to_end_m) const;
  std::vector<ZipBody> waiting(const End& end, const ViewOnLine& view) const;

  const geometry::VehicleShape& vehicle_;
  const DrivingTask& task_;
  std::vector<End> ends_;
  ZipMerge zip_;
};

}  // namespace roadbed::planning::maneuvers
