#include "roadbed/tools/report/surroundings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadbed/map/derived/map_part.h"

namespace roadbed::tools::inline report {
namespace {

// The stretch of a line between two stations, with both its ends, from the lower one on.
geometry::Polyline stretch(const geometry::Polyline& line, double from_s_m, double to_s_m) {
  if (from_s_m > to_s_m) std::swap(from_s_m, to_s_m);
  std::vector<Eigen::Vector2d> points{line.at(from_s_m)};
  for (std::size_t i = 0; i < line.points().size(); ++i) {
    const double s_m = line.stations_m()[i];
    if (s_m > from_s_m && s_m < to_s_m) points.push_back(line.points()[i]);
  }
  points.push_back(line.at(to_s_m));
  return geometry::Polyline(std::move(points));
}

}  // namespace

std::shared_ptr<const map::RoadMap> map_around(const map::RoadMap& road_map,
                                               const Eigen::AlignedBox2d& box_in_source) {
  const Eigen::AlignedBox2d box_in_map =
      box_in_source.isEmpty() ? box_in_source
                              : Eigen::AlignedBox2d(road_map.to_map(box_in_source.min()),
                                                    road_map.to_map(box_in_source.max()));
  return std::make_shared<const map::RoadMap>(map::map_part(road_map, box_in_map));
}

LineInSource line_in_source(const map::RoadMap& road_map, const geometry::Polyline& in_map) {
  LineInSource line;
  for (const Eigen::Vector2d& point : in_map.points()) line.push_back(road_map.to_source(point));
  return line;
}

LineInSource outline_in_source(const map::RoadMap& road_map, const map::Lane& lane) {
  LineInSource ring = line_in_source(road_map, lane.right.in_map);
  const LineInSource left = line_in_source(road_map, lane.left.in_map);
  ring.insert(ring.end(), left.rbegin(), left.rend());
  return ring;
}

std::vector<LineInSource> route_lines(const map::RoadMap& road_map, const planning::Route& route) {
  std::vector<LineInSource> lines;
  for (const planning::RouteLeg& leg : route.legs) {
    const geometry::Polyline& centre = road_map.lane(leg.lane).centre.in_map;
    lines.push_back(line_in_source(road_map, stretch(centre, leg.from_s_m, leg.to_s_m)));
  }
  return lines;
}

std::optional<Eigen::Vector2d> route_goal(const map::RoadMap& road_map,
                                          const planning::Route& route) {
  if (route.legs.empty()) return std::nullopt;
  const planning::RouteLeg& last = route.legs.back();
  return road_map.to_source(road_map.lane(last.lane).pose_at(last.to_s_m).position());
}

LineInSource reference_points(const map::RoadMap& road_map, const planning::ReferenceLine& line) {
  LineInSource points;
  const int pieces = std::max(1, static_cast<int>(std::ceil(line.length_m())));
  for (int i = 0; i <= pieces; ++i) {
    points.push_back(road_map.to_source(line.at(line.length_m() * i / pieces).in_map));
  }
  return points;
}

}  // namespace roadbed::tools::report
