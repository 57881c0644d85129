#include "roadbed/map/sumo/lane_lines.h"

#include <algorithm>
#include <cstddef>

namespace roadbed::map::sumo {
namespace {

constexpr double kNear_m = 0.01;  // points of a connection that are nearer to each other are one

}  // namespace

Points line_of(const RoadMap& road_map, DirectedLane way, LineOf which, double from_share,
               double to_share) {
  const Lane& lane = road_map.lane(way.lane);
  const LaneLine& line = which == LineOf::centre                  ? lane.centre
                         : (which == LineOf::left) != way.against ? lane.left
                                                                  : lane.right;
  Points points;
  std::vector<double> along_m = line.station_m;
  for (std::size_t i = 0; i < along_m.size(); ++i) {
    points.emplace_back(line.in_map.points()[i].x(), line.in_map.points()[i].y(), line.z_m[i]);
  }
  if (way.against) {
    std::reverse(points.begin(), points.end());
    std::reverse(along_m.begin(), along_m.end());
    for (double& s_m : along_m) s_m = lane.length_m() - s_m;
  }
  if (from_share <= 0.0 && to_share >= 1.0) return points;
  const double from_m = from_share * lane.length_m(), to_m = to_share * lane.length_m();
  const auto at = [&](double s_m) -> Eigen::Vector3d {
    const auto after = std::upper_bound(along_m.begin(), along_m.end(), s_m);
    if (after == along_m.end()) return points.back();
    const auto i = std::max<std::size_t>(1, static_cast<std::size_t>(after - along_m.begin()));
    const double step_m = along_m[i] - along_m[i - 1];
    return points[i - 1] + (s_m - along_m[i - 1]) / step_m * (points[i] - points[i - 1]);
  };
  Points part{at(from_m)};
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (along_m[i] > from_m && along_m[i] < to_m) part.push_back(points[i]);
  }
  part.push_back(at(to_m));
  return part;
}

LaneLines::LaneLines(const RoadMap& road_map, const Net& net)
    : road_map_(road_map), net_(net), lines_(net.edges.size()) {
  for (std::size_t i = 0; i < net.edges.size(); ++i) {
    const NetEdge& edge = net.edges[i];
    for (const DirectedLane way : edge.lanes) {
      lines_[i].push_back(line_of(road_map, way, LineOf::centre, edge.from_share, edge.to_share));
    }
  }
}

Points LaneLines::of(const NetConnection& connection) const {
  const NetEdge &from = net_.edges[connection.from], &to = net_.edges[connection.to];
  Points all{of(connection.from, connection.from_lane).back()};
  for (const DirectedLane way : connection.across) {
    // What an edge has of a lane is not inside the junction.
    const double from_share = way == net_.from_lane(connection) ? from.to_share : 0.0;
    const double to_share = way == net_.to_lane(connection) ? to.from_share : 1.0;
    const Points some = line_of(road_map_, way, LineOf::centre, from_share, to_share);
    all.insert(all.end(), some.begin(), some.end());
  }
  all.push_back(of(connection.to, connection.to_lane).front());
  Points kept;
  for (const Eigen::Vector3d& point : all) {
    if (kept.empty() || (point - kept.back()).norm() > kNear_m) kept.push_back(point);
  }
  return kept;
}

}  // namespace roadbed::map::sumo
