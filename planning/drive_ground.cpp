#include "roadbed/planning/drive_ground.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "roadbed/map/input_error.h"
#include "roadbed/planning/drive_places.h"

namespace roadbed::planning {
namespace {

using Eigen::Vector2d;
using map::GroundPlace;

constexpr double kSameRoad_m = 0.5;  // heights that differ by less belong to one surface

[[noreturn]] void refuse_ground(const Vector2d& at, const std::string& found,
                                const std::string& needed) {
  throw map::InputError({.file = "ground",
                         .place = {},
                         .element = fmt::format("at ({:.1f}, {:.1f})", at.x(), at.y()),
                         .found = found,
                         .needed = needed,
                         .remedy = "give --ground Z, or cut the drive"});
}

double plane_at(const GroundPlace& plane, const Vector2d& point) {
  return plane.z_m + plane.slope.dot(point - plane.in_source);
}

double height_at(const map::LaneLine& line, double station_m) {
  const auto after = std::ranges::upper_bound(line.station_m, station_m);
  if (after == line.station_m.begin()) return line.z_m.front();
  if (after == line.station_m.end()) return line.z_m.back();
  const auto i = static_cast<std::size_t>(after - line.station_m.begin());
  const double from_m = line.station_m[i - 1], share = (station_m - from_m) / (*after - from_m);
  return line.z_m[i - 1] + share * (line.z_m[i] - line.z_m[i - 1]);
}

/// The plane that touches a lane's surface at a place of it.
GroundPlace plane_of(const map::Lane& lane, const map::LaneMatch& match, const Vector2d& point) {
  constexpr double step_m = 0.5;
  const double s_m = match.place.s_m, length_m = lane.length_m();
  const double from_m = std::max(0.0, s_m - step_m), to_m = std::min(length_m, s_m + step_m);
  const Vector2d ahead(std::cos(match.heading_rad), std::sin(match.heading_rad));
  GroundPlace plane{.in_source = point, .z_m = height_at(lane.centre, s_m)};
  if (to_m > from_m) {
    const double rise_m = height_at(lane.centre, to_m) - height_at(lane.centre, from_m);
    plane.slope += rise_m / (to_m - from_m) * ahead;
  }
  const Vector2d across =
      map::Lane::point_at(lane.left, s_m) - map::Lane::point_at(lane.right, s_m);
  constexpr double least_width_m = 0.1;
  if (across.norm() > least_width_m) {
    const double rise_m = height_at(lane.left, s_m) - height_at(lane.right, s_m);
    const double fall = rise_m / across.norm();
    plane.slope += fall * Vector2d(-ahead.y(), ahead.x());
    plane.z_m += fall * match.place.d_m;
  }
  return plane;
}

/// Follows the surface of one road.
class RoadFollower {
 public:
  explicit RoadFollower(const map::RoadMap& road_map) : road_map_(road_map) {}

  GroundPlace at(const geometry::Pose2& pose) {
    std::vector<Candidate> candidates = near(pose);
    const Vector2d point = pose.position();
    const auto worse = [&](const Candidate& a, const Candidate& b) {
      return std::pair(beside(a, point), a.off_m) < std::pair(beside(b, point), b.off_m);
    };
    if (!last_) check_is_one(candidates, pose);
    const Candidate best = *std::ranges::min_element(candidates, worse);
    if (last_ && beside(best, point) > kSameRoad_m) {
      refuse_ground(
          point,
          fmt::format("the lanes lie {:.2f} m above or below the road so far", beside(best, point)),
          "a road without a step");
    }
    last_ = best.plane;
    return best.plane;
  }

 private:
  struct Candidate {
    GroundPlace plane;
    double off_m, turned_rad;
  };

  double beside(const Candidate& candidate, const Vector2d& point) const {
    return last_ ? std::abs(candidate.plane.z_m - plane_at(*last_, point)) : 0.0;
  }

  std::vector<Candidate> near(const geometry::Pose2& pose) const {
    constexpr double radius_m = 20.0, same_m = 0.5;
    const Vector2d point = pose.position();
    std::vector<Candidate> candidates;
    for (const map::LaneMatch& match : road_map_.locate(road_map_.to_map(point), radius_m, false)) {
      if (!candidates.empty() && match.distance_m > candidates.front().off_m + same_m) break;
      const double turned_rad = std::remainder(match.heading_rad - pose.heading_rad, M_PI);
      candidates.push_back({plane_of(road_map_.lane(match.place.lane), match, point),
                            match.distance_m, std::abs(turned_rad)});
    }
    if (candidates.empty()) {
      refuse_ground(point, fmt::format("is over {} m from every lane", radius_m), "a lane");
    }
    return candidates;
  }

  // Of roads above one another, those along the drive count.
  static void check_is_one(std::vector<Candidate>& candidates, const geometry::Pose2& pose) {
    const auto spread_m = [&] {
      const auto [low, high] = std::ranges::minmax_element(
          candidates, {}, [](const Candidate& candidate) { return candidate.plane.z_m; });
      return high->plane.z_m - low->plane.z_m;
    };
    if (spread_m() <= kSameRoad_m) return;
    constexpr double along_rad = 0.8;
    const auto is_across = [](const Candidate& candidate) {
      return candidate.turned_rad > along_rad;
    };
    if (!std::ranges::all_of(candidates, is_across)) std::erase_if(candidates, is_across);
    if (spread_m() <= kSameRoad_m) return;
    refuse_ground(pose.position(), fmt::format("roads lie {:.1f} m above one another", spread_m()),
                  "a start that is on one road only");
  }

  const map::RoadMap& road_map_;
  std::optional<GroundPlace> last_;
};

// A point beside the drive belongs to one place only.
void check_is_single(const std::vector<GroundPlace>& places) {
  constexpr double near_m = 15.0;
  constexpr std::size_t step = 4, apart = 40;
  for (std::size_t i = 0; i < places.size(); i += step) {
    for (std::size_t k = i + apart; k < places.size(); k += step) {
      const Vector2d middle = 0.5 * (places[i].in_source + places[k].in_source);
      if ((places[k].in_source - places[i].in_source).norm() > near_m) continue;
      const double step_m = std::abs(plane_at(places[i], middle) - plane_at(places[k], middle));
      if (step_m <= kSameRoad_m) continue;
      refuse_ground(places[k].in_source,
                    fmt::format("the drive passes over itself, {:.1f} m apart", step_m),
                    "one height of the ground at each place");
    }
  }
}

/// The lowest occupied cell of each column near a drive.
class LowestCells {
 public:
  LowestCells(const map::OccupancySource& occupancy, const std::vector<geometry::Pose2>& places)
      : cell_m_(occupancy.resolution_m()), origin_(occupancy.origin_in_source().head<2>()) {
    Vector2d least = places.front().position(), most = least;
    for (const geometry::Pose2& place : places) {
      least = least.cwiseMin(place.position());
      most = most.cwiseMax(place.position());
    }
    const Vector2d margin = Vector2d::Constant(kWidest_m + cell_m_);
    const Vector2d from = least - margin, to = most + margin;
    constexpr double any_height_m = 1e6;
    for (const map::OccupancyCell& leaf : occupancy.cells_in(
             {{from.x(), from.y(), -any_height_m}, {to.x(), to.y(), any_height_m}})) {
      if (leaf.state == map::CellState::occupied) add(leaf, least - margin, most + margin);
    }
  }

  static constexpr double kWidest_m = 4.0;

  /// Middles of the cells in columns around a point.
  std::vector<Eigen::Vector3d> around(const Vector2d& point, double radius_m) const {
    std::vector<Eigen::Vector3d> found;
    const auto reach = static_cast<std::int64_t>(std::ceil(radius_m / cell_m_));
    const auto [x, y] = column_of(point);
    for (std::int64_t v = y - reach; v <= y + reach; ++v) {
      for (std::int64_t u = x - reach; u <= x + reach; ++u) {
        const auto at = lowest_m_.find(key(u, v));
        const Vector2d middle = middle_of(u, v);
        if (at == lowest_m_.end() || (middle - point).norm() > radius_m) continue;
        found.emplace_back(middle.x(), middle.y(), at->second);
      }
    }
    return found;
  }

 private:
  static std::int64_t key(std::int64_t x, std::int64_t y) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(x) << 32 |
                                     static_cast<std::uint32_t>(y));
  }
  std::pair<std::int64_t, std::int64_t> column_of(const Vector2d& point) const {
    return {static_cast<std::int64_t>(std::floor((point.x() - origin_.x()) / cell_m_)),
            static_cast<std::int64_t>(std::floor((point.y() - origin_.y()) / cell_m_))};
  }
  Vector2d middle_of(std::int64_t x, std::int64_t y) const {
    return origin_ + cell_m_ * Vector2d(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5);
  }

  void add(const map::OccupancyCell& leaf, const Vector2d& least, const Vector2d& most) {
    const Vector2d half = Vector2d::Constant(0.5 * (leaf.size_m - cell_m_));
    const Vector2d centre = leaf.centre_in_source.head<2>();
    const double z_m = leaf.centre_in_source.z() - 0.5 * (leaf.size_m - cell_m_);
    const auto [from_x, from_y] = column_of((centre - half).cwiseMax(least));
    const auto [to_x, to_y] = column_of((centre + half).cwiseMin(most));
    for (std::int64_t y = from_y; y <= to_y; ++y) {
      for (std::int64_t x = from_x; x <= to_x; ++x) {
        const auto [at, is_new] = lowest_m_.emplace(key(x, y), z_m);
        if (!is_new) at->second = std::min(at->second, z_m);
      }
    }
  }

  double cell_m_;
  Vector2d origin_;
  std::unordered_map<std::int64_t, double> lowest_m_;
};

/// The plane of least squares through points not far from another plane; none if they do not span
/// one.
std::optional<GroundPlace> fitted(const std::vector<Eigen::Vector3d>& points,
                                  const GroundPlace& start, double within_m, std::size_t least) {
  constexpr double steepest = 0.35;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  std::size_t count = 0;
  for (const Eigen::Vector3d& point : points) {
    if (std::abs(point.z() - plane_at(start, point.head<2>())) > within_m) continue;
    const Vector2d off = point.head<2>() - start.in_source;
    const Eigen::Vector3d row(1.0, off.x(), off.y());
    normal += row * row.transpose();
    right += row * (point.z() - start.z_m);
    ++count;
  }
  if (count < least) return std::nullopt;
  const Eigen::Vector3d plane = normal.ldlt().solve(right);
  GroundPlace place{start.in_source, start.z_m + plane.x(), {plane.y(), plane.z()}};
  if (!plane.allFinite() || place.slope.norm() > steepest) return std::nullopt;
  return place;
}

/// Follows the measured surface.
class SurfaceFollower {
 public:
  SurfaceFollower(const LowestCells& cells, double cell_m) : cells_(cells), cell_m_(cell_m) {}

  GroundPlace at(const Vector2d& point) {
    for (const double radius_m : {2.0, LowestCells::kWidest_m}) {
      const std::vector<Eigen::Vector3d> points = cells_.around(point, radius_m);
      if (const auto place = plane_near(point, points)) {
        last_ = *place;
        has_last_ = true;
        return *place;
      }
    }
    refuse_ground(point, "no surface was measured there that could be the ground",
                  "occupied cells of the road around the drive");
  }

 private:
  std::optional<GroundPlace> plane_near(const Vector2d& point,
                                        const std::vector<Eigen::Vector3d>& points) const {
    constexpr std::size_t fewest = 12;
    if (points.size() < fewest) return std::nullopt;
    // A third is enough where the road so far says what to look for.
    const std::size_t least = std::max(fewest, has_last_ ? points.size() / 3 : points.size() / 2);
    GroundPlace plane = start(point, points);
    for (const double within_m : {0.6, 0.3, 0.2, 0.2}) {
      const auto next = fitted(points, plane, std::max(within_m, 2.0 * cell_m_), least);
      if (!next) return std::nullopt;
      plane = *next;
    }
    const bool is_step = has_last_ && std::abs(plane.z_m - plane_at(last_, point)) > kSameRoad_m;
    return is_step ? std::nullopt : std::optional(plane);
  }

  GroundPlace start(const Vector2d& point, const std::vector<Eigen::Vector3d>& points) const {
    if (has_last_) return {point, plane_at(last_, point), last_.slope};
    std::vector<double> heights_m;
    for (const Eigen::Vector3d& place : points) heights_m.push_back(place.z());
    const auto middle = heights_m.begin() + static_cast<std::ptrdiff_t>(heights_m.size() / 2);
    std::ranges::nth_element(heights_m, middle);
    return {point, *middle, {0.0, 0.0}};
  }

  const LowestCells& cells_;
  double cell_m_;
  GroundPlace last_;
  bool has_last_ = false;
};

}  // namespace

map::Ground road_under(const map::RoadMap& road_map, const geometry::Trajectory& drive_in_source) {
  RoadFollower follower(road_map);
  std::vector<GroundPlace> places;
  for (const geometry::Pose2& pose : places_along(drive_in_source)) {
    places.push_back(follower.at(pose));
  }
  check_is_single(places);
  return map::Ground(std::move(places));
}

map::Ground measured_under(const map::OccupancySource& occupancy,
                           const geometry::Trajectory& drive_in_source) {
  const std::vector<geometry::Pose2> poses = places_along(drive_in_source);
  const LowestCells cells(occupancy, poses);
  SurfaceFollower follower(cells, occupancy.resolution_m());
  std::vector<GroundPlace> places;
  for (const geometry::Pose2& pose : poses) places.push_back(follower.at(pose.position()));
  check_is_single(places);
  return map::Ground(std::move(places));
}

}  // namespace roadbed::planning
