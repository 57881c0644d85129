#include "roadbed/map/opendrive/write/shape_roads.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "roadbed/map/files/in_threads.h"
#include "roadbed/map/opendrive/write/close_joints.h"
#include "roadbed/map/opendrive/write/end_lines.h"
#include "roadbed/map/opendrive/write/joint_gaps.h"
#include "roadbed/map/opendrive/write/reference_borders.h"
#include "roadbed/map/opendrive/write/road_network.h"

namespace roadbed::map::opendrive {
namespace {

constexpr int kMostRounds = 4, kMostPlans = 3;
constexpr double kParting_m = 0.2;   // fault of a road with several lanes that is too much
constexpr double kHopeless_m = 1.0;  // of one with a single lane
constexpr double kAnyFault_m = 1e300;
constexpr double kGain_m = 1e-4;      // that makes another line worth while
constexpr double kRounding_m = 1e-9;  // of sums of faults
constexpr double kDetour = 1e-3;      // what a line costs by its distance from the map's own ends

/// Lanes with the border that a reference line follows and the lines across their ends: all that a
/// road's shape depends on.
using PlaceKey = std::vector<double>;

/// What earlier plans and rounds found.
struct Memory {
  std::map<PlaceKey, PlacedRoad> placed;
  std::map<PlaceKey, double> faults_m;  // no more than they are
};

class RoadsPlacer {
 public:
  RoadsPlacer(const RoadMap& road_map, const RoadPlan& plan, Memory& memory, int threads)
      : road_map_(road_map),
        plan_(plan),
        memory_(memory),
        borders_(reference_borders(road_map, plan)),
        lines_(end_lines(road_map, plan)),
        ends_(find_end_roles(road_map, plan)),
        chosen_(lines_.choices.size(), 0),
        roads_of_(lines_.choices.size()),
        joints_of_(lines_.choices.size()),
        roads_(plan.roads.size()) {
    in_threads(plan.roads.size(), threads, [&](std::size_t i) {
      const auto road = static_cast<std::uint32_t>(i);
      roads_[road] = place(road, key(road), kAnyFault_m);
    });
    for (std::uint32_t road = 0; road < plan.roads.size(); ++road) {
      memory_.faults_m[key(road)] = roads_[road].fault_m;
      for (const std::uint32_t end : {2 * road, 2 * road + 1}) {
        auto& roads = roads_of_[lines_.group_of_end[end]];
        if (roads.empty() || roads.back() != road) roads.push_back(road);
      }
    }
    for (const auto& joint : ends_.joints) {
      joints_of_[lines_.group_of_end[joint.first.first]].push_back(&joint);
    }
  }

  std::vector<PlacedRoad> place_all() {
    std::vector<bool> is_open(chosen_.size(), true);
    for (int round = 0; round < kMostRounds; ++round) {
      for (std::size_t group = 0; group < chosen_.size(); ++group) {
        if (!is_open[group]) continue;
        is_open[group] = false;
        if (!improve(group)) continue;
        for (const std::uint32_t road : roads_of_[group]) {
          for (const std::uint32_t end : {2 * road, 2 * road + 1}) {
            const std::uint32_t other = lines_.group_of_end[end];
            is_open[other] = is_open[other] || other != group;
          }
        }
      }
    }
    return std::move(roads_);
  }

  // For the next plan, most of whose roads are the same.
  void remember(std::vector<PlacedRoad> roads) {
    memory_.placed.clear();
    for (std::uint32_t road = 0; road < roads.size(); ++road) {
      memory_.placed.emplace(key(road), std::move(roads[road]));
    }
  }

 private:
  EndLine line(std::uint32_t end) const {
    return lines_.at(end, chosen_[lines_.group_of_end[end]]);
  }

  PlaceKey key(std::uint32_t road) const {
    PlaceKey key{double(borders_[road])};
    for (const EndLine& across : {line(2 * road), line(2 * road + 1)}) {
      key.insert(key.end(), {across.in_map.x(), across.in_map.y(), across.heading_rad,
                             across.is_rim ? 1.0 : 0.0});
    }
    for (const PlannedSection& section : plan_.roads[road].sections) {
      key.insert(key.end(), {-1.0, double(section.left_lanes)});
      for (const PlannedLane& lane : section.lanes) {
        key.push_back(2.0 * lane.lane.index + (lane.forward ? 1.0 : 0.0));
      }
    }
    return key;
  }

  PlacedRoad place(std::uint32_t road, const PlaceKey& key, double most_m) const {
    const auto known = memory_.placed.find(key);
    if (known != memory_.placed.end()) return known->second;
    return place_road(road_map_, plan_.roads[road], borders_[road],
                      {line(2 * road), line(2 * road + 1)}, most_m);
  }

  // The roads of a group with the line chosen now, unless their faults exceed a sum.
  std::optional<std::vector<PlacedRoad>> place_group(std::size_t group, double most_m) const {
    const auto& roads = roads_of_[group];
    std::vector<PlaceKey> keys;
    std::vector<double> at_least_m;
    for (const std::uint32_t road : roads) {
      keys.push_back(key(road));
      const auto known = memory_.faults_m.find(keys.back());
      at_least_m.push_back(known == memory_.faults_m.end() ? 0.0 : known->second);
    }
    double left_m = most_m - std::accumulate(at_least_m.begin(), at_least_m.end(), 0.0);
    std::vector<PlacedRoad> placed;
    for (std::size_t i = 0; i < roads.size() && left_m >= 0.0; ++i) {
      left_m += at_least_m[i];
      placed.push_back(place(roads[i], keys[i], left_m + kRounding_m));
      memory_.faults_m[keys[i]] = placed.back().fault_m;
      left_m -= placed.back().fault_m;
    }
    return left_m >= 0.0 ? std::optional(std::move(placed)) : std::nullopt;
  }

  void exchange_roads(std::size_t group, std::vector<PlacedRoad>& roads) {
    for (std::size_t i = 0; i < roads.size(); ++i) std::swap(roads_[roads_of_[group][i]], roads[i]);
  }

  // What a line costs that leads away from the map's own ends.
  double detour_m(std::size_t group, std::size_t choice) const {
    return kDetour * lines_.choices[group][choice].off_m;
  }

  // Where there are faults or gaps takes the line with the least of them, and of such the one that
  // is nearest to the map's own ends.
  bool improve(std::size_t group) {
    const auto& roads = roads_of_[group];
    const JointGaps gaps(road_map_, plan_, joints_of_[group]);
    const auto gap_m = [&] {
      return gaps.sum_m([&](const JointGaps::BorderEnd& at) {
        return roads_[at.end / 2].end_point(at.end % 2 == 1, at.place);
      });
    };
    double least_m = gap_m();
    for (const std::uint32_t road : roads) least_m += roads_[road].fault_m;
    if (least_m <= 0.0) return false;
    const std::size_t before = chosen_[group];
    least_m += detour_m(group, before);
    std::size_t best = before;
    for (const std::size_t i : lines_.nearest_first(group)) {
      if (least_m <= detour_m(group, i) + kGain_m) break;  // as no other is nearer
      if (i == before) continue;
      chosen_[group] = i;
      const double most_m = least_m - kGain_m - detour_m(group, i);
      // Where a road is sound its borders end where they cross the line.
      const double crossing_gap_m = gaps.sum_m([&](const JointGaps::BorderEnd& at) {
        return crossing(at.border, line(at.end), at.end % 2 == 1).in_map;
      });
      auto placed = place_group(group, most_m - crossing_gap_m);
      if (!placed) continue;
      exchange_roads(group, *placed);
      double sum_m = gap_m();
      for (const std::uint32_t road : roads) sum_m += roads_[road].fault_m;
      if (sum_m > most_m) {
        exchange_roads(group, *placed);
        continue;
      }
      least_m = sum_m + detour_m(group, i);
      best = i;
    }
    chosen_[group] = best;
    return best != before;
  }

  const RoadMap& road_map_;
  const RoadPlan& plan_;
  Memory& memory_;
  std::vector<std::size_t> borders_;
  EndLines lines_;
  EndRoles ends_;
  std::vector<std::size_t> chosen_;                                   // by group of ends
  std::vector<std::vector<std::uint32_t>> roads_of_;                  // likewise
  std::vector<std::vector<const EndJoints::value_type*>> joints_of_;  // likewise
  std::vector<PlacedRoad> roads_;
};

// Takes company from lanes of roads that are not sound; whether there are any.
bool part_lanes(const RoadPlan& plan, const std::vector<PlacedRoad>& placed,
                std::vector<Company>& company) {
  bool is_changed = false;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const PlannedRoad& road = plan.roads[i];
    if (road.source) continue;
    const auto& lanes = road.sections.front().lanes;
    if (placed[i].fault_m <= (lanes.size() > 1 ? kParting_m : kHopeless_m)) continue;
    for (const PlannedLane& lane : lanes) {
      company[lane.lane.index] = lanes.size() > 1 ? Company::none : Company::left_out;
    }
    is_changed = true;
  }
  return is_changed;
}

}  // namespace

ShapedRoads shape_roads(const RoadMap& road_map, int minor, int threads) {
  std::vector<Company> company(road_map.lanes().size(), Company::any);
  Memory memory;
  for (int round = 0;; ++round) {
    ShapedRoads roads{plan_network_roads(road_map, company, minor), {}};
    RoadsPlacer placer(road_map, roads.plan, memory, threads);
    auto placed = placer.place_all();
    if (round < kMostPlans && part_lanes(roads.plan, placed, company)) {
      placer.remember(std::move(placed));
      continue;
    }
    close_joints(road_map, roads.plan, placed);
    roads.shapes.resize(placed.size());
    in_threads(placed.size(), threads, [&](std::size_t i) {
      roads.shapes[i] = shape_road(road_map, roads.plan.roads[i], placed[i]);
    });
    return roads;
  }
}

}  // namespace roadbed::map::opendrive
