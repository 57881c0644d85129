#include "roadbed/tools/cli/place.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/gis/lon_lat.h"
#include "roadbed/planning/route/route_options.h"

namespace roadbed::tools::inline cli {
namespace {

constexpr std::string_view kLanePrefix = "lane:", kLonLatPrefix = "lonlat:";

std::optional<double> number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t comma = text.find(',');
    parts.push_back(text.substr(0, comma));
    if (comma == std::string_view::npos) return parts;
    text.remove_prefix(comma + 1);
  }
}

// Radians, or degrees with their unit behind.
std::optional<double> heading(std::string_view text) {
  constexpr std::string_view kDegrees = "deg";
  if (text.ends_with(kDegrees)) {
    const auto degrees = number(text.substr(0, text.size() - kDegrees.size()));
    return degrees ? std::optional(*degrees * std::numbers::pi / 180.0) : std::nullopt;
  }
  const auto radians = number(text);
  return radians && std::abs(*radians) <= 2.0 * std::numbers::pi ? radians : std::nullopt;
}

struct LaneText {
  std::string_view name;
  std::string_view station;  ///< empty if none is given
};

LaneText lane_text(std::string_view text) {
  text.remove_prefix(kLanePrefix.size());
  const std::size_t at = text.rfind('@');
  if (at == std::string_view::npos) return {text, {}};
  return {text.substr(0, at), text.substr(at + 1)};
}

[[noreturn]] void refuse_place(const std::string& text, const std::string& found,
                               const std::string& needed, const std::string& remedy) {
  throw map::InputError(
      {.file = "place \"" + text + "\"", .found = found, .needed = needed, .remedy = remedy});
}

Place at_lane(const map::RoadMap& road_map, const std::string& text) {
  const LaneText parts = lane_text(text);
  const auto id = road_map.find_lane(parts.name);
  if (!id) {
    refuse_place(text, fmt::format("the map has no lane {}", parts.name), "",
                 "see the names with: roadbed locate MAP --at X,Y");
  }
  const map::Lane& lane = road_map.lane(*id);
  const double s_m = parts.station.empty() ? 0.0 : number(parts.station).value();
  if (s_m < 0.0 || s_m > lane.length_m()) {
    refuse_place(text, fmt::format("station {} m", s_m),
                 fmt::format("0 to {:.3f} m, the lane's length", lane.length_m()), "");
  }
  return {{*id, s_m, 0.0}, lane.pose_at(s_m), false, planning::Sense::either, {}};
}

[[noreturn]] void refuse_far(const map::RoadMap& road_map, const std::string& text,
                             const std::vector<planning::PlaceCandidate>& candidates,
                             map::Participant participant) {
  std::string found = "is off the road", remedy;
  for (const planning::PlaceCandidate& candidate : candidates) {
    const map::Lane& lane = road_map.lane(candidate.place.lane);
    if (candidate.verdict == planning::MatchVerdict::not_for_participant) {
      found = fmt::format("is on lane {}, where a {} may not drive: its type is {}", lane.name,
                          planning::to_string(participant), map::to_string(lane.type));
      break;
    }
    const Eigen::Vector2d on_lane =
        road_map.to_source(lane.pose_at(candidate.place.s_m).position());
    remedy += remedy.empty()
                  ? fmt::format(
                        "the nearest drivable lane is {}, {:.2f} m away; its centre there "
                        "is at {:.3f},{:.3f}",
                        lane.name, candidate.distance_m, on_lane.x(), on_lane.y())
                  : fmt::format("; next {}, {:.2f} m", lane.name, candidate.distance_m);
  }
  if (remedy.empty()) remedy = "no drivable lane is within 100 km: mind the coordinates";
  refuse_place(text, found, "", remedy);
}

/// The words of a point, without what it begins with.
std::vector<std::string_view> point_words(std::string_view text) {
  if (text.starts_with(kLonLatPrefix)) text.remove_prefix(kLonLatPrefix.size());
  return split(text);
}

/// What is wrong with the two numbers of a point.
std::string coordinates_fault(const std::string& text) {
  const auto words = point_words(text);
  const auto first = number(words[0]), second = number(words[1]);
  if (!text.starts_with(kLonLatPrefix)) return first && second ? "" : "X or Y is not a number";
  if (!first || !second) return "LON or LAT is not a number";
  const bool on_globe = std::abs(*first) <= 180.0 && std::abs(*second) <= 90.0;
  return on_globe ? ""
                  : "is not on the globe: the longitude, within ±180, comes first, then the "
                    "latitude, within ±90";
}

Eigen::Vector2d in_source(const map::RoadMap& road_map, const std::string& text) {
  const auto words = point_words(text);
  Eigen::Vector2d point(number(words[0]).value(), number(words[1]).value());
  if (!text.starts_with(kLonLatPrefix)) return point;
  try {
    map::lon_lat_to_source(road_map, std::span(&point, 1));
  } catch (const map::InputError& error) {
    refuse_place(text, error.what(), "", "");
  }
  return point;
}

PointPlace point_of(const map::RoadMap& road_map, const std::string& text) {
  const auto words = point_words(text);
  return {in_source(road_map, text), words.size() > 2 ? heading(words[2]) : std::nullopt};
}

/// @param text_of  how it is written, for what is refused
template <typename TextOf>
Place at_point(const map::RoadMap& road_map, const PointPlace& point, map::Participant participant,
               const TextOf& text_of) {
  const Eigen::Vector2d in_map = road_map.to_map(point.in_source);
  auto candidates =
      planning::match_place(road_map, in_map, point.heading_rad, {.participant = participant});
  if (candidates.empty() || candidates.front().verdict != planning::MatchVerdict::chosen) {
    refuse_far(road_map, text_of(), candidates, participant);
  }
  const planning::PlaceCandidate& chosen = candidates.front();
  Place place{chosen.place,
              {in_map.x(), in_map.y(), point.heading_rad.value_or(chosen.heading_rad)},
              point.heading_rad.has_value(),
              chosen.sense,
              {}};
  place.candidates = std::move(candidates);
  return place;
}

}  // namespace

void Place::choose(map::LaneId lane) {
  const auto taken = std::ranges::find(
      candidates, lane, [](const planning::PlaceCandidate& one) { return one.place.lane; });
  if (taken == candidates.end() || taken == candidates.begin()) return;
  std::swap(taken->verdict, candidates.front().verdict);
  std::rotate(candidates.begin(), taken, taken + 1);
  on_lane = candidates.front().place;
}

std::string place_syntax_fault(const std::string& text) {
  if (text.starts_with(kLanePrefix)) {
    const LaneText parts = lane_text(text);
    if (parts.name.empty()) return "the lane's name is missing";
    const bool has_station = text.find('@') != std::string::npos;
    if (has_station && !number(parts.station)) return "the station behind @ is not a number";
    return "";
  }
  const auto parts = point_words(text);
  if (parts.size() < 2 || parts.size() > 3) return std::string("is not ") + kPlaceSyntax;
  if (const std::string fault = coordinates_fault(text); !fault.empty()) return fault;
  if (parts.size() == 3 && !heading(parts[2])) {
    return "the heading is not a number of radians up to 2π; write degrees as 90deg";
  }
  return "";
}

std::string point_syntax_fault(const std::string& text) {
  if (point_words(text).size() != 2) return "is not X,Y or lonlat:LON,LAT: two numbers";
  return coordinates_fault(text);
}

Eigen::Vector2d find_point(const map::RoadMap& road_map, const std::string& text) {
  const std::string fault = point_syntax_fault(text);
  if (!fault.empty()) refuse_place(text, fault, "", "");
  return in_source(road_map, text);
}

Place find_place(const map::RoadMap& road_map, const std::string& text,
                 map::Participant participant) {
  const std::string fault = place_syntax_fault(text);
  if (!fault.empty()) refuse_place(text, fault, "", "");
  if (text.starts_with(kLanePrefix)) return at_lane(road_map, text);
  return at_point(road_map, point_of(road_map, text), participant, [&] { return text; });
}

Place find_place(const map::RoadMap& road_map, const PointPlace& point,
                 map::Participant participant) {
  const auto text_of = [&] {
    const std::string text = fmt::format("{},{}", point.in_source.x(), point.in_source.y());
    return point.heading_rad ? fmt::format("{},{}", text, *point.heading_rad) : text;
  };
  if (!point.in_source.allFinite() || !std::isfinite(point.heading_rad.value_or(0.0))) {
    refuse_place(text_of(), "X, Y or the heading is not a number", "", "");
  }
  return at_point(road_map, point, participant, text_of);
}

}  // namespace roadbed::tools::cli
