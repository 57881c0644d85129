#include "roadbed/map/opendrive/write/road_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

#include "roadbed/map/derived/crossings.h"
#include "roadbed/map/derived/lane_relations.h"

namespace roadbed::map::opendrive {
namespace {

constexpr int kRuleOfRoads = 5, kDirectionOfLanes = 8;  // revisions that have words for them

constexpr double kLeastLength_m = 0.05;   // of a lane that makes a road of its own
constexpr double kLeastSection_m = 2e-3;  // of one in a section of the map
constexpr double kLeastWidth_m = 0.02;    // on average
constexpr double kSameBorder_m = 0.3;     // how far apart neighbours' ends may be

// Whether there is a strip between the borders at all.
bool is_strip(const Lane& lane) {
  const double length_m = lane.length_m();
  if (!(length_m > (lane.road ? kLeastSection_m : kLeastLength_m))) return false;
  const auto width_m = [&](double share) {
    const double s_m = share * length_m;
    const Eigen::Vector2d across = Lane::point_at(lane.left, s_m) - Lane::point_at(lane.right, s_m);
    const geometry::Pose2 pose = lane.centre.in_map.pose_at(s_m);
    return across.dot(Eigen::Vector2d(-std::sin(pose.heading_rad), std::cos(pose.heading_rad)));
  };
  return std::max({width_m(0.02), width_m(0.5), width_m(0.98)}) > kLeastWidth_m;
}

Eigen::Vector2d end_of(const LaneLine& line, bool last) {
  return last ? line.in_map.points().back() : line.in_map.points().front();
}

class Planner {
 public:
  Planner(const RoadMap& road_map, const std::vector<Company>& company, int minor)
      : road_map_(road_map), company_(company), minor_(minor) {
    plan_.places.resize(road_map.lanes().size());
    usable_.resize(road_map.lanes().size());
    for (const Lane& lane : road_map.lanes()) {
      const bool strip = is_strip(lane);
      const bool is_hopeless = company_of(lane.id) == Company::left_out;
      usable_[lane.id.index] = strip && !is_hopeless && !is_crosswalk(lane);
      if (!strip) plan_.left_out.push_back(lane.name + ": there is no strip between its borders");
      if (is_hopeless) {
        plan_.left_out.push_back(lane.name +
                                 ": its borders turn so sharply, or its ends are so "
                                 "askew, that its cross-sections cross each other");
      }
    }
  }

  RoadPlan plan() {
    plan_.left_hand_traffic = minor_ >= kRuleOfRoads && drives_on_the_left(road_map_);
    crossing_of_ = crossings_of_lanes(road_map_, usable_);
    for (const Road& road : road_map_.roads()) add_source_road(road);
    for (const Lane& lane : road_map_.lanes()) {
      if (usable_[lane.id.index] && !plan_.places[lane.id.index]) add_strip(lane.id);
    }
    return std::move(plan_);
  }

 private:
  Company company_of(LaneId lane) const { return company_[lane.index]; }

  void add_road(PlannedRoad road) {
    const auto index = static_cast<std::uint32_t>(plan_.roads.size());
    for (std::uint32_t section = 0; section < road.sections.size(); ++section) {
      const auto& lanes = road.sections[section].lanes;
      for (std::uint32_t i = 0; i < lanes.size(); ++i) {
        plan_.places[lanes[i].lane.index] = {index, section, i};
        if (!road.crossing) road.crossing = crossing_of_[lanes[i].lane.index];
      }
    }
    plan_.roads.push_back(std::move(road));
  }

  // A road of the map: its sections in order, split where lanes lead elsewhere in between.
  void add_source_road(const Road& road) {
    std::map<int, std::vector<std::pair<int, LaneId>>> sections;
    bool is_apart = false;
    for (const LaneId id : road.lanes) {
      const Lane& lane = road_map_.lane(id);
      if (!usable_[id.index]) continue;
      sections[lane.origin.section].emplace_back(-std::atoi(lane.origin.source_id.c_str()), id);
      is_apart = is_apart || company_of(id) == Company::of_its_direction;
    }
    if (sections.empty() || road.reference_in_map.points().empty()) return;
    std::vector<PlannedSection> made;
    for (auto& [index, lanes] : sections) {
      std::sort(lanes.begin(), lanes.end());
      PlannedSection& section = made.emplace_back();
      for (const auto& [order, id] : lanes) {
        const LaneOrigin& origin = road_map_.lane(id).origin;
        const bool forward = origin.road_from_s_m <= origin.road_to_s_m, is_left = order < 0;
        section.lanes.push_back({id, forward});
        section.left_lanes += is_left ? 1 : 0;
        const bool is_usual = forward == (is_left == plan_.left_hand_traffic);
        is_apart = is_apart || (!is_usual && minor_ < kDirectionOfLanes);
      }
    }
    if (is_apart) {
      for (const bool forward : {true, false}) add_runs(one_way(made, forward), road.id);
    } else {
      add_runs(made, road.id);
    }
  }

  // The lanes of one direction, on the side where it is usual.
  std::vector<PlannedSection> one_way(const std::vector<PlannedSection>& sections,
                                      bool forward) const {
    std::vector<PlannedSection> kept;
    for (const PlannedSection& section : sections) {
      PlannedSection& some = kept.emplace_back();
      for (const PlannedLane& lane : section.lanes) {
        if (lane.forward == forward) some.lanes.push_back(lane);
      }
      some.left_lanes = forward == plan_.left_hand_traffic ? some.lanes.size() : 0;
    }
    std::erase_if(kept, [](const PlannedSection& section) { return section.lanes.empty(); });
    return kept;
  }

  void add_runs(std::vector<PlannedSection> sections, RoadId source) {
    PlannedRoad run{{}, source, {}};
    for (PlannedSection& section : sections) {
      if (!run.sections.empty() && !follows(run.sections.back(), section)) {
        add_road(std::exchange(run, PlannedRoad{{}, source, {}}));
      }
      run.sections.push_back(std::move(section));
    }
    if (!run.sections.empty()) add_road(std::move(run));
  }

  // Whether lanes lead from one section to the next one and nowhere else.
  bool follows(const PlannedSection& before, const PlannedSection& after) const {
    const auto among = [](const std::vector<LaneId>& links, const PlannedSection& section) {
      return std::all_of(links.begin(), links.end(), [&](LaneId id) {
        return std::any_of(section.lanes.begin(), section.lanes.end(),
                           [&](const PlannedLane& lane) { return lane.lane == id; });
      });
    };
    const auto ahead = [&](const PlannedLane& lane, bool along) -> const std::vector<LaneId>& {
      const LaneLinks& links = road_map_.graph().of(lane.lane);
      return lane.forward == along ? links.successors : links.predecessors;
    };
    const double gap_m = std::abs(low_s_m(after) - high_s_m(before));
    return gap_m < 1e-3 &&
           std::all_of(before.lanes.begin(), before.lanes.end(),
                       [&](const auto& lane) { return among(ahead(lane, true), after); }) &&
           std::all_of(after.lanes.begin(), after.lanes.end(),
                       [&](const auto& lane) { return among(ahead(lane, false), before); });
  }

  double low_s_m(const PlannedSection& section) const {
    const LaneOrigin& origin = road_map_.lane(section.lanes.front().lane).origin;
    return std::min(origin.road_from_s_m, origin.road_to_s_m);
  }
  double high_s_m(const PlannedSection& section) const {
    const LaneOrigin& origin = road_map_.lane(section.lanes.front().lane).origin;
    return std::max(origin.road_from_s_m, origin.road_to_s_m);
  }

  // The lane beside one, on the left or right seen along the road, if it knows of it, too.
  std::optional<PlannedLane> beside(const PlannedLane& from, bool to_left) const {
    const LaneLinks& links = road_map_.graph().of(from.lane);
    const std::optional<Neighbour>& link = to_left == from.forward ? links.left : links.right;
    if (!link || !usable_[link->lane.index] || plan_.places[link->lane.index]) return {};
    const PlannedLane other{link->lane, from.forward == link->same_direction};
    const Company company = std::max(company_of(from.lane), company_of(other.lane));
    const bool may_be_opposite = company == Company::any;
    if (company >= Company::none || (other.forward != from.forward && !may_be_opposite)) return {};
    const LaneLinks& back_links = road_map_.graph().of(other.lane);
    const std::optional<Neighbour>& back =
        to_left != other.forward ? back_links.left : back_links.right;
    if (!back || back->lane != from.lane || !touch(from, other, to_left)) return {};
    return other;
  }

  bool touch(const PlannedLane& from, const PlannedLane& other, bool to_left) const {
    const Lane& a = road_map_.lane(from.lane);
    const Lane& b = road_map_.lane(other.lane);
    const LaneLine& of_a = to_left == from.forward ? a.left : a.right;
    const LaneLine& of_b = to_left != other.forward ? b.left : b.right;
    for (const bool last : {false, true}) {
      const double gap_m =
          (end_of(of_a, last == from.forward) - end_of(of_b, last == other.forward)).norm();
      if (gap_m > kSameBorder_m) return false;
    }
    return true;
  }

  // The lane with all those beside it, as far as there is one change of direction at most, on the
  // side where opposite lanes are.
  void add_strip(LaneId id) {
    std::vector<PlannedLane> lanes{{id, true}};
    std::size_t changes = 0;
    for (const bool to_left : {true, false}) {
      while (lanes.size() < 100) {
        const PlannedLane edge = to_left ? lanes.front() : lanes.back();
        const auto next = beside(edge, to_left);
        if (!next || contains(lanes, next->lane)) break;
        if (next->forward != edge.forward) {
          const bool usual = edge.forward == (to_left != plan_.left_hand_traffic);
          if (!usual || ++changes > 1) break;
        }
        lanes.insert(to_left ? lanes.begin() : lanes.end(), *next);
      }
    }
    PlannedSection section{std::move(lanes), 0};
    const bool lefts_forward = plan_.left_hand_traffic;
    section.left_lanes = static_cast<std::size_t>(
        std::count_if(section.lanes.begin(), section.lanes.end(),
                      [&](const PlannedLane& lane) { return lane.forward == lefts_forward; }));
    add_road({{std::move(section)}, {}, {}});
  }

  static bool contains(const std::vector<PlannedLane>& lanes, LaneId id) {
    return std::any_of(lanes.begin(), lanes.end(),
                       [&](const PlannedLane& lane) { return lane.lane == id; });
  }

  const RoadMap& road_map_;
  const std::vector<Company>& company_;
  int minor_;
  std::vector<bool> usable_;
  std::vector<std::optional<std::uint32_t>> crossing_of_;
  RoadPlan plan_;
};

}  // namespace

bool PlannedRoad::has_both_ways() const {
  std::array<bool, 2> ways{};
  for (const PlannedSection& section : sections) {
    for (const PlannedLane& lane : section.lanes) ways[lane.forward ? 1 : 0] = true;
  }
  return ways[0] && ways[1];
}

BorderPlace RoadPlan::border_of(LaneId lane, bool on_left) const {
  const LanePlaceInPlan& place = *places[lane.index];
  const bool forward = roads[place.road].sections[place.section].lanes[place.lane].forward;
  return {place.road, place.section, place.lane + (on_left == forward ? 0 : 1)};
}

RoadPlan plan_roads(const RoadMap& road_map, const std::vector<Company>& company, int minor) {
  return Planner(road_map, company, minor).plan();
}

}  // namespace roadbed::map::opendrive
