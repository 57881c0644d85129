#include "roadbed/map/formats/open_drive_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace roadbed::map::open_drive {

geometry::CubicRecord read_cubic(const XmlDocument& xml, pugi::xml_node node,
                                 const char* s_attribute, double s_add_m) {
  return {s_add_m + xml.number(node, s_attribute), xml.number(node, "a"), xml.number(node, "b"),
          xml.number(node, "c"), xml.number(node, "d")};
}

std::vector<geometry::CubicRecord> sorted(std::vector<geometry::CubicRecord> records) {
  std::stable_sort(records.begin(), records.end(),
                   [](const auto& a, const auto& b) { return a.s_m < b.s_m; });
  return records;
}

geometry::PiecewiseCubic read_cubics(const XmlDocument& xml, pugi::xml_node parent,
                                     const char* name, const char* s_attribute, double s_add_m) {
  std::vector<geometry::CubicRecord> records;
  for (const auto node : parent.children(name)) {
    records.push_back(read_cubic(xml, node, s_attribute, s_add_m));
  }
  return geometry::PiecewiseCubic(sorted(std::move(records)));
}

std::optional<double> read_speed(const XmlDocument& xml, pugi::xml_node speed) {
  const std::string_view written = speed.attribute("max").value();
  if (written.empty() || written == "no limit" || written == "undefined") return {};
  const std::string_view unit = speed.attribute("unit").value();
  const double max = xml.number(speed, "max");
  double to_mps = 1.0;
  if (unit == "km/h") {
    to_mps = 1.0 / 3.6;
  } else if (unit == "mph") {
    to_mps = 0.44704;
  } else if (!unit.empty() && unit != "m/s") {
    xml.refuse(speed, fmt::format("unit=\"{}\"", unit), "m/s, km/h or mph", "correct the unit");
  }
  if (max < 0.0) return {};
  return max * to_mps;
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
  static constexpr std::array<std::pair<std::string_view, LaneType>, 30> words = {{
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

}  // namespace roadbed::map::open_drive
