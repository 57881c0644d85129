#include "roadbed/map/opendrive/write/road_network.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/geometry/primitives/disjoint_sets.h"
#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/opendrive/write/end_roles.h"
#include "roadbed/map/opendrive/write/id_giver.h"

namespace roadbed::map::opendrive {
namespace {

constexpr double kCut_m = 20.0;    // length of a connecting road that is cut off
constexpr double kLong_m = 100.0;  // of a road between two junctions
constexpr double kCopied_m = 5.0;  // length of connecting roads that overlap
constexpr double kTurnsBack_rad = 150.0 * geometry::kRadiansPerDegree;

// Of connecting roads that overlap, of a map of so many lanes.
std::size_t most_copies(std::size_t lanes) {
  constexpr std::size_t kBytesOfLane = 500, kBytesOfCopy = 8'000;  // in a file; until it is in one
  return geometry::most_bytes_read(kBytesOfLane * lanes) / kBytesOfCopy;
}

bool turns_back(const RoadShape& shape) {
  const geometry::PlanPiece& last = shape.plan_view.back();
  const double from_rad = shape.plan_view.front().start.heading_rad;
  const double to_rad = geometry::plan_point(last, last.s_m + last.length_m).pose.heading_rad;
  return std::abs(geometry::wrap_angle(to_rad - from_rad)) > kTurnsBack_rad;
}

class NetworkBuilder {
 public:
  NetworkBuilder(const RoadMap& road_map, const RoadPlan& plan,
                 const std::vector<RoadShape>& shapes)
      : road_map_(road_map),
        plan_(plan),
        shapes_(shapes),
        ends_(find_end_roles(road_map, plan)),
        clusters_(2 * plan.roads.size() + crossings()),
        copies_left_(most_copies(road_map.lanes().size())) {
    network_.parts_of.resize(plan.roads.size());
    network_.lost_links = ends_.lost_links;
    for (const auto& [ends, lanes] : ends_.joints) meeting_[ends.second].push_back(ends.first);
  }

  RoadNetwork build() {
    for (std::uint32_t road = 0; road < plan_.roads.size(); ++road) add_parts(road);
    number_junctions();
    for (const auto& [ends, lanes] : ends_.joints) add_joint(ends.first, ends.second, lanes);
    for (const auto& [before, after] : cuts_) add_cut(before, after);
    name_parts();
    return std::move(network_);
  }

 private:
  std::size_t crossings() const {
    std::size_t count = 0;
    for (const PlannedRoad& road : plan_.roads) {
      if (road.crossing) count = std::max<std::size_t>(count, *road.crossing + 1);
    }
    return count;
  }

  EndRole role(std::uint32_t end) const { return ends_.roles[end]; }
  bool is_spoke(std::uint32_t end) const { return role(end) == EndRole::spoke; }
  bool has_spoke(std::uint32_t road) const { return is_spoke(2 * road) || is_spoke(2 * road + 1); }

  std::uint32_t add_part(std::uint32_t road, double from_m, double to_m,
                         std::optional<std::uint32_t> in_cluster) {
    RoadPart part;
    part.road = road;
    part.from_m = from_m;
    part.to_m = to_m;
    network_.parts.push_back(std::move(part));
    cluster_of_.push_back(in_cluster);
    return static_cast<std::uint32_t>(network_.parts.size() - 1);
  }

  // A road with a spoke may stay whole if its other end leads into a junction as well, or to a road
  // that is no connecting road.
  bool stays_whole(std::uint32_t road) const {
    const std::uint32_t start = 2 * road, end = start + 1;
    if (is_spoke(start) && is_spoke(end)) {
      return shapes_[road].length_m <= kLong_m || plan_.roads[road].crossing.has_value();
    }
    const std::uint32_t other = is_spoke(start) ? end : start;
    return role(other) == EndRole::plain && !has_spoke(ends_.partner[other] / 2) &&
           shapes_[road].length_m <= kLong_m;
  }

  // A road that the map has inside a crossing, though it is the only one at both its ends.
  bool is_lone_crossing(std::uint32_t road) const {
    const PlannedRoad& planned = plan_.roads[road];
    if (!planned.crossing || planned.has_both_ways()) return false;
    return std::all_of(&kBothEnds[0], &kBothEnds[2], [&](std::uint32_t at) {
      const std::uint32_t end = 2 * road + at;
      if (role(end) != EndRole::plain) return false;
      const std::uint32_t other = ends_.partner[end] / 2;
      return !has_spoke(other) && !plan_.roads[other].crossing;
    });
  }

  void add_parts(std::uint32_t road) {
    const std::uint32_t start = 2 * road, end = start + 1;
    const double length_m = shapes_[road].length_m;
    auto& parts = network_.parts_of[road];
    if (add_whole_copies(road)) return;
    if (has_spoke(road) && stays_whole(road)) {
      parts.push_back(add_part(road, 0.0, length_m, whole_cluster(road)));
      return;
    }
    if (is_lone_crossing(road)) {
      parts.push_back(add_part(road, 0.0, length_m, crossing_cluster(road)));
      return;
    }
    const double share = is_cut(start) && is_cut(end) ? 1.0 / 3.0 : 0.5;
    const auto cut_m = [&](std::uint32_t at) {
      if (!is_cut(at)) return 0.0;
      return std::min(share * length_m, role(at) == EndRole::mesh_entry ? kCopied_m : kCut_m);
    };
    const double from_m = cut_m(start), to_m = length_m - cut_m(end);
    if (is_spoke(start)) parts.push_back(add_part(road, 0.0, from_m, ends_.groups[start]));
    parts.push_back(add_part(road, from_m, to_m, std::nullopt));
    const std::uint32_t middle = parts.back();
    if (is_spoke(end)) parts.push_back(add_part(road, to_m, length_m, ends_.groups[end]));
    for (std::size_t i = 1; i < parts.size(); ++i) cuts_.emplace_back(parts[i - 1], parts[i]);
    if (role(start) == EndRole::mesh_entry) add_copies(start, 0.0, from_m, middle);
    if (role(end) == EndRole::mesh_entry) add_copies(end, to_m, length_m, middle);
  }

  // A short road that turns back from a mesh into a junction, or to a road that is no connecting
  // road, is whole in each of its copies: no piece of it would be a U-turn.
  bool add_whole_copies(std::uint32_t road) {
    const double length_m = shapes_[road].length_m;
    if (length_m > kLong_m || !turns_back(shapes_[road])) return false;
    for (const std::uint32_t entry : {2 * road, 2 * road + 1}) {
      const std::uint32_t other = entry ^ 1U;
      const bool ends_here = is_spoke(other) || leads_to_plain_road(other);
      if (role(entry) != EndRole::mesh_entry || !ends_here) continue;
      add_copies(entry, 0.0, length_m, std::nullopt);
      if (is_spoke(other)) clusters_.join(ends_.groups[entry], ends_.groups[other]);
      return true;
    }
    return false;
  }

  // Which has connecting roads at neither end.
  bool leads_to_plain_road(std::uint32_t end) const {
    if (role(end) != EndRole::plain) return false;
    const std::uint32_t other = ends_.partner[end] / 2;
    return !has_spoke(other) && role(2 * other) != EndRole::mesh_entry &&
           role(2 * other + 1) != EndRole::mesh_entry;
  }

  bool is_cut(std::uint32_t end) const { return is_spoke(end) || role(end) == EndRole::mesh_entry; }

  // A connecting road for each end that leads to this one.
  // @param middle  what is left of the road between its ends, if anything is.
  void add_copies(std::uint32_t end, double from_m, double to_m,
                  std::optional<std::uint32_t> middle) {
    if (!copies_left_.spend(meeting_[end].size())) {
      const std::size_t lanes = road_map_.lanes().size();
      throw InputError({.file = "OpenDRIVE",
                        .found = fmt::format("{} lanes that lead into one another in more ways "
                                             "than {}, each a connecting road",
                                             lanes, most_copies(lanes)),
                        .needed = "fewer lanes that end and begin in one place",
                        .remedy = "clip the map to a part without them"});
    }
    for (const std::uint32_t from : meeting_[end]) {
      const std::uint32_t copy = add_part(end / 2, from_m, to_m, ends_.groups[end]);
      copies_[{from, end}] = copy;
      network_.parts[copy].bare_lanes = lanes_of_other_copies(from, end);
      if (!middle) {
        network_.parts_of[end / 2].push_back(copy);
      } else if (end % 2 == 0) {
        cuts_.emplace_back(copy, *middle);
      } else {
        cuts_.emplace_back(*middle, copy);
      }
    }
  }

  // Lanes that are entered from others of the ends that lead to this one.
  std::vector<std::uint32_t> lanes_of_other_copies(std::uint32_t from, std::uint32_t end) const {
    std::vector<std::uint32_t> own, others;
    for (const std::uint32_t one : meeting_.at(end)) {
      for (const auto& [leaving, entering] : ends_.joints.at({one, end})) {
        (one == from ? own : others).push_back(plan_.places[entering.index]->lane);
      }
    }
    std::erase_if(others, [&](std::uint32_t lane) { return contains(own, lane); });
    return others;
  }

  static bool contains(const std::vector<std::uint32_t>& lanes, std::uint32_t lane) {
    return std::find(lanes.begin(), lanes.end(), lane) != lanes.end();
  }

  std::uint32_t whole_cluster(std::uint32_t road) {
    const std::uint32_t start = 2 * road, end = start + 1;
    const std::uint32_t group = ends_.groups[is_spoke(start) ? start : end];
    if (is_spoke(start) && is_spoke(end)) clusters_.join(ends_.groups[start], ends_.groups[end]);
    if (plan_.roads[road].crossing) clusters_.join(group, crossing_cluster(road));
    return group;
  }

  std::uint32_t crossing_cluster(std::uint32_t road) const {
    return static_cast<std::uint32_t>(2 * plan_.roads.size()) + *plan_.roads[road].crossing;
  }

  void number_junctions() {
    std::map<std::size_t, std::uint32_t> numbers;
    std::map<std::uint32_t, const Junction*> sources;
    for (std::uint32_t i = 0; i < network_.parts.size(); ++i) {
      if (!cluster_of_[i]) continue;
      const std::size_t key = clusters_.of(*cluster_of_[i]);
      const auto next = static_cast<std::uint32_t>(numbers.size());
      const std::uint32_t number = numbers.emplace(key, next).first->second;
      network_.parts[i].junction = number;
      const auto& crossing = plan_.roads[network_.parts[i].road].crossing;
      if (crossing && *crossing < road_map_.junctions().size()) {
        sources.emplace(number, &road_map_.junctions()[*crossing]);
      }
    }
    network_.junctions.resize(numbers.size());
    IdGiver ids;
    for (const auto& [number, source] : sources) {
      network_.junctions[number].id = ids.give(source->source_id);
      network_.junctions[number].name = source->name;
    }
    for (WrittenJunction& junction : network_.junctions) {
      if (junction.id.empty()) junction.id = ids.give("");
    }
  }

  // Several where each copy of the road is whole.
  std::vector<std::uint32_t> parts_at(std::uint32_t end) const {
    const auto& parts = network_.parts_of[end / 2];
    const RoadPart &first = network_.parts[parts.front()], &last = network_.parts[parts.back()];
    if (first.from_m == last.from_m && first.to_m == last.to_m) return parts;
    return {end % 2 == 0 ? parts.front() : parts.back()};
  }

  const PlannedSection& section_at(std::uint32_t part, bool at_end) const {
    const auto& sections = plan_.roads[network_.parts[part].road].sections;
    return at_end ? sections.back() : sections.front();
  }

  void add_joint(std::uint32_t from, std::uint32_t to, const LanePairs& lanes) {
    const auto copy = copies_.find({from, to});
    std::vector<std::pair<std::uint32_t, std::uint32_t>> places;
    for (const auto& [leaving, entering] : lanes) {
      places.emplace_back(plan_.places[leaving.index]->lane, plan_.places[entering.index]->lane);
    }
    const auto entered =
        copy != copies_.end() ? std::vector<std::uint32_t>{copy->second} : parts_at(to);
    for (const std::uint32_t a : parts_at(from)) {
      for (const std::uint32_t b : entered) {
        join({a, from % 2 == 1, &section_at(a, from % 2 == 1)},
             {b, to % 2 == 1, &section_at(b, to % 2 == 1)}, places);
      }
    }
  }

  // Two parts of one road, the second behind the first.
  void add_cut(std::uint32_t before, std::uint32_t after) {
    const std::uint32_t road = network_.parts[before].road;
    const std::size_t index = section_before(shapes_[road], network_.parts[before].to_m);
    const PlannedSection& section = plan_.roads[road].sections[index];
    for (const bool along : {true, false}) {
      std::vector<std::pair<std::uint32_t, std::uint32_t>> places;
      for (std::uint32_t i = 0; i < section.lanes.size(); ++i) {
        if (section.lanes[i].forward == along) places.emplace_back(i, i);
      }
      const PartEnd first{before, true, &section}, second{after, false, &section};
      if (!places.empty()) join(along ? first : second, along ? second : first, places);
    }
  }

  struct PartEnd {
    std::uint32_t part;
    bool at_end;
    const PlannedSection* section;
  };
  using Places = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

  // Lanes leave the first end and enter the second.
  void join(const PartEnd& from, const PartEnd& to, Places places) {
    std::erase_if(places, [&](const auto& pair) {
      return contains(network_.parts[from.part].bare_lanes, pair.first) ||
             contains(network_.parts[to.part].bare_lanes, pair.second);
    });
    std::erase_if(places, [&](const auto& pair) {
      const bool lost = !has_width(from, pair.first) || !has_width(to, pair.second);
      network_.lost_links += lost ? 1 : 0;
      return lost;
    });
    if (places.empty()) return;
    RoadPart &a = network_.parts[from.part], &b = network_.parts[to.part];
    for (const auto& [leaving, entering] : places) {
      a.lane_links[from.at_end].emplace_back(leaving, lane_id(*to.section, entering));
      b.lane_links[to.at_end].emplace_back(entering, lane_id(*from.section, leaving));
    }
    const bool into = b.junction && !a.junction, out = a.junction && !b.junction;
    a.links[from.at_end] =
        into ? PartLink{true, *b.junction, false} : PartLink{false, to.part, to.at_end};
    b.links[to.at_end] =
        out ? PartLink{true, *a.junction, false} : PartLink{false, from.part, from.at_end};
    if (!into) return;
    WrittenConnection connection{from.part, to.part, to.at_end, {}};
    for (const auto& [leaving, entering] : places) {
      connection.lanes.emplace_back(lane_id(*from.section, leaving),
                                    lane_id(*to.section, entering));
    }
    network_.junctions[*b.junction].connections.push_back(std::move(connection));
  }

  // A lane that ends in a point leads nowhere.
  bool has_width(const PartEnd& end, std::uint32_t lane) const {
    const RoadPart& part = network_.parts[end.part];
    const RoadShape& shape = shapes_[part.road];
    const double at_m = end.at_end ? part.to_m : part.from_m;
    const auto& rims = shape.rims[end.at_end];
    const bool is_outermost = end.at_end ? at_m >= shape.length_m : at_m <= 0.0;
    if (is_outermost && !rims.empty()) {
      return (end.at_end ? rims.back() : rims.front()).has_width(lane, at_m);
    }
    const auto section =
        static_cast<std::size_t>(end.section - plan_.roads[part.road].sections.data());
    return shape.sections[section].has_width(lane, at_m);
  }

  void name_parts() {
    IdGiver ids;
    for (std::size_t road = 0; road < plan_.roads.size(); ++road) {
      if (!plan_.roads[road].source) continue;
      const auto& parts = network_.parts_of[road];
      const auto main = std::find_if(parts.begin(), parts.end(), [&](std::uint32_t part) {
        return !network_.parts[part].junction || parts.size() == 1;
      });
      if (main == parts.end()) continue;
      network_.parts[*main].id = ids.give(road_map_.road(*plan_.roads[road].source).source_id);
    }
    for (RoadPart& part : network_.parts) {
      if (part.id.empty()) part.id = ids.give("");
    }
  }

  static constexpr std::uint32_t kBothEnds[2] = {0, 1};

  const RoadMap& road_map_;
  const RoadPlan& plan_;
  const std::vector<RoadShape>& shapes_;
  EndRoles ends_;
  // Groups of ends that lie in one junction: numbers of groups, then crossings of the map.
  geometry::DisjointSets clusters_;
  geometry::WorkBudget copies_left_;
  std::vector<std::optional<std::uint32_t>> cluster_of_;  // by part
  std::vector<std::pair<std::uint32_t, std::uint32_t>> cuts_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> meeting_;  // ends that lead to an end
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> copies_;
  RoadNetwork network_;
};

}  // namespace

int lane_id(const PlannedSection& section, std::size_t place) {
  const int from_left = static_cast<int>(section.left_lanes) - static_cast<int>(place);
  return from_left > 0 ? from_left : from_left - 1;
}

RoadPlan plan_network_roads(const RoadMap& road_map, std::vector<Company> company, int minor) {
  for (int round = 0;; ++round) {
    RoadPlan plan = plan_roads(road_map, company, minor);
    const EndRoles ends = find_end_roles(road_map, plan);
    bool changed = false;
    for (std::size_t road = 0; road < plan.roads.size(); ++road) {
      if (!ends.is_apart[road]) continue;
      for (const PlannedSection& section : plan.roads[road].sections) {
        for (const PlannedLane& lane : section.lanes) {
          Company& of_lane = company[lane.lane.index];
          of_lane = std::max(of_lane, Company::of_its_direction);
        }
      }
      changed = true;
    }
    if (!changed || round == 8) return plan;
  }
}

RoadNetwork join_roads(const RoadMap& road_map, const RoadPlan& plan,
                       const std::vector<RoadShape>& shapes) {
  return NetworkBuilder(road_map, plan, shapes).build();
}

}  // namespace roadbed::map::opendrive
