#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/map/validation/lane_folds.h"
#include "roadbed/map/validation/validate.h"

namespace roadbed::map::validation {
namespace {

using Eigen::Vector2d;
using Points = std::vector<Vector2d>;

// A step that no smoothing hides: more than this is an error, less a warning.
constexpr double kBrokenGap = 0.5;   // [m]
constexpr double kBrokenKink = 0.5;  // [rad]
constexpr double kReversed = 2.6;    // [rad], 150°

double heading_rad(const Vector2d& from, const Vector2d& to) {
  return std::atan2(to.y() - from.y(), to.x() - from.x());
}

/// A greater turn is a corner, which no bend is drawn by.
constexpr double kCorner = 0.3;  // [rad]

/// Direction of a sampled curve at one of its ends, outwards: a chord has the curve's direction at
/// its middle, so half a chord's turn is added, as the last two chords turn. Points that slipped
/// less than 0.1 m from the one before them say nothing. None where there are no others.
std::optional<double> outward_heading_rad(const LaneLine& line, bool at_end) {
  constexpr double kSlip = 0.1;  // [m]
  const Points& points = line.in_map.points();
  Points apart;  // from the end inwards
  for (std::size_t i = 0; i < points.size() && apart.size() < 3; ++i) {
    const Vector2d& point = points[at_end ? points.size() - 1 - i : i];
    if (apart.empty() || (point - apart.back()).norm() > kSlip) apart.push_back(point);
  }
  if (apart.size() < 2) return std::nullopt;
  const double last_rad = heading_rad(apart[1], apart[0]);
  if (apart.size() < 3) return last_rad;
  const double turn_rad = geometry::wrap_angle(last_rad - heading_rad(apart[2], apart[1]));
  if (std::abs(turn_rad) > kCorner) return last_rad;
  const double last_m = (apart[0] - apart[1]).norm(), other_m = (apart[1] - apart[2]).norm();
  return last_rad + turn_rad * last_m / (last_m + other_m);
}

double border_gap_m(const LaneLine& from, const LaneLine& to) {
  return (to.in_map.points().front() - from.in_map.points().back()).norm();
}

bool holds(const std::vector<LaneId>& lanes, const std::optional<Neighbour>& neighbour) {
  return neighbour && neighbour->same_direction &&
         std::find(lanes.begin(), lanes.end(), neighbour->lane) != lanes.end();
}

/// A lane that splits into two meets each of them with one border only, two that merge likewise.
struct Seam {
  double left_m = 0.0, right_m = 0.0;
};

Seam seam_between(const LaneGraph& graph, const Lane& from, const Lane& to) {
  const LaneLinks &before = graph.of(from.id), &after = graph.of(to.id);
  Seam seam;
  if (!holds(before.successors, after.left) && !holds(after.predecessors, before.left)) {
    seam.left_m = border_gap_m(from.left, to.left);
  }
  if (!holds(before.successors, after.right) && !holds(after.predecessors, before.right)) {
    seam.right_m = border_gap_m(from.right, to.right);
  }
  return seam;
}

bool both_drivable(const Lane& from, const Lane& to) {
  return is_drivable(from.type) && is_drivable(to.type);
}

Severity by_use(const Lane& from, const Lane& to) {
  return both_drivable(from, to) ? Severity::error : Severity::warning;
}

Severity gap_severity(const Lane& from, const Lane& to, double gap_m) {
  if (!both_drivable(from, to)) return gap_m > kBrokenGap ? Severity::warning : Severity::info;
  return gap_m > kBrokenGap ? Severity::error : Severity::warning;
}

/// Calls `check(from, to)` for every link between lanes.
template <typename Check>
void for_each_link(const RoadMap& road_map, const Check& check) {
  for (const Lane& from : road_map.lanes()) {
    for (const LaneId to : road_map.graph().of(from.id).successors) check(from, road_map.lane(to));
  }
}

/// The same for those between drivable lanes.
template <typename Check>
void for_each_drivable_link(const RoadMap& road_map, const Check& check) {
  for_each_link(road_map, [&](const Lane& from, const Lane& to) {
    if (both_drivable(from, to)) check(from, to);
  });
}

/// Change of heading from one line to the next, 0 where one has no direction.
double turn_between(const LaneLine& from, const LaneLine& to) {
  const auto end_rad = outward_heading_rad(from, true), back_rad = outward_heading_rad(to, false);
  return end_rad && back_rad ? geometry::wrap_angle(*back_rad + std::numbers::pi - *end_rad) : 0.0;
}

/// Change of heading from one lane to the next: of the centreline, or that of both borders on
/// average where it is less. A centreline between borders of few points has corners that the lane
/// has not, and borders that part or close in do not turn the lane.
double kink_between(const Lane& from, const Lane& to) {
  const double centre_rad = turn_between(from.centre, to.centre);
  const double borders_rad =
      0.5 * (turn_between(from.left, to.left) + turn_between(from.right, to.right));
  if (centre_rad * borders_rad <= 0.0) return 0.0;
  return std::abs(borders_rad) < std::abs(centre_rad) ? borders_rad : centre_rad;
}

/// Whether one lane runs against the other where they meet. Over half a metre: the last centimetre
/// of a lane whose width slips there may point anywhere.
bool runs_against(const Lane& from, const Lane& to) {
  const Vector2d end = direction_at(from, from.length_m()), start = direction_at(to, 0.0);
  return end.dot(start) < std::cos(kReversed);
}

void gaps(const RoadMap& road_map, const ValidateOptions& options, Report& report) {
  for_each_link(road_map, [&](const Lane& from, const Lane& to) {
    const auto [left_m, right_m] = seam_between(road_map.graph(), from, to);
    const double gap_m = std::max(left_m, right_m);
    if (gap_m <= options.max_gap_m) return;
    report
        .add("lane " + from.name, from.centre.in_map.points().back(),
             fmt::format("its end is off the start of lane {}, left border by {:.3f} m, right "
                         "border by {:.3f} m; move one of them, or correct a width",
                         to.name, left_m, right_m))
        .severity = gap_severity(from, to, gap_m);
  });
}

/// The greatest turn between two segments of a centreline near one of its ends: how coarsely it is
/// drawn there. Corners that no bend is drawn by do not count.
double corner_rad(const Lane& lane, bool at_end) {
  constexpr double kNear = 10.0;  // [m]
  constexpr std::size_t kMost = 16;
  const Points& points = lane.centre.in_map.points();
  const auto point = [&](std::size_t i) { return points[at_end ? points.size() - 1 - i : i]; };
  double greatest_rad = 0.0;
  for (std::size_t i = 1; i + 1 < std::min(points.size(), kMost); ++i) {
    if ((point(i) - point(0)).norm() > kNear && i > 1) break;
    const double turn_rad = geometry::wrap_angle(heading_rad(point(i), point(i + 1)) -
                                                 heading_rad(point(i - 1), point(i)));
    greatest_rad = std::max(greatest_rad, std::abs(turn_rad));
  }
  return std::min(greatest_rad, kCorner);
}

void kinks(const RoadMap& road_map, const ValidateOptions& options, Report& report) {
  for_each_drivable_link(road_map, [&](const Lane& from, const Lane& to) {
    const double kink_rad = kink_between(from, to);
    if (std::abs(kink_rad) <= options.max_kink_rad || runs_against(from, to)) return;
    // Backwards at once goes only who is folded, which has a finding of its own.
    if (std::abs(kink_rad) > kReversed && (is_folded(from) || is_folded(to))) return;
    // A line drawn by few points has corners; where two of them meet is one more.
    if (std::abs(kink_rad) <= std::max(corner_rad(from, true), corner_rad(to, false))) return;
    Finding& finding = report.add(
        "lane " + from.name, from.centre.in_map.points().back(),
        fmt::format("lane {} goes on turned by {:.3f} rad; correct the heading of one of them, or "
                    "a width's slope",
                    to.name, kink_rad));
    if (std::abs(kink_rad) > kBrokenKink) finding.severity = Severity::error;
  });
}

void reversals(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  for_each_link(road_map, [&](const Lane& from, const Lane& to) {
    if (!runs_against(from, to)) return;
    if (is_folded(from) || is_folded(to)) return;  // which has a finding of its own
    report
        .add("lane " + from.name, from.centre.in_map.points().back(),
             fmt::format("lane {} goes on in the opposite direction; correct the link, or the "
                         "direction of one of them",
                         to.name))
        .severity = by_use(from, to);
  });
}

/// Distances between the four pairs of ends of two lanes' centrelines.
struct EndDistances {
  double as_linked_m = 0.0, otherwise_m = 0.0;
};

EndDistances end_distances(const Lane& from, const Lane& to) {
  const Points &a = from.centre.in_map.points(), &b = to.centre.in_map.points();
  return {(a.back() - b.front()).norm(),
          std::min({(a.back() - b.back()).norm(), (a.front() - b.front()).norm(),
                    (a.front() - b.back()).norm()})};
}

void wrong_ends(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  for_each_link(road_map, [&](const Lane& from, const Lane& to) {
    const auto [as_linked_m, otherwise_m] = end_distances(from, to);
    if (as_linked_m <= kBrokenGap || otherwise_m > 0.2 * as_linked_m) return;
    report
        .add("lane " + from.name, from.centre.in_map.points().back(),
             fmt::format("is linked to the start of lane {}, {:.2f} m off, but other ends of the "
                         "two meet within {:.2f} m; correct the link's ends",
                         to.name, as_linked_m, otherwise_m))
        .severity = by_use(from, to);
  });
}

void elevation_steps(const RoadMap& road_map, const ValidateOptions& options, Report& report) {
  for_each_drivable_link(road_map, [&](const Lane& from, const Lane& to) {
    const double step_m = to.centre.z_m.front() - from.centre.z_m.back();
    if (!(std::abs(step_m) > options.max_step_m)) return;
    Finding& finding =
        report.add("lane " + from.name, from.centre.in_map.points().back(),
                   fmt::format("lane {} goes on {:.3f} m higher; make their elevations meet",
                               to.name, step_m));
    if (std::abs(step_m) > kBrokenGap) finding.severity = Severity::error;
  });
}

/// Rise over run at an end of a centreline, over a metre; none where the lane is shorter.
std::optional<double> end_slope(const Lane& lane, bool at_end) {
  constexpr double kReach = 1.0;  // [m]
  const auto& z_m = lane.centre.z_m;
  const auto& s_m = lane.centre.station_m;
  if (lane.length_m() < kReach) return {};
  const std::size_t n = z_m.size();
  std::size_t other = at_end ? n - 1 : 0;
  while (std::abs(s_m[other] - s_m[at_end ? n - 1 : 0]) < kReach) at_end ? --other : ++other;
  const std::size_t end = at_end ? n - 1 : 0;
  return (z_m[end] - z_m[other]) / (s_m[end] - s_m[other]);
}

void slope_jumps(const RoadMap& road_map, const ValidateOptions& options, Report& report) {
  for_each_drivable_link(road_map, [&](const Lane& from, const Lane& to) {
    const auto before = end_slope(from, true), after = end_slope(to, false);
    if (!before || !after || !(std::abs(*after - *before) > options.max_slope_jump)) return;
    report.add("lane " + from.name, from.centre.in_map.points().back(),
               fmt::format("lane {} goes on with a slope of {:.1f} % after {:.1f} %; round the "
                           "elevation off",
                           to.name, 100.0 * *after, 100.0 * *before));
  });
}

constexpr std::array<MapRule, 6> kContinuityRules = {{
    {{"geometry.gap", "asam.net:xodr:1.7.0:lane_smoothness.contact_point_no_horizontal_gaps",
      Severity::warning,
      "borders of linked lanes do not meet within --max-gap; where a lane splits or lanes merge, "
      "the outer borders"},
     gaps},
    {{"geometry.kink",
      {},
      Severity::warning,
      "linked drivable lanes meet at more than --max-kink, in their centrelines and borders"},
     kinks},
    {{"geometry.elevation-step",
      {},
      Severity::warning,
      "linked drivable lanes meet at elevations more than --max-step apart"},
     elevation_steps},
    {{"geometry.slope-jump",
      {},
      Severity::warning,
      "linked drivable lanes meet with slopes more than --max-slope-jump apart"},
     slope_jumps},
    {{"link.reversed", {}, Severity::error, "a lane leads to one that runs the other way"},
     reversals},
    {{"link.wrong-end",
      {},
      Severity::error,
      "linked lanes do not meet where they are linked, but at other ends"},
     wrong_ends},
}};

}  // namespace

std::span<const MapRule> continuity_rules() { return kContinuityRules; }

}  // namespace roadbed::map::validation
