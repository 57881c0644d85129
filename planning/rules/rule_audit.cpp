#include "roadbed/planning/rules/rule_audit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/map/derived/rule_index.h"
#include "roadbed/map/elements/side.h"
#include "roadbed/planning/rules/speed_limit.h"

namespace roadbed::planning::inline rules {
namespace {

using Eigen::Vector2d;
using geometry::TrajectoryPoint;
using map::Lane;
using map::LaneId;
using map::LaneMatch;
using map::Side;

constexpr double kApart_m = 0.2, kInLane_m = 1e-3;
constexpr std::size_t kMostLanes = 16;

/// A moment of the drive.
struct Moment {
  TrajectoryPoint state;          // in source coordinates
  Vector2d axle, front, rear;     // in coordinates of the map
  std::optional<double> way_rad;  // in which the axle moves; none: it stands
  double speed_mps = 0.0;
};

bool has_speeds(const geometry::Trajectory& drive) {
  return std::ranges::any_of(drive.points(),
                             [](const TrajectoryPoint& p) { return p.speed_mps != 0.0; });
}

Moment moment_of(const map::RoadMap& road_map, const TrajectoryPoint& state,
                 const geometry::BodyPart& body) {
  const Vector2d ahead(std::cos(state.heading_rad), std::sin(state.heading_rad));
  const Vector2d axle = road_map.to_map({state.x_m, state.y_m});
  return {.state = state,
          .axle = axle,
          .front = axle + body.front_m * ahead,
          .rear = axle + body.rear_m * ahead,
          .way_rad = std::nullopt,
          .speed_mps = std::abs(state.speed_mps)};
}

std::vector<Moment> moments_of(const map::RoadMap& road_map, const geometry::Trajectory& drive,
                               const geometry::BodyPart& body) {
  const auto& samples = drive.points();
  if (samples.empty())
    throw std::invalid_argument("rules: the drive needs at least 1 point, got 0");
  const bool tells_speed = has_speeds(drive);
  std::vector<Moment> moments{moment_of(road_map, samples.front(), body)};
  std::size_t last = 0;  // row of the last moment
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const TrajectoryPoint &a = samples[i - 1], &b = samples[i];
    const auto way_from = [&](const TrajectoryPoint& row) -> Vector2d {
      return b.pose().position() - row.pose().position();
    };
    const double row_m = way_from(a).norm();
    const TrajectoryPoint& from = row_m < kApart_m ? samples[last] : a;
    const Vector2d way = way_from(from);
    const double way_m = way.norm();
    if (way_m < kApart_m && i + 1 < samples.size()) continue;
    const double steps = std::max(1.0, std::ceil(row_m / kApart_m));
    for (double step = 1.0; step <= steps; ++step) {
      Moment& next = moments.emplace_back(
          moment_of(road_map, geometry::interpolate(a, b, step / steps), body));
      if (way_m > 1e-3) next.way_rad = std::atan2(way.y(), way.x());
      if (!tells_speed) next.speed_mps = way_m / (b.t_s - from.t_s);
    }
    last = i;
  }
  if (moments.size() > 1) {
    moments.front().way_rad = moments[1].way_rad;
    if (!tells_speed) moments.front().speed_mps = moments[1].speed_mps;
  }
  return moments;
}

/// Moments that follow each other and break one rule in one place are one violation.
class Violations {
 public:
  /// @param place  of the violation: a lane's index, or that of a crossing.
  void add(double previous_s, std::size_t place, const Violation& next) {
    const auto [found, is_new] = last_at_.try_emplace(place, all_.size());
    if (is_new || all_[found->second].to_s < previous_s) {
      found->second = all_.size();
      all_.push_back(next);
      return;
    }
    Violation& last = all_[found->second];
    last.to_s = next.to_s;
    if (next.over > last.over) {
      last.at = next.at;
      last.text = next.text;
      last.over = next.over;
    }
  }
  std::vector<Violation> take() { return std::move(all_); }

 private:
  std::vector<Violation> all_;
  std::map<std::size_t, std::size_t> last_at_;
};

/// A lane's border, and how the body came over it.
using Border = std::pair<LaneId, Side>;
struct Crossing {
  bool from_inside = false;  ///< the axle was on the lane's side of the border then
  std::size_t index = 0;     ///< the same for all borders that are one line
};
using Crossings = std::map<Border, Crossing>;

class RuleAudit {
 public:
  RuleAudit(const RuleInputs& inputs, const geometry::Trajectory& drive,
            const geometry::BodyPart& body)
      : road_map_(*inputs.road_map),
        lights_(inputs.lights),
        body_(body),
        moments_(moments_of(road_map_, drive, body)),
        at_axle_(locate(&Moment::axle)),
        at_front_(locate(&Moment::front)),
        at_rear_(locate(&Moment::rear)) {}

  std::vector<RuleReport> all() { return {markings(), direction(), speed(), lights()}; }

 private:
  map::LaneMatches locate(Vector2d Moment::*point) const {
    std::vector<Vector2d> points;
    for (const Moment& moment : moments_) points.push_back(moment.*point);
    return road_map_.locate(points, kInLane_m, kMostLanes, true);
  }

  double previous_s(std::size_t i) const { return moments_[i == 0 ? 0 : i - 1].state.t_s; }

  Violation violation(std::size_t i, const std::string& lane, std::string text,
                      double over = 0.0) const {
    return {.from_s = moments_[i].state.t_s,
            .to_s = moments_[i].state.t_s,
            .at = moments_[i].state,
            .lane = lane,
            .text = std::move(text),
            .over = over};
  }

  static bool is_along(double heading_rad, const LaneMatch& match, double most_rad) {
    return std::abs(geometry::wrap_angle(heading_rad - match.heading_rad)) < most_rad;
  }

  static RuleReport judged(RuleReport report) {
    report.unknown = joined(std::move(report.unknown));
    report.verdict = !report.violations.empty() ? Verdict::conflict
                     : report.unknown.empty()   ? Verdict::clear
                                                : Verdict::unknown;
    return report;
  }

  RuleReport direction() const {
    Violations found;
    RuleReport report{.rule = TrafficRule::direction, .violations = {}, .unknown = {}};
    for (std::size_t i = 0; i < moments_.size(); ++i) {
      const auto matches = at_axle_.of(i);
      if (matches.empty()) {
        report.unknown.push_back({previous_s(i), moments_[i].state.t_s});
        continue;
      }
      if (!moments_[i].way_rad) continue;
      const auto allows = [&](const LaneMatch& match) {
        return !road_map_.lane(match.place.lane).one_way ||
               is_along(*moments_[i].way_rad, match, 0.5 * std::numbers::pi);
      };
      if (std::ranges::any_of(matches, allows)) continue;
      const Lane& lane = road_map_.lane(matches.front().place.lane);
      found.add(previous_s(i), lane.id.index,
                violation(i, lane.name, "against the lane's direction"));
    }
    report.violations = found.take();
    if (!report.unknown.empty()) report.reason = "the rear axle is in no drivable lane";
    return judged(std::move(report));
  }

  RuleReport speed() const {
    constexpr double least_over_mps = 0.01;
    Violations found;
    RuleReport report{.rule = TrafficRule::speed, .violations = {}, .unknown = {}};
    for (std::size_t i = 0; i < moments_.size(); ++i) {
      const std::optional<LaneLimit> limit =
          limit_along(road_map_, at_axle_.of(i), moments_[i].state.heading_rad);
      if (!limit) {
        report.unknown.push_back({previous_s(i), moments_[i].state.t_s});
        continue;
      }
      const double over_mps = moments_[i].speed_mps - limit->limit_mps;
      if (over_mps <= least_over_mps) continue;
      found.add(previous_s(i), limit->lane->id.index,
                violation(i, limit->lane->name,
                          fmt::format("{:.1f} km/h, limit {:.1f} km/h", 3.6 * moments_[i].speed_mps,
                                      3.6 * limit->limit_mps),
                          over_mps));
    }
    report.violations = found.take();
    if (!report.unknown.empty()) report.reason = "the map has no speed limit there";
    return judged(std::move(report));
  }

  static map::MarkType mark_at(const Lane& lane, Side side, double s_m) {
    map::MarkType type = map::MarkType::none;
    for (const map::BorderMark& mark : map::marks(lane, side)) {
      if (mark.from_s_m <= s_m) type = mark.type;
    }
    return type;
  }

  static bool forbids(map::MarkType type, bool from_right) {
    switch (type) {
      case map::MarkType::solid:
      case map::MarkType::solid_solid:
      case map::MarkType::solid_broken:
      case map::MarkType::broken_solid:
        return !map::may_cross(type, from_right);
      default:
        return false;
    }
  }

  /// The markings of those pieces of a lane's border that the body is over, not farther along than
  /// its reach; empty: it is not over the border.
  std::set<map::MarkType> marks_under(const geometry::Rectangle& body, const Lane& lane, Side side,
                                      double s_m) const {
    std::set<map::MarkType> found;
    const map::LaneLine& line = map::border(lane, side);
    const auto& points = line.in_map.points();
    const auto& stations = line.station_m;
    const double reach_m = 2.0 * body_.reach_m();
    const auto first = std::lower_bound(stations.begin(), stations.end(), s_m - reach_m);
    std::size_t i =
        first == stations.begin() ? 0 : static_cast<std::size_t>(first - stations.begin()) - 1;
    for (; i + 1 < points.size() && stations[i] <= s_m + reach_m; ++i) {
      const Vector2d along = points[i + 1] - points[i];
      const double length_m = along.norm();
      if (!(length_m > 0.0)) continue;
      const geometry::Rectangle piece{.centre = 0.5 * (points[i] + points[i + 1]),
                                      .axis = along / length_m,
                                      .half_length_m = 0.5 * length_m};
      if (geometry::distance_m(body, piece) > 0.0) continue;
      found.insert(mark_at(lane, side, 0.5 * (stations[i] + stations[i + 1])));
    }
    return found;
  }

  /// Lanes outside of junctions that the body's front, axle or rear is in, and where along them.
  std::map<LaneId, double> lanes_under(std::size_t i) const {
    std::map<LaneId, double> lanes;
    for (const auto* at : {&at_axle_, &at_front_, &at_rear_}) {
      for (const LaneMatch& match : at->of(i)) {
        if (!road_map_.lane(match.place.lane).junction) {
          lanes.emplace(match.place.lane, match.place.s_m);
        }
      }
    }
    return lanes;
  }

  /// The crossing of a border that has begun: of itself, or of the one before or behind it.
  std::optional<Crossing> begun(const Border& border, const Crossings& known) const {
    const auto& [lane, side] = border;
    if (const auto found = known.find(border); found != known.end()) return found->second;
    const map::LaneLinks& links = road_map_.graph().of(lane);
    for (const auto* lanes : {&links.predecessors, &links.successors}) {
      for (const LaneId next : *lanes) {
        if (const auto found = known.find({next, side}); found != known.end()) return found->second;
      }
    }
    return std::nullopt;
  }

  /// The crossing of the same line that has begun: of the border, or of the neighbour's facing it.
  std::optional<Crossing> begun_of_line(const Border& border, const Crossings& known) const {
    const auto& [lane, side] = border;
    if (const auto own = begun(border, known)) return own;
    const map::LaneLinks& links = road_map_.graph().of(lane);
    const auto& other = side == Side::left ? links.left : links.right;
    if (!other) return std::nullopt;
    auto facing = begun({other->lane, other->same_direction ? map::opposite(side) : side}, known);
    if (facing) facing->from_inside = !facing->from_inside;
    return facing;
  }

  bool is_inside(const Vector2d& point, const Lane& lane, Side side) const {
    return (map::border(lane, side).in_map.project(point).d_m > 0.0) == (side == Side::right);
  }

  /// Whether these are all lanes that the axle is in, outside of junctions; so where it is in none.
  /// Where lanes overlap, as those through a crossing do, who keeps to one of them breaks no line.
  bool are_all_at_axle(std::size_t i, const std::set<LaneId>& broken) const {
    return std::ranges::all_of(at_axle_.of(i), [&](const LaneMatch& match) {
      const Lane& lane = road_map_.lane(match.place.lane);
      return match.distance_m > 0.0 || lane.junction || broken.contains(lane.id);
    });
  }

  /// A line is crossed from where the axle was when the body came over it, to the crossing's end.
  RuleReport markings() const {
    Violations found;
    Crossings before;
    std::size_t count = 0;
    for (std::size_t i = 0; i < moments_.size(); ++i) {
      const Moment& moment = moments_[i];
      const geometry::Rectangle body =
          body_.box_at({moment.axle.x(), moment.axle.y(), moment.state.heading_rad});
      Crossings now;
      std::set<LaneId> broken;
      std::vector<std::pair<std::size_t, Violation>> over;  // by line
      for (const auto& [id, s_m] : lanes_under(i)) {
        const Lane& lane = road_map_.lane(id);
        for (const Side side : {Side::left, Side::right}) {
          const std::set<map::MarkType> marks = marks_under(body, lane, side, s_m);
          if (marks.empty()) continue;
          std::optional<Crossing> crossing = begun_of_line({id, side}, before);
          if (!crossing) crossing = begun_of_line({id, side}, now);
          if (!crossing) crossing = {is_inside(moment.axle, lane, side), count++};
          now[{id, side}] = *crossing;
          const bool from_right = crossing->from_inside == (side == Side::left);
          if (std::ranges::none_of(marks, [&](auto mark) { return forbids(mark, from_right); }))
            continue;
          broken.insert(id);
          over.emplace_back(crossing->index,
                            violation(i, lane.name,
                                      fmt::format("over the solid marking on its {}",
                                                  side == Side::left ? "left" : "right")));
        }
      }
      if (are_all_at_axle(i, broken)) {
        for (const auto& [line, one] : over) found.add(previous_s(i), line, one);
      }
      before = std::move(now);
    }
    RuleReport report{.rule = TrafficRule::markings, .violations = found.take(), .unknown = {}};
    return judged(std::move(report));
  }

  const LightCycle* cycle_of(const std::string& signal) const {
    const auto found = std::ranges::find_if(lights_, [&](const LightCycle& light) {
      return std::ranges::count(light.signals, signal) > 0;
    });
    return found == lights_.end() ? nullptr : &*found;
  }

  /// Ids of the lights of a place where vehicles of a lane stop.
  std::vector<std::string> lights_of(const map::RulePlace& place) const {
    std::vector<std::string> ids;
    if (place.kind == map::RuleKind::stop_line) {
      for (const std::string& id : road_map_.stop_lines()[place.index].signals) {
        const auto is_light = [&](const map::Signal& signal) {
          return signal.source_id == id && signal.dynamic;
        };
        if (std::ranges::any_of(road_map_.signals(), is_light)) ids.push_back(id);
      }
    } else if (const map::Signal& signal = road_map_.signals()[place.index]; signal.dynamic) {
      ids.push_back(signal.source_id);
    }
    return ids;
  }

  /// Whether the front passed station `s_m` of a lane between two moments.
  bool passes(std::size_t i, LaneId lane, double s_m) const {
    const auto station = [&](std::size_t k) -> std::optional<double> {
      for (const LaneMatch& match : at_front_.of(k)) {
        if (match.place.lane == lane) return match.place.s_m;
      }
      return std::nullopt;
    };
    const std::optional<double> before_m = station(i - 1), now_m = station(i);
    if (!before_m || *before_m >= s_m) return false;
    if (now_m) return *now_m >= s_m;
    const auto& successors = road_map_.graph().of(lane).successors;
    return std::ranges::any_of(at_front_.of(i), [&](const LaneMatch& match) {
      return std::ranges::count(successors, match.place.lane) > 0;
    });
  }

  /// Of signals with a stop line, the line counts, which they are not looked at before.
  RuleReport lights() const {
    RuleReport report{.rule = TrafficRule::lights, .violations = {}, .unknown = {}};
    std::set<LaneId> set;
    for (std::size_t i = 0; i < moments_.size(); ++i) {
      for (const LaneMatch& match : at_front_.of(i)) {
        if (is_along(moments_[i].state.heading_rad, match, 0.5 * std::numbers::pi)) {
          set.insert(match.place.lane);
        }
      }
    }
    const std::vector<LaneId> lanes(set.begin(), set.end());
    const map::RuleIndex rules(road_map_, lanes);
    for (const LaneId lane : lanes) {
      std::set<std::string> seen;
      auto places = rules.ahead(std::array{lane}, 0.0, road_map_.lane(lane).length_m());
      std::ranges::stable_sort(places, [](const auto& a, const auto& b) {
        return a.kind == map::RuleKind::stop_line && b.kind != map::RuleKind::stop_line;
      });
      for (const map::RulePlace& place : places) {
        for (const std::string& id : lights_of(place)) {
          if (seen.insert(id).second) look_at_light(id, lane, place.s_m, report);
        }
      }
    }
    std::ranges::stable_sort(report.violations, {}, &Violation::from_s);
    return judged(std::move(report));
  }

  void look_at_light(const std::string& id, LaneId lane, double s_m, RuleReport& report) const {
    const LightCycle* cycle = cycle_of(id);
    for (std::size_t i = 1; i < moments_.size(); ++i) {
      if (!passes(i, lane, s_m)) continue;
      const Stretch time{moments_[i - 1].state.t_s, moments_[i].state.t_s};
      if (cycle == nullptr) {
        report.unknown.push_back(time);
        report.reason = fmt::format("nothing says what light {} shows", id);
        continue;
      }
      // Red all through the time in which the front passes.
      const bool is_red = colour_at(*cycle, time.from_s) == LightColour::red &&
                          colour_at(*cycle, time.to_s) == LightColour::red;
      if (!is_red) continue;
      Violation passed =
          violation(i, road_map_.lane(lane).name, fmt::format("light {} is red", id));
      passed.from_s = time.from_s;
      report.violations.push_back(std::move(passed));
    }
  }

  const map::RoadMap& road_map_;
  std::span<const LightCycle> lights_;
  geometry::BodyPart body_;
  std::vector<Moment> moments_;
  map::LaneMatches at_axle_, at_front_, at_rear_;
};

}  // namespace

std::string_view to_string(TrafficRule rule) {
  constexpr std::array<std::string_view, 4> names{"markings", "direction", "speed", "lights"};
  return names[static_cast<std::size_t>(rule)];
}

std::vector<RuleReport> audit_rules(const RuleInputs& inputs, const geometry::Trajectory& drive,
                                    const geometry::BodyPart& body) {
  return RuleAudit(inputs, drive, body).all();
}

}  // namespace roadbed::planning::rules
