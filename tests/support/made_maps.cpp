#include "roadbed/tests/support/made_maps.h"

#include <algorithm>

namespace roadbed::tests {
namespace {

using Points = std::vector<Eigen::Vector2d>;

map::LaneLine line(const Points& points, const std::vector<double>& stations_m) {
  return {geometry::Polyline(points), std::vector<double>(points.size(), 0.0), stations_m};
}

Points centre_of(const Points& left, const Points& right) {
  Points centre;
  for (std::size_t i = 0; i < left.size(); ++i) centre.push_back(0.5 * (left[i] + right[i]));
  return centre;
}

}  // namespace

map::RoadId MadeMap::add_road(const std::string& source_id,
                              std::optional<map::JunctionId> junction) {
  map::Road road;
  road.id = {static_cast<std::uint32_t>(parts.roads.size())};
  road.source_id = source_id;
  road.junction = junction;
  road.reference_in_map = geometry::Polyline({{0, 0}, {1, 0}});
  road.reference_road_s_m = {0, 1};
  if (junction) parts.junctions.at(junction->index).connecting_roads.push_back(road.id);
  parts.roads.push_back(road);
  return road.id;
}

map::JunctionId MadeMap::add_junction(const std::string& source_id) {
  const map::JunctionId id{static_cast<std::uint32_t>(parts.junctions.size())};
  parts.junctions.push_back({id, source_id, "", map::JunctionKind::common, {}});
  return id;
}

map::LaneId MadeMap::add_lane(map::RoadId road, const std::string& source_id, const Points& left,
                              const Points& right, map::LaneType type) {
  map::Road& owner = parts.roads.at(road.index);
  const geometry::Polyline centre(centre_of(left, right));
  map::Lane lane;
  lane.id = {static_cast<std::uint32_t>(parts.lanes.size())};
  lane.road = road;
  lane.junction = owner.junction;
  lane.origin = {0, source_id, 0.0, centre.length_m()};
  lane.name = owner.source_id + "/0/" + source_id;
  lane.type = type;
  lane.participants = map::Participants::vehicles();
  lane.speed_limits = {{0.0, 13.9}};
  lane.left = line(left, centre.stations_m());
  lane.centre = line(centre.points(), centre.stations_m());
  lane.right = line(right, centre.stations_m());
  geometry::Ring ring = right;
  ring.insert(ring.end(), left.rbegin(), left.rend());
  const auto pieces = geometry::make_simple(ring);
  if (!pieces.empty()) lane.polygon = pieces.front().outer;
  owner.lanes.push_back(lane.id);
  owner.length_m = std::max(owner.length_m, centre.length_m());
  parts.lanes.push_back(lane);
  parts.links.emplace_back();
  return lane.id;
}

void MadeMap::link(map::LaneId from, map::LaneId to) {
  parts.links.at(from.index).successors.push_back(to);
  parts.links.at(to.index).predecessors.push_back(from);
}

void MadeMap::put_beside(map::LaneId left, map::LaneId right, bool change_allowed) {
  const auto windows = [&](map::LaneId id) -> std::vector<map::StationRange> {
    if (!change_allowed) return {};
    return {{0.0, lane(id).length_m()}};
  };
  parts.links.at(left.index).right = map::Neighbour{right, true, windows(left)};
  parts.links.at(right.index).left = map::Neighbour{left, true, windows(right)};
}

void MadeMap::put_opposite(map::LaneId one, map::LaneId other) {
  parts.links.at(one.index).left = map::Neighbour{other, false, {}};
  parts.links.at(other.index).left = map::Neighbour{one, false, {}};
}

MadeMap straight_two_lane_road(double length_m) {
  MadeMap made;
  made.parts.format = "made";
  const map::RoadId road = made.add_road("1");
  const map::LaneId east =
      made.add_lane(road, "-1", {{0, 0}, {length_m, 0}}, {{0, -3.5}, {length_m, -3.5}});
  const map::LaneId west =
      made.add_lane(road, "1", {{length_m, 0}, {0, 0}}, {{length_m, 3.5}, {0, 3.5}});
  made.put_opposite(east, west);
  return made;
}

MadeMap three_roads_in_a_row() {
  MadeMap made;
  made.parts.format = "made";
  const map::JunctionId junction = made.add_junction("7");
  std::vector<map::LaneId> lanes;
  for (int i = 0; i < 3; ++i) {
    const map::RoadId road = made.add_road(
        std::to_string(i + 1), i == 1 ? std::optional<map::JunctionId>(junction) : std::nullopt);
    const double from_m = 50.0 * i, to_m = from_m + 50.0;
    lanes.push_back(
        made.add_lane(road, "-1", {{from_m, 2}, {to_m, 2}}, {{from_m, -2}, {to_m, -2}}));
    if (i > 0) made.link(lanes[lanes.size() - 2], lanes.back());
  }
  return made;
}

TwoLanes::TwoLanes(bool change_allowed) {
  const auto road = made.add_road("1"), next = made.add_road("2");
  left = made.add_lane(road, "-1", {{0, 0}, {100, 0}}, {{0, -4}, {100, -4}});
  right = made.add_lane(road, "-2", {{0, -4}, {100, -4}}, {{0, -8}, {100, -8}});
  after_left = made.add_lane(next, "-1", {{100, 0}, {200, 0}}, {{100, -4}, {200, -4}});
  after_right = made.add_lane(next, "-2", {{100, -4}, {200, -4}}, {{100, -8}, {200, -8}});
  made.link(left, after_left);
  made.link(right, after_right);
  made.put_beside(left, right, change_allowed);
}

ShortSections::ShortSections(const std::vector<double>& lengths_m) {
  double x_m = 0.0;
  for (std::size_t i = 0; i < lengths_m.size(); ++i) {
    const auto road = made.add_road(std::to_string(i));
    const double end_m = x_m + lengths_m[i];
    left.push_back(made.add_lane(road, "-1", {{x_m, 0}, {end_m, 0}}, {{x_m, -4}, {end_m, -4}}));
    right.push_back(made.add_lane(road, "-2", {{x_m, -4}, {end_m, -4}}, {{x_m, -8}, {end_m, -8}}));
    made.put_beside(left.back(), right.back());
    if (i > 0) made.link(left[i - 1], left[i]);
    if (i > 0) made.link(right[i - 1], right[i]);
    x_m = end_m;
  }
}

}  // namespace roadbed::tests
