#include <fmt/format.h>

#include <array>
#include <cmath>
#include <set>

#include "roadbed/map/lanelet2/autoware/rules.h"
#include "roadbed/map/lanelet2/traffic_rules.h"

namespace roadbed::map::lanelet2::autoware {
namespace {

using validation::Report;
using validation::ValidateOptions;

void road_attributes(const VectorMap& map, const ValidateOptions&, Report& report) {
  for (const Lanelet& lanelet : map.lanelets()) {
    if (lanelet.subtype() != "road") continue;
    const std::string_view location = lanelet.tag("location"), one_way = lanelet.tag("one_way");
    if (location != "urban" && location != "private") {
      add_issue(report, map, 1, lanelet,
                fmt::format("location is \"{}\"; make it urban or private", location));
    }
    if (one_way != "yes") {
      add_issue(report, map, 2, lanelet,
                fmt::format("one_way is \"{}\", and Autoware drives roads in one direction only; "
                            "make it yes",
                            one_way));
    }
  }
}

void speed_limits(const VectorMap& map, const ValidateOptions& options, Report& report) {
  for (const Lanelet& lanelet : map.lanelets()) {
    if (lanelet.subtype() != "road" && lanelet.subtype() != "private") continue;
    if (!has_tag(lanelet, "speed_limit")) continue;
    const std::string_view text = lanelet.tag("speed_limit");
    const double limit_kmph = number_in(text);
    if (!(limit_kmph > 0.0)) {
      add_issue(report, map, 1, lanelet,
                fmt::format("speed_limit is \"{}\", no positive number without a unit; give it in "
                            "km/h",
                            text));
    } else if (limit_kmph < options.min_tagged_speed_kmph ||
               limit_kmph > options.max_tagged_speed_kmph) {
      add_issue(report, map, 2, lanelet,
                fmt::format("speed_limit is {} km/h, not between {} and {} km/h; correct it, or "
                            "say --speed-range if it is so",
                            text, options.min_tagged_speed_kmph, options.max_tagged_speed_kmph));
    }
  }
}

/// Whether two roads of one direction lie on either side of a border of a lanelet.
bool lies_between_roads(const VectorMap& map, const Lanelet& lanelet, Side side) {
  const Surface& own = *lanelet.surface;
  const Border border = side == Side::left ? own.left_border : own.right_border;
  for (const Lanelet* other : map.neighbours(lanelet, side)) {
    if (other->subtype() != "road") continue;
    const Surface& surface = *other->surface;
    if ((side == Side::left ? surface.right_border : surface.left_border) == border) return true;
  }
  return false;
}

void lane_changes(const VectorMap& map, const ValidateOptions&, Report& report) {
  std::set<std::uint32_t> looked_at;
  for (const Lanelet& lanelet : map.lanelets()) {
    if (lanelet.subtype() != "road" || !lanelet.surface) continue;
    for (const Side side : {Side::left, Side::right}) {
      const Surface& surface = *lanelet.surface;
      const std::uint32_t way =
          (side == Side::left ? surface.left_border : surface.right_border).way;
      if (!lies_between_roads(map, lanelet, side) || !looked_at.insert(way).second) continue;
      const Way& line = map.document().ways[way];
      const std::string_view value = value_of(line.tags, "lane_change");
      if (value == "yes" || value == "no") continue;
      if (value.empty()) {
        add_issue(report, map, 1, line,
                  "lies between two roads and has no lane_change; add yes or no");
      } else {
        add_issue(report, map, 2, line,
                  fmt::format("lies between two roads and lane_change is \"{}\"; make it yes or no",
                              value));
      }
    }
  }
}

void local_coordinates(const VectorMap& map, const ValidateOptions&, Report& report) {
  const Document& document = map.document();
  const auto is_declared = [](double coordinate) { return !std::isnan(coordinate); };
  bool any = false;
  for (const NodePlace& place : document.places) {
    any = any || is_declared(place.local_x_m) || is_declared(place.local_y_m);
  }
  if (!any) return;
  for (std::size_t i = 0; i < document.places.size(); ++i) {
    const bool x = is_declared(document.places[i].local_x_m);
    const bool y = is_declared(document.places[i].local_y_m);
    const Node& node = document.nodes[i];
    if (x && y) continue;
    if (!x && !y) {
      add_issue(report, map, 1, node,
                "has no local_x and local_y, other nodes have; add them, or remove all of them");
    } else if (x) {
      add_issue(report, map, 2, node, "has a local_x and no local_y; add it");
    } else {
      add_issue(report, map, 3, node, "has a local_y and no local_x; add it");
    }
  }
}

constexpr std::array<Rule, 4> kLaneTagRules = {{
    {{"autoware.lane.road-attributes",
      {},
      validation::Severity::error,
      "a road's location is not urban or private, or its one_way is not yes",
      "Lane.RoadLaneletAttribute"},
     road_attributes},
    {{"autoware.lane.speed-limit",
      {},
      validation::Severity::error,
      "a road's speed_limit is no number, or outside --speed-range",
      "Lane.SpeedLimitValidity"},
     speed_limits},
    {{"autoware.lane.lane-change",
      {},
      validation::Severity::error,
      "a line between two roads does not say whether lanes may be changed there",
      "Lane.LaneChangeAttribute"},
     lane_changes},
    {{"autoware.lane.local-coordinates",
      {},
      validation::Severity::error,
      "some nodes have local_x and local_y, others have not",
      "Lane.LocalCoordinatesDeclaration"},
     local_coordinates},
}};

}  // namespace

std::span<const Rule> lane_tag_rules() { return kLaneTagRules; }

}  // namespace roadbed::map::lanelet2::autoware
