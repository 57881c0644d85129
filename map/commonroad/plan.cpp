#include "roadbed/map/commonroad/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>

#include "roadbed/map/commonroad/values.h"

namespace roadbed::map::commonroad {
namespace {

std::vector<std::uint64_t> lane_ids(const RoadMap& road_map, IdGiver& ids) {
  std::vector<std::uint64_t> given;
  // All as in the source or none, so that nobody takes a counted one for the source's.
  IdGiver kept;
  bool all_kept = true;
  for (const Lane& lane : road_map.lanes()) all_kept = all_kept && kept.keep(lane.name);
  for (const Lane& lane : road_map.lanes()) {
    const bool has_use = lane.type != LaneType::none;
    given.push_back(has_use ? ids.give(all_kept ? lane.name : "") : kNoLanelet);
  }
  return given;
}

std::string attribute_of(const Attributes& attributes, std::string_view key) {
  for (const auto& [name, value] : attributes) {
    if (name == key) return value;
  }
  return {};
}

// The country whose signs the map has, of those that CommonRoad knows; of several the most
// frequent.
std::string country_of_signs(const RoadMap& road_map) {
  std::map<std::string, std::size_t> counts;
  for (const Signal& signal : road_map.signals()) {
    const std::string country = known_country(signal.country);
    if (!signal.dynamic && !country.empty()) ++counts[country];
  }
  const auto most =
      std::max_element(counts.begin(), counts.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts.end() ? "ZAM" : most->first;
}

std::vector<std::string> split(const std::string& words) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  while (from < words.size()) {
    const std::size_t to = std::min(words.find(' ', from), words.size());
    if (to > from) parts.push_back(words.substr(from, to - from));
    from = to + 1;
  }
  return parts;
}

std::optional<double> speed_mps(const Signal& signal) {
  if (!signal.value) return {};
  if (signal.unit == "m/s") return signal.value;
  if (signal.unit == "mph") return *signal.value * 0.44704;
  if (signal.unit == "km/h") return *signal.value / 3.6;
  return {};
}

bool limits_speed(const Signal& signal) { return is_speed_limit(signal.country, signal.type); }

/// Whether the lanes that the sign speaks to have just the limit that it says.
bool agrees_with_lanes(const RoadMap& road_map, const Signal& sign) {
  const std::optional<double> limit_mps = speed_mps(sign);
  return limit_mps && std::all_of(sign.lanes.begin(), sign.lanes.end(), [&](LaneId id) {
           return road_map.lane(id).least_speed_limit_mps() == limit_mps;
         });
}

PlannedSign::Element first_element(const Signal& signal) {
  if (limits_speed(signal)) return {signal.type, {fmt::format("{}", *speed_mps(signal))}};
  if (!signal.text.empty()) return {signal.type, split(signal.text)};
  if (signal.value) return {signal.type, {fmt::format("{}", *signal.value)}};
  return {signal.type, {}};
}

class Planner {
 public:
  explicit Planner(const RoadMap& road_map) : road_map_(road_map) {
    const std::size_t lanes = road_map.lanes().size();
    plan_.lane_ids = lane_ids(road_map, ids_);
    plan_.sign_ids.resize(lanes);
    plan_.light_ids.resize(lanes);
    plan_.stop_lines.resize(lanes);
    plan_.benchmark_id = attribute_of(road_map.attributes(), "benchmarkID");
    if (plan_.benchmark_id.empty()) plan_.benchmark_id = country_of_signs(road_map) + "_Roadbed-1";
    country_ = country_of(plan_.benchmark_id);
  }

  Plan plan() {
    for (const Signal& signal : road_map_.signals()) {
      if (signal.dynamic) {
        add_light(signal);
      } else if (!signal.lanes.empty() && !signal.type.empty()) {
        add_sign(signal);
      } else {
        ++plan_.lost_signs;
      }
    }
    add_speed_limits();
    for (const StopLine& line : road_map_.stop_lines()) {
      for (const LaneId id : line.lanes) {
        const StopLine*& of_lane = plan_.stop_lines[id.index];
        if (!of_lane) of_lane = &line;
      }
    }
    plan_.intersections = plan_intersections(road_map_, ids_);
    return std::move(plan_);
  }

 private:
  void add_light(const Signal& signal) {
    const std::uint64_t id = ids_.give(signal.source_id);
    plan_.lights.push_back({id, &signal});
    plan_.light_by_source.emplace(signal.source_id, id);
    for (const LaneId lane : signal.lanes) plan_.light_ids[lane.index].push_back(id);
  }

  void add_sign(const Signal& signal) {
    if (limits_speed(signal) && !agrees_with_lanes(road_map_, signal)) {
      ++plan_.lost_signs;
      return;
    }
    PlannedSign sign;
    sign.elements = {first_element(signal)};
    for (const auto& [key, value] : signal.attributes) {
      if (key == "trafficSignElement") {
        std::vector<std::string> words = split(value);
        if (words.empty()) continue;
        sign.elements.push_back({words.front(), {words.begin() + 1, words.end()}});
      }
    }
    sign.in_map = signal.in_map;
    sign.is_virtual = attribute_of(signal.attributes, "virtual") == "true";
    sign.lanes = signal.lanes;
    if (limits_speed(signal)) {
      for (const LaneId lane : sign.lanes) limited_.insert(lane);
    }
    give_id(std::move(sign), signal.source_id);
  }

  void give_id(PlannedSign sign, const std::string& source_id) {
    sign.id = ids_.give(source_id);
    if (!source_id.empty()) plan_.sign_by_source.emplace(source_id, sign.id);
    for (const LaneId lane : sign.lanes) plan_.sign_ids[lane.index].push_back(sign.id);
    plan_.signs.push_back(std::move(sign));
  }

  // Limits that no sign says: one virtual sign each, at the first lane that it holds on.
  void add_speed_limits() {
    std::map<double, std::vector<LaneId>> lanes_by_limit;
    for (const Lane& lane : road_map_.lanes()) {
      const std::optional<double> limit_mps = lane.least_speed_limit_mps();
      if (limit_mps && !limited_.contains(lane.id)) lanes_by_limit[*limit_mps].push_back(lane.id);
    }
    for (auto& [limit_mps, lanes] : lanes_by_limit) {
      PlannedSign sign;
      sign.elements = {{std::string(speed_limit_id(country_)), {fmt::format("{}", limit_mps)}}};
      sign.in_map = road_map_.lane(lanes.front()).right.in_map.points().front();
      sign.is_virtual = true;
      sign.lanes = std::move(lanes);
      give_id(std::move(sign), {});
    }
  }

  const RoadMap& road_map_;
  std::string country_;
  IdGiver ids_;
  std::set<LaneId> limited_;  ///< lanes whose limit a sign of the map says
  Plan plan_;
};

}  // namespace

bool IdGiver::keep(const std::string& source_id) {
  constexpr std::size_t most_digits = 18;
  std::uint64_t id = 0;
  const auto [end, error] =
      std::from_chars(source_id.data(), source_id.data() + source_id.size(), id);
  if (error != std::errc() || end != source_id.data() + source_id.size()) return false;
  if (id == 0 || source_id.size() > most_digits || source_id.front() == '0') return false;
  return taken_.insert(id).second;
}

std::uint64_t IdGiver::give(const std::string& source_id) {
  if (keep(source_id)) return std::stoull(source_id);
  while (!taken_.insert(next_).second) ++next_;
  return next_;
}

Plan make_plan(const RoadMap& road_map) { return Planner(road_map).plan(); }

}  // namespace roadbed::map::commonroad
