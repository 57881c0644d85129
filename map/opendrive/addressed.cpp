#include "roadbed/map/opendrive/addressed.h"

#include <algorithm>

#include "roadbed/map/opendrive/lane_borders.h"
#include "roadbed/map/opendrive/road_frame.h"

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
