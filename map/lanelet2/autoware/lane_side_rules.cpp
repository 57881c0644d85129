#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "roadbed/map/lanelet2/autoware/rules.h"
#include "roadbed/map/lanelet2/autoware/shapes.h"
#include "roadbed/map/lanelet2/traffic_rules.h"

namespace roadbed::map::lanelet2::autoware {
namespace {

using validation::Report;
using validation::ValidateOptions;

bool is_road(const Lanelet* lanelet) { return lanelet->subtype() == "road"; }

/// Lanelets on either side of one.
struct Neighbours {
  std::vector<const Lanelet*> left, right;

  bool are_on_one_side() const { return left.empty() != right.empty(); }
  bool have_road() const {
    return std::ranges::any_of(left, is_road) || std::ranges::any_of(right, is_road);
  }
};

Neighbours neighbours_of(const VectorMap& map, const Lanelet& lanelet) {
  return {map.neighbours(lanelet, Side::left), map.neighbours(lanelet, Side::right)};
}

/// An issue about the border that nothing lies behind, where it is no edge of the road.
void check_outer_border(const VectorMap& map, Report& report, const Lanelet& lanelet,
                        const Neighbours& neighbours, int number) {
  if (!neighbours.are_on_one_side()) return;
  const Border border =
      neighbours.left.empty() ? lanelet.surface->left_border : lanelet.surface->right_border;
  const Way& way = map.document().ways[border.way];
  if (way.type == "road_border") return;
  add_issue(report, map, number, way,
            fmt::format("is the outer border of {} {} and of type \"{}\"; make it road_border",
                        lanelet.subtype(), lanelet.id(), way.type));
}

void pedestrian_lanes(const VectorMap& map, const ValidateOptions&, Report& report) {
  for (const Lanelet& lanelet : map.lanelets()) {
    if (lanelet.subtype() != "pedestrian_lane" || !lanelet.surface) continue;
    const Neighbours neighbours = neighbours_of(map, lanelet);
    if (neighbours.left.empty() && neighbours.right.empty()) {
      add_issue(report, map, 1, lanelet,
                "no lanelet shares a border with this pedestrian lane; let it share that of the "
                "road");
      continue;
    }
    if (neighbours.are_on_one_side() && !neighbours.have_road()) {
      add_issue(report, map, 2, lanelet,
                "no road lies beside this pedestrian lane; let it share the border of the road");
    }
    check_outer_border(map, report, lanelet, neighbours, 3);
  }
}

void road_shoulders(const VectorMap& map, const ValidateOptions& options, Report& report) {
  // Autoware's validator asked for a road beside a shoulder until version 1.7.0.
  const bool needs_road = options.choice.names(report.autoware_issue(2));
  for (const Lanelet& lanelet : map.lanelets()) {
    if (lanelet.subtype() != "road_shoulder" || !lanelet.surface) continue;
    const Neighbours neighbours = neighbours_of(map, lanelet);
    if (neighbours.left.empty() && neighbours.right.empty()) {
      add_issue(
          report, map, 1, lanelet,
          "no lanelet shares a border with this road shoulder; let it share that of the road");
      continue;
    }
    if (needs_road && !neighbours.have_road()) {
      add_issue(report, map, 2, lanelet,
                "no road lies beside this road shoulder; let it share the border of the road");
    }
    check_outer_border(map, report, lanelet, neighbours, 3);
  }
}

/// Whether vehicles drive on lanelets of that subtype, or may have to.
bool suits_vehicles(std::string_view subtype) {
  return subtype.empty() || subtype == "road" || subtype == "road_shoulder" ||
         subtype == "pedestrian_lane" || subtype == "bicycle_lane";
}

void lateral_subtypes(const VectorMap& map, const ValidateOptions&, Report& report) {
  std::set<std::pair<const Lanelet*, const Lanelet*>> said;
  for (const Lanelet& lanelet : map.lanelets()) {
    if (!suits_vehicles(lanelet.subtype())) continue;
    for (const Side side : {Side::left, Side::right}) {
      for (const Lanelet* other : map.neighbours(lanelet, side)) {
        if (suits_vehicles(other->subtype()) || !said.emplace(&lanelet, other).second) continue;
        add_issue(report, map, 1, lanelet,
                  fmt::format("shares a border with lanelet {} of subtype {}, where no vehicles "
                              "drive; correct the subtype, or give it a border of its own",
                              other->id(), other->subtype()));
      }
    }
  }
}

bool is_for_walking(const Lanelet& lanelet) {
  return lanelet.subtype() == "crosswalk" || lanelet.subtype() == "walkway";
}

bool is_two_way(const Lanelet& lanelet) {
  const Tags tags = lanelet.relation().tags;
  return !is_one_way(tags, participants(tags));
}

/// Lanelets that one leads to, in the direction in which its borders run: those that begin where it
/// ends, and two-way ones that end there.
class Successors {
 public:
  explicit Successors(const VectorMap& map) : map_(map) {
    constexpr std::size_t kMost = 64;
    for (const Lanelet& lanelet : map.lanelets()) {
      if (!lanelet.surface || !is_two_way(lanelet)) continue;
      auto& there = against_[turned(*lanelet.text->end)];
      if (there.size() < kMost) there.push_back(&lanelet);
    }
  }

  std::vector<const Lanelet*> of(const Lanelet& lanelet) const {
    std::vector<const Lanelet*> found = map_.following(lanelet);
    if (!lanelet.surface) return found;
    const auto against = against_.find(*lanelet.text->end);
    if (against == against_.end()) return found;
    for (const Lanelet* other : against->second) {
      if (other != &lanelet) found.push_back(other);
    }
    return found;
  }

 private:
  static rules::Edge turned(const rules::Edge& edge) { return {edge.right, edge.left}; }

  const VectorMap& map_;
  std::map<rules::Edge, std::vector<const Lanelet*>> against_;
};

void longitudinal_subtypes(const VectorMap& map, const ValidateOptions&, Report& report) {
  const Successors successors(map);
  for (const Lanelet& lanelet : map.lanelets()) {
    const auto next = successors.of(lanelet);
    if (next.empty()) continue;
    if (is_for_walking(lanelet)) {
      add_issue(report, map, 1, lanelet,
                fmt::format("is a {} and lanelet {} goes on where it ends; make them one",
                            lanelet.subtype(), next.front()->id()));
      continue;
    }
    const auto other = std::ranges::find_if(
        next, [&](const Lanelet* following) { return following->subtype() != lanelet.subtype(); });
    if (other == next.end()) continue;
    add_issue(report, map, 2, lanelet,
              fmt::format("is of subtype \"{}\" and lanelet {} behind it of \"{}\"; give both the "
                          "same",
                          lanelet.subtype(), (*other)->id(), (*other)->subtype()));
  }
}

constexpr std::array<Rule, 4> kLaneSideRules = {{
    {{"autoware.lane.pedestrian-lane",
      {},
      validation::Severity::error,
      "a pedestrian lane lies beside no road, or its outer border is no road border",
      "Lane.PedestrianLane"},
     pedestrian_lanes},
    {{"autoware.lane.road-shoulder",
      {},
      validation::Severity::error,
      "a road shoulder lies beside no lanelet, or its outer border is no road border",
      "Lane.RoadShoulder"},
     road_shoulders},
    {{"autoware.lane.lateral-subtype",
      {},
      validation::Severity::error,
      "a lanelet for vehicles shares a border with one that is not",
      "Lane.LateralSubtypeConnection"},
     lateral_subtypes},
    {{"autoware.lane.longitudinal-subtype",
      {},
      validation::Severity::error,
      "a lanelet goes on as one of another subtype, or a crosswalk or walkway goes on at all",
      "Lane.LongitudinalSubtypeConnection"},
     longitudinal_subtypes},
}};

}  // namespace

std::span<const Rule> lane_side_rules() { return kLaneSideRules; }

}  // namespace roadbed::map::lanelet2::autoware
