#include "roadbed/map/opendrive/furniture.h"

#include <algorithm>
#include <cmath>

#include "roadbed/map/files/coordinate_limits.h"
#include "roadbed/map/opendrive/sample_borders.h"

namespace roadbed::map::opendrive {
namespace {

bool is_named(const LaneRanges& ranges, int lane) {
  return ranges.empty() || std::any_of(ranges.begin(), ranges.end(), [&](const auto& range) {
           return lane >= range.first && lane <= range.second;
         });
}

// The section that says something of a side at s.
std::size_t speaking_section(const RoadRecord& road, std::size_t section, int sign) {
  const LaneSection& record = road.sections[section];
  const bool has_side = !section_side(road, section, sign).lanes.empty();
  const std::size_t before = sign > 0 ? record.before_left : record.before_right;
  return record.single_side && !has_side && before < section ? before : section;
}

}  // namespace

Eigen::Vector3d RoadFrame::at(double s_m, double t_m, double h_m) const {
  const geometry::Pose2 pose = plan_view_->at(s_m).pose;
  const double roll_rad = road_->superelevation.cubic.at(s_m).value;
  const double sideways_m = t_m * std::cos(roll_rad) - h_m * std::sin(roll_rad);
  const double up_m = t_m * std::sin(roll_rad) + h_m * std::cos(roll_rad);
  return {pose.x_m - sideways_m * std::sin(pose.heading_rad),
          pose.y_m + sideways_m * std::cos(pose.heading_rad),
          road_->elevation.cubic.at(s_m).value + up_m};
}

std::pair<double, double> RoadFrame::reach_m(double s_m) const {
  const double offset_m = road_->lane_offset.cubic.at(s_m).value;
  double least_m = offset_m, greatest_m = offset_m;
  if (road_->sections.empty()) return {least_m, greatest_m};
  const std::size_t section = section_index_at(*road_, s_m);
  for (const int sign : {1, -1}) {
    double t_m = offset_m;
    for (const LaneRecord* lane : section_side(*road_, section, sign).lanes) {
      const double value_m = lane->outer().at(s_m).value;
      const bool by_width = lane->goes_by_width();
      t_m = by_width ? t_m + sign * value_m : offset_m + value_m;
      least_m = std::min(least_m, t_m);
      greatest_m = std::max(greatest_m, t_m);
    }
  }
  return {least_m, greatest_m};
}

std::size_t section_index_at(const RoadRecord& road, double s_m) {
  const auto after =
      std::upper_bound(road.sections.begin(), road.sections.end(), s_m,
                       [](double s, const LaneSection& section) { return s < section.s_m; });
  return after == road.sections.begin()
             ? 0
             : static_cast<std::size_t>(after - road.sections.begin()) - 1;
}

bool is_placeable(const Eigen::Vector3d& in_map) {
  return in_map.allFinite() && in_map.cwiseAbs().maxCoeff() < kFarthestM;
}

std::vector<LaneId> addressed_lanes(const RoadRecord& road, std::size_t road_index,
                                    const BuiltLanes& built, double s_m, char orientation,
                                    const LaneRanges& ranges) {
  std::vector<LaneId> named, facing;
  if (road.sections.empty() || s_m < -1e-3 || s_m > road.length_m + 1e-3) return {};
  const std::size_t section = section_index_at(road, s_m);
  for (const int sign : {1, -1}) {
    const std::size_t speaking = speaking_section(road, section, sign);
    for (const LaneRecord* record : section_side(road, speaking, sign).lanes) {
      const auto found = built.ids.find({road_index, speaking, record->id});
      if (found == built.ids.end() || !is_named(ranges, record->id)) continue;
      if (!is_drivable(record->type)) continue;
      const LaneId id = found->second;
      named.push_back(id);
      const bool both_ways = orientation == 0 || !built.lanes[id.index].one_way;
      if (both_ways || (orientation == '+') == built.forward[id.index]) facing.push_back(id);
    }
  }
  std::vector<LaneId>& lanes = facing.empty() && !ranges.empty() ? named : facing;
  std::sort(lanes.begin(), lanes.end());
  return std::move(lanes);
}

}  // namespace roadbed::map::opendrive
