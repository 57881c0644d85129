#include "roadbed/planning/reference/way_point_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "roadbed/geometry/curves/quintic_bezier.h"
#include "roadbed/geometry/curves/spline_curve.h"
#include "roadbed/geometry/primitives/segment.h"
#include "roadbed/planning/reference/reference_point.h"

namespace roadbed::planning::inline reference {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr double kSamePoint_m = 1e-6;
constexpr double kCornerTurn_rad = std::numbers::pi / 6.0;
constexpr double kLongLeg_m = 10.0;
constexpr double kStraight_rad = 0.05;  // a segment goes on while it turns by less
constexpr double kTurnsBack_rad = 170.0 / 180.0 * std::numbers::pi;
constexpr double kLongestRounding_m = 40.0;
constexpr double kBeyondSegments_m = 12.0;  // the road goes on, for the body at the segments' ends
constexpr double kLeastCornerSpeed_mps = 0.1, kSpeedStep = 1.25;
const double kMostRounding_m = geometry::kPaperGaps.total_m();

bool same(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return (a - b).norm() <= kSamePoint_m;
}

Points distinct(std::span<const Eigen::Vector2d> way_points) {
  Points points;
  for (const Eigen::Vector2d& point : way_points) {
    if (!point.allFinite()) throw std::invalid_argument("path_through: a way-point is not finite");
    if (points.empty() || !same(point, points.back())) points.push_back(point);
  }
  if (points.size() < 2) {
    throw std::invalid_argument(
        fmt::format("path_through: needs at least two distinct way-points, got {}", points.size()));
  }
  return points;
}

double angle_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
}

double turn_at(const Points& points, std::size_t i) {
  if (i == 0 || i + 1 >= points.size()) return 0.0;
  return angle_between(points[i] - points[i - 1], points[i + 1] - points[i]);
}

bool is_corner(const Points& points, std::size_t i) {
  const double turn = turn_at(points, i);
  if (turn < kCornerTurn_rad) return false;
  const auto alone = [&](std::size_t neighbour) {
    return turn_at(points, neighbour) < 0.5 * turn ||
           (points[neighbour] - points[i]).norm() >= kLongLeg_m;
  };
  return alone(i - 1) && alone(i + 1);
}

void refuse_turning_back(const Points& points) {
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const double turn_rad = turn_at(points, i);
    if (turn_rad < kTurnsBack_rad) continue;
    throw std::invalid_argument(
        fmt::format("path_through: the path turns back by {:.0f}° at ({:.2f}, {:.2f})",
                    turn_rad * 180.0 / std::numbers::pi, points[i].x(), points[i].y()));
  }
}

void refuse_too_long(const Points& points, double step_m) {
  constexpr double most_points = 2.0 * kMostSupportPoints;  // which are twice as far apart
  double length_m = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length_m += (points[i] - points[i - 1]).norm();
  if (length_m <= most_points * step_m) return;
  throw std::invalid_argument(
      fmt::format("path_through: {:.0f} m in steps of {} m are over {:.0f} points", length_m,
                  step_m, most_points));
}

// A corner, and how far its segments are straight; later: how much of them its curve takes.
struct Corner {
  std::size_t at;
  Eigen::Vector2d back, ahead;  // unit vectors away from the corner
  double room_m;
  geometry::CornerGaps gaps;
};

// Length of the straight segment from a corner, `step` +1 or −1; half of it if it ends at a corner.
double leg_m(const Points& points, const std::vector<bool>& corners, std::size_t at, int step) {
  const auto next = [step](std::size_t i) { return step > 0 ? i + 1 : i - 1; };
  std::size_t i = next(at);
  const Eigen::Vector2d direction = (points[i] - points[at]).normalized();
  while (!corners[i] && i > 0 && i + 1 < points.size() &&
         angle_between(points[next(i)] - points[i], direction) < kStraight_rad) {
    i = next(i);
  }
  const double length_m = (points[i] - points[at]).dot(direction);
  return corners[i] ? 0.5 * length_m : length_m;
}

std::vector<Corner> corners_of(const Points& points, double most_m) {
  std::vector<bool> is(points.size(), false);
  for (std::size_t i = 1; i + 1 < points.size(); ++i) is[i] = is_corner(points, i);
  std::vector<Corner> corners;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    if (!is[i]) continue;
    const double room_m = std::min(leg_m(points, is, i, -1), leg_m(points, is, i, +1));
    corners.push_back({i,
                       (points[i - 1] - points[i]).normalized(),
                       (points[i + 1] - points[i]).normalized(),
                       std::min(room_m, most_m),
                       {}});
  }
  return corners;
}

// The road of both segments, half a width to each side.
Points road_of(const Eigen::Vector2d& at, const Corner& corner, double half_width_m) {
  const auto left_of = [](const Eigen::Vector2d& v) { return Eigen::Vector2d(-v.y(), v.x()); };
  const Eigen::Vector2d n1 = half_width_m * left_of(-corner.back);
  const Eigen::Vector2d n2 = half_width_m * left_of(corner.ahead);
  const Eigen::Vector2d mitre = (n1 + n2) / (1.0 + n1.dot(n2) / (half_width_m * half_width_m));
  const double reach_m = corner.room_m + kBeyondSegments_m;
  const Eigen::Vector2d before = at + reach_m * corner.back, after = at + reach_m * corner.ahead;
  return {before - n1, at - mitre, after - n2, after + n2, at + mitre, before + n1};
}

// Chooses a corner's gaps; what is not as asked is said.
std::string round_for(const CornerDriving& driving, const Points& points, Corner& corner) {
  const Eigen::Vector2d& at = points[corner.at];
  CornerQuestion question{.before = at + corner.room_m * corner.back,
                          .at = at,
                          .after = at + corner.room_m * corner.ahead,
                          .speed_mps = driving.speed_mps,
                          .drivable = road_of(at, corner, driving.half_width_m)};
  const CornerChoice as_asked = choose_corner_gaps(question, driving.vehicle);
  CornerChoice choice = as_asked;
  while (!choice.gaps && question.speed_mps > kLeastCornerSpeed_mps) {
    question.speed_mps /= kSpeedStep;
    choice = choose_corner_gaps(question, driving.vehicle);
  }
  const std::string place = fmt::format("corner at ({:.2f}, {:.2f})", at.x(), at.y());
  if (!choice.gaps) {
    corner.room_m = std::min(corner.room_m, kMostRounding_m);
    corner.gaps = geometry::scaled_to(geometry::kGentleGaps, corner.room_m * (1.0 - 1e-12));
    return fmt::format("{}: rounded as without a vehicle; {}", place, choice.reason);
  }
  corner.gaps = *choice.gaps;
  corner.room_m = choice.gaps->total_m();
  if (as_asked.gaps) return {};
  return fmt::format("{}: rounded for {:.1f} m/s; {}", place, question.speed_mps, as_asked.reason);
}

geometry::QuinticBezier curve_at(const Points& points, const Corner& corner) {
  const Eigen::Vector2d& at = points[corner.at];
  return geometry::QuinticBezier::corner(at + corner.room_m * corner.back, at,
                                         at + corner.room_m * corner.ahead, corner.gaps);
}

void append(Points& path, const Points& piece) {
  for (const Eigen::Vector2d& point : piece) {
    if (path.empty() || !same(point, path.back())) path.push_back(point);
  }
}

Points sampled(const geometry::QuinticBezier& curve, double step_m) {
  const int count = static_cast<int>(std::ceil(2.0 * curve.length_m() / step_m));
  Points points;
  for (int i = 0; i <= count; ++i) points.push_back(curve.at(static_cast<double>(i) / count));
  return points;
}

// Way-points after one corner and before the next that neither of them replaces.
Points between(const Points& points, const Corner* before, const Corner* after) {
  const auto clear_of = [&](const Corner* corner, const Eigen::Vector2d& point) {
    return corner == nullptr || (point - points[corner->at]).norm() > corner->room_m * (1.0 + 1e-9);
  };
  const std::size_t from = before == nullptr ? 0 : before->at + 1;
  const std::size_t to = after == nullptr ? points.size() : after->at;
  Points kept;
  for (std::size_t i = from; i < to; ++i) {
    if (clear_of(before, points[i]) && clear_of(after, points[i])) kept.push_back(points[i]);
  }
  return kept;
}

// Goes along the way-points with the spline.
void measure_swing(const Points& through, const Points& spline, WayPointPath& path) {
  std::size_t i = 0;
  for (const Eigen::Vector2d& point : spline) {
    const auto apart_m = [&](std::size_t k) {
      return geometry::distance_to_segment_m(point, through[k], through[k + 1]);
    };
    while (i + 2 < through.size() && apart_m(i + 1) <= apart_m(i)) ++i;
    if (apart_m(i) <= path.largest_swing_m) continue;
    path.largest_swing_m = apart_m(i);
    path.swing_at = point;
  }
}

// The spline from one corner's curve (or the first way-point) to the next one's (or the last).
void append_piece(WayPointPath& path, const Points& points, const Corner* before,
                  const Corner* after, double step_m) {
  Points piece = between(points, before, after);
  path.way_points.insert(path.way_points.end(), piece.begin(), piece.end());
  std::optional<Eigen::Vector2d> first, last;
  if (before != nullptr) {
    first = before->ahead;
    piece.insert(piece.begin(), points[before->at] + before->room_m * before->ahead);
  }
  if (after != nullptr) {
    last = -after->back;
    piece.push_back(points[after->at] + after->room_m * after->back);
  }
  piece.erase(std::unique(piece.begin(), piece.end(), same), piece.end());
  if (piece.size() < 2) return;
  const Points spline = geometry::SplineCurve::through(piece, first, last).resample(step_m);
  measure_swing(piece, spline, path);
  append(path.points, spline);
}

}  // namespace

WayPointPath path_through(std::span<const Eigen::Vector2d> way_points, double step_m,
                          const std::optional<CornerDriving>& driving) {
  const Points points = distinct(way_points);
  refuse_turning_back(points);
  refuse_too_long(points, step_m);
  WayPointPath path;
  const Corner* before = nullptr;
  std::vector<Corner> corners = corners_of(points, driving ? kLongestRounding_m : kMostRounding_m);
  for (Corner& corner : corners) {
    corner.gaps = geometry::scaled_to(geometry::kGentleGaps, corner.room_m * (1.0 - 1e-12));
    if (driving) {
      std::string note = round_for(*driving, points, corner);
      if (!note.empty()) path.notes.push_back(std::move(note));
    }
    append_piece(path, points, before, &corner, step_m);
    append(path.points, sampled(curve_at(points, corner), step_m));
    before = &corner;
  }
  append_piece(path, points, before, nullptr, step_m);
  return path;
}

}  // namespace roadbed::planning::reference
