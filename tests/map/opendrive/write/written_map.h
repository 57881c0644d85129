#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "roadbed/map/load_map.h"
#include "roadbed/map/opendrive/write/write.h"
#include "roadbed/map/validate_file.h"
#include "roadbed/tests/support/program_run.h"

// What a written map is when it is read back, beside the one that it is written of.
namespace roadbed::map {

inline opendrive::OpenDriveFile file_of(const RoadMap& road_map, int minor = 8) {
  return opendrive::write_open_drive(road_map, {road_map.crs(), {}, minor});
}

inline double farthest_m(const geometry::Polyline& line, const RoadMap& from, const RoadMap& to,
                         const std::vector<const geometry::Polyline*>& others) {
  double worst_m = 0.0;
  for (const Eigen::Vector2d& point : line.points()) {
    const Eigen::Vector2d at = to.to_map(from.to_source(point));
    double least_m = 1e9;
    for (const geometry::Polyline* other : others) {
      least_m = std::min(least_m, std::abs(other->project(at).d_m));
    }
    worst_m = std::max(worst_m, least_m);
  }
  return worst_m;
}

// The largest distance of a border of `a` to the nearest one of `b`.
inline double borders_apart_m(const RoadMap& a, const RoadMap& b) {
  std::vector<const geometry::Polyline*> others;
  for (const Lane& lane : b.lanes()) {
    others.push_back(&lane.left.in_map);
    others.push_back(&lane.right.in_map);
  }
  double worst_m = 0.0;
  for (const Lane& lane : a.lanes()) {
    if (!is_drivable(lane.type)) continue;
    for (const LaneLine* line : {&lane.left, &lane.right}) {
      worst_m = std::max(worst_m, farthest_m(line->in_map, a, b, others));
    }
  }
  return worst_m;
}

inline std::set<LaneId> lanes_at(const RoadMap& from, const RoadMap& to, const Lane& lane,
                                 double s_m) {
  const geometry::Pose2 pose = lane.pose_at(s_m);
  std::set<LaneId> found;
  for (const LaneMatch& match : to.locate(to.to_map(from.to_source(pose.position())), 0.01, true)) {
    if (std::cos(match.heading_rad - pose.heading_rad) > 0.9) found.insert(match.place.lane);
  }
  return found;
}

// Whether any of some lanes leads to any of others, over short ones in between.
inline bool leads(const RoadMap& road_map, std::set<LaneId> lanes, const std::set<LaneId>& others) {
  for (int step = 0; step < 5; ++step) {
    std::set<LaneId> next;
    for (const LaneId id : lanes) {
      if (others.contains(id)) return true;
      const auto& successors = road_map.graph().of(id).successors;
      next.insert(successors.begin(), successors.end());
    }
    lanes = std::move(next);
  }
  return false;
}

// How many links of drivable lanes have no counterpart.
inline int lost_links(const RoadMap& before, const RoadMap& after) {
  int lost = 0;
  for (const Lane& lane : before.lanes()) {
    if (!is_drivable(lane.type)) continue;
    for (const LaneId id : before.graph().of(lane.id).successors) {
      const Lane& next = before.lane(id);
      if (!is_drivable(next.type)) continue;
      const auto from = lanes_at(before, after, lane, 0.7 * lane.length_m());
      const auto to = lanes_at(before, after, next, 0.3 * next.length_m());
      lost += leads(after, from, to) ? 0 : 1;
    }
  }
  return lost;
}

inline double drivable_length_m(const RoadMap& road_map) {
  double sum_m = 0.0;
  for (const Lane& lane : road_map.lanes()) sum_m += is_drivable(lane.type) ? lane.length_m() : 0.0;
  return sum_m;
}

// @param least_share  of the drivable lanes' length, which borders out of line may cut.
inline void expect_comes_back(const RoadMap& before, int minor, double least_share = 0.99) {
  const opendrive::OpenDriveFile file = file_of(before, minor);
  EXPECT_LE(file.largest_error_m, 0.01);
  const RoadMap after = parse_map(file.bytes, "written.xodr");
  EXPECT_LE(borders_apart_m(after, before), 0.01);
  EXPECT_LE(borders_apart_m(before, after), 0.01);
  EXPECT_EQ(lost_links(before, after), 0);
  EXPECT_NEAR(drivable_length_m(after), drivable_length_m(before),
              (1.0 - least_share) * drivable_length_m(before));
}

// Errors that `validate` finds in what is written.
inline std::vector<std::string> errors_in(const opendrive::OpenDriveFile& file) {
  const tests::TemporaryFolder folder;
  std::vector<std::string> errors;
  for (const auto& finding : validate_file(folder.write("a.xodr", file.bytes)).findings) {
    if (finding.severity != validation::Severity::error) continue;
    errors.push_back(finding.rule + " " + finding.element + " " + finding.message);
  }
  return errors;
}

}  // namespace roadbed::map
