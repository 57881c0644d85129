#include "roadbed/map/derived/road_place.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace roadbed::map::inline derived {
namespace {

// The piece of a road's reference line between two road stations, with the stations of its points.
struct Piece {
  std::vector<Eigen::Vector2d> points;
  std::vector<double> road_s_m;

  void add(const Eigen::Vector2d& point, double s_m) {
    points.push_back(point);
    road_s_m.push_back(s_m);
  }
};

Eigen::Vector2d reference_at(const Road& road, double s_m) {
  const auto& stations = road.reference_road_s_m;
  const auto after = std::upper_bound(stations.begin() + 1, stations.end() - 1, s_m);
  const auto i = static_cast<std::size_t>(after - stations.begin());
  const double step_m = stations[i] - stations[i - 1];
  const double share = step_m > 0.0 ? std::clamp((s_m - stations[i - 1]) / step_m, 0.0, 1.0) : 0.0;
  const auto& points = road.reference_in_map.points();
  return points[i - 1] + share * (points[i] - points[i - 1]);
}

Piece piece_between(const Road& road, double from_m, double to_m) {
  Piece piece;
  piece.add(reference_at(road, from_m), from_m);
  for (std::size_t i = 0; i < road.reference_road_s_m.size(); ++i) {
    const double s_m = road.reference_road_s_m[i];
    if (s_m > from_m && s_m < to_m) piece.add(road.reference_in_map.points()[i], s_m);
  }
  piece.add(reference_at(road, to_m), to_m);
  return piece;
}

}  // namespace

std::optional<RoadPlace> road_place(const RoadMap& road_map, LaneId lane_id,
                                    const Eigen::Vector2d& point_in_map) {
  const Lane& lane = road_map.lane(lane_id);
  if (!lane.road) return {};
  const auto [from_m, to_m] = std::minmax(lane.origin.road_from_s_m, lane.origin.road_to_s_m);
  const Piece piece = piece_between(road_map.road(*lane.road), from_m, to_m);
  const geometry::Polyline line(piece.points);
  const geometry::LinePosition beside = line.project(point_in_map);
  const auto& along = line.stations_m();
  const auto after = std::upper_bound(along.begin() + 1, along.end() - 1, beside.s_m);
  const auto i = static_cast<std::size_t>(after - along.begin());
  const double step_m = along[i] - along[i - 1];
  const double share = step_m > 0.0 ? (beside.s_m - along[i - 1]) / step_m : 0.0;
  return RoadPlace{*lane.road, std::lerp(piece.road_s_m[i - 1], piece.road_s_m[i], share),
                   beside.d_m};
}

}  // namespace roadbed::map::derived
