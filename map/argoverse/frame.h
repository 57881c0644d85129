#pragma once

#include <cstddef>
#include <optional>

#include "roadbed/map/argoverse/ground_height.h"
#include "roadbed/map/argoverse/values.h"
#include "roadbed/map/elements/map_content.h"

namespace roadbed::map::argoverse {

/// From points of the city to points of the map, which begins near the first of them; heights that
/// the file does not give are the ground's, or 0.
class Frame {
 public:
  explicit Frame(std::optional<GroundHeight> ground) : ground_(std::move(ground)) {}

  void to_map(Line3& points);

  Eigen::Vector2d origin_in_source() const { return origin_.value_or(Eigen::Vector2d::Zero()); }

  /// Says what raster there is and how far the file's heights are from it.
  void report(RoadMapParts& parts) const;

 private:
  void set_height(Eigen::Vector3d& point);

  std::optional<GroundHeight> ground_;
  std::optional<Eigen::Vector2d> origin_;
  std::size_t filled_ = 0, compared_ = 0, far_ = 0;
  double farthest_m_ = 0.0;
};

}  // namespace roadbed::map::argoverse
