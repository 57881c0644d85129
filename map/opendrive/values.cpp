#include "roadbed/map/opendrive/values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

namespace roadbed::map::opendrive {
namespace {

constexpr double kBroken = std::numeric_limits<double>::quiet_NaN();

}  // namespace

template <typename Read>
void AttributeReader::keep_fault_of(const Read& read) {
  if (fault_) return;  // throwing costs more than reading, and a file may be nothing but faults
  try {
    read();
  } catch (const InputError& error) {
    fault_ = error;
  }
}

double AttributeReader::number(pugi::xml_node node, const char* attribute) {
  pugi::xml_attribute first;
  return number(node, attribute, first);
}

double AttributeReader::number(pugi::xml_node node, const char* attribute,
                               pugi::xml_attribute& next) {
  if (const auto found = xml.optional_number(node, attribute, next)) return *found;
  double value = kBroken;
  keep_fault_of([&] { value = xml.number(node, attribute); });  // the first, where one is repeated
  return value;
}

double AttributeReader::number_or(pugi::xml_node node, const char* attribute, double fallback) {
  pugi::xml_attribute found = node.attribute(attribute);
  return found ? number(node, attribute, found) : fallback;
}

double AttributeReader::station_m(pugi::xml_node node, const char* attribute) {
  pugi::xml_attribute first;
  return station_m(node, attribute, first);
}

double AttributeReader::station_m(pugi::xml_node node, const char* attribute,
                                  pugi::xml_attribute& next) {
  const double value_m = number(node, attribute, next);
  if (std::abs(value_m) > kLongestRoadM) {
    refuse(node, fmt::format("{} {:.3g} m", attribute, value_m), "at most 1e6 m",
           "correct the station");
  }
  return value_m;
}

std::optional<int> AttributeReader::integer(pugi::xml_node node, const char* attribute) {
  const std::optional<int> value = xml.optional_integer(node, attribute);
  if (!value) keep_fault_of([&] { static_cast<void>(xml.integer(node, attribute)); });
  return value;
}

std::string AttributeReader::text(pugi::xml_node node, const char* attribute) {
  std::string value = node.attribute(attribute).value();
  if (value.empty()) keep_fault_of([&] { static_cast<void>(xml.text(node, attribute)); });
  return value;
}

void AttributeReader::refuse(pugi::xml_node node, const std::string& found,
                             const std::string& needed, const std::string& remedy) {
  keep_fault_of([&] { xml.refuse(node, found, needed, remedy); });
}

geometry::CubicRecord read_cubic(AttributeReader& in, pugi::xml_node node, const char* s_attribute,
                                 double s_add_m) {
  pugi::xml_attribute next;
  const geometry::CubicRecord record{s_add_m + in.station_m(node, s_attribute, next),
                                     in.number(node, "a", next), in.number(node, "b", next),
                                     in.number(node, "c", next), in.number(node, "d", next)};
  constexpr double largest = 1e200;  // so that sums of them stay finite
  for (const double value : {record.a, record.b, record.c, record.d}) {
    if (std::abs(value) > largest) {
      in.refuse(node, fmt::format("a coefficient of {:.3g}", value), "a value of a road",
                "correct the value");
    }
  }
  return record;
}

std::vector<CubicElement> read_cubics(AttributeReader& in, pugi::xml_node parent, const char* name,
                                      const char* s_attribute, double s_add_m) {
  std::vector<CubicElement> records;
  for (const auto node : parent.children(name)) {
    records.push_back({node, read_cubic(in, node, s_attribute, s_add_m)});
  }
  return records;
}

void begin_at_zero(std::vector<geometry::CubicRecord>& records) {
  if (!records.empty() && records.front().s_m > kRoundingM) records.insert(records.begin(), {{}});
}

std::optional<double> read_speed(const XmlDocument& xml, pugi::xml_node speed,
                                 std::vector<ImportDiagnostic>& remarks) {
  const std::string_view written = speed.attribute("max").value();
  if (written == "no limit") return std::numeric_limits<double>::infinity();
  if (written.empty() || written == "undefined") return {};
  const std::string_view unit = speed.attribute("unit").value();
  const double to_mps = unit.empty() || unit == "m/s" ? 1.0
                        : unit == "km/h"              ? 1.0 / 3.6
                        : unit == "mph"               ? 0.44704
                                                      : 0.0;
  const std::optional<double> max = xml.optional_number(speed, "max");
  if (!max || *max < 0.0 || *max > 1e4 || to_mps == 0.0) {
    remarks.push_back(
        {"import.speed", true, xml.place_of(speed), xml.line_of(speed),
         fmt::format("max=\"{}\" unit=\"{}\" is no speed in m/s, km/h or mph; the limit "
                     "counts as unknown, correct it",
                     written, unit)});
    return {};
  }
  return *max * to_mps;
}

bool is_true(std::string_view word) { return word == "true" || word == "1"; }

char orientation_of(std::string_view word) {
  return word == "+" || word == "-" ? word.front() : '\0';
}

LaneRanges read_lane_ranges(AttributeReader& in, pugi::xml_node node) {
  LaneRanges ranges;
  for (const auto validity : node.children("validity")) {
    const auto from = in.integer(validity, "fromLane"), to = in.integer(validity, "toLane");
    if (from && to) ranges.emplace_back(std::minmax({*from, *to}));
  }
  return ranges;
}

void keep_attributes(pugi::xml_node node, std::initializer_list<const char*> names,
                     Attributes& attributes) {
  for (const char* name : names) {
    if (const auto found = node.attribute(name)) attributes.emplace_back(name, found.value());
  }
}

ImportDiagnostic left_out(const char* rule, const InputError& error) {
  const InputError::Parts& parts = error.parts();
  return {rule, true, parts.element, std::strtol(parts.place.c_str(), nullptr, 10),
          fmt::format("{}, needs {}; it is left out, {}", parts.found, parts.needed, parts.remedy)};
}

std::string described(pugi::xml_node node) {
  std::string text;
  for (const auto attribute : node.attributes()) {
    if (!text.empty()) text += ", ";
    text += attribute.name();
    text += ' ';
    text += attribute.value();
  }
  return text;
}

Participants participants_of(LaneType type) {
  switch (type) {
    case LaneType::bus:
      return {Participant::bus, Participant::emergency};
    case LaneType::taxi:
      return {Participant::taxi, Participant::emergency};
    case LaneType::biking:
      return {Participant::bicycle};
    case LaneType::sidewalk:
      return {Participant::pedestrian};
    case LaneType::tram:
      return {Participant::tram};
    case LaneType::rail:
      return {Participant::train};
    default:
      return is_surface(type) ? Participants::vehicles() : Participants{};
  }
}

LaneType lane_type(std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, LaneType>, 31> words = {{
      {"none", LaneType::none},
      {"driving", LaneType::driving},
      {"bidirectional", LaneType::bidirectional},
      {"entry", LaneType::entry},
      {"mwyEntry", LaneType::entry},
      {"exit", LaneType::exit},
      {"mwyExit", LaneType::exit},
      {"onRamp", LaneType::on_ramp},
      {"offRamp", LaneType::off_ramp},
      {"connectingRamp", LaneType::connecting_ramp},
      {"slipLane", LaneType::connecting_ramp},
      {"shoulder", LaneType::shoulder},
      {"stop", LaneType::stop},
      {"parking", LaneType::parking},
      {"border", LaneType::border},
      {"biking", LaneType::biking},
      {"sidewalk", LaneType::sidewalk},
      {"walking", LaneType::sidewalk},
      {"shared", LaneType::other},
      {"curb", LaneType::curb},
      {"median", LaneType::median},
      {"restricted", LaneType::restricted},
      {"roadWorks", LaneType::roadworks},
      {"tram", LaneType::tram},
      {"rail", LaneType::rail},
      {"bus", LaneType::bus},
      {"taxi", LaneType::taxi},
      {"HOV", LaneType::driving},
      {"special1", LaneType::other},
      {"special2", LaneType::other},
      {"special3", LaneType::other},
  }};
  const auto found =
      std::find_if(words.begin(), words.end(), [&](const auto& w) { return w.first == word; });
  return found == words.end() ? LaneType::other : found->second;
}

}  // namespace roadbed::map::opendrive
