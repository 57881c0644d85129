#include "roadbed/planning/route/route_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/planning/route/route_changes.h"

namespace roadbed::planning::inline route {
namespace {

constexpr double kLeastPath_m = 1.0;
constexpr double kHalfChord_m = 0.2;
constexpr double kStep_m = 0.05;               // at a link: a larger one is taken out
constexpr double kMostStep_m = 5.0;            // what is larger is a gap of the map
constexpr double kStepCurvature_per_m = 0.02;  // with which a step is taken out

double smooth_step(double t) {
  const double x = std::clamp(t, 0.0, 1.0);
  return x * x * x * (10.0 + x * (6.0 * x - 15.0));
}

// Where the path passes over from one lane to the next, in fractions of the lanes' length: below 0
// or above 1 where that lies beside a stretch before or behind.
struct Crossing {
  double middle = 0.0, half = 0.0;
};

// Lanes beside each other, and how the path changes between them.
struct Stretch {
  std::vector<DrivenLane> lanes;
  std::vector<Crossing> changes;
  double from = 0.0, to = 1.0;
};

class Stretches {
 public:
  Stretches(const map::RoadMap& road_map, const Route& route, const RoutePathOptions& options)
      : road_map_(road_map),
        route_(route),
        wanted_m_(options.lane_change_length_m),
        placed_(options.placed_change) {}

  std::vector<Stretch> build() && {
    bool joins = false;
    for (const RouteLeg& leg : route_.legs) {
      const double length_m = length_of(driven_lane(leg));
      const DrivenLane lane = driven_lane(leg);
      if (!joins) {
        made_.push_back({{}, {}, mirrored_m(road_map_, lane, leg.from_s_m) / length_m, 1.0});
      }
      Stretch& stretch = made_.back();
      stretch_of_leg_.push_back(made_.size() - 1);
      stretch.lanes.push_back(lane);
      stretch.to = mirrored_m(road_map_, lane, leg.to_s_m) / length_m;
      joins = leg.exit == LegExit::change_left || leg.exit == LegExit::change_right;
      if (joins) stretch.changes.push_back({stretch.to, 0.0});
    }
    for (Stretch& stretch : made_) fit(stretch);
    for (std::size_t leg = 0; leg < route_.legs.size(); ++leg) spread(leg);
    return std::move(made_);
  }

 private:
  double length_of(const DrivenLane& lane) const {
    return std::max(1e-3, road_map_.lane(lane.lane).length_m());
  }

  // As long as wanted, clear of the neighbours.
  void fit(Stretch& stretch) const {
    auto& at = stretch.changes;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const double before =
          i == 0 ? at[i].middle - stretch.from : 0.5 * (at[i].middle - at[i - 1].middle);
      const double after =
          i + 1 == at.size() ? stretch.to - at[i].middle : 0.5 * (at[i + 1].middle - at[i].middle);
      const double wanted = 0.5 * wanted_m_ / length_of(stretch.lanes[i]);
      at[i].half = std::max(1e-9, std::min({before, after, wanted}));
    }
  }

  // A change that takes several stretches goes over all of them about its own middle, and so does
  // one that is not made in the middle of its window.
  void spread(std::size_t leg) {
    const std::vector<ChangePart> parts = parts_of_change(road_map_, route_, leg);
    const bool is_placed = placed_ && placed_->leg == leg;
    if (parts.empty() || (parts.size() < 2 && !is_placed)) return;
    const Crossing in_m = crossing_m(leg, is_placed);
    for (const ChangePart& part : parts) {
      const double length_m = length_of(part.from);
      place(made_[stretch_of_leg_[part.leg]], part,
            {(in_m.middle - part.offset_m) / length_m, in_m.half / length_m});
    }
  }

  // By stations of the leg's lane.
  Crossing crossing_m(std::size_t leg, bool is_placed) const {
    const map::StationRange window = driven_window(road_map_, route_.legs[leg]);
    const double wanted_m = is_placed ? placed_->length_m : wanted_m_;
    const double half_m = 0.5 * std::min(wanted_m, window.to_s_m - window.from_s_m);
    if (!is_placed) return {0.5 * (window.from_s_m + window.to_s_m), half_m};
    const bool is_early = placed_->at == PlacedChange::At::window_start;
    return {is_early ? window.from_s_m + half_m : window.to_s_m - half_m, half_m};
  }

  // Puts a crossing where its lanes stand, or beside the lanes of the stretch.
  static void place(Stretch& stretch, const ChangePart& part, const Crossing& crossing) {
    auto& lanes = stretch.lanes;
    const auto at = std::find(lanes.begin(), lanes.end(), part.from);
    if (at != lanes.end() && at + 1 != lanes.end()) {
      if (*(at + 1) == part.to)
        stretch.changes[static_cast<std::size_t>(at - lanes.begin())] = crossing;
    } else if (at != lanes.end()) {
      lanes.push_back(part.to);
      stretch.changes.push_back(crossing);
    } else if (lanes.front() == part.to) {
      lanes.insert(lanes.begin(), part.from);
      stretch.changes.insert(stretch.changes.begin(), crossing);
    }
  }

  const map::RoadMap& road_map_;
  const Route& route_;
  double wanted_m_;
  std::optional<PlacedChange> placed_;
  std::vector<Stretch> made_;
  std::vector<std::size_t> stretch_of_leg_;
};

Eigen::Vector2d centre_at(const map::RoadMap& road_map, const DrivenLane& lane, double s_m) {
  return road_map.lane(lane.lane).centre.in_map.at(mirrored_m(road_map, lane, s_m));
}

// Of a chord, since single segments of real centrelines may point anywhere.
Eigen::Vector2d direction_of(const map::RoadMap& road_map, const DrivenLane& lane,
                             double fraction) {
  const double s_m = fraction * road_map.lane(lane.lane).length_m();
  const Eigen::Vector2d chord =
      centre_at(road_map, lane, s_m + kHalfChord_m) - centre_at(road_map, lane, s_m - kHalfChord_m);
  return chord.norm() > 0.0 ? Eigen::Vector2d(chord.normalized()) : Eigen::Vector2d(1.0, 0.0);
}

std::optional<DrivenLane> straightest_successor(const map::RoadMap& road_map,
                                                const DrivenLane& lane) {
  const auto heading_at_end = [&](const DrivenLane& of) {
    const Eigen::Vector2d along = direction_of(road_map, of, 1.0);
    return std::atan2(along.y(), along.x());
  };
  std::optional<DrivenLane> best;
  double least_turn = std::numeric_limits<double>::infinity();
  for (const DrivenLane& next : following(road_map, lane)) {
    const map::Lane& candidate = road_map.lane(next.lane);
    if (!is_drivable(candidate.type) || candidate.length_m() <= 0.0) continue;
    if (next.reversed && candidate.one_way) continue;
    const double turn = std::abs(geometry::wrap_angle(heading_at_end(next) - heading_at_end(lane)));
    if (turn < least_turn || (turn == least_turn && next.lane < best->lane)) {
      least_turn = turn;
      best = next;
    }
  }
  return best;
}

class Builder {
 public:
  Builder(const map::RoadMap& road_map, const RoutePathOptions& options)
      : road_map_(road_map), options_(options) {}

  void lead(const Stretch& first) {
    const double fraction = options_.lead_m / length_m(first.lanes.front());
    sample(first, std::max(0.0, first.from - fraction), first.from);
    path_.start_m = length_m_;
  }

  void follow(const Stretch& stretch) {
    take_out_step(stretch);
    sample(stretch, stretch.from, stretch.to);
  }

  void extend(Stretch last) {
    path_.goal_m = length_m_;
    const double end_m = length_m_ + std::max(options_.extend_m, kLeastPath_m);
    last = {{last.lanes.back()}, {}, last.to, 1.0};
    // A loop of lanes without length would never end, hence the count.
    for (std::size_t i = 0; i <= road_map_.lanes().size() && length_m_ < end_m; ++i) {
      const double fraction = (end_m - length_m_) / length_m(last.lanes.back());
      last.to = std::min(1.0, last.from + fraction);
      if (i > 0) take_out_step(last);
      sample(last, last.from, last.to);
      if (last.to < 1.0) return;
      const auto next = straightest_successor(road_map_, last.lanes.back());
      if (!next) break;
      last = {{*next}, {}, 0.0, 1.0};
    }
    go_straight(end_m - length_m_);
  }

  RoutePath take() && { return std::move(path_); }

 private:
  double length_m(const DrivenLane& lane) const {
    return std::max(1e-3, road_map_.lane(lane.lane).length_m());
  }

  Eigen::Vector2d centre(const DrivenLane& lane, double fraction) const {
    return centre_at(road_map_, lane, fraction * road_map_.lane(lane.lane).length_m());
  }

  Eigen::Vector2d direction(const DrivenLane& lane, double fraction) const {
    return direction_of(road_map_, lane, fraction);
  }

  RoutePathPoint place(const Stretch& stretch, double fraction) const {
    RoutePathPoint point{centre(stretch.lanes[0], fraction), {}, fraction};
    DrivenLane lane = stretch.lanes[0];
    for (std::size_t i = 0; i < stretch.changes.size(); ++i) {
      const auto [middle, half] = stretch.changes[i];
      const double weight = smooth_step((fraction - middle + half) / (2.0 * half));
      point.in_map +=
          weight * (centre(stretch.lanes[i + 1], fraction) - centre(stretch.lanes[i], fraction));
      if (weight > 0.5) lane = stretch.lanes[i + 1];
    }
    point.lane = lane.lane;
    point.reversed = lane.reversed;
    return point;
  }

  // Where a stretch begins beside the end of the path: the offset is kept at first and fades.
  void take_out_step(const Stretch& stretch) {
    step_ = Eigen::Vector2d(0.0, 0.0);
    if (path_.points.empty() || stretch.from > 0.0) return;
    const DrivenLane lane = stretch.lanes.front();
    const Eigen::Vector2d along = direction(lane, 0.0), left(-along.y(), along.x());
    const double step_m = (path_.points.back().in_map - place(stretch, 0.0).in_map).dot(left);
    if (std::abs(step_m) < kStep_m || std::abs(step_m) > kMostStep_m) return;
    step_ = step_m * left;
    const double wanted_m = std::sqrt(6.0 * std::abs(step_m) / kStepCurvature_per_m);
    step_fraction_ = std::min(1.0, wanted_m / length_m(lane));
  }

  void sample(const Stretch& stretch, double from, double to) {
    const double range_m = (to - from) * length_m(stretch.lanes.back());
    const int count = std::max(1, static_cast<int>(std::ceil(range_m / options_.step_m)));
    for (int i = 0; i <= count; ++i) {
      const double fraction = std::lerp(from, to, static_cast<double>(i) / count);
      RoutePathPoint point = place(stretch, fraction);
      point.in_map += (1.0 - smooth_step(fraction / step_fraction_)) * step_;
      add(point, direction({point.lane, point.reversed}, fraction));
    }
  }

  // Leaves out what is not ahead: lanes of real maps overlap by some centimetres.
  void add(const RoutePathPoint& point, const Eigen::Vector2d& along) {
    if (!path_.points.empty()) {
      const Eigen::Vector2d advance = point.in_map - path_.points.back().in_map;
      if (advance.dot(along) < 0.02 * options_.step_m) return;
      length_m_ += advance.norm();
    }
    path_.points.push_back(point);
  }

  void go_straight(double rest_m) {
    if (rest_m < options_.step_m || path_.points.empty()) return;
    RoutePathPoint point = path_.points.back();
    const Eigen::Vector2d along = direction({point.lane, point.reversed}, point.fraction);
    const int count = static_cast<int>(std::ceil(rest_m / options_.step_m));
    for (int i = 0; i < count; ++i) {
      point.in_map += rest_m / count * along;
      add(point, along);
    }
  }

  const map::RoadMap& road_map_;
  const RoutePathOptions& options_;
  RoutePath path_;
  double length_m_ = 0.0;
  Eigen::Vector2d step_{0.0, 0.0};
  double step_fraction_ = 1.0;
};

}  // namespace

RoutePath path_along(const map::RoadMap& road_map, const Route& route,
                     const RoutePathOptions& options) {
  if (route.legs.empty()) throw std::invalid_argument("path_along: the route has no leg");
  const std::vector<Stretch> stretches = Stretches(road_map, route, options).build();
  Builder builder(road_map, options);
  builder.lead(stretches.front());
  for (const Stretch& stretch : stretches) builder.follow(stretch);
  builder.extend(stretches.back());
  return std::move(builder).take();
}

}  // namespace roadbed::planning::route
