#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/index/road_map_index.h"
#include "roadbed/map/validation/validate.h"

namespace roadbed::map::validation {
namespace {

constexpr double kStep = 4.0;  // [m] between places along a centreline that are looked at
constexpr int kMostSteps = 2000;
// Of a whole map, and a lane of it on average: a file of a few lines can hold roads without end.
constexpr double kMostPlaces = 1e5, kMostPlacesOfALane = 200.0;
// Of lanes, that are looked at: of any map, and at a place on average.
constexpr std::size_t kFewPieces = 200'000, kPiecesOfAPlace = 32;

double elevation_m(const Lane& lane, double s_m) {
  const auto& stations = lane.centre.station_m;
  const auto after = std::upper_bound(stations.begin(), stations.end(), s_m);
  const auto index = std::min<std::ptrdiff_t>(after - stations.begin(),
                                              static_cast<std::ptrdiff_t>(stations.size()) - 1);
  return lane.centre.z_m[static_cast<std::size_t>(index)];
}

/// Lanes of other roads, outside junctions and at the same level, whose middle third the place is
/// in.
std::vector<LaneId> lanes_under(const RoadMap& road_map, const Lane& lane, double s_m,
                                geometry::WorkBudget& budget) {
  constexpr double kSameLevel = 2.0;  // [m]
  const LaneQuery query{.radius_m = 0.0, .types = LaneTypes::drivable(), .budget = &budget};
  std::vector<LaneId> found;
  for (const LaneMatch& match : road_map.index().lanes.near(lane.centre.in_map.at(s_m), query)) {
    const Lane& other = road_map.lane(match.place.lane);
    if (other.junction || !other.road || other.road == lane.road) continue;
    const bool deep = std::abs(match.place.d_m) < other.width_m(match.place.s_m) / 3.0;
    const double apart_m = elevation_m(lane, s_m) - elevation_m(other, match.place.s_m);
    if (deep && std::abs(apart_m) < kSameLevel) found.push_back(other.id);
  }
  return found;
}

/// How many places of a lane are looked at.
int places_of(const Lane& lane, double about_m) {
  return std::clamp(static_cast<int>(lane.length_m() / about_m), 1, kMostSteps);
}

/// How far a lane's centreline runs inside each other lane that it should not touch; a single
/// place inside is a crossing.
std::map<LaneId, double> overlaps_m(const RoadMap& road_map, const Lane& lane, double about_m,
                                    geometry::WorkBudget& budget) {
  const int steps = places_of(lane, about_m);
  const double step_m = lane.length_m() / steps;
  std::map<LaneId, int> places;
  for (int i = 0; i < steps; ++i) {
    for (const LaneId other : lanes_under(road_map, lane, (i + 0.5) * step_m, budget))
      ++places[other];
  }
  std::map<LaneId, double> overlap_m;
  for (const auto& [other, count] : places) {
    if (count > 1) overlap_m[other] = count * step_m;
  }
  return overlap_m;
}

bool is_compared(const Lane& lane) {
  return is_drivable(lane.type) && !lane.junction && lane.road.has_value();
}

/// Between places that are looked at.
double step_for(const RoadMap& road_map) {
  double length_m = 0.0, lanes = 0.0;
  for (const Lane& lane : road_map.lanes()) {
    if (!is_compared(lane)) continue;
    length_m += std::min(lane.length_m(), kMostSteps * kStep);
    lanes += 1.0;
  }
  return std::max(kStep, length_m / std::max(kMostPlaces, lanes * kMostPlacesOfALane));
}

struct Overlap {
  const Lane* lane;
  LaneId other;
  double length_m;
};

void overlapping_lanes(const RoadMap& road_map, const ValidateOptions& options, Report& report) {
  const double step_m = step_for(road_map);
  std::size_t places = 0;
  for (const Lane& lane : road_map.lanes()) {
    if (is_compared(lane)) places += static_cast<std::size_t>(places_of(lane, step_m));
  }
  geometry::WorkBudget budget(kFewPieces + kPiecesOfAPlace * places);
  const auto middle = [](const Lane& lane) {
    return lane.pose_at(0.5 * lane.length_m()).position();
  };
  std::vector<Overlap> found;
  for (const Lane& lane : road_map.lanes()) {
    if (!is_compared(lane)) continue;
    if (budget.is_spent()) {  // first, as the last ones of many are only counted
      report.add("lane " + lane.name, middle(lane),
                 "this lane and those behind it in the file were not compared: too many lie on "
                 "each other; remove those that stand there twice, then validate again");
      break;
    }
    for (const auto& [other, length_m] : overlaps_m(road_map, lane, step_m, budget)) {
      if (length_m >= options.min_overlap_m) found.push_back({&lane, other, length_m});
    }
  }
  for (const Overlap& overlap : found) {
    report.add("lane " + overlap.lane->name, middle(*overlap.lane),
               fmt::format("runs inside lane {} for {:.1f} m, outside of any junction; move one "
                           "of their roads, or put them into a junction",
                           road_map.lane(overlap.other).name, overlap.length_m));
  }
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Eigen::Vector2d median_place(const RoadMap& road_map) {
  std::vector<double> x, y;
  for (const Lane& lane : road_map.lanes()) {
    x.push_back(lane.centre.in_map.points().front().x());
    y.push_back(lane.centre.in_map.points().front().y());
  }
  return {median(std::move(x)), median(std::move(y))};
}

void lanes_far_away(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  constexpr double kFar = 2e5;  // [m]
  if (road_map.lanes().empty()) return;
  const Eigen::Vector2d middle = median_place(road_map);
  for (const Lane& lane : road_map.lanes()) {
    const Eigen::Vector2d place = lane.centre.in_map.points().front();
    const double away_m = (place - middle).norm();
    if (away_m <= kFar) continue;
    report.add("lane " + lane.name, place,
               fmt::format("is {:.0f} km from the middle of the map; correct its coordinates (zero "
                           "is a usual slip)",
                           away_m / 1000.0));
  }
}

constexpr std::array<MapRule, 2> kSurfaceRules = {{
    {{"geometry.overlap", "asam.net:xodr:1.4.0:road.no_overlap_outside_junction", Severity::warning,
      "drivable lanes of two roads lie on top of each other for --min-overlap, outside junctions"},
     overlapping_lanes},
    {{"geometry.far-away",
      {},
      Severity::warning,
      "a lane is more than 200 km from the middle of the map"},
     lanes_far_away},
}};

}  // namespace

std::span<const MapRule> surface_rules() { return kSurfaceRules; }

}  // namespace roadbed::map::validation
