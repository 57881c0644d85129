#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::tests {

/// Builds a map lane by lane, for tests that know every border. Fields that a test does not set
/// are as a faultless reader would fill them.
class MadeMap {
 public:
  map::RoadId add_road(const std::string& source_id,
                       std::optional<map::JunctionId> junction = std::nullopt);
  map::JunctionId add_junction(const std::string& source_id);

  /// A lane between two borders of equally many points, in driving direction; section 0.
  map::LaneId add_lane(map::RoadId road, const std::string& source_id,
                       const std::vector<Eigen::Vector2d>& left,
                       const std::vector<Eigen::Vector2d>& right,
                       map::LaneType type = map::LaneType::driving);

  /// `to` begins where `from` ends.
  void link(map::LaneId from, map::LaneId to);

  /// Two lanes of one direction beside each other.
  void put_beside(map::LaneId left, map::LaneId right, bool change_allowed = true);

  /// Two lanes of opposite directions, each to the left of the other.
  void put_opposite(map::LaneId one, map::LaneId other);

  map::Lane& lane(map::LaneId id) { return parts.lanes.at(id.index); }
  map::RoadMap build() const { return map::RoadMap(parts); }

  map::RoadMapParts parts;
};

/// Road 1 along the x axis from 0 to `length_m`: lane 1/0/-1 eastwards (y from −3.5 to 0), lane
/// 1/0/1 westwards (y from 0 to 3.5), 3.5 m wide both, 13.9 m/s.
MadeMap straight_two_lane_road(double length_m = 100.0);

/// Three one-lane roads eastwards, one behind the other, 50 m each, 4 m wide, y from −2 to 2:
/// lanes 1/0/-1, 2/0/-1 and 3/0/-1 linked both ways; the middle one is in junction 7.
MadeMap three_roads_in_a_row();

/// Two lanes of 100 m eastwards, 4 m wide, and one behind each: 1/0/-1 (y from 0 to −4) left of
/// 1/0/-2, linked to 2/0/-1 and 2/0/-2, between which nobody may change.
struct TwoLanes {
  MadeMap made;
  map::LaneId left, right, after_left, after_right;

  explicit TwoLanes(bool change_allowed = true);
};

/// Sections of two lanes eastwards, one behind the other, each as long as said, 4 m wide, between
/// which changes are allowed everywhere: lanes 0/0/-1, 1/0/-1, … left of 0/0/-2, 1/0/-2, …
struct ShortSections {
  MadeMap made;
  std::vector<map::LaneId> left, right;

  explicit ShortSections(const std::vector<double>& lengths_m);
};

}  // namespace roadbed::tests
