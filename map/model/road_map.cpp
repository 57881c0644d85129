#include "roadbed/map/model/road_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "roadbed/map/elements/map_fields.h"
#include "roadbed/map/index/road_map_index.h"

namespace roadbed::map::inline model {

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

void check(const RoadMapParts& parts) {
  check_lane_ids(parts);
  check_road_ids(parts);
}

LazyMapContent kept(RoadMapParts parts) {
  check(parts);
  LazyMapContent content;
  static_cast<MapHead&>(content) = parts;
  const auto keep = [](const char*, const auto&, auto& into, auto& from) {
    into = std::move(from);
  };
  fields::lists(keep, content, parts);
  return content;
}

}  // namespace

RoadMap::RoadMap(RoadMapParts parts, int threads)
    : content_(kept(std::move(parts))),
      graph_(content_.links),
      index_(std::make_unique<const RoadMapIndex>(RoadMapIndex::of(content_.lanes, threads))) {
  graph_.check();
}

RoadMap::RoadMap(LazyMapContent content, RoadMapIndex index)
    : content_(std::move(content)),
      graph_(content_.links),
      index_(std::make_unique<const RoadMapIndex>(std::move(index))) {
  const bool fits = content_.links.size() == content_.lanes.size() &&
                    index_->by_name.size() == content_.lanes.size() &&
                    index_->lanes.data().lanes.size() == content_.lanes.size();
  if (!fits) throw std::invalid_argument("RoadMap: its lists do not fit each other");
}

RoadMapParts RoadMap::parts() const {
  RoadMapParts parts;
  static_cast<MapHead&>(parts) = content_;
  const auto copy = [](const char*, const auto&, auto& into, const auto& from) {
    into.assign(from.begin(), from.end());
  };
  fields::lists(copy, parts, content_);
  return parts;
}

RoadMap::~RoadMap() = default;
RoadMap::RoadMap(RoadMap&&) noexcept = default;
RoadMap& RoadMap::operator=(RoadMap&&) noexcept = default;

Eigen::Vector2d RoadMap::to_map(const Eigen::Vector2d& in_source) const {
  return in_source - content_.origin_in_source;
}

Eigen::Vector2d RoadMap::to_source(const Eigen::Vector2d& in_map) const {
  return in_map + content_.origin_in_source;
}

std::optional<LaneId> RoadMap::find_lane(std::string_view name) const {
  return index_->find(content_.lanes, name);
}

std::vector<LaneMatch> RoadMap::locate(const Eigen::Vector2d& point_in_map, double radius_m,
                                       bool only_drivable) const {
  return index_->lanes.near(
      point_in_map,
      {.radius_m = radius_m, .types = only_drivable ? LaneTypes::drivable() : LaneTypes::all()});
}

LaneMatches RoadMap::locate(std::span<const Eigen::Vector2d> points_in_map, double radius_m,
                            std::size_t count, bool only_drivable) const {
  return index_->lanes.near(points_in_map,
                            {.radius_m = radius_m,
                             .count = count,
                             .types = only_drivable ? LaneTypes::drivable() : LaneTypes::all()});
}

bool RoadMap::on_surface(const Eigen::Vector2d& point_in_map, double margin_m) const {
  return index_->lanes.is_any_near(
      point_in_map, {.radius_m = margin_m, .count = 1, .types = LaneTypes::surface()});
}

}  // namespace roadbed::map::model
