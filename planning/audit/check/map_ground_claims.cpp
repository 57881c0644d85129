#include "roadbed/planning/audit/check/certificate_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "roadbed/map/index/road_map_index.h"

namespace roadbed::planning::inline audit {
namespace {

using Eigen::Vector2d;
using map::GroundPlace;

constexpr double kSamePlane_m = 1e-3, kSameSlope = 1e-3;
constexpr double kFarthestLane_m = 20.0, kAsNear_m = 0.5;  // as near as the nearest lane
constexpr double kOneRoad_m = 0.5;                         // steps by more lead to another
constexpr double kHalfStep_m = 0.5;                        // over which a lane's slope is told

double cross_of(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

double fraction_along(const Vector2d& point, const Vector2d& from, const Vector2d& to) {
  const double squared = (to - from).squaredNorm();
  return squared > 0.0 ? std::clamp((point - from).dot(to - from) / squared, 0.0, 1.0) : 0.0;
}

double away_from_edge_m(const Vector2d& point, const Vector2d& from, const Vector2d& to) {
  return (point - from - fraction_along(point, from, to) * (to - from)).norm();
}

/// Distance from a polygon, 0 inside.
double from_polygon_m(const geometry::Ring& ring, const Vector2d& point) {
  double least_m = std::numeric_limits<double>::infinity();
  bool is_inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
    least_m = std::min(least_m, away_from_edge_m(point, a, b));
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (x > point.x()) is_inside = !is_inside;
  }
  return is_inside ? 0.0 : least_m;
}

/// A value along a line, by station.
template <class Value>
Value along(const std::vector<double>& station_m, const std::vector<Value>& values, double s_m) {
  std::size_t i = 1;
  while (i + 1 < station_m.size() && station_m[i] <= s_m) ++i;
  const double from_m = station_m[i - 1], length_m = station_m[i] - from_m;
  const double fraction = length_m > 0.0 ? std::clamp((s_m - from_m) / length_m, 0.0, 1.0) : 0.0;
  return values[i - 1] + fraction * (values[i] - values[i - 1]);
}

/// What a lane's surface is at a point, as a plane, and where the lane goes there.
struct Surface {
  GroundPlace plane;
  double off_m, heading_rad;
};

Surface surface_of(const map::Lane& lane, const Vector2d& in_map) {
  const auto& centre = lane.centre.in_map.points();
  std::size_t nearest = 0;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < centre.size(); ++i) {
    const double away_m = away_from_edge_m(in_map, centre[i], centre[i + 1]);
    if (away_m >= least_m) continue;
    least_m = away_m;
    nearest = i;
  }
  const Vector2d &a = centre[nearest], &b = centre[nearest + 1];
  const auto& stations_m = lane.centre.station_m;
  const double s_m = stations_m[nearest] +
                     fraction_along(in_map, a, b) * (stations_m[nearest + 1] - stations_m[nearest]);
  const Vector2d ahead = (b - a).normalized(), left(-ahead.y(), ahead.x());
  const double d_m = cross_of(b - a, in_map - a) < 0.0 ? -least_m : least_m;
  const auto height_m = [&](const map::LaneLine& line, double at_m) {
    return along(line.station_m, line.z_m, at_m);
  };
  Surface surface{.plane = {.in_source = in_map, .z_m = height_m(lane.centre, s_m)},
                  .off_m = from_polygon_m(lane.polygon, in_map),
                  .heading_rad = std::atan2(ahead.y(), ahead.x())};
  const double from_m = std::max(0.0, s_m - kHalfStep_m);
  const double to_m = std::min(lane.length_m(), s_m + kHalfStep_m);
  if (to_m > from_m) {
    const double rise_m = height_m(lane.centre, to_m) - height_m(lane.centre, from_m);
    surface.plane.slope += rise_m / (to_m - from_m) * ahead;
  }
  const double width_m = (along(lane.left.station_m, lane.left.in_map.points(), s_m) -
                          along(lane.right.station_m, lane.right.in_map.points(), s_m))
                             .norm();
  constexpr double least_width_m = 0.1;
  if (width_m > least_width_m) {
    const double fall = (height_m(lane.left, s_m) - height_m(lane.right, s_m)) / width_m;
    surface.plane.slope += fall * left;
    surface.plane.z_m += fall * d_m;
  }
  return surface;
}

/// The surfaces of the lanes that are about as near to a point as the nearest one.
std::vector<Surface> surfaces_at(const map::RoadMap& road_map, const Vector2d& in_source) {
  const Vector2d point = road_map.to_map(in_source), far = Vector2d::Constant(kFarthestLane_m);
  std::vector<Surface> surfaces;
  for (const map::LaneId id :
       road_map.index().lanes.in_box(point - far, point + far, map::LaneTypes::all())) {
    const map::Lane& lane = road_map.lane(id);
    if (lane.polygon.empty() || from_polygon_m(lane.polygon, point) > kFarthestLane_m) continue;
    surfaces.push_back(surface_of(lane, point));
  }
  if (surfaces.empty()) return surfaces;
  const double least_m = std::ranges::min(surfaces, {}, &Surface::off_m).off_m;
  std::erase_if(surfaces,
                [&](const Surface& one) { return one.off_m > least_m + kAsNear_m + kSamePlane_m; });
  return surfaces;
}

bool is_same(const GroundPlace& claimed, const GroundPlace& found) {
  return std::abs(claimed.z_m - found.z_m) <= kSamePlane_m &&
         (claimed.slope - found.slope).norm() <= kSameSlope;
}

double step_to_m(const GroundPlace& from, const GroundPlace& to) {
  return std::abs(from.z_m + from.slope.dot(to.in_source - from.in_source) - to.z_m);
}

// Where roads lie above one another, a drive is on one of those that it goes along.
bool is_one_road(std::vector<Surface> surfaces, double heading_rad) {
  constexpr double along_rad = 0.8;
  const auto height = [](const Surface& surface) { return surface.plane.z_m; };
  const auto is_level = [&] {
    const auto [low, high] = std::ranges::minmax(surfaces, {}, height);
    return height(high) - height(low) <= kOneRoad_m + kSamePlane_m;
  };
  if (is_level()) return true;
  std::erase_if(surfaces, [&](const Surface& surface) {
    return std::abs(std::remainder(surface.heading_rad - heading_rad, M_PI)) > along_rad;
  });
  return !surfaces.empty() && is_level();
}

std::string told(const GroundPlace& place, const std::string& what) {
  return fmt::format("ground: at ({:.1f}, {:.1f}) {}", place.in_source.x(), place.in_source.y(),
                     what);
}

}  // namespace

std::string map_ground_fault(const std::vector<GroundPlace>& places, const map::RoadMap& road_map,
                             const geometry::Trajectory& drive_in_source) {
  const auto& samples = drive_in_source.points();
  const auto is_at = [](const GroundPlace& place, const geometry::TrajectoryPoint& sample) {
    return (place.in_source - sample.pose().position()).norm() <= kSamePlane_m;
  };
  if (!is_at(places.front(), samples.front()) || !is_at(places.back(), samples.back())) {
    return "ground: it does not go from the drive's start to its end";
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::vector<Surface> surfaces = surfaces_at(road_map, places[i].in_source);
    const auto found = std::ranges::find_if(
        surfaces, [&](const Surface& surface) { return is_same(places[i], surface.plane); });
    if (found == surfaces.end()) {
      return told(places[i], fmt::format("z {:.3f} m is of no lane of the map", places[i].z_m));
    }
    if (i == 0 && !is_one_road(surfaces, samples.front().heading_rad)) {
      return told(places[i], "roads lie above one another where the drive begins");
    }
    if (i > 0 && step_to_m(places[i - 1], places[i]) > kOneRoad_m + kSamePlane_m) {
      return told(places[i], fmt::format("it steps by {:.2f} m from the place before",
                                         step_to_m(places[i - 1], places[i])));
    }
  }
  return {};
}

}  // namespace roadbed::planning::audit
