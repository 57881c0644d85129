#include "roadbed/map/elements/lane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

namespace roadbed::map::inline elements {
namespace {

/// Between the values of vertices, by their stations; beyond the ends those of the ends.
template <typename Value>
Value value_at(const std::vector<double>& stations_m, const std::vector<Value>& values,
               double station_m) {
  const auto after = std::upper_bound(stations_m.begin(), stations_m.end(), station_m);
  if (after == stations_m.begin()) return values.front();
  if (after == stations_m.end()) return values.back();
  const auto i = static_cast<std::size_t>(after - stations_m.begin());
  const double fraction = (station_m - stations_m[i - 1]) / (stations_m[i] - stations_m[i - 1]);
  return values[i - 1] + fraction * (values[i] - values[i - 1]);
}

geometry::Ring ring_between(const geometry::Polyline& left, const geometry::Polyline& right) {
  geometry::Ring ring = right.points();
  ring.insert(ring.end(), left.points().rbegin(), left.points().rend());
  return ring;
}

// Without repeated points; none where fewer than three are left.
geometry::Ring counter_clockwise(geometry::Ring ring) {
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  if (ring.size() < 3) return {};
  if (geometry::signed_area_m2(ring) < 0.0) std::reverse(ring.begin(), ring.end());
  return ring;
}

bool folds(const geometry::Ring& ring) {
  return !ring.empty() && !(geometry::signed_area_m2(ring) > 0.0 && geometry::is_simple(ring));
}

geometry::Ring largest_part(const geometry::Ring& ring) {
  geometry::Ring largest;
  for (geometry::Polygon& part : geometry::make_simple(ring)) {
    if (largest.empty() ||
        geometry::signed_area_m2(part.outer) > geometry::signed_area_m2(largest)) {
      largest = std::move(part.outer);
    }
  }
  return largest;
}

}  // namespace

std::string_view to_string(LaneType type) {
  static constexpr std::array<std::string_view, 23> names = {
      "none",    "driving",        "bidirectional", "entry",  "exit",       "onRamp",
      "offRamp", "connectingRamp", "shoulder",      "stop",   "parking",    "border",
      "biking",  "sidewalk",       "curb",          "median", "restricted", "roadWorks",
      "tram",    "rail",           "bus",           "taxi",   "other"};
  return names.at(static_cast<std::size_t>(type));
}

bool is_drivable(LaneType type) {
  switch (type) {
    case LaneType::driving:
    case LaneType::bidirectional:
    case LaneType::entry:
    case LaneType::exit:
    case LaneType::on_ramp:
    case LaneType::off_ramp:
    case LaneType::connecting_ramp:
      return true;
    default:
      return false;
  }
}

bool is_surface(LaneType type) {
  switch (type) {
    case LaneType::shoulder:
    case LaneType::stop:
    case LaneType::parking:
    case LaneType::bus:
    case LaneType::taxi:
      return true;
    default:
      return is_drivable(type);
  }
}

std::optional<double> Lane::speed_limit_at_mps(double s_m) const {
  const auto after = std::ranges::upper_bound(speed_limits, s_m, {}, &SpeedLimit::from_s_m);
  return after == speed_limits.begin() ? std::nullopt : std::prev(after)->limit_mps;
}

std::optional<double> Lane::least_speed_limit_mps() const {
  std::optional<double> least_mps;
  for (const SpeedLimit& limit : speed_limits) {
    if (limit.limit_mps && std::isfinite(*limit.limit_mps))
      least_mps = std::min(*limit.limit_mps, least_mps.value_or(*limit.limit_mps));
  }
  return least_mps;
}

Eigen::Vector2d Lane::point_at(const LaneLine& line, double station_m) {
  return value_at(line.station_m, line.in_map.points(), station_m);
}

double Lane::height_at(const LaneLine& line, double station_m) {
  return value_at(line.station_m, line.z_m, station_m);
}

geometry::Pose2 Lane::pose_at(double s_m) const {
  constexpr double reach_m = 0.05;
  const double s = std::clamp(s_m, 0.0, length_m());
  const Eigen::Vector2d point = centre.in_map.at(s);
  const Eigen::Vector2d along = centre.in_map.at(s + reach_m) - centre.in_map.at(s - reach_m);
  return {point.x(), point.y(), std::atan2(along.y(), along.x())};
}

double Lane::width_m(double s_m) const {
  return (point_at(left, s_m) - point_at(right, s_m)).norm();
}

geometry::Ring simple_ring(geometry::Ring ring) {
  ring = counter_clockwise(std::move(ring));
  return folds(ring) ? largest_part(ring) : ring;
}

geometry::Ring lane_ring(const geometry::Polyline& left_in_map,
                         const geometry::Polyline& right_in_map) {
  return simple_ring(ring_between(left_in_map, right_in_map));
}

bool lay_ring(Lane& lane) {
  lane.polygon = counter_clockwise(ring_between(lane.left.in_map, lane.right.in_map));
  return folds(lane.polygon);
}

void unfold_ring(Lane& lane) { lane.polygon = largest_part(lane.polygon); }

}  // namespace roadbed::map::elements
