#include "roadbed/map/commonroad/build_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "roadbed/map/commonroad/values.h"

namespace roadbed::map::commonroad {
namespace {

constexpr std::string_view kCrossing = "crossing";

/// Lanes by the sign or light that they refer to.
using LanesByReference = std::map<std::string, std::vector<LaneId>, std::less<>>;

LanesByReference lanes_by_reference(const BuiltLanes& built, const char* child) {
  LanesByReference found;
  for (const Lane& lane : built.lanes) {
    for (const std::string& id : references(built.elements[lane.id.index], child)) {
      std::vector<LaneId>& lanes = found[id];
      if (lanes.empty() || lanes.back() != lane.id) lanes.push_back(lane.id);
    }
  }
  return found;
}

std::optional<double> positive_number(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  if (!std::isfinite(value) || value < 0.0) return {};
  return value;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

class RuleReader {
 public:
  RuleReader(const Document& document, const std::string& country, BuiltLanes& built,
             RoadMapParts& parts)
      : document_(document), xml_(document.xml), country_(country), built_(built), parts_(parts) {}

  void read() {
    LanesByReference lanes = lanes_by_reference(built_, "trafficSignRef");
    for (const pugi::xml_node sign : xml_.root().children("trafficSign")) add_sign(sign, lanes);
    remark_missing(lanes, "trafficSign");
    lanes = lanes_by_reference(built_, "trafficLightRef");
    for (const pugi::xml_node light : xml_.root().children("trafficLight")) add_light(light, lanes);
    remark_missing(lanes, "trafficLight");
    for (const Lane& lane : built_.lanes) add_stop_line(lane);
    for (const pugi::xml_node node : xml_.root().children("intersection")) add_intersection(node);
  }

 private:
  void fault(const char* rule, pugi::xml_node node, const std::string& message,
             bool in_text = false) {
    parts_.remarks.push_back({rule, true,
                              fmt::format("{} {}", node.name(), node.attribute("id").value()),
                              xml_.line_of(node), message, in_text});
  }

  /// What signs and lights share. Takes the lanes that refer to it from the map.
  Signal signal_of(pugi::xml_node node, LanesByReference& lanes) {
    Signal signal;
    signal.source_id = node.attribute("id").value();
    signal.country = country_;
    if (const auto found = lanes.find(signal.source_id); found != lanes.end()) {
      signal.lanes = std::move(found->second);
      lanes.erase(found);
    }
    place(node, signal);
    return signal;
  }

  // Where the file gives no position: at the right border of the first lane that refers to it, at
  // its end (a sign of a rule that begins there stands at its start).
  void place(pugi::xml_node node, Signal& signal) {
    if (const pugi::xml_node point = node.child("position").child("point")) {
      const Eigen::Vector3d at = read_point(xml_, point, parts_.origin_in_source);
      signal.in_map = at.head<2>();
      signal.z_m = at.z();
    } else if (!signal.lanes.empty()) {
      const Lane& lane = built_.lanes[signal.lanes.front().index];
      signal.in_map = lane.right.in_map.points().back();
      signal.z_m = lane.right.z_m.back();
    } else {
      fault("import.signal-place", node, "it has no position, and no lanelet refers to it");
    }
  }

  void add_sign(pugi::xml_node node, LanesByReference& lanes) {
    Signal sign = signal_of(node, lanes);
    for (const pugi::xml_node element : node.children("trafficSignElement")) {
      add_sign_element(element, sign);
    }
    if (node.child("virtual"))
      sign.attributes.emplace_back("virtual", text_of(node.child("virtual")));
    parts_.signals.push_back(std::move(sign));
  }

  // The first element is the sign's type; further ones, on the same pole, are kept as attributes.
  void add_sign_element(pugi::xml_node element, Signal& sign) {
    const std::string id = text_of(element.child("trafficSignID"));
    const std::vector<std::string> values = texts(element, "additionalValue");
    const bool limits_speed = is_speed_limit(country_, id);
    const auto value = values.empty() ? std::nullopt : positive_number(values.front());
    if (limits_speed) limit_speed(element, sign, value);
    if (sign.type.empty()) {
      sign.type = id;
      sign.text = joined(values);
      sign.value = value;
      if (limits_speed && value) sign.unit = "m/s";
    } else {
      sign.attributes.emplace_back("trafficSignElement",
                                   values.empty() ? id : id + " " + joined(values));
    }
  }

  void limit_speed(pugi::xml_node element, const Signal& sign, std::optional<double> limit_mps) {
    if (!limit_mps) {
      fault("import.speed-limit", element.parent(),
            "a speed limit without a speed; it limits nothing");
      return;
    }
    for (const LaneId id : sign.lanes) {
      std::vector<SpeedLimit>& limits = built_.lanes[id.index].speed_limits;
      if (limits.empty()) limits = {{0.0, limit_mps}};
      limits.front().limit_mps = std::min(*limits.front().limit_mps, *limit_mps);
    }
  }

  void add_light(pugi::xml_node node, LanesByReference& lanes) {
    Signal light = signal_of(node, lanes);
    light.type = "trafficLight";
    light.dynamic = true;
    const pugi::xml_node cycle = node.child("cycle");
    for (const pugi::xml_node element : cycle.children("cycleElement")) {
      light.attributes.emplace_back("cycleElement", text_of(element.child("color")) + " " +
                                                        text_of(element.child("duration")));
    }
    for (const pugi::xml_node part :
         {cycle.child("timeOffset"), node.child("direction"), node.child("active")}) {
      if (part) light.attributes.emplace_back(part.name(), text_of(part));
    }
    parts_.signals.push_back(std::move(light));
  }

  // What lanes refer to and the file does not hold.
  void remark_missing(const LanesByReference& lanes, const char* kind) {
    for (const auto& [id, referring] : lanes) {
      fault("import.reference", built_.elements[referring.front().index],
            fmt::format("refers to {} {}, which is not there", kind, id), true);
    }
  }

  // Without points of its own, a stop line lies across the end of its lanelet. Where it names no
  // light, it holds for those of the lanelet, and where it names nothing, for the signs too.
  void add_stop_line(const Lane& lane) {
    const pugi::xml_node lanelet = built_.elements[lane.id.index];
    const pugi::xml_node node = lanelet.child("stopLine");
    if (!node) return;
    StopLine line;
    line.source_id = lane.name;
    line.in_map = read_points(xml_, node, parts_.origin_in_source);
    if (line.in_map.size() < 2) {
      const auto end = [](const LaneLine& border) {
        const Eigen::Vector2d& at = border.in_map.points().back();
        return Eigen::Vector3d(at.x(), at.y(), border.z_m.back());
      };
      line.in_map = {end(lane.left), end(lane.right)};
    }
    line.lanes = {lane.id};
    const bool names_light = node.child("trafficLightRef");
    const bool names_any = names_light || node.child("trafficSignRef");
    line.signals = references(names_any ? node : lanelet, "trafficSignRef");
    for (std::string& id : references(names_light ? node : lanelet, "trafficLightRef")) {
      line.signals.push_back(std::move(id));
    }
    parts_.stop_lines.push_back(std::move(line));
  }

  void add_intersection(pugi::xml_node node) {
    Regulation rule;
    rule.source_id = node.attribute("id").value();
    rule.type = "intersection";
    for (const pugi::xml_node incoming : node.children("incoming")) {
      add_incoming(node, incoming, rule);
    }
    for (const std::string& id : references(node.child("crossing"), "crossingLanelet")) {
      add_member(node, kCrossing, id, {}, rule);
    }
    const JunctionId junction{static_cast<std::uint32_t>(parts_.junctions.size())};
    parts_.junctions.push_back({junction, rule.source_id, {}, JunctionKind::common, {}});
    for (const RegulationMember& member : rule.members) {
      if (member.role == "incoming") rule.lanes.push_back(*member.lane);
      if (!member.role.starts_with("successors")) continue;
      // The first intersection that holds a lane has it.
      std::optional<JunctionId>& of_lane = built_.lanes[member.lane->index].junction;
      if (!of_lane) of_lane = junction;
    }
    parts_.regulations.push_back(std::move(rule));
  }

  void add_incoming(pugi::xml_node intersection, pugi::xml_node incoming, Regulation& rule) {
    struct Kind {
      const char *child, *role;
    };
    constexpr Kind kinds[] = {{"incomingLanelet", "incoming"},
                              {"successorsRight", "successors_right"},
                              {"successorsStraight", "successors_straight"},
                              {"successorsLeft", "successors_left"}};
    const Attributes of_incoming = {{"incoming", incoming.attribute("id").value()}};
    for (const Kind& kind : kinds) {
      for (const std::string& id : references(incoming, kind.child)) {
        add_member(intersection, kind.role, id, of_incoming, rule);
      }
    }
    for (const std::string& id : references(incoming, "isLeftOf")) {
      rule.members.push_back({"is_left_of", id, {}, {}, of_incoming});
    }
  }

  void add_member(pugi::xml_node intersection, std::string_view role, const std::string& lanelet,
                  const Attributes& attributes, Regulation& rule) {
    const std::optional<LaneId> lane = built_.find(lanelet);
    if (!lane) {
      fault("import.reference", intersection,
            fmt::format("names lanelet {}, which is not there", lanelet),
            role != kCrossing && !document_.lanelet_by_id.contains(lanelet));
      return;
    }
    rule.members.push_back({std::string(role), lanelet, lane, {}, attributes});
  }

  const Document& document_;
  const XmlDocument& xml_;
  const std::string& country_;
  BuiltLanes& built_;
  RoadMapParts& parts_;
};

}  // namespace

void add_rules(const Document& document, const std::string& country, BuiltLanes& built,
               RoadMapParts& parts) {
  RuleReader(document, country, built, parts).read();
}

}  // namespace roadbed::map::commonroad
