#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "roadbed/map/model/road_map.h"

/// What a CommonRoad file of a map will hold, before it is written.
namespace roadbed::map::commonroad {

/// Gives out ids: positive whole numbers, none twice.
class IdGiver {
 public:
  /// The source's id where it is one and still free, else the next free one.
  std::uint64_t give(const std::string& source_id);

  /// Whether it is a positive whole number of at most 18 digits that nobody has; keeps it if so.
  bool keep(const std::string& source_id);

 private:
  std::set<std::uint64_t> taken_;
  std::uint64_t next_ = 1;
};

struct PlannedSign {
  struct Element {
    std::string sign_id;
    std::vector<std::string> values;
  };
  std::uint64_t id = 0;
  std::vector<Element> elements;
  Eigen::Vector2d in_map{0, 0};
  bool is_virtual = false;
  std::vector<LaneId> lanes;
};

struct PlannedLight {
  std::uint64_t id = 0;
  const Signal* signal = nullptr;
};

struct PlannedIncoming {
  std::uint64_t id = 0, is_left_of = 0;  ///< 0: of none
  std::vector<LaneId> lanes, right, straight, left;
};

struct PlannedIntersection {
  std::uint64_t id = 0;
  std::vector<PlannedIncoming> incomings;
  std::vector<LaneId> crossings;
};

/// In place of the id of a lane that is not written: of type none, which CommonRoad cannot say.
inline constexpr std::uint64_t kNoLanelet = 0;

struct Plan {
  std::string benchmark_id;
  std::vector<std::uint64_t> lane_ids;  ///< one per lane, or kNoLanelet
  std::vector<PlannedSign> signs;
  std::vector<PlannedLight> lights;
  std::vector<PlannedIntersection> intersections;
  /// Per lane: ids of signs and lights that it refers to, and its stop line.
  std::vector<std::vector<std::uint64_t>> sign_ids, light_ids;
  std::vector<const StopLine*> stop_lines;
  std::size_t lost_signs = 0;  ///< that speak to no lane, or say another limit than the lanes have
  /// What became of the source's signs and lights, by their source id.
  std::map<std::string, std::uint64_t, std::less<>> sign_by_source, light_by_source;
};

/// The map must outlive the plan.
Plan make_plan(const RoadMap& road_map);

/// Intersections as the source has them, else one per junction: its ways in grouped by neighbours,
/// their ways on by the turn between the lane's ends (beyond 45° left or right).
std::vector<PlannedIntersection> plan_intersections(const RoadMap& road_map, IdGiver& ids);

}  // namespace roadbed::map::commonroad
