#include "roadbed/map/derived/lane_piece.h"

#include <algorithm>
#include <array>

namespace roadbed::map::inline derived {
namespace {

std::vector<double> cross_section_stations(const Lane& lane) {
  std::vector<double> stations = lane.left.station_m;
  stations.insert(stations.end(), lane.right.station_m.begin(), lane.right.station_m.end());
  std::sort(stations.begin(), stations.end());
  stations.erase(std::unique(stations.begin(), stations.end()), stations.end());
  return stations;
}

void add_pieces(const Lane& lane, std::vector<LanePiece>& pieces) {
  const std::vector<double> stations = cross_section_stations(lane);
  for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
    const double from_m = stations[i], to_m = stations[i + 1];
    pieces.push_back({lane.id,
                      {from_m, to_m},
                      Lane::point_at(lane.left, from_m),
                      Lane::point_at(lane.left, to_m),
                      Lane::point_at(lane.right, from_m),
                      Lane::point_at(lane.right, to_m),
                      Lane::height_at(lane.centre, 0.5 * (from_m + to_m))});
  }
}

}  // namespace

geometry::Box LanePiece::box() const {
  const std::array<Eigen::Vector2d, 4> corners{left_from, left_to, right_from, right_to};
  return geometry::box_around(corners);
}

std::vector<LanePiece> drivable_pieces(const RoadMap& road_map) {
  std::vector<LanePiece> pieces;
  for (const Lane& lane : road_map.lanes()) {
    if (is_drivable(lane.type)) add_pieces(lane, pieces);
  }
  return pieces;
}

std::vector<LanePiece> drivable_pieces(const RoadMap& road_map, std::span<const LaneId> lanes) {
  std::vector<LanePiece> pieces;
  for (const LaneId id : lanes) {
    if (is_drivable(road_map.lane(id).type)) add_pieces(road_map.lane(id), pieces);
  }
  return pieces;
}

}  // namespace roadbed::map::derived
