#include "roadbed/map/opendrive/write/shape_roads.h"

#include <algorithm>
#include <map>
#include <utility>

#include "roadbed/map/opendrive/write/close_joints.h"
#include "roadbed/map/opendrive/write/end_lines.h"
#include "roadbed/map/opendrive/write/reference_borders.h"
#include "roadbed/map/opendrive/write/road_network.h"

namespace roadbed::map::opendrive {
namespace {

constexpr int kMostRounds = 4, kMostPlans = 3;
constexpr double kParting_m = 0.2;   // fault of a road with several lanes that is too much
constexpr double kHopeless_m = 1.0;  // of one with a single lane
constexpr double kGain_m = 1e-4;     // that makes another line worth while
constexpr double kDetour = 1e-3;     // what a line costs by its distance from the map's own ends
constexpr double kGap_m = 5e-3;      // between borders at a joint, which is let be

/// Lanes with the border that a reference line follows and the lines across their ends: all that a
/// road's shape depends on.
using PlaceKey = std::vector<double>;

/// What earlier plans and rounds found.
struct Memory {
  std::map<PlaceKey, PlacedRoad> placed;
  std::map<PlaceKey, double> faults_m, at_least_m;  // known, and what is known to be exceeded
};

class RoadsPlacer {
 public:
  RoadsPlacer(const RoadMap& road_map, const RoadPlan& plan, Memory& memory)
      : road_map_(road_map),
        plan_(plan),
        memory_(memory),
        borders_(reference_borders(road_map, plan)),
        lines_(end_lines(road_map, plan)),
        ends_(find_end_roles(road_map, plan)),
        chosen_(lines_.choices.size(), 0),
        roads_of_(lines_.choices.size()),
        joints_of_(lines_.choices.size()) {
    for (std::uint32_t road = 0; road < plan.roads.size(); ++road) {
      roads_.push_back(place(road));
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
    bool is_better = true;
    for (int round = 0; is_better && round < kMostRounds; ++round) {
      is_better = false;
      for (std::size_t group = 0; group < chosen_.size(); ++group) {
        is_better = improve(group) || is_better;
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

  PlacedRoad place(std::uint32_t road) const {
    PlaceKey wanted = key(road);
    const auto known = memory_.placed.find(wanted);
    if (known != memory_.placed.end()) return known->second;
    PlacedRoad placed = place_road(road_map_, plan_.roads[road], borders_[road],
                                   {line(2 * road), line(2 * road + 1)});
    memory_.faults_m.emplace(std::move(wanted), placed.fault_m);
    return placed;
  }

  // The fault of a road, or some that is `most_m` or more.
  double fault_m(std::uint32_t road, double most_m) const {
    const PlaceKey wanted = key(road);
    const auto known = memory_.faults_m.find(wanted);
    if (known != memory_.faults_m.end()) return known->second;
    double& at_least_m = memory_.at_least_m[wanted];
    if (at_least_m >= most_m) return at_least_m;
    const double fault_m = place_road(road_map_, plan_.roads[road], borders_[road],
                                      {line(2 * road), line(2 * road + 1)}, most_m)
                               .fault_m;
    if (fault_m < most_m) memory_.faults_m.emplace(wanted, fault_m);
    at_least_m = fault_m;
    return fault_m;
  }

  // How far borders have to be led at the ends of a group.
  double gap_m(std::size_t group) const {
    double sum_m = 0.0;
    for (const EndJoints::value_type* joint : joints_of_[group]) {
      const double gap_m = joint_gap_m(plan_, *joint, roads_);
      if (gap_m > kGap_m) sum_m += gap_m;
    }
    return sum_m;
  }

  // The roads of a group with the line chosen now; returns those before.
  std::vector<PlacedRoad> place_group(std::size_t group) {
    std::vector<PlacedRoad> before;
    for (const std::uint32_t road : roads_of_[group]) {
      before.push_back(std::exchange(roads_[road], place(road)));
    }
    return before;
  }

  void put_back(std::size_t group, std::vector<PlacedRoad> roads) {
    for (std::size_t i = 0; i < roads.size(); ++i) {
      roads_[roads_of_[group][i]] = std::move(roads[i]);
    }
  }

  // What a line costs that leads away from the map's own ends.
  double detour_m(std::size_t group, std::size_t choice) const {
    return kDetour * lines_.choices[group][choice].off_m;
  }

  // Where there are faults or gaps takes the line with the least of them, and of such the one that
  // is nearest to the map's own ends.
  bool improve(std::size_t group) {
    const auto& roads = roads_of_[group];
    double least_m = gap_m(group);
    for (const std::uint32_t road : roads) least_m += roads_[road].fault_m;
    if (least_m <= 0.0) return false;
    const std::size_t before = chosen_[group];
    least_m += detour_m(group, before);
    std::size_t best = before;
    for (std::size_t i = 0; i < lines_.choices[group].size(); ++i) {
      if (i == before) continue;
      chosen_[group] = i;
      double sum_m = detour_m(group, i);
      for (const std::uint32_t road : roads) {
        if (sum_m > least_m - kGain_m) break;
        sum_m += fault_m(road, least_m - kGain_m - sum_m + 1e-9);
      }
      if (sum_m > least_m - kGain_m) continue;
      auto roads_before = place_group(group);
      sum_m += gap_m(group);
      if (sum_m > least_m - kGain_m) {
        put_back(group, std::move(roads_before));
        continue;
      }
      least_m = sum_m;
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

ShapedRoads shape_roads(const RoadMap& road_map, int minor) {
  std::vector<Company> company(road_map.lanes().size(), Company::any);
  Memory memory;
  for (int round = 0;; ++round) {
    ShapedRoads roads{plan_network_roads(road_map, company, minor), {}};
    RoadsPlacer placer(road_map, roads.plan, memory);
    auto placed = placer.place_all();
    if (round < kMostPlans && part_lanes(roads.plan, placed, company)) {
      placer.remember(std::move(placed));
      continue;
    }
    close_joints(road_map, roads.plan, placed);
    for (std::size_t i = 0; i < placed.size(); ++i) {
      roads.shapes.push_back(shape_road(road_map, roads.plan.roads[i], placed[i]));
    }
    return roads;
  }
}

}  // namespace roadbed::map::opendrive
