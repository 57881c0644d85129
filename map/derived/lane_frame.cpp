#include "roadbed/map/derived/lane_frame.h"

#include <algorithm>
#include <cmath>

namespace roadbed::map::inline derived {
namespace {

using Eigen::Vector2d;

/// Records of real files do not meet exactly: a step as short as this has no direction.
constexpr double kShortestPiece_m = 0.05;

/// Stations of the centreline's vertices, those left out that are too near the one before.
std::vector<double> corner_stations(const geometry::Polyline& line) {
  std::vector<double> kept{0.0};
  for (const double s_m : line.stations_m()) {
    if (s_m - kept.back() >= kShortestPiece_m) kept.push_back(s_m);
  }
  if (kept.back() < line.length_m()) {
    if (kept.size() > 1) kept.pop_back();
    kept.push_back(line.length_m());
  }
  if (kept.size() < 2) kept.push_back(kept.back());
  return kept;
}

Vector2d unit_or(const Vector2d& vector, const Vector2d& fallback) {
  const double length = vector.norm();
  return length > 0.0 ? Vector2d(vector / length) : fallback;
}

/// The direction at a piece's other end where the curve goes on as an arc: mirrored at the piece.
Vector2d mirrored(const Vector2d& tangent, const Vector2d& piece) {
  return 2.0 * tangent.dot(piece) * piece - tangent;
}

/// Tangents of the parabola through each corner and its neighbours: the shorter piece counts more.
std::vector<Vector2d> corner_tangents(const geometry::Polyline& line,
                                      const std::vector<double>& station_m) {
  std::vector<Vector2d> piece;
  for (std::size_t i = 0; i + 1 < station_m.size(); ++i) {
    const Vector2d along = line.at(station_m[i + 1]) - line.at(station_m[i]);
    piece.push_back(unit_or(along, i > 0 ? piece.back() : Vector2d(1.0, 0.0)));
  }
  std::vector<Vector2d> tangents{piece.front()};
  for (std::size_t i = 1; i < piece.size(); ++i) {
    const double before_m = station_m[i] - station_m[i - 1];
    const double after_m = station_m[i + 1] - station_m[i];
    tangents.push_back(unit_or(after_m * piece[i - 1] + before_m * piece[i], piece[i]));
  }
  if (piece.size() == 1) return {piece.front(), piece.front()};
  tangents.front() = mirrored(tangents[1], piece.front());
  tangents.push_back(mirrored(tangents.back(), piece.back()));
  return tangents;
}

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
  const double fraction =
      step_m > 0.0 ? std::clamp((s_m - stations[i - 1]) / step_m, 0.0, 1.0) : 0.0;
  const auto& points = road.reference_in_map.points();
  return points[i - 1] + fraction * (points[i] - points[i - 1]);
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

LaneFrame::LaneFrame(const Lane& lane)
    : lane_(&lane),
      station_m_(corner_stations(lane.centre.in_map)),
      tangents_(corner_tangents(lane.centre.in_map, station_m_)) {}

Vector2d LaneFrame::direction(double s_m) const {
  const auto after = std::upper_bound(station_m_.begin() + 1, station_m_.end() - 1, s_m);
  const auto i = static_cast<std::size_t>(after - station_m_.begin());
  const double length_m = station_m_[i] - station_m_[i - 1];
  const double fraction =
      length_m > 0.0 ? std::clamp((s_m - station_m_[i - 1]) / length_m, 0.0, 1.0) : 0.0;
  return unit_or((1.0 - fraction) * tangents_[i - 1] + fraction * tangents_[i], tangents_[i]);
}

double LaneFrame::heading_rad(double s_m) const {
  const Vector2d along = direction(s_m);
  return std::atan2(along.y(), along.x());
}

Vector2d LaneFrame::to_map(double s_m, double d_m) const {
  const Vector2d along = direction(s_m);
  return lane_->centre.in_map.at(s_m) + d_m * Vector2d(-along.y(), along.x());
}

/// How far the point is ahead of the lane's cross-section at a station.
double LaneFrame::ahead_m(const Vector2d& point, double s_m) const {
  return (point - lane_->centre.in_map.at(s_m)).dot(direction(s_m));
}

/// Bisection: the point is ahead of the cross-section at `from_m` and not ahead of that at `to_m`.
double LaneFrame::station_beside_m(const Vector2d& point, double from_m, double to_m) const {
  for (int i = 0; i < 60 && to_m - from_m > 1e-12; ++i) {
    const double middle_m = 0.5 * (from_m + to_m);
    (ahead_m(point, middle_m) > 0.0 ? from_m : to_m) = middle_m;
  }
  return 0.5 * (from_m + to_m);
}

std::optional<LanePlace> LaneFrame::to_lane(const Vector2d& point_in_map) const {
  std::optional<LanePlace> best;
  double before_m = ahead_m(point_in_map, station_m_.front());
  for (std::size_t i = 1; i < station_m_.size(); ++i) {
    const double after_m = ahead_m(point_in_map, station_m_[i]);
    if (before_m >= 0.0 && after_m <= 0.0) {
      const double s_m = station_beside_m(point_in_map, station_m_[i - 1], station_m_[i]);
      const Vector2d along = direction(s_m);
      const Vector2d across = point_in_map - lane_->centre.in_map.at(s_m);
      const double d_m = along.x() * across.y() - along.y() * across.x();
      if (!best || std::abs(d_m) < std::abs(best->d_m)) best = LanePlace{lane_->id, s_m, d_m};
    }
    before_m = after_m;
  }
  return best;
}

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
  const double fraction = step_m > 0.0 ? (beside.s_m - along[i - 1]) / step_m : 0.0;
  return RoadPlace{*lane.road, std::lerp(piece.road_s_m[i - 1], piece.road_s_m[i], fraction),
                   beside.d_m};
}

}  // namespace roadbed::map::derived
