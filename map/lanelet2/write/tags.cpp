#include "roadbed/map/lanelet2/write/tags.h"

#include <fmt/format.h>

#include "roadbed/map/lanelet2/traffic_rules.h"

namespace roadbed::map::lanelet2 {
namespace {

std::string_view subtype_of(LaneType type) {
  switch (type) {
    case LaneType::bus:
    case LaneType::taxi:
      return "bus_lane";
    case LaneType::biking:
      return "bicycle_lane";
    case LaneType::sidewalk:
      return "walkway";
    case LaneType::shoulder:
      return "road_shoulder";
    case LaneType::stop:
      return "emergency_lane";
    case LaneType::parking:
      return "parking";
    case LaneType::tram:
      return "tram";
    case LaneType::rail:
      return "rail";
    default:
      return "road";
  }
}

// participant tags, where the subtype does not already say the same. A shoulder or parking lane
// open to vehicles would become a lane to drive on.
void add_missing_participants(const Lane& lane, Attributes& tags) {
  const bool beside_traffic = lane.type == LaneType::shoulder || lane.type == LaneType::stop ||
                              lane.type == LaneType::parking;
  if (beside_traffic || participants(views_of(tags)) == lane.participants) return;
  add_participants(lane.participants, tags);
}

Attributes line(const char* type, const char* subtype) {
  return {{"type", type}, {"subtype", subtype}};
}

Attributes mark_tags(const BorderMark& mark) {
  const char* const painted = mark.width_m >= 0.2 ? "line_thick" : "line_thin";
  switch (mark.type) {
    case MarkType::none:
      return {{"type", "virtual"}};
    case MarkType::solid:
      return line(painted, "solid");
    case MarkType::broken:
    case MarkType::broken_broken:
    case MarkType::botts_dots:
      return line(painted, "dashed");
    case MarkType::solid_solid:
      return line(painted, "solid_solid");
    case MarkType::solid_broken:
      return line(painted, "solid_dashed");
    case MarkType::broken_solid:
      return line(painted, "dashed_solid");
    case MarkType::curb:
      return line("curbstone", "high");
    case MarkType::grass:
    case MarkType::edge:
      return {{"type", "road_border"}};
    case MarkType::other:
      break;
  }
  return {{"type", "unknown"}};
}

// The marking that allows what is asked for, for a line whose marking nobody knows.
Attributes wished_tags(const CrossingWish& wish) {
  if (!wish.to_left && !wish.to_right) return {{"type", "virtual"}};
  const bool left = wish.to_left.value_or(false), right = wish.to_right.value_or(false);
  if (left && right) return line("line_thin", "dashed");
  if (left) return line("line_thin", wish.to_right ? "solid_dashed" : "dashed");
  if (right) return line("line_thin", wish.to_left ? "dashed_solid" : "dashed");
  return line("line_thin", "solid");
}

}  // namespace

bool is_writable(const Lane& lane) {
  return !lane.participants.empty() || lane.type == LaneType::shoulder;
}

void add_participants(const Participants& users, Attributes& tags) {
  using enum Participant;
  const Participants vehicles = Participants::vehicles();
  const bool all_vehicles = (users.bits() & vehicles.bits()) == vehicles.bits();
  const auto add = [&](Participant kind, const char* name) {
    if (users.has(kind)) tags.emplace_back(fmt::format("participant:{}", name), "yes");
  };
  if (all_vehicles) {
    tags.emplace_back("participant:vehicle", "yes");
  } else {
    add(motorcycle, "vehicle:motorcycle");
    add(car, "vehicle:car");
    add(taxi, "vehicle:taxi");
    add(bus, "vehicle:bus");
    add(truck, "vehicle:truck");
    add(emergency, "vehicle:emergency");
  }
  add(bicycle, "bicycle");
  add(pedestrian, "pedestrian");
  add(tram, "tram");
  add(train, "train");
}

Attributes lanelet_tags(const Lane& lane, bool from_lanelet2) {
  Attributes tags{{"type", "lanelet"}};
  if (from_lanelet2) {
    for (const auto& tag : lane.attributes) {
      if (tag.first != "type") tags.push_back(tag);
    }
    return tags;
  }
  tags.emplace_back("subtype", subtype_of(lane.type));
  add_missing_participants(lane, tags);
  tags.emplace_back("one_way", lane.one_way ? "yes" : "no");
  if (const auto limit_mps = lane.least_speed_limit_mps()) {
    tags.emplace_back("speed_limit", fmt::format("{:.6g}", *limit_mps * 3.6));
  }
  tags.emplace_back("name", lane.name);
  return tags;
}

BorderMark turned(BorderMark mark) {
  if (mark.type == MarkType::solid_broken) {
    mark.type = MarkType::broken_solid;
  } else if (mark.type == MarkType::broken_solid) {
    mark.type = MarkType::solid_broken;
  }
  return mark;
}

Attributes border_tags(const std::optional<BorderMark>& mark, const CrossingWish& wish) {
  Attributes tags = mark ? mark_tags(*mark) : wished_tags(wish);
  if (mark && !mark->color.empty()) tags.emplace_back("color", mark->color);
  if (mark && mark->width_m > 0.0) tags.emplace_back("width", fmt::format("{:.6g}", mark->width_m));
  const CrossingRule rule = crossing_rule(views_of(tags), Participants::vehicles());
  const bool left = wish.to_left.value_or(rule.to_left);
  const bool right = wish.to_right.value_or(rule.to_right);
  if (left != rule.to_left || right != rule.to_right) {
    tags.emplace_back("lane_change:left", left ? "yes" : "no");
    tags.emplace_back("lane_change:right", right ? "yes" : "no");
  }
  return tags;
}

}  // namespace roadbed::map::lanelet2
