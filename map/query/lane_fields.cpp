#include "roadbed/map/query/lane_fields.h"

#include <array>
#include <cmath>
#include <utility>

namespace roadbed::map::inline query {
namespace {

using Texts = std::vector<std::string>;

FieldValue text(std::string value) {
  if (value.empty()) return {};
  return Texts{std::move(value)};
}

FieldValue truth(bool value) { return Texts{value ? "true" : "false"}; }

FieldValue names(const AskedLane& lane, const std::vector<LaneId>& lanes) {
  if (lanes.empty()) return {};
  Texts found;
  for (const LaneId id : lanes) found.push_back(lane.map().lane(id).name);
  return found;
}

FieldValue name(const AskedLane& lane, const std::optional<Neighbour>& neighbour) {
  return neighbour ? text(lane.map().lane(neighbour->lane).name) : FieldValue();
}

std::vector<std::string_view> truths() { return {"true", "false"}; }

std::vector<std::string_view> type_words() {
  std::vector<std::string_view> words;
  for (int type = 0; type <= static_cast<int>(LaneType::other); ++type) {
    words.push_back(to_string(static_cast<LaneType>(type)));
  }
  return words;
}

constexpr std::array<std::pair<Participant, std::string_view>, 10> kParticipants = {
    {{Participant::pedestrian, "pedestrian"},
     {Participant::bicycle, "bicycle"},
     {Participant::motorcycle, "motorcycle"},
     {Participant::car, "car"},
     {Participant::taxi, "taxi"},
     {Participant::bus, "bus"},
     {Participant::truck, "truck"},
     {Participant::emergency, "emergency"},
     {Participant::tram, "tram"},
     {Participant::train, "train"}}};

std::vector<std::string_view> participant_words() {
  std::vector<std::string_view> words;
  for (const auto& [kind, word] : kParticipants) words.push_back(word);
  return words;
}

FieldValue participants(const AskedLane& lane) {
  Texts found;
  for (const auto& [kind, word] : kParticipants) {
    if (lane.lane().participants.has(kind)) found.emplace_back(word);
  }
  if (found.empty()) return {};
  return found;
}

/// As the map's file says it, without what the way to m/s and back adds.
double in_kmh(double speed_mps) { return std::round(3.6e6 * speed_mps) / 1e6; }

FieldValue speed(const AskedLane& lane) {
  const auto limit_mps = lane.lane().least_speed_limit_mps();
  return limit_mps ? FieldValue(in_kmh(*limit_mps)) : FieldValue();
}

FieldValue road(const AskedLane& lane) {
  const auto& id = lane.lane().road;
  return id ? text(lane.map().road(*id).source_id) : FieldValue();
}

FieldValue junction(const AskedLane& lane) {
  const auto& id = lane.lane().junction;
  return id ? text(lane.map().junction(*id).source_id) : FieldValue();
}

using L = const AskedLane&;

constexpr std::array<LaneField, 21> kFields = {{
    {"lane", false, "name, as in lane:NAME", [](L lane) { return text(lane.lane().name); }},
    {"id", false, "the source's own id", [](L lane) { return text(lane.lane().origin.source_id); }},
    {"road", false, "id of its road", road},
    {"section", true, "index of its section along the road",
     [](L lane) { return FieldValue(static_cast<double>(lane.lane().origin.section)); }},
    {"junction", false, "id of its junction", junction},
    {"type", false, "driving, biking, bus, sidewalk, …",
     [](L lane) { return text(std::string(to_string(lane.lane().type))); }, type_words},
    {"drivable", false, "true where a car may plan to drive along it",
     [](L lane) { return truth(is_drivable(lane.lane().type)); }, truths},
    {"one_way", false, "true or false", [](L lane) { return truth(lane.lane().one_way); }, truths},
    {"participants", false, "who may use it: car, bus, bicycle, …", participants,
     participant_words},
    {"speed", true, "speed limit, of several the least [km/h]", speed},
    {"length", true, "of the centreline [m]",
     [](L lane) { return FieldValue(lane.lane().length_m()); }},
    {"area", true, "between the borders [m²]",
     [](L lane) { return FieldValue(lane.measures().area_m2); }},
    {"width", true, "area by length [m]",
     [](L lane) { return FieldValue(lane.measures().mean_width_m); }},
    {"min_width", true, "the least [m]",
     [](L lane) { return FieldValue(lane.measures().least_width_m); }},
    {"max_width", true, "the greatest [m]",
     [](L lane) { return FieldValue(lane.measures().greatest_width_m); }},
    {"slope", true, "the greatest, up or down [%]",
     [](L lane) { return FieldValue(100.0 * lane.measures().greatest_slope); }},
    {"curvature", true, "the greatest, to either side [1/m]",
     [](L lane) { return FieldValue(lane.measures().greatest_curvature_per_m); }},
    {"successors", false, "names of the lanes that follow",
     [](L lane) { return names(lane, lane.links().successors); }},
    {"predecessors", false, "names of the lanes before",
     [](L lane) { return names(lane, lane.links().predecessors); }},
    {"left", false, "name of the lane across the left border",
     [](L lane) { return name(lane, lane.links().left); }},
    {"right", false, "name of the lane across the right border",
     [](L lane) { return name(lane, lane.links().right); }},
}};

}  // namespace

const LaneMeasures& AskedLane::measures() const {
  if (!measures_) measures_ = measure(*lane_);
  return *measures_;
}

std::span<const LaneField> lane_fields() { return kFields; }

}  // namespace roadbed::map::query
