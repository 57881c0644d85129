#include "roadbed/map/lanelet2/traffic_rules.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "roadbed/map/lanelet2/document.h"

namespace roadbed::map::lanelet2 {
namespace {

using enum Participant;

// The road users by their names in `participant:NAME` and `speed_limit:NAME`.
constexpr std::array<std::pair<Participant, std::string_view>, 10> kNames = {{
    {pedestrian, "pedestrian"},
    {bicycle, "bicycle"},
    {motorcycle, "vehicle:motorcycle"},
    {car, "vehicle:car"},
    {taxi, "vehicle:taxi"},
    {bus, "vehicle:bus"},
    {truck, "vehicle:truck"},
    {emergency, "vehicle:emergency"},
    {tram, "tram"},
    {train, "train"},
}};

std::string_view name_of(Participant kind) { return kNames[static_cast<std::size_t>(kind)].second; }

// Whether `part` is `whole` or its beginning up to a colon.
bool names_or_contains(std::string_view part, std::string_view whole) {
  return whole.starts_with(part) && (whole.size() == part.size() || whole[part.size()] == ':');
}

// The value of "prefix:NAME" that is most specific to a road user, "prefix" alone included.
std::optional<std::string_view> override_for(Tags tags, std::string_view prefix, Participant kind) {
  std::size_t longest = 0;
  std::optional<std::string_view> found;
  for (const auto& [key, value] : tags) {
    if (key.size() < prefix.size() || key.size() <= longest || !key.starts_with(prefix)) continue;
    const std::string_view rest = key.substr(prefix.size());
    const bool is_for_it =
        rest.starts_with(':') && names_or_contains(rest.substr(1), name_of(kind));
    if (!rest.empty() && !is_for_it) continue;
    longest = key.size();
    found = value;
  }
  return found;
}

bool has_key_from(Tags tags, std::string_view prefix) {
  return std::any_of(tags.begin(), tags.end(),
                     [&](const auto& entry) { return entry.first.starts_with(prefix); });
}

Participants with(Participants set, std::initializer_list<Participant> more) {
  for (const Participant kind : more) set.add(kind);
  return set;
}

Participants by_subtype(std::string_view subtype) {
  const Participants vehicles = Participants::vehicles();
  if (subtype.empty() || subtype == "highway") return vehicles;
  if (subtype == "road") return with(vehicles, {bicycle});
  if (subtype == "play_street" || subtype == "exit") return with(vehicles, {pedestrian, bicycle});
  if (subtype == "emergency_lane") return {emergency};
  if (subtype == "bus_lane") return {bus, emergency, taxi};
  if (subtype == "bicycle_lane") return {bicycle};
  if (subtype == "shared_walkway") return {pedestrian, bicycle};
  if (subtype == "walkway" || subtype == "crosswalk" || subtype == "stairs" ||
      subtype == "pedestrian_lane") {
    return {pedestrian};
  }
  if (subtype == "rail") return {train};
  if (subtype == "tram") return {tram};
  return {};
}

// The road user a lane is mainly for.
Participant main_user(const Participants& users) {
  for (const Participant kind : {car, bus, taxi, truck, motorcycle, bicycle, pedestrian}) {
    if (users.has(kind)) return kind;
  }
  return car;
}

bool is_painted_line(std::string_view type) { return type == "line_thin" || type == "line_thick"; }

CrossingRule rule_for_vehicles(std::string_view type, std::string_view subtype) {
  if (!is_painted_line(type)) return {};
  if (subtype == "dashed") return {true, true};
  if (subtype == "dashed_solid") return {false, true};
  if (subtype == "solid_dashed") return {true, false};
  return {};
}

CrossingRule either(CrossingRule a, CrossingRule b) {
  return {a.to_left || b.to_left, a.to_right || b.to_right};
}

MarkType painted_mark(std::string_view subtype, bool reversed) {
  if (subtype == "solid") return MarkType::solid;
  if (subtype == "dashed") return MarkType::broken;
  if (subtype == "solid_solid") return MarkType::solid_solid;
  if (subtype == "dashed_dashed") return MarkType::broken_broken;
  const bool solid_first = subtype == "solid_dashed";
  if (!solid_first && subtype != "dashed_solid") return MarkType::other;
  return solid_first != reversed ? MarkType::solid_broken : MarkType::broken_solid;
}

MarkType mark_type(std::string_view type, std::string_view subtype, bool reversed) {
  if (is_painted_line(type)) return painted_mark(subtype, reversed);
  if (type == "virtual") return MarkType::none;
  if (type == "curbstone") return MarkType::curb;
  constexpr std::array<std::string_view, 5> ends = {"road_border", "guard_rail", "wall", "fence",
                                                    "jersey_barrier"};
  return std::find(ends.begin(), ends.end(), type) != ends.end() ? MarkType::edge : MarkType::other;
}

}  // namespace

std::string_view value_of(Tags tags, std::string_view key) {
  const auto found =
      std::find_if(tags.begin(), tags.end(), [&](const auto& entry) { return entry.first == key; });
  return found == tags.end() ? std::string_view() : found->second;
}

std::optional<bool> truth_of(std::string_view value) {
  if (value == "yes" || value == "true" || value == "1") return true;
  if (value == "no" || value == "false" || value == "0") return false;
  return {};
}

Participants participants(Tags tags) {
  if (!has_key_from(tags, "participant")) return by_subtype(value_of(tags, "subtype"));
  Participants users;
  for (const auto& [kind, name] : kNames) {
    const auto value = override_for(tags, "participant", kind);
    if (value && truth_of(*value).value_or(false)) users.add(kind);
  }
  return users;
}

bool is_one_way(Tags tags, const Participants& users) {
  const Participant user = main_user(users);
  if (const auto plain = truth_of(value_of(tags, "one_way"))) return *plain;
  if (has_key_from(tags, "one_way")) {
    const auto value = override_for(tags, "one_way", user);
    return !value || truth_of(*value).value_or(true);
  }
  return user != pedestrian;
}

LaneType lane_type(std::string_view subtype, const Participants& users) {
  if (users.has(car)) return LaneType::driving;
  if (subtype == "road_shoulder") return LaneType::shoulder;
  if (subtype == "emergency_lane") return LaneType::stop;
  if (subtype == "parking") return LaneType::parking;
  if (subtype == "bicycle_lane") return LaneType::biking;
  if (users.has(bus)) return LaneType::bus;
  if (users.has(taxi)) return LaneType::taxi;
  if (users.has(pedestrian)) return LaneType::sidewalk;
  if (users.has(bicycle)) return LaneType::biking;
  if (users.has(tram)) return LaneType::tram;
  if (users.has(train)) return LaneType::rail;
  return users.empty() ? LaneType::other : LaneType::restricted;
}

CrossingRule crossing_rule(Tags line_tags, const Participants& users) {
  const auto says = [&](std::string_view key) {
    return truth_of(value_of(line_tags, key)).value_or(false);
  };
  const auto has = [&](std::string_view key) {
    return std::any_of(line_tags.begin(), line_tags.end(),
                       [&](const auto& entry) { return entry.first == key; });
  };
  if (has("lane_change")) return {says("lane_change"), says("lane_change")};
  if (has("lane_change:left") || has("lane_change:right")) {
    return {says("lane_change:left"), says("lane_change:right")};
  }
  const std::string_view type = value_of(line_tags, "type");
  const std::string_view subtype = value_of(line_tags, "subtype");
  const bool low_curb = type == "curbstone" && subtype == "low";
  const CrossingRule on_foot{low_curb, low_curb};
  const Participant user = main_user(users);
  if (user == pedestrian) return on_foot;
  const CrossingRule on_wheels = rule_for_vehicles(type, subtype);
  return user == bicycle ? either(on_wheels, on_foot) : on_wheels;
}

std::optional<BorderMark> border_mark(Tags line_tags, bool reversed) {
  const std::string_view type = value_of(line_tags, "type");
  if (type.empty()) return {};
  BorderMark mark;
  mark.type = mark_type(type, value_of(line_tags, "subtype"), reversed);
  const std::string_view color = value_of(line_tags, "color");
  if (color.size() <= 32) mark.color = color;
  const double width_m = number_in(value_of(line_tags, "width"));
  mark.width_m = width_m > 0.0 && width_m < 10.0 ? width_m : 0.0;
  return mark;
}

std::optional<double> speed_mps(std::string_view text) {
  const std::size_t digits = text.find_first_not_of("0123456789.+ ");
  const double value = number_in(text.substr(0, digits));
  std::string_view unit = digits == text.npos ? std::string_view() : text.substr(digits);
  while (!unit.empty() && unit.back() == ' ') unit.remove_suffix(1);
  if (!(value >= 0.0 && value < 1e4)) return {};
  if (unit.empty() || unit == "km/h" || unit == "kmh" || unit == "kph") return value / 3.6;
  if (unit == "mph" || unit == "mp/h") return value * 0.44704;
  if (unit == "m/s" || unit == "mps") return value;
  return {};
}

std::optional<double> sign_speed_mps(std::string_view code) {
  if (code == "de310") return 50.0 / 3.6;  // place name: the built-up area begins
  if (code == "de274" || code == "de274.1" || code == "de274_1") return 30.0 / 3.6;
  for (const std::string_view sign : {"de274-", "de274.1-", "de274_1-"}) {
    if (code.starts_with(sign)) return speed_mps(code.substr(sign.size()));
  }
  return speed_mps(code);
}

std::optional<double> tagged_speed_mps(Tags tags, const Participants& users) {
  const auto value = override_for(tags, "speed_limit", main_user(users));
  return value ? speed_mps(*value) : std::nullopt;
}

}  // namespace roadbed::map::lanelet2
