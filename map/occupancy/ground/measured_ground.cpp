#include "roadbed/map/occupancy/ground/drive_ground.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "roadbed/map/occupancy/ground/column_minima.h"
#include "roadbed/map/occupancy/ground/drive_places.h"

namespace roadbed::map::inline occupancy::inline ground {
namespace {

using Eigen::Vector2d;
using map::GroundPlace;

constexpr double kAround_m = 2.0;         // columns this near speak of a place
constexpr double kSteepest = 0.35;        // more is no road
constexpr double kStationsApart_m = 1.0;  // of places along a body
constexpr double kSame_m = 0.7;           // nearer places are one

/// Places under a body at a pose, from the axle to the front, then to the rear.
std::vector<geometry::Pose2> stations_under(const geometry::Pose2& pose, const BodyReach& body) {
  const Vector2d axis(std::cos(pose.heading_rad), std::sin(pose.heading_rad));
  std::vector<geometry::Pose2> stations{pose};
  for (const double end_m : {body.front_m, body.rear_m}) {
    const double count = std::ceil(std::abs(end_m) / kStationsApart_m);
    for (double i = 1.0; i <= count; ++i) {
      const Vector2d at = pose.position() + i / count * end_m * axis;
      stations.push_back({at.x(), at.y(), pose.heading_rad});
    }
  }
  return stations;
}

/// The last of places that are so near to one another that few have to be looked at.
template <class Place, class Position>
const Place* nearest_of_last(const std::vector<Place>& places, const Vector2d& point,
                             const Position& position) {
  constexpr std::size_t looked_at = 64;
  const Place* nearest = nullptr;
  double least_m = 0.0;
  for (std::size_t i = places.size() - std::min(looked_at, places.size()); i < places.size(); ++i) {
    const double away_m = (position(places[i]) - point).norm();
    if (nearest != nullptr && away_m >= least_m) continue;
    nearest = &places[i];
    least_m = away_m;
  }
  return nearest;
}

std::vector<geometry::Pose2> stations_along(const geometry::Trajectory& drive,
                                            const BodyReach& body) {
  std::vector<geometry::Pose2> stations;
  const auto position = [](const geometry::Pose2& pose) { return pose.position(); };
  for (const geometry::Pose2& pose : places_along(drive)) {
    for (const geometry::Pose2& station : stations_under(pose, body)) {
      const auto* near = nearest_of_last(stations, station.position(), position);
      const bool is_new =
          near == nullptr || (near->position() - station.position()).norm() > kSame_m;
      if (is_new) stations.push_back(station);
    }
  }
  return stations;
}

/// The plane of least squares through the points within a distance of another plane; none if they
/// do not span one.
std::optional<GroundPlace> plane_through(const std::vector<Eigen::Vector3d>& points,
                                         const GroundPlace& start, double within_m) {
  constexpr int fewest = 12;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  int count = 0;
  for (const Eigen::Vector3d& point : points) {
    if (std::abs(point.z() - plane_at(start, point.head<2>())) > within_m) continue;
    const Vector2d off = point.head<2>() - start.in_source;
    const Eigen::Vector3d row(1.0, off.x(), off.y());
    normal += row * row.transpose();
    right += row * (point.z() - start.z_m);
    ++count;
  }
  if (count < fewest) return std::nullopt;
  const Eigen::Vector3d plane = normal.ldlt().solve(right);
  GroundPlace place{start.in_source, start.z_m + plane.x(), {plane.y(), plane.z()}};
  if (!plane.allFinite() || place.slope.norm() > kSteepest) return std::nullopt;
  return place;
}

GroundPlace level_at_median(const std::vector<Eigen::Vector3d>& points, const Vector2d& at) {
  std::vector<double> heights_m;
  for (const Eigen::Vector3d& point : points) heights_m.push_back(point.z());
  const auto middle = heights_m.begin() + static_cast<std::ptrdiff_t>(heights_m.size() / 2);
  std::ranges::nth_element(heights_m, middle);
  return {at, *middle, {0.0, 0.0}};
}

/// Follows the measured surface from place to place, and refuses one that may be an obstacle's.
class MeasuredFollower {
 public:
  explicit MeasuredFollower(const ColumnMinima& cells)
      : cells_(cells),
        within_m_(measured_ground_margin_m(cells.cell_m())),
        step_m_(std::max(0.5 * cells.cell_m(), 0.03)) {}

  void follow(const geometry::Pose2& station) {
    const Vector2d at = station.position();
    const std::vector<Eigen::Vector3d> points = cells_.around(at);
    const GroundPlace* last =
        nearest_of_last(places_, at, [](const GroundPlace& place) { return place.in_source; });
    const GroundPlace plane = fitted(points, at, last);
    check_all_around(points, plane, station.heading_rad);
    if (last != nullptr) check_goes_on(*last, plane);
    places_.push_back(plane);
  }

  std::vector<GroundPlace> places() && { return std::move(places_); }

 private:
  // From the ground so far, no farther than an obstacle is high.
  GroundPlace fitted(const std::vector<Eigen::Vector3d>& points, const Vector2d& at,
                     const GroundPlace* last) const {
    if (points.empty()) refuse(at, "no surface was measured there");
    GroundPlace plane = last != nullptr ? GroundPlace{at, plane_at(*last, at), last->slope}
                                        : level_at_median(points, at);
    std::vector<double> rounds_m{1.5 * within_m_, within_m_, within_m_, within_m_};
    if (last == nullptr) rounds_m.insert(rounds_m.begin(), {0.6, 0.3});
    for (const double round_m : rounds_m) {
      const auto next = plane_through(points, plane, std::max(round_m, within_m_));
      if (!next) refuse(at, "no surface was measured there that goes on from the ground so far");
      plane = *next;
    }
    return plane;
  }

  // What is lower is the ground, and not the plane. Where most is higher on one side, or nothing
  // was measured, the plane may not go on there. Cells of two levels are off a plane between them.
  void check_all_around(const std::vector<Eigen::Vector3d>& points, const GroundPlace& plane,
                        double heading_rad) const {
    constexpr double few = 0.02, most = 0.5, spread = 0.5;
    constexpr int fewest = 4;
    struct Sector {
      int all = 0, on = 0;
    };
    std::array<Sector, 4> sides;
    int below = 0, on = 0;
    double squares_m2 = 0.0;
    const Vector2d axis(std::cos(heading_rad), std::sin(heading_rad));
    for (const Eigen::Vector3d& point : points) {
      const Vector2d off = point.head<2>() - plane.in_source;
      const bool is_ahead = off.dot(axis) >= 0.0;
      const bool is_left = axis.x() * off.y() - axis.y() * off.x() >= 0.0;
      Sector& side = sides[(is_ahead ? 2U : 0U) + (is_left ? 1U : 0U)];
      const double above_m = point.z() - plane_at(plane, point.head<2>());
      ++side.all;
      if (above_m < -within_m_) ++below;
      if (std::abs(above_m) > within_m_) continue;
      ++side.on;
      ++on;
      squares_m2 += above_m * above_m;
    }
    if (below > few * static_cast<double>(points.size())) {
      refuse(plane.in_source, fmt::format("{} of {} columns are lower than the surface there",
                                          below, points.size()));
    }
    if (squares_m2 > std::pow(spread * within_m_, 2) * on) {
      refuse(plane.in_source, "the surface there lies on two levels");
    }
    for (const Sector& side : sides) {
      if (side.on >= fewest && side.on >= most * side.all) continue;
      refuse(plane.in_source, fmt::format("on one side {} of {} columns are at the surface's "
                                          "height",
                                          side.on, side.all));
    }
  }

  void check_goes_on(const GroundPlace& last, const GroundPlace& plane) const {
    const Vector2d middle = 0.5 * (last.in_source + plane.in_source);
    const double step_m = std::abs(plane_at(last, middle) - plane_at(plane, middle));
    if (step_m <= step_m_) return;
    refuse(plane.in_source, fmt::format("the surface steps by {:.2f} m", step_m));
  }

  [[noreturn]] static void refuse(const Vector2d& at, const std::string& found) {
    refuse_ground(at, found, "one surface all around, with nothing below it and no step");
  }

  const ColumnMinima& cells_;
  double within_m_, step_m_;
  std::vector<GroundPlace> places_;
};

}  // namespace

map::Ground measured_under(const map::OccupancySource& occupancy,
                           const geometry::Trajectory& drive_in_source, const BodyReach& body) {
  const std::vector<geometry::Pose2> stations = stations_along(drive_in_source, body);
  std::vector<Vector2d> points;
  for (const geometry::Pose2& station : stations) points.push_back(station.position());
  const ColumnMinima cells(occupancy, points, kAround_m);
  MeasuredFollower follower(cells);
  for (const geometry::Pose2& station : stations) follower.follow(station);
  std::vector<GroundPlace> places = std::move(follower).places();
  check_is_single(places);
  return map::Ground(std::move(places));
}

double measured_ground_margin_m(double cell_m) { return std::max(cell_m, 0.05); }

}  // namespace roadbed::map::occupancy::ground
