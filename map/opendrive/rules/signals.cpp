#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>

#include "roadbed/map/opendrive/rules/furniture.h"

namespace roadbed::map::opendrive::rules {
namespace {

/// Files round lengths; a thing at the very end of its road is on it.
constexpr double kAtEnd_m = 0.01;

void find_stations_off(const Source& source, const char* parent, const char* name,
                       validation::Report& report) {
  for_each_thing(source, parent, name, [&](const RoadSource& road, pugi::xml_node node) {
    const double s_m = source.number(node, "s");
    if (!(s_m < -kAtEnd_m || s_m > road.record.length_m + kAtEnd_m)) return;
    add_thing(
        report, source, road, node,
        fmt::format("is at s {:.2f} m of road {}, which is {:.2f} m long; correct s or the road",
                    s_m, road.record.id, road.record.length_m));
  });
}

void signals_off_station(const Source& source, const validation::ValidateOptions&,
                         validation::Report& report) {
  find_stations_off(source, "signals", "signal", report);
  find_stations_off(source, "signals", "signalReference", report);
}

void objects_off_station(const Source& source, const validation::ValidateOptions&,
                         validation::Report& report) {
  find_stations_off(source, "objects", "object", report);
}

const LaneSection* section_at(const RoadSource& road, double s_m) {
  if (road.record.sections.empty()) return nullptr;
  const auto after =
      std::upper_bound(road.record.sections.begin() + 1, road.record.sections.end(), s_m + kAtEnd_m,
                       [](double s, const LaneSection& section) { return s < section.s_m; });
  return &*std::prev(after);
}

/// A range of lanes that a <validity> names, as numbers.
struct LaneRange {
  int from = 0, to = 0;
};

LaneRange range_of(pugi::xml_node validity) {
  return {validity.attribute("fromLane").as_int(), validity.attribute("toLane").as_int()};
}

bool names_a_lane(const LaneSection& section, LaneRange range) {
  return std::ranges::any_of(section.listed(), [&](const LaneRecord& lane) {
    return lane.id >= std::min(range.from, range.to) && lane.id <= std::max(range.from, range.to);
  });
}

template <typename Check>
void for_each_validity(const Source& source, const Check& check) {
  for (const auto& [parent, name] :
       {std::pair{"signals", "signal"}, {"signals", "signalReference"}, {"objects", "object"}}) {
    for_each_thing(source, parent, name, [&](const RoadSource& road, pugi::xml_node node) {
      for (const auto validity : node.children("validity")) check(road, node, validity);
    });
  }
}

void unknown_validity(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  for_each_validity(source, [&](const RoadSource& road, pugi::xml_node node,
                                pugi::xml_node validity) {
    const LaneSection* section = section_at(road, source.number(node, "s"));
    const LaneRange range = range_of(validity);
    if (section == nullptr || names_a_lane(*section, range)) return;
    add_thing(
        report, source, road, node,
        fmt::format("holds for lanes {} to {} of road {}, none of which is there; correct validity",
                    range.from, range.to, road.record.id));
  });
}

void reversed_validity(const Source& source, const validation::ValidateOptions&,
                       validation::Report& report) {
  for_each_validity(source, [&](const RoadSource& road, pugi::xml_node node,
                                pugi::xml_node validity) {
    const LaneRange range = range_of(validity);
    if (range.from <= range.to) return;
    validation::Finding& finding = add_thing(
        report, source, road, node,
        fmt::format("holds for lanes {} to {}; write the smaller one first", range.from, range.to));
    const bool object = std::strcmp(node.name(), "object") == 0;
    finding.asam_rule = object ? "asam.net:xodr:1.7.0:road.object.validty.from_lower_equal_to"
                               : "asam.net:xodr:1.7.0:road.signal.reference.from_lower_equal_to";
  });
}

/// Sign of the lanes that drive in the orientation's direction, 0 for both.
int sign_of(const RoadSource& road, pugi::xml_node node) {
  const std::string_view orientation = node.attribute("orientation").value();
  const bool left_hand = road.record.left_hand_traffic;
  if (orientation == "+") return left_hand ? 1 : -1;
  if (orientation == "-") return left_hand ? -1 : 1;
  return 0;
}

void validity_against_orientation(const Source& source, const validation::ValidateOptions&,
                                  validation::Report& report) {
  for_each_validity(
      source, [&](const RoadSource& road, pugi::xml_node node, pugi::xml_node validity) {
        const int sign = sign_of(road, node);
        const LaneRange range = range_of(validity);
        if (sign == 0 || (range.from * sign >= 0 && range.to * sign >= 0)) return;
        validation::Finding& finding = add_thing(
            report, source, road, node,
            fmt::format("faces traffic of orientation {} but holds for lanes {} to {}, which drive "
                        "the other way; correct one of them",
                        node.attribute("orientation").value(), range.from, range.to));
        const bool left_hand = road.record.left_hand_traffic;
        const char* kind = std::strcmp(node.name(), "object") == 0   ? "object.validty"
                           : std::strcmp(node.name(), "signal") == 0 ? "signal.validity"
                                                                     : "signal.reference";
        finding.asam_rule = fmt::format("asam.net:xodr:1.7.0:road.{}.{}_hand_traffic_lane_ids",
                                        kind, left_hand ? "left" : "right");
      });
}

bool is_country(std::string_view code) {
  if (code == "OpenDRIVE") return true;
  const bool letters =
      std::all_of(code.begin(), code.end(), [](unsigned char c) { return std::isupper(c) != 0; });
  return letters && (code.size() == 2 || code.size() == 3);
}

/// Country names that OpenDRIVE 1.4 listed in full.
bool is_old_country(std::string_view name) {
  static constexpr std::string_view kNames[] = {"Austria", "Brazil", "China",       "France",
                                                "Germany", "Italy",  "Switzerland", "USA"};
  return std::find(std::begin(kNames), std::end(kNames), name) != std::end(kNames);
}

void unknown_countries(const Source& source, const validation::ValidateOptions&,
                       validation::Report& report) {
  for_each_thing(source, "signals", "signal", [&](const RoadSource& road, pugi::xml_node node) {
    const std::string_view code = node.attribute("country").value();
    if (is_country(code) || is_old_country(code)) return;
    add_thing(report, source, road, node,
              code.empty()
                  ? std::string("does not say whose catalogue its type is from; add a country")
                  : fmt::format("country=\"{}\" is no country code (two capitals, as DE); "
                                "correct it",
                                code))
        .severity = code.empty() ? validation::Severity::info : validation::Severity::warning;
  });
}

void signals_without_type(const Source& source, const validation::ValidateOptions&,
                          validation::Report& report) {
  for_each_thing(source, "signals", "signal", [&](const RoadSource& road, pugi::xml_node node) {
    if (*node.attribute("type").value() != '\0') return;
    add_thing(report, source, road, node,
              "has no type, so that nobody knows what it shows; add one");
  });
}

void empty_controllers(const Source& source, const validation::ValidateOptions&,
                       validation::Report& report) {
  for (const auto controller : source.xml.root().children("controller")) {
    if (controller.child("control")) continue;
    report.add(thing_name(controller), std::nullopt, "controls no signal; add some or remove it")
        .line = source.xml.line_of(controller);
  }
}

/// Calls `check(road, speed)` for every <speed> of roads and lanes.
template <typename Check>
void for_each_speed(const Source& source, const Check& check) {
  for (const RoadSource& road : source.roads) {
    for (const auto type : road.record.node.children("type")) {
      if (const auto speed = type.child("speed")) check(road, speed);
    }
    for (const LaneSection& section : road.record.sections) {
      for (const LaneRecord& lane : section.listed()) {
        for (const auto speed : lane.node.children("speed")) check(road, speed);
      }
    }
  }
}

double metres_per_second(std::string_view unit) {
  if (unit == "km/h") return 1.0 / 3.6;
  if (unit == "mph") return 0.44704;
  return 1.0;
}

void speeds_without_unit(const Source& source, const validation::ValidateOptions&,
                         validation::Report& report) {
  constexpr double kFastInCity = 40.0;  // as m/s beyond most motorways, as km/h a street
  for_each_speed(source, [&](const RoadSource& road, pugi::xml_node speed) {
    if (speed.attribute("unit") || !(source.number(speed, "max") >= kFastInCity)) return;
    add_at(report, source, road, speed,
           fmt::format("speed {} has no unit and holds as m/s; add unit=\"km/h\" or \"mph\" if it "
                       "is one of them",
                       speed.attribute("max").value()));
  });
}

void unknown_units(const Source& source, const validation::ValidateOptions&,
                   validation::Report& report) {
  for_each_speed(source, [&](const RoadSource& road, pugi::xml_node speed) {
    const std::string_view unit = speed.attribute("unit").value();
    if (unit.empty() || unit == "m/s" || unit == "km/h" || unit == "mph") return;
    add_at(report, source, road, speed,
           fmt::format("speed has the unit \"{}\"; use m/s, km/h or mph", unit));
  });
}

void absurd_speeds(const Source& source, const validation::ValidateOptions& options,
                   validation::Report& report) {
  for_each_speed(source, [&](const RoadSource& road, pugi::xml_node speed) {
    const double speed_mps =
        source.number(speed, "max") * metres_per_second(speed.attribute("unit").value());
    if (!(speed_mps > options.max_speed_mps || speed_mps <= 0.0)) return;
    add_at(report, source, road, speed,
           fmt::format("speed limit is {:.1f} m/s ({:.0f} km/h); correct the value or its unit",
                       speed_mps, 3.6 * speed_mps));
  });
}

constexpr std::array<SourceRule, 11> kSignalRules = {{
    {{"signal.station", {}, validation::Severity::warning, "a signal's s is not on its road"},
     signals_off_station},
    {{"object.station", {}, validation::Severity::warning, "an object's s is not on its road"},
     objects_off_station},
    {{"signal.validity-unknown",
      {},
      validation::Severity::warning,
      "a signal or object holds for lanes that are not there"},
     unknown_validity},
    {{"signal.validity-order", "asam.net:xodr:1.7.0:road.signal.reference.from_lower_equal_to",
      validation::Severity::warning,
      "a lane range of a signal or object begins with its larger lane"},
     reversed_validity},
    {{"signal.validity-orientation",
      "asam.net:xodr:1.7.0:road.signal.validity.right_hand_traffic_lane_ids",
      validation::Severity::info,
      "a signal or object holds for lanes that drive against its orientation"},
     validity_against_orientation},
    {{"signal.country", "asam.net:xodr:1.7.0:road.signal.use_country_code",
      validation::Severity::warning, "a signal's country is missing or unknown"},
     unknown_countries},
    {{"signal.no-type", "asam.net:xodr:1.7.0:road.signal.signal_type",
      validation::Severity::warning, "a signal has no type"},
     signals_without_type},
    {{"controller.empty", "asam.net:xodr:1.7.0:road.signal.controller.valid_for_signals",
      validation::Severity::warning, "a controller controls no signal"},
     empty_controllers},
    {{"speed.no-unit",
      {},
      validation::Severity::warning,
      "a speed limit of 40 or more has no unit, and so holds as m/s"},
     speeds_without_unit},
    {{"speed.unknown-unit", "asam.net:xodr:1.0.0:xml.valid_schema", validation::Severity::error,
      "a speed limit has a unit that the standard does not know"},
     unknown_units},
    {{"speed.absurd-limit",
      {},
      validation::Severity::warning,
      "a speed limit is not positive, or above --max-speed"},
     absurd_speeds},
}};

}  // namespace

std::span<const SourceRule> signal_rules() { return kSignalRules; }

}  // namespace roadbed::map::opendrive::rules
