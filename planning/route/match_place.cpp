#include "roadbed/planning/route/match_place.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string_view>
#include <tuple>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/planning/route/route_network.h"

namespace roadbed::planning::inline route {
namespace {

constexpr std::array kSearch_m = {10.0, 100.0, 1e3, 1e4, 1e5};
constexpr std::size_t kNearest = 3;

PlaceCandidate judge(const map::RoadMap& road_map, const map::LaneMatch& match,
                     std::optional<double> heading_rad, const MatchOptions& options) {
  PlaceCandidate made{match.place, match.distance_m, match.heading_rad};
  double turn_rad =
      heading_rad ? std::abs(geometry::wrap_angle(match.heading_rad - *heading_rad)) : 0.0;
  if (heading_rad && may_reverse(road_map.lane(match.place.lane), options.participant)) {
    made.sense = turn_rad > 0.5 * std::numbers::pi ? Sense::against : Sense::along;
  }
  if (made.sense == Sense::against) {
    turn_rad = std::numbers::pi - turn_rad;
    made.heading_rad = geometry::wrap_angle(made.heading_rad + std::numbers::pi);
  }
  made.misfit_m = match.distance_m + options.metres_per_radian * turn_rad +
                  options.offset_weight * std::abs(match.place.d_m);
  if (!may_use(road_map.lane(match.place.lane), options.participant)) {
    made.verdict = MatchVerdict::not_for_participant;
  } else if (turn_rad > 0.5 * std::numbers::pi) {
    made.verdict = MatchVerdict::against_heading;
  }
  return made;
}

void sort_by_fit(std::vector<PlaceCandidate>& candidates) {
  std::sort(candidates.begin(), candidates.end(),
            [](const PlaceCandidate& a, const PlaceCandidate& b) {
              return std::tie(a.verdict, a.misfit_m, a.place.lane) <
                     std::tie(b.verdict, b.misfit_m, b.place.lane);
            });
}

std::vector<PlaceCandidate> nearest(const map::RoadMap& road_map, const Eigen::Vector2d& in_map,
                                    std::optional<double> heading_rad,
                                    const MatchOptions& options) {
  for (const double radius_m : kSearch_m) {
    std::vector<PlaceCandidate> found;
    for (const map::LaneMatch& match : road_map.locate(in_map, radius_m, false)) {
      PlaceCandidate candidate = judge(road_map, match, heading_rad, options);
      if (candidate.verdict == MatchVerdict::not_for_participant) continue;
      candidate.verdict = MatchVerdict::too_far;
      found.push_back(candidate);
    }
    if (found.empty()) continue;
    if (found.size() > kNearest) found.resize(kNearest);  // locate() gives the nearest first
    return found;
  }
  return {};
}

}  // namespace

std::string_view to_string(MatchVerdict verdict) {
  static constexpr std::array<std::string_view, 5> names = {"chosen", "possible", "against_heading",
                                                            "not_for_participant", "too_far"};
  return names.at(static_cast<std::size_t>(verdict));
}

std::vector<PlaceCandidate> match_place(const map::RoadMap& road_map, const Eigen::Vector2d& in_map,
                                        std::optional<double> heading_rad,
                                        const MatchOptions& options) {
  std::vector<PlaceCandidate> candidates;
  for (const map::LaneMatch& match : road_map.locate(in_map, options.reach_m, false)) {
    candidates.push_back(judge(road_map, match, heading_rad, options));
  }
  sort_by_fit(candidates);
  if (candidates.empty() || candidates.front().verdict == MatchVerdict::not_for_participant) {
    std::vector<PlaceCandidate> far = nearest(road_map, in_map, heading_rad, options);
    candidates.insert(candidates.begin(), far.begin(), far.end());
    return candidates;
  }
  candidates.front().verdict = MatchVerdict::chosen;
  return candidates;
}

RoutePlace route_place_of(const std::vector<PlaceCandidate>& candidates) {
  constexpr double kSame_m = 0.01;
  const PlaceCandidate& chosen = candidates.front();
  RoutePlace place(chosen.place, chosen.sense);
  for (const PlaceCandidate& other : std::span(candidates).subspan(1)) {
    const bool is_same = other.verdict == MatchVerdict::possible && other.sense == chosen.sense &&
                         other.misfit_m <= chosen.misfit_m + kSame_m;
    if (is_same) place.or_on.push_back(other.place);
  }
  return place;
}

std::vector<RoutePlace> places_under(const map::RoadMap& road_map,
                                     const geometry::Pose2& map_from_vehicle) {
  constexpr double kAlong_rad = 0.35;
  std::vector<RoutePlace> places;
  for (const PlaceCandidate& found :
       match_place(road_map, map_from_vehicle.position(), map_from_vehicle.heading_rad)) {
    const bool may =
        found.verdict == MatchVerdict::chosen || found.verdict == MatchVerdict::possible;
    const double turn_rad = geometry::wrap_angle(found.heading_rad - map_from_vehicle.heading_rad);
    if (!may || found.distance_m > 0.0 || std::abs(turn_rad) > kAlong_rad) continue;
    const bool against = found.sense == Sense::against;
    places.push_back({found.place, against ? Sense::against : Sense::along});
  }
  return places;
}

std::vector<RoutePlace> places_to_set_off(const map::RoadMap& road_map,
                                          const geometry::Pose2& map_from_vehicle) {
  constexpr double kReach_m = 3.0, kAcross = -0.2;  // cosine: a little more than across
  std::vector<RoutePlace> places = places_under(road_map, map_from_vehicle);
  if (!places.empty()) return places;
  for (const PlaceCandidate& near :
       match_place(road_map, map_from_vehicle.position(), map_from_vehicle.heading_rad,
                   {.reach_m = kReach_m})) {
    const bool heads_along = std::cos(map_from_vehicle.heading_rad - near.heading_rad) >= kAcross;
    if (near.verdict != MatchVerdict::chosen || !heads_along) continue;
    places.push_back({near.place, near.sense == Sense::against ? Sense::against : Sense::along});
  }
  return places;
}

}  // namespace roadbed::planning::route
