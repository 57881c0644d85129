#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "roadbed/map/validation/lane_folds.h"
#include "roadbed/map/validation/validate.h"

namespace roadbed::map::validation {
namespace {

/// Calls `check(lane, other, neighbour, on_left)` for every neighbour of every lane.
template <typename Check>
void for_each_neighbour(const RoadMap& road_map, const Check& check) {
  for (const Lane& lane : road_map.lanes()) {
    const LaneLinks& links = road_map.graph().of(lane.id);
    if (links.left) check(lane, road_map.lane(links.left->lane), *links.left, true);
    if (links.right) check(lane, road_map.lane(links.right->lane), *links.right, false);
  }
}

const char* side(bool left) { return left ? "left" : "right"; }

void one_sided_neighbours(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  for_each_neighbour(road_map, [&](const Lane& lane, const Lane& other, const Neighbour& neighbour,
                                   bool on_left) {
    const LaneLinks& links = road_map.graph().of(other.id);
    const bool back_left = neighbour.same_direction != on_left;
    const auto& back = back_left ? links.left : links.right;
    if (back && back->lane == lane.id && back->same_direction == neighbour.same_direction) return;
    report.add("lane " + lane.name, lane.pose_at(0.5 * lane.length_m()).position(),
               fmt::format("has lane {} as its {} neighbour, which does not have it as its {} one "
                           "of {} direction; make both name each other",
                           other.name, side(on_left), side(back_left),
                           neighbour.same_direction ? "the same" : "the opposite"));
  });
}

/// The middle of the shorter of two lanes, and where it is beside the other one.
struct Abreast {
  const Lane *shorter, *longer;
  double shorter_s_m, longer_s_m;
};

Abreast abreast(const Lane& a, const Lane& b) {
  const bool a_shorter = a.length_m() <= b.length_m();
  const Lane &shorter = a_shorter ? a : b, &longer = a_shorter ? b : a;
  const double middle_m = 0.5 * shorter.length_m();
  const auto beside = longer.centre.in_map.project(shorter.centre.in_map.at(middle_m));
  return {&shorter, &longer, middle_m, beside.s_m};
}

double distance_m(const geometry::Polyline& line, const Eigen::Vector2d& point) {
  return std::abs(line.project(point).d_m);
}

/// How far apart the borders are that two neighbours should share, at their middle.
double border_distance_m(const Lane& lane, const Lane& other, bool same_direction, bool on_left) {
  const LaneLine& own = on_left ? lane.left : lane.right;
  const LaneLine& theirs = on_left == same_direction ? other.right : other.left;
  if (own.in_map.length_m() <= theirs.in_map.length_m()) {
    return distance_m(theirs.in_map, own.in_map.at(0.5 * own.in_map.length_m()));
  }
  return distance_m(own.in_map, theirs.in_map.at(0.5 * theirs.in_map.length_m()));
}

void neighbours_apart(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  constexpr double kApart = 0.5;  // [m]
  for_each_neighbour(road_map, [&](const Lane& lane, const Lane& other, const Neighbour& neighbour,
                                   bool on_left) {
    const double apart_m = border_distance_m(lane, other, neighbour.same_direction, on_left);
    if (apart_m <= kApart) return;
    report.add("lane " + lane.name, lane.pose_at(0.5 * lane.length_m()).position(),
               fmt::format("its {} neighbour, lane {}, is {:.2f} m away; correct a border, or do "
                           "not name them neighbours",
                           side(on_left), other.name, apart_m));
  });
}

void neighbours_against(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  for_each_neighbour(road_map, [&](const Lane& lane, const Lane& other, const Neighbour& neighbour,
                                   bool on_left) {
    const Abreast at = abreast(lane, other);
    const double turn_rad = at.shorter->pose_at(at.shorter_s_m).heading_rad -
                            at.longer->pose_at(at.longer_s_m).heading_rad;
    const double along = std::cos(turn_rad);
    if (std::abs(along) < 0.5 || (along > 0.0) == neighbour.same_direction) return;
    if (is_folded(lane) || is_folded(other)) return;  // which has a finding of its own
    report.add("lane " + lane.name, lane.pose_at(0.5 * lane.length_m()).position(),
               fmt::format("its {} neighbour, lane {}, runs in {} direction, but is said to run in "
                           "{}; correct it",
                           side(on_left), other.name, along > 0.0 ? "the same" : "the opposite",
                           neighbour.same_direction ? "the same" : "the opposite"));
  });
}

constexpr std::array<MapRule, 3> kNeighbourRules = {{
    {{"neighbour.one-sided", {}, Severity::warning, "a lane's neighbour does not know of it"},
     one_sided_neighbours},
    {{"neighbour.apart",
      {},
      Severity::warning,
      "the border that neighbours share is more than 0.5 m apart"},
     neighbours_apart},
    {{"neighbour.direction",
      {},
      Severity::error,
      "neighbours run in other directions than they say"},
     neighbours_against},
}};

}  // namespace

std::span<const MapRule> neighbour_rules() { return kNeighbourRules; }

}  // namespace roadbed::map::validation
