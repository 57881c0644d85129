#include "roadbed/map/elements/lane_lines.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace roadbed::map::inline elements {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Per point how far along the line it is, from 0 to 1.
std::vector<double> fractions(const Points& line) {
  std::vector<double> along{0.0};
  along.reserve(line.size());
  for (std::size_t i = 1; i < line.size(); ++i) {
    along.push_back(along.back() + (line[i] - line[i - 1]).head<2>().norm());
  }
  if (along.back() > 0.0) {
    for (double& fraction : along) fraction /= along.back();
  }
  along.back() = 1.0;
  return along;
}

/// The fractions of two lines, each once.
std::vector<double> merged(const std::vector<double>& one, const std::vector<double>& other) {
  std::vector<double> all;
  all.reserve(one.size() + other.size());
  std::merge(one.begin(), one.end(), other.begin(), other.end(), std::back_inserter(all));
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// The line with a point at each of `wanted`, which holds all of its own fractions.
Points with_points_at(const Points& line, const std::vector<double>& own,
                      const std::vector<double>& wanted) {
  Points result;
  result.reserve(wanted.size());
  std::size_t i = 0;
  for (const double fraction : wanted) {
    while (i + 2 < line.size() && own[i + 1] <= fraction) ++i;
    const double step = own[i + 1] - own[i];
    const double part = step > 0.0 ? std::clamp((fraction - own[i]) / step, 0.0, 1.0) : 1.0;
    result.emplace_back(line[i] + part * (line[i + 1] - line[i]));
  }
  return result;
}

/// The station of each of `own`, which are among `all`.
std::vector<double> stations_at(const std::vector<double>& own, const std::vector<double>& all,
                                const std::vector<double>& station_m) {
  std::vector<double> found;
  found.reserve(own.size());
  std::size_t i = 0;
  for (const double fraction : own) {
    while (all[i] < fraction) ++i;
    found.push_back(station_m[i]);
  }
  return found;
}

}  // namespace

LaneLine lane_line(const Points& in_map, std::vector<double> station_m) {
  std::vector<Eigen::Vector2d> plan;
  std::vector<double> z_m;
  plan.reserve(in_map.size());
  z_m.reserve(in_map.size());
  for (const Eigen::Vector3d& point : in_map) {
    plan.emplace_back(point.head<2>());
    z_m.push_back(point.z());
  }
  return {geometry::Polyline(std::move(plan)), std::move(z_m), std::move(station_m)};
}

Points points_halfway(const Points& left_in_map, const Points& right_in_map) {
  Points centre;
  centre.reserve(left_in_map.size());
  for (std::size_t i = 0; i < left_in_map.size(); ++i) {
    centre.emplace_back(0.5 * (left_in_map[i] + right_in_map[i]));
  }
  return centre;
}

void pair_points(Points& left_in_map, Points& right_in_map) {
  const std::vector<double> left = fractions(left_in_map), right = fractions(right_in_map);
  const std::vector<double> all = merged(left, right);
  left_in_map = with_points_at(left_in_map, left, all);
  right_in_map = with_points_at(right_in_map, right, all);
}

void set_borders(const Points& left_in_map, const Points& right_in_map, Lane& lane) {
  const std::vector<double> left = fractions(left_in_map), right = fractions(right_in_map);
  const std::vector<double> all = merged(left, right);
  lane.centre = lane_line(points_halfway(with_points_at(left_in_map, left, all),
                                         with_points_at(right_in_map, right, all)),
                          {});
  lane.centre.station_m = lane.centre.in_map.stations_m();
  lane.left = lane_line(left_in_map, stations_at(left, all, lane.centre.station_m));
  lane.right = lane_line(right_in_map, stations_at(right, all, lane.centre.station_m));
  lane.polygon = lane_ring(lane.left.in_map, lane.right.in_map);
}

void set_lines(const Points& left_in_map, const Points& centre_in_map, const Points& right_in_map,
               Lane& lane) {
  lane.centre = lane_line(centre_in_map, {});
  lane.centre.station_m = lane.centre.in_map.stations_m();
  lane.left = lane_line(left_in_map, lane.centre.station_m);
  lane.right = lane_line(right_in_map, lane.centre.station_m);
  lane.polygon = lane_ring(lane.left.in_map, lane.right.in_map);
}

bool has_swapped_borders(const Lane& lane) {
  const auto& left = lane.left.in_map.points();
  geometry::Ring ring = lane.right.in_map.points();
  ring.insert(ring.end(), left.rbegin(), left.rend());
  return geometry::signed_area_m2(ring) < 0.0;
}

Eigen::Vector2d origin_near(const Eigen::Vector2d& in_source) {
  constexpr double far_m = 20'000.0, grid_m = 1'000.0;
  if (in_source.cwiseAbs().maxCoeff() <= far_m) return {0.0, 0.0};
  return {grid_m * std::round(in_source.x() / grid_m), grid_m * std::round(in_source.y() / grid_m)};
}

}  // namespace roadbed::map::elements
