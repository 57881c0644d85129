#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed::map::inline occupancy::inline clouds {

/// Values from one to another, both included.
struct ValueRange {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();

  bool holds(double value) const { return value >= least && value <= most; }
};

/// What of clouds counts before occupancy is built from them; as it stands, everything. What a
/// point says of itself (class, return, intensity) is looked at when it is read, a cloud that does
/// not say it is refused; `vehicle_box` is looked at before clouds are placed, the rest after.
struct CloudFilter {
  std::vector<int> classes = {};             ///< only these, as LAS numbers them; empty: all
  std::vector<int> left_out_classes = {};    ///< none of these
  std::vector<int> returns = {};             ///< only these of each pulse, from 1; empty: all
  bool last_returns = false;                 ///< only the last one of each pulse
  std::optional<ValueRange> intensity = {};  ///< in the file's own measure
  std::optional<Box3> vehicle_box = {};     ///< nothing in it: the vehicle itself, in its own frame
  std::optional<ValueRange> range_m = {};   ///< from where the point was measured
  std::optional<ValueRange> height_m = {};  ///< z in the source
  double voxel_m = 0.0;             ///< one point, the mean, per cube of this side; 0: keep all
  int outlier_neighbours = 0;       ///< compare distances to this many neighbours; 0: keep all
  double outlier_deviations = 2.0;  ///< over the mean by more standard deviations: an outlier

  /// Whether it looks at what a point says of itself.
  bool looks_at_attributes() const {
    return !classes.empty() || !left_out_classes.empty() || !returns.empty() || last_returns ||
           intensity.has_value();
  }
  /// Whether it needs PCL.
  bool looks_at_neighbours() const { return voxel_m > 0.0 || outlier_neighbours > 0; }
  bool keeps_all() const {
    return !looks_at_attributes() && !looks_at_neighbours() && !vehicle_box && !range_m &&
           !height_m;
  }
};

/// A cloud without its points in `vehicle_box`; may hold none then.
PointCloud without_vehicle(PointCloud cloud, const CloudFilter& filter);

/// A cloud with its points within `range_m` and `height_m`; may hold none then.
/// @param remedy  for who asks for a range where a point's sensor is not known.
/// @throws InputError then.
PointCloud within_reach(PointCloud cloud, const CloudFilter& filter,
                        const std::string& remedy =
                            "leave the range out, or name it in the file: "
                            "fields sensor_x, sensor_y and sensor_z");

/// Applies PCL's StatisticalOutlierRemoval, then its VoxelGrid; a point that is left was measured
/// from where the nearest one of the cloud was. PCL is opened now, not when the
/// program starts, which would cost every command 50 ms.
/// @throws InputError if roadbed was built without PCL, or no point is left.
PointCloud filtered(const PointCloud& cloud, const CloudFilter& filter);

/// Without the points for which `leaves_out` says so; scans keep what is left of theirs.
PointCloud leaving_out(PointCloud cloud,
                       const std::function<bool(const Eigen::Vector3d& in_source)>& leaves_out);

}  // namespace roadbed::map::occupancy::clouds
