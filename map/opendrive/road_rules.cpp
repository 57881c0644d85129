#include "roadbed/map/opendrive/stretch.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "roadbed/map/opendrive/values.h"

namespace roadbed::map::opendrive {
namespace {

std::optional<Participant> participant(std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, Participant>, 11> words = {{
      {"pedestrian", Participant::pedestrian},
      {"bicycle", Participant::bicycle},
      {"motorcycle", Participant::motorcycle},
      {"passengerCar", Participant::car},
      {"car", Participant::car},
      {"taxi", Participant::taxi},
      {"bus", Participant::bus},
      {"truck", Participant::truck},
      {"trucks", Participant::truck},
      {"emergency", Participant::emergency},
      {"tram", Participant::tram},
  }};
  const auto found =
      std::find_if(words.begin(), words.end(), [&](const auto& w) { return w.first == word; });
  if (found == words.end()) return {};
  return found->second;
}

using AccessIterator = std::vector<LaneAccess>::const_iterator;

// What the records of one station make of those that the lane's type lets in.
Participants apply(Participants usual, AccessIterator from, AccessIterator to) {
  Participants allowed;
  for (auto access = from; access != to; ++access) {
    const auto kind = participant(access->restriction);
    if (access->allow && kind) allowed.add(*kind);
  }
  Participants result = allowed.empty() ? usual : allowed;
  for (auto access = from; access != to; ++access) {
    const auto kind = participant(access->restriction);
    if (!access->allow && kind) result.remove(*kind);
  }
  return result;
}

}  // namespace

std::vector<Stretch<std::optional<double>>> speed_stretches(const RoadRecord& road,
                                                            const LaneRecord& lane, double from_s_m,
                                                            double to_s_m) {
  using Limit = std::optional<double>;
  const auto limit = [](const SpeedRecord& record) { return record.limit_mps; };
  const auto roads = stretches(road.speeds, from_s_m, to_s_m, Limit{}, limit);
  if (lane.speeds.empty()) return roads;
  const double own_from_m = std::clamp(lane.speeds.front().s_m, from_s_m, to_s_m);
  std::vector<Stretch<Limit>> found;
  for (const auto& stretch : roads) {
    if (stretch.from_s_m < own_from_m) found.push_back(stretch);
  }
  if (!found.empty()) found.back().to_s_m = std::min(found.back().to_s_m, own_from_m);
  if (own_from_m >= to_s_m) return found;
  for (auto& own : stretches(lane.speeds, own_from_m, to_s_m, Limit{}, limit)) {
    if (!found.empty() && found.back().value == own.value) {
      found.back().to_s_m = own.to_s_m;
    } else {
      found.push_back(own);
    }
  }
  return found;
}

Participants participants_along(const LaneRecord& lane) {
  const Participants usual = participants_of(lane.type);
  if (lane.accesses.empty()) return usual;
  std::uint16_t bits = 0xffff;
  for (auto from = lane.accesses.begin(); from != lane.accesses.end();) {
    const auto to = std::find_if(from, lane.accesses.end(),
                                 [&](const LaneAccess& access) { return access.s_m != from->s_m; });
    bits = static_cast<std::uint16_t>(bits & apply(usual, from, to).bits());
    from = to;
  }
  return Participants::from_bits(bits);
}

std::string access_in_words(const LaneRecord& lane) {
  std::string words;
  for (const LaneAccess& access : lane.accesses) {
    words += fmt::format("{}{} {} {}", words.empty() ? "" : ", ", access.s_m,
                         access.allow ? "allow" : "deny", access.restriction);
  }
  return words;
}

}  // namespace roadbed::map::opendrive
