#include "roadbed/planning/tracking/lane_forecast.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "roadbed/geometry/primitives/angle.h"

namespace roadbed::planning::inline tracking {
namespace {

using geometry::Pose2;

constexpr double kLeastDriving_mps = 0.5;
constexpr double kReach_m = 1.5;         // from a lane that one may still drive along
constexpr double kMostTurned_rad = 0.6;  // against it
constexpr double kHeading_rad = 0.2, kOffset_m = 0.8, kForkTurn_rad = 0.7;  // what is usual
constexpr double kMostLateral_mps2 = 4.0, kBraking_mps2 = 2.0;  // in turns and before them
constexpr double kAtOnce_m = 1.0, kLeastUsual = 1e-4;
constexpr double kLeastShare = 0.05;  // of the likeliest; what is less likely is left out
constexpr double kReturns_s = 1.5;    // to the lane's middle
constexpr double kWaitsFor_s = 15.0, kStays_s = 2.0, kSetsOff_mps = 0.5;
constexpr double kQueuesFor_s = 90.0;  // as lights are red
constexpr double kStopLine_m = 20.0;   // before a junction, of the centre of the first
constexpr double kMidLane_m = 0.4, kMidLane_rad = 0.1;         // farther from it one parks
constexpr double kNextInQueue_m = 15.0, kBesideQueue_m = 1.5;  // of the centre of the next
constexpr double kSpareWay_m = 100.0;  // that ways are longer than asked for

bool follows_lanes(const Track& track) { return track.kind != "pedestrian"; }

/// Who rides at the side of a lane goes on there: what is narrower than a car.
bool keeps_beside(const Track& track) { return track.width_m < 1.2; }

/// For how long it is known to have stood; none: it drives.
std::optional<double> stands_since_s(const Track& track, const SeenMotion& seen) {
  if (seen.speed_mps != 0.0) return std::nullopt;
  return seen.t_s - track.moved_s.value_or(track.first_s);
}

bool stands_behind_another(LaneForecast::Tracks tracks, const SeenMotion& seen) {
  return std::ranges::any_of(tracks, [&](const std::optional<Track>& other) {
    if (!other) return false;
    const SeenMotion there = other->filter.state();
    const Eigen::Vector2d ahead = seen.pose.inverse() * there.pose.position();
    const double turned_rad =
        std::abs(geometry::wrap_angle(there.pose.heading_rad - seen.pose.heading_rad));
    return there.speed_mps == 0.0 && turned_rad < kMostTurned_rad && ahead.x() > 0.0 &&
           ahead.x() < kNextInQueue_m && std::abs(ahead.y()) < kBesideQueue_m;
  });
}

/// Stays for a while, then moves on a little, so that it is followed and not passed.
geometry::Trajectory setting_off(const SeenMotion& seen) {
  const Pose2 later = seen.pose * Pose2{kSetsOff_mps * (kForeseen_s - kStays_s), 0.0, 0.0};
  const auto at = [&](double after_s, const Pose2& pose, double speed_mps) {
    return geometry::TrajectoryPoint{.t_s = seen.t_s + after_s,
                                     .x_m = pose.x_m,
                                     .y_m = pose.y_m,
                                     .heading_rad = pose.heading_rad,
                                     .speed_mps = speed_mps};
  };
  return geometry::Trajectory({at(0.0, seen.pose, 0.0), at(kStays_s, seen.pose, 0.0),
                               at(kForeseen_s, later, kSetsOff_mps)});
}

/// From beside a way to an offset from its middle, as a critically damped spring leads there.
geometry::Trajectory along_way(const SeenMotion& seen, const geometry::Polyline& way,
                               const geometry::LinePosition& from, double to_d_m,
                               double turned_rad) {
  std::vector<geometry::TrajectoryPoint> points;
  const double aside_mps = seen.speed_mps * std::sin(turned_rad);
  const double d_m = from.d_m - to_d_m;
  const double pull_mps = aside_mps + d_m / kReturns_s;
  const auto steps = static_cast<int>(std::lround(kForeseen_s / kForeseenStep_s));
  double ahead_m = 0.0;
  for (int k = 0; k <= steps; ++k) {
    const double after_s = kForeseenStep_s * k;
    const double speed_mps = foreseen_speed_mps(seen, after_s);
    const double fades = std::exp(-after_s / kReturns_s);
    const double beside_m = (d_m + pull_mps * after_s) * fades;
    const double sideways_mps = pull_mps * fades - beside_m / kReturns_s;
    const double drift_rad =
        speed_mps > kLeastDriving_mps ? std::atan2(sideways_mps, speed_mps) : 0.0;
    const Pose2 pose = pose_on(way, from.s_m + ahead_m) * Pose2{0.0, to_d_m + beside_m, drift_rad};
    points.push_back({.t_s = seen.t_s + after_s,
                      .x_m = pose.x_m,
                      .y_m = pose.y_m,
                      .heading_rad = pose.heading_rad,
                      .speed_mps = speed_mps});
    ahead_m += kForeseenStep_s * foreseen_speed_mps(seen, after_s + 0.5 * kForeseenStep_s);
  }
  return geometry::Trajectory(std::move(points));
}

}  // namespace

std::vector<ForecastMotion> LaneForecast::motions(Tracks tracks, std::size_t slot) {
  const Track& track = *tracks[slot];
  const SeenMotion seen = track.filter.state();
  std::vector<OnLane> on;
  if (follows_lanes(track) && seen.speed_mps > kLeastDriving_mps) on = lanes_at(seen);
  if (waits(tracks, track, seen)) return {{.motion = setting_off(seen)}};
  if (on.empty()) return {{.motion = foreseen_motion(seen)}};

  struct Choice {
    std::size_t lane, way;
    double weight;
  };
  std::vector<Choice> choices;
  const Kept& kept = ways_from(slot, on, kForeseen_s * seen.speed_mps);
  for (std::size_t i = 0; i < on.size(); ++i) {
    for (std::size_t k = 0; k < kept.ways[i].size(); ++k) {
      const Way& way = kept.ways[i][k];
      const double weight = on[i].weight * way.weight;
      choices.push_back({i, k, weight * slows_in_time(seen.speed_mps, way.ahead, on[i].place.s_m)});
    }
  }
  std::ranges::stable_sort(choices, std::greater{}, &Choice::weight);
  if (choices.size() > kMostMotions) choices.resize(kMostMotions);
  double sum = 0.0;
  for (const Choice& choice : choices) sum += choice.weight;
  std::vector<ForecastMotion> found;
  for (const Choice& choice : choices) {
    const OnLane& at = on[choice.lane];
    const Way& way = kept.ways[choice.lane][choice.way];
    const double to_d_m = keeps_beside(track) ? at.place.d_m : 0.0;
    found.push_back(
        {along_way(seen, way.centre, {at.place.s_m, at.place.d_m}, to_d_m, at.turned_rad),
         choice.weight / sum, way.ahead.lanes});
  }
  return found;
}

/// Who drove not long ago stands in a queue, at a light or a sign; a parked car has never been seen
/// to drive, and stands at the side.
bool LaneForecast::waits(Tracks tracks, const Track& track, const SeenMotion& seen) const {
  const std::optional<double> since_s = stands_since_s(track, seen);
  if (!since_s || *since_s >= kQueuesFor_s) return false;
  if (!track.moved_s && !is_in_mid_lane(seen)) return false;
  return (track.moved_s && *since_s < kWaitsFor_s) || stands_behind_another(tracks, seen) ||
         is_at_junction(seen);
}

bool LaneForecast::is_in_mid_lane(const SeenMotion& seen) const {
  return std::ranges::any_of(lanes_at(seen), [](const OnLane& at) {
    return std::abs(at.place.d_m) < kMidLane_m && std::abs(at.turned_rad) < kMidLane_rad;
  });
}

bool LaneForecast::is_at_junction(const SeenMotion& seen) const {
  return std::ranges::any_of(lanes_at(seen), [&](const OnLane& at) {
    const map::LanePlace from{.lane = at.place.lane, .s_m = at.place.s_m};
    const LanesAhead ahead = ways_ahead(road_map_, from, kStopLine_m, 1).front();
    return std::ranges::any_of(
        ahead.lanes, [&](map::LaneId lane) { return road_map_.lane(lane).junction.has_value(); });
  });
}

std::vector<LaneForecast::OnLane> LaneForecast::lanes_at(const SeenMotion& seen) const {
  std::vector<OnLane> on;
  for (const map::LaneMatch& match : road_map_.locate(seen.pose.position(), kReach_m, true)) {
    const double turned_rad = geometry::wrap_angle(seen.pose.heading_rad - match.heading_rad);
    if (std::abs(turned_rad) > kMostTurned_rad) continue;
    const double soon_m = match.place.d_m + seen.speed_mps * std::sin(turned_rad);
    const double misfit = std::pow(turned_rad / kHeading_rad, 2) + std::pow(soon_m / kOffset_m, 2);
    on.push_back({match.place, turned_rad, std::exp(-0.5 * misfit)});
  }
  const auto by_weight = [](const OnLane& a, const OnLane& b) { return a.weight < b.weight; };
  const auto best = std::ranges::max_element(on, by_weight);
  if (best == on.end()) return on;
  const double least = kLeastShare * best->weight;
  std::erase_if(on, [&](const OnLane& lane) { return lane.weight < least; });
  return on;
}

const LaneForecast::Kept& LaneForecast::ways_from(std::size_t slot, const std::vector<OnLane>& on,
                                                  double length_m) {
  if (kept_.size() <= slot) kept_.resize(slot + 1);
  Kept& kept = kept_[slot];
  const auto is_same = [](map::LaneId lane, const OnLane& now) { return lane == now.place.lane; };
  if (kept.length_m >= length_m && std::ranges::equal(kept.from, on, is_same)) return kept;
  kept = {.length_m = length_m + kSpareWay_m, .from = {}, .ways = {}};
  for (const OnLane& lane : on) {
    kept.from.push_back(lane.place.lane);
    kept.ways.push_back(new_ways(lane.place.lane, kept.length_m));
  }
  return kept;
}

std::vector<LaneForecast::Way> LaneForecast::new_ways(map::LaneId from, double length_m) const {
  const double whole_m = road_map_.lane(from).centre.in_map.length_m() + length_m;
  std::vector<Way> ways;
  for (LanesAhead& ahead :
       ways_ahead(road_map_, {.lane = from, .s_m = 0.0}, whole_m, kMostMotions)) {
    geometry::Polyline centre = centre_of(road_map_, ahead);
    const double weight = fork_weight(ahead);
    ways.push_back({std::move(ahead), std::move(centre), weight});
  }
  return ways;
}

/// How usual the braking is that the first turns of a way ask for.
double LaneForecast::slows_in_time(double speed_mps, const LanesAhead& ahead, double s_m) const {
  double hardest_mps2 = 0.0, to_m = -s_m;
  for (const map::LaneId id : ahead.lanes) {
    const map::Lane& lane = road_map_.lane(id);
    const double bend_per_m = turned_along_rad(lane) / lane.length_m();
    const double fastest_mps = std::sqrt(kMostLateral_mps2 / std::max(1e-6, bend_per_m));
    const double over_m2ps2 = speed_mps * speed_mps - fastest_mps * fastest_mps;
    hardest_mps2 = std::max(hardest_mps2, 0.5 * over_m2ps2 / std::max(kAtOnce_m, to_m));
    to_m += lane.length_m();
  }
  return std::max(kLeastUsual, std::exp(-0.5 * std::pow(hardest_mps2 / kBraking_mps2, 2)));
}

double LaneForecast::fork_weight(const LanesAhead& ahead) const {
  double weight = 1.0;
  for (std::size_t i = 0; i + 1 < ahead.lanes.size(); ++i) {
    double sum = 0.0;
    for (const map::LaneId next : road_map_.graph().of(ahead.lanes[i]).successors) {
      const map::Lane& lane = road_map_.lane(next);
      if (map::is_drivable(lane.type)) sum += std::exp(-turned_along_rad(lane) / kForkTurn_rad);
    }
    weight *= std::exp(-turned_along_rad(road_map_.lane(ahead.lanes[i + 1])) / kForkTurn_rad) / sum;
  }
  return weight;
}

}  // namespace roadbed::planning::tracking
