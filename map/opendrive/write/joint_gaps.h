#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "roadbed/map/opendrive/write/end_lines.h"
#include "roadbed/map/opendrive/write/end_roles.h"

namespace roadbed::map::opendrive {

/// The borders that meet where lanes lead into each other. Roads of the map have their own ends,
/// which are left out.
class JointGaps {
 public:
  JointGaps(const RoadMap& road_map, const RoadPlan& plan,
            std::span<const EndJoints::value_type* const> joints);

  struct BorderEnd {
    std::uint32_t end;
    std::size_t place;  ///< of the border in its section
    RoadBorder border;
  };

  /// How far from each other the borders of lanes that lead into each other end, in sum, but for
  /// 5 mm of a joint.
  double sum_m(const std::function<Eigen::Vector2d(const BorderEnd&)>& point_of) const;

 private:
  using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

  std::vector<BorderEnd> borders_;
  std::vector<Pairs> joints_;  // places among them
};

}  // namespace roadbed::map::opendrive
