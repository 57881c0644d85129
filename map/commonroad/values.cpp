#include "roadbed/map/commonroad/values.h"

#include <algorithm>
#include <array>
#include <utility>

namespace roadbed::map::commonroad {
namespace {

using P = Participant;

template <typename Value, std::size_t N>
using Words = std::array<std::pair<std::string_view, Value>, N>;

template <typename Value, std::size_t N>
const Value* find(const Words<Value, N>& words, std::string_view word) {
  const auto found =
      std::find_if(words.begin(), words.end(), [&](const auto& w) { return w.first == word; });
  return found == words.end() ? nullptr : &found->second;
}

constexpr double kBroadM = 0.25;  // Germany's broad line (RMS-1, Breitstrich innerorts)

struct Marking {
  MarkType type;
  double width_m;
};

constexpr Words<Marking, 11> kMarkings = {{
    {"dashed", {MarkType::broken, 0.0}},
    {"solid", {MarkType::solid, 0.0}},
    {"dashed_dashed", {MarkType::broken_broken, 0.0}},
    {"solid_solid", {MarkType::solid_solid, 0.0}},
    {"solid_dashed", {MarkType::solid_broken, 0.0}},
    {"dashed_solid", {MarkType::broken_solid, 0.0}},
    {"broad_dashed", {MarkType::broken, kBroadM}},
    {"broad_solid", {MarkType::solid, kBroadM}},
    {"curb", {MarkType::curb, 0.0}},
    {"lowered_curb", {MarkType::curb, 0.0}},
    {"no_marking", {MarkType::none, 0.0}},
}};

constexpr Words<Participants, 10> kUsers = {{
    {"vehicle", Participants::vehicles()},
    {"car", {P::car}},
    {"truck", {P::truck}},
    {"bus", {P::bus}},
    {"priorityVehicle", {P::emergency}},
    {"motorcycle", {P::motorcycle}},
    {"bicycle", {P::bicycle}},
    {"pedestrian", {P::pedestrian}},
    {"train", {P::tram, P::train}},
    {"taxi", {P::taxi}},
}};

// Types that say what a lane is for; "urban", "highway" and the like only say where it is.
constexpr Words<LaneType, 11> kTypes = {{
    {"shoulder", LaneType::shoulder},
    {"busLane", LaneType::bus},
    {"busStop", LaneType::bus},
    {"bicycleLane", LaneType::biking},
    {"sidewalk", LaneType::sidewalk},
    {"crosswalk", LaneType::sidewalk},
    {"border", LaneType::border},
    {"parking", LaneType::parking},
    {"restricted", LaneType::restricted},
    {"restricted_area", LaneType::restricted},
    {"accessRamp", LaneType::on_ramp},
}};

// Numbers of the national sign catalogues, as the documentation of CommonRoad lists them.
constexpr Words<std::string_view, 12> kSpeedLimitIds = {{
    {"ZAM", "274"},
    {"DEU", "274"},
    {"CHN", "274"},
    {"ITA", "274"},
    {"USA", "R2-1"},
    {"PRI", "R2-1"},
    {"ESP", "r301"},
    {"RUS", "3.24"},
    {"ARG", "R15"},
    {"BEL", "C43"},
    {"FRA", "B14"},
    {"HRV", "B31"},
}};
constexpr std::string_view kGreekSpeedLimit = "\u03a1-32";  // a capital rho

bool has_any(Participants users, Participants kinds) { return (users.bits() & kinds.bits()) != 0; }

LaneType type_for_users(Participants users) {
  if (users.empty() || users.has(P::car)) return LaneType::driving;
  if (has_any(users, {P::tram, P::train})) return LaneType::rail;
  if (users.has(P::bus)) return LaneType::bus;
  if (users.has(P::taxi)) return LaneType::taxi;
  if (has_any(users, Participants::vehicles())) return LaneType::restricted;
  return users.has(P::bicycle) ? LaneType::biking : LaneType::sidewalk;
}

}  // namespace

std::optional<BorderMark> border_mark(std::string_view word) {
  const Marking* marking = find(kMarkings, word);
  if (!marking) return {};
  return BorderMark{0.0, marking->type, {}, marking->width_m};
}

std::string_view marking_word(const BorderMark& mark) {
  const bool broad = mark.width_m >= kBroadM;
  switch (mark.type) {
    case MarkType::none:
      return "no_marking";
    case MarkType::solid:
      return broad ? "broad_solid" : "solid";
    case MarkType::broken:
      return broad ? "broad_dashed" : "dashed";
    case MarkType::botts_dots:
      return "dashed";
    case MarkType::solid_solid:
      return "solid_solid";
    case MarkType::solid_broken:
      return "solid_dashed";
    case MarkType::broken_solid:
      return "dashed_solid";
    case MarkType::broken_broken:
      return "dashed_dashed";
    case MarkType::curb:
    case MarkType::edge:
      return "curb";
    default:
      return "unknown";
  }
}

Participants users(std::string_view word) {
  const Participants* found = find(kUsers, word);
  return found ? *found : Participants{};
}

std::vector<std::string_view> user_words(Participants users) {
  std::vector<std::string_view> words;
  for (const auto& [word, kinds] : kUsers) {
    if ((users.bits() & kinds.bits()) != kinds.bits()) continue;
    words.push_back(word);
    users = Participants::from_bits(static_cast<std::uint16_t>(users.bits() & ~kinds.bits()));
  }
  return words;
}

LaneType lane_type(const std::vector<std::string>& type_words, Participants named_users) {
  for (const std::string& word : type_words) {
    if (word == "exitRamp") return LaneType::off_ramp;
    if (const LaneType* type = find(kTypes, word)) return *type;
  }
  return type_for_users(named_users);
}

Participants default_users(LaneType type) {
  switch (type) {
    case LaneType::bus:
      return {P::bus, P::emergency};
    case LaneType::biking:
      return {P::bicycle};
    case LaneType::sidewalk:
      return {P::pedestrian};
    case LaneType::border:
    case LaneType::restricted:
      return {};
    default:
      return Participants::vehicles();
  }
}

std::string_view type_word(LaneType type) {
  switch (type) {
    case LaneType::entry:
    case LaneType::on_ramp:
      return "accessRamp";
    case LaneType::exit:
    case LaneType::off_ramp:
      return "exitRamp";
    case LaneType::driving:
    case LaneType::bidirectional:
    case LaneType::connecting_ramp:
    case LaneType::taxi:
      return "urban";
    case LaneType::stop:
      return "shoulder";
    case LaneType::median:
    case LaneType::curb:
      return "border";
    case LaneType::roadworks:
      return "restricted";
    default:
      break;
  }
  for (const auto& [word, meant] : kTypes) {
    if (meant == type) return word;
  }
  return "unknown";
}

std::string country_of(std::string_view benchmark_id) {
  if (benchmark_id.starts_with("C-")) benchmark_id.remove_prefix(2);
  if (benchmark_id.size() < 4 || benchmark_id[3] != '_') return {};
  return std::string(benchmark_id.substr(0, 3));
}

std::string known_country(std::string_view code) {
  constexpr Words<std::string_view, 11> kShort = {{{"DE", "DEU"},
                                                   {"CN", "CHN"},
                                                   {"IT", "ITA"},
                                                   {"US", "USA"},
                                                   {"PR", "PRI"},
                                                   {"ES", "ESP"},
                                                   {"RU", "RUS"},
                                                   {"AR", "ARG"},
                                                   {"BE", "BEL"},
                                                   {"FR", "FRA"},
                                                   {"HR", "HRV"}}};
  if (code == "GRC" || code == "GR") return "GRC";
  if (const std::string_view* country = find(kShort, code)) return std::string(*country);
  return find(kSpeedLimitIds, code) ? std::string(code) : std::string();
}

std::string_view speed_limit_id(std::string_view country) {
  if (country == "GRC") return kGreekSpeedLimit;
  const std::string_view* id = find(kSpeedLimitIds, country);
  return id ? *id : "274";
}

bool is_speed_limit(std::string_view country, std::string_view sign_id) {
  return sign_id == "274" || sign_id == speed_limit_id(country);
}

}  // namespace roadbed::map::commonroad
