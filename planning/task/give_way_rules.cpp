#include "roadbed/planning/task/give_way_rules.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <string>

namespace roadbed::planning::inline task {
namespace {

constexpr std::array<std::string_view, 4> kStopSigns{"206", "de206", "r1-1", "usr1-1"};
constexpr std::array<std::string_view, 4> kGiveWaySigns{"205", "de205", "r1-2", "usr1-2"};

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
  return text;
}

bool is_one_of(const map::Signal& signal, std::span<const std::string_view> types) {
  const std::string type = lower(signal.type), subtype = lower(signal.subtype);
  return std::ranges::any_of(types, [&](std::string_view t) { return t == type || t == subtype; });
}

}  // namespace

bool is_stop_sign(const map::Signal& signal) { return is_one_of(signal, kStopSigns); }
bool is_give_way_sign(const map::Signal& signal) { return is_one_of(signal, kGiveWaySigns); }

bool has_sign_to_give_way(const map::RoadMap& road_map, const map::RuleIndex& rules,
                          map::LaneId lane) {
  const std::array<map::LaneId, 1> one{lane};
  const auto places = rules.ahead(one, 0.0, road_map.lane(lane).length_m());
  return std::ranges::any_of(places, [&](const map::RulePlace& place) {
    if (place.kind != map::RuleKind::signal) return false;
    const map::Signal& signal = road_map.signals()[place.index];
    return is_stop_sign(signal) || is_give_way_sign(signal);
  });
}

bool has_priority_role(const map::Regulation& regulation, std::string_view role, map::LaneId lane) {
  return regulation.type == "right_of_way" &&
         std::ranges::any_of(regulation.members, [&](const map::RegulationMember& member) {
           return member.role == role && member.lane == lane;
         });
}

}  // namespace roadbed::planning::task
