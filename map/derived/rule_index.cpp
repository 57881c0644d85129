#include "roadbed/map/derived/rule_index.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "roadbed/geometry/primitives/cross.h"

namespace roadbed::map::inline derived {
namespace {

using Eigen::Vector2d;

/// Station at which the centreline crosses the segment from `a` to `b`, the first of several.
std::optional<double> crossing_m(const geometry::Polyline& line, const Vector2d& a,
                                 const Vector2d& b) {
  const auto& points = line.points();
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vector2d piece = points[i + 1] - points[i], segment = b - a, to_segment = a - points[i];
    const double turn = geometry::cross(piece, segment);
    if (turn == 0.0) continue;
    const double on_piece = geometry::cross(to_segment, segment) / turn;
    const double on_segment = geometry::cross(to_segment, piece) / turn;
    if (on_piece < 0.0 || on_piece > 1.0 || on_segment < 0.0 || on_segment > 1.0) continue;
    return line.stations_m()[i] + on_piece * piece.norm();
  }
  return std::nullopt;
}

/// Where the centreline crosses the stop line, else where it is nearest to the line's middle.
double station_of(const StopLine& stop_line, const Lane& lane) {
  const auto& points = stop_line.in_map;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vector2d from = points[i].head<2>(), to = points[i + 1].head<2>();
    if (const auto s_m = crossing_m(lane.centre.in_map, from, to)) return *s_m;
  }
  const Vector2d middle = 0.5 * (points.front() + points.back()).head<2>();
  return lane.centre.in_map.project(middle).s_m;
}

/// The station that the source gives for the signal on its k-th lane, else of its foot there.
double station_of(const Signal& signal, std::size_t k, const RoadMap& road_map) {
  if (k < signal.lane_s_m.size()) return signal.lane_s_m[k];
  return road_map.lane(signal.lanes[k]).centre.in_map.project(signal.in_map).s_m;
}

template <typename Indices, typename Index>
void add_once(Indices& indices, Index index) {
  if (std::find(indices.begin(), indices.end(), index) == indices.end()) indices.push_back(index);
}

bool may_change(const std::optional<Neighbour>& to, double s_m) {
  if (!to || !to->same_direction) return false;
  return std::any_of(
      to->change_windows.begin(), to->change_windows.end(),
      [&](const StationRange& window) { return window.from_s_m <= s_m && s_m <= window.to_s_m; });
}

}  // namespace

RuleIndex::RuleIndex(const RoadMap& road_map) : road_map_(&road_map) {
  add_all([](LaneId) { return true; });
}

RuleIndex::RuleIndex(const RoadMap& road_map, std::span<const LaneId> lanes)
    : road_map_(&road_map) {
  const std::set<LaneId> wanted(lanes.begin(), lanes.end());
  add_all([&](LaneId id) { return wanted.contains(id); });
}

template <typename Wants>
void RuleIndex::add_all(const Wants& wants) {
  for (std::size_t i = 0; i < road_map_->signals().size(); ++i) {
    const Signal& signal = road_map_->signals()[i];
    for (std::size_t k = 0; k < signal.lanes.size(); ++k) {
      if (!wants(signal.lanes[k])) continue;
      add({RuleKind::signal, i, signal.lanes[k], station_of(signal, k, *road_map_), 0.0});
    }
  }
  for (std::size_t i = 0; i < road_map_->stop_lines().size(); ++i) {
    const StopLine& stop_line = road_map_->stop_lines()[i];
    if (stop_line.in_map.empty()) continue;
    for (const LaneId id : stop_line.lanes) {
      if (!wants(id)) continue;
      add({RuleKind::stop_line, i, id, station_of(stop_line, road_map_->lane(id)), 0.0});
    }
  }
  for (std::size_t i = 0; i < road_map_->regulations().size(); ++i) {
    for (const LaneId id : road_map_->regulations()[i].lanes) {
      if (wants(id)) add_once(of_lane_[id].regulations, i);
    }
  }
  sort_places();
}

void RuleIndex::sort_places() {
  for (auto& [lane, of_lane] : of_lane_) {
    std::sort(of_lane.places.begin(), of_lane.places.end(),
              [](const RulePlace& a, const RulePlace& b) {
                return std::tie(a.s_m, a.kind, a.index) < std::tie(b.s_m, b.kind, b.index);
              });
  }
}

const RuleIndex::OfLane& RuleIndex::of(LaneId lane) const {
  static const OfLane nothing;
  const auto found = of_lane_.find(lane);
  return found == of_lane_.end() ? nothing : found->second;
}

RulesAt RuleIndex::at(LaneId lane, double s_m) const {
  RulesAt rules;
  rules.speed_limit_mps = road_map_->lane(lane).speed_limit_at_mps(s_m);
  const LaneLinks& links = road_map_->graph().of(lane);
  rules.may_change_left = may_change(links.left, s_m);
  rules.may_change_right = may_change(links.right, s_m);
  rules.regulations = of(lane).regulations;
  for (RulePlace place : of(lane).places) {
    if (place.s_m < s_m) continue;
    place.distance_m = place.s_m - s_m;
    auto& next = place.kind == RuleKind::signal ? rules.next_signal : rules.next_stop_line;
    if (!next) next = place;
  }
  return rules;
}

std::vector<RulePlace> RuleIndex::ahead(std::span<const LaneId> path, double from_s_m,
                                        double within_m) const {
  std::vector<RulePlace> found;
  double start_m = -from_s_m;  // of the lane, along the way
  for (const LaneId id : path) {
    if (start_m > within_m) break;
    for (RulePlace place : of(id).places) {
      place.distance_m = start_m + place.s_m;
      if (place.distance_m >= 0.0 && place.distance_m <= within_m) found.push_back(place);
    }
    start_m += road_map_->lane(id).length_m();
  }
  return found;
}

}  // namespace roadbed::map::derived
