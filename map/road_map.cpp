#include "roadbed/map/road_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "roadbed/map/lane_index.h"

namespace roadbed::map {

struct RoadMap::Index {
  LaneIndex lanes;
  std::map<std::string, LaneId, std::less<>> by_name;
};

namespace {

bool is_whole(const LaneLine& line) {
  const std::size_t points = line.in_map.points().size();
  return points >= 2 && line.z_m.size() == points && line.station_m.size() == points;
}

void check_lane_ids(const RoadMapParts& parts) {
  for (std::size_t i = 0; i < parts.lanes.size(); ++i) {
    const Lane& lane = parts.lanes[i];
    const bool in_order = lane.id.index == i;
    const bool road_there = !lane.road || lane.road->index < parts.roads.size();
    const bool junction_there = !lane.junction || lane.junction->index < parts.junctions.size();
    const bool whole = is_whole(lane.left) && is_whole(lane.centre) && is_whole(lane.right);
    if (!in_order || !road_there || !junction_there || !whole) {
      throw std::invalid_argument(fmt::format(
          "RoadMap: lane {} is out of order, lacks a line or names what is not there", i));
    }
  }
  if (parts.links.size() != parts.lanes.size()) {
    throw std::invalid_argument(
        fmt::format("RoadMap: {} lanes but links of {}", parts.lanes.size(), parts.links.size()));
  }
}

void check_road_ids(const RoadMapParts& parts) {
  for (std::size_t i = 0; i < parts.roads.size(); ++i) {
    const Road& road = parts.roads[i];
    const bool lanes_there = std::all_of(road.lanes.begin(), road.lanes.end(),
                                         [&](LaneId id) { return id.index < parts.lanes.size(); });
    if (road.id.index != i || !lanes_there ||
        (road.junction && road.junction->index >= parts.junctions.size())) {
      throw std::invalid_argument(
          fmt::format("RoadMap: road {} is out of order or names what is not there", i));
    }
  }
  for (const Junction& junction : parts.junctions) {
    for (const RoadId id : junction.connecting_roads) {
      if (id.index >= parts.roads.size()) {
        throw std::invalid_argument(
            fmt::format("RoadMap: junction {} names a road that is not there", junction.source_id));
      }
    }
  }
  for (const Signal& signal : parts.signals) {
    const bool lanes_there = std::all_of(signal.lanes.begin(), signal.lanes.end(),
                                         [&](LaneId id) { return id.index < parts.lanes.size(); });
    const bool stations_there =
        signal.lane_s_m.empty() || signal.lane_s_m.size() == signal.lanes.size();
    if (!lanes_there || !stations_there ||
        (signal.road && signal.road->index >= parts.roads.size())) {
      throw std::invalid_argument(
          fmt::format("RoadMap: signal {} names what is not there", signal.source_id));
    }
  }
}

RoadMapParts checked(RoadMapParts parts) {
  check_lane_ids(parts);
  check_road_ids(parts);
  return parts;
}

}  // namespace

RoadMap::RoadMap(RoadMapParts parts) : parts_(checked(std::move(parts))), graph_(parts_.links) {
  auto index = std::make_unique<Index>(Index{LaneIndex(parts_.lanes), {}});
  for (const Lane& lane : parts_.lanes) index->by_name.emplace(lane.name, lane.id);
  index_ = std::move(index);
}

RoadMap::~RoadMap() = default;
RoadMap::RoadMap(RoadMap&&) noexcept = default;
RoadMap& RoadMap::operator=(RoadMap&&) noexcept = default;

Eigen::Vector2d RoadMap::to_map(const Eigen::Vector2d& in_source) const {
  return in_source - parts_.origin_in_source;
}

Eigen::Vector2d RoadMap::to_source(const Eigen::Vector2d& in_map) const {
  return in_map + parts_.origin_in_source;
}

std::optional<LaneId> RoadMap::find_lane(std::string_view name) const {
  const auto found = index_->by_name.find(name);
  if (found == index_->by_name.end()) return {};
  return found->second;
}

std::vector<LaneMatch> RoadMap::locate(const Eigen::Vector2d& point_in_map, double radius_m,
                                       bool only_drivable) const {
  std::vector<LaneMatch> matches = index_->lanes.near(
      parts_.lanes, point_in_map, radius_m,
      [&](const Lane& candidate) { return !only_drivable || is_drivable(candidate.type); });
  std::sort(matches.begin(), matches.end(), [](const LaneMatch& a, const LaneMatch& b) {
    const auto key = [](const LaneMatch& m) {
      return std::tuple(m.distance_m, std::abs(m.place.d_m), m.place.lane);
    };
    return key(a) < key(b);
  });
  return matches;
}

bool RoadMap::on_surface(const Eigen::Vector2d& point_in_map, double margin_m) const {
  return !index_->lanes
              .near(parts_.lanes, point_in_map, margin_m,
                    [](const Lane& candidate) { return is_surface(candidate.type); })
              .empty();
}

}  // namespace roadbed::map
