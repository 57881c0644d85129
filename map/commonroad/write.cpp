#include "roadbed/map/commonroad/write.h"

#include <fmt/format.h>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <iterator>
#include <set>

#include "roadbed/map/commonroad/plan.h"
#include "roadbed/map/commonroad/values.h"
#include "roadbed/map/files/xml_characters.h"

namespace roadbed::map::commonroad {
namespace {

/// The shortest decimal that reads back as the same double; XML Schema's decimals have no exponent.
std::string decimal(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find('e') != std::string::npos) text = fmt::format("{:.17f}", value);
  return text;
}

/// A border's point and height at a station.
Eigen::Vector3d point_at(const LaneLine& line, double station_m) {
  const auto& stations = line.station_m;
  const auto& points = line.in_map.points();
  const auto after = std::upper_bound(stations.begin(), stations.end(), station_m);
  const auto at = [&](std::size_t i) {
    return Eigen::Vector3d(points[i].x(), points[i].y(), line.z_m[i]);
  };
  if (after == stations.begin()) return at(0);
  if (after == stations.end()) return at(points.size() - 1);
  const auto i = static_cast<std::size_t>(after - stations.begin());
  const double fraction = (station_m - stations[i - 1]) / (stations[i] - stations[i - 1]);
  return at(i - 1) + fraction * (at(i) - at(i - 1));
}

/// The marking along most of a lane; without any, what the right to change lanes says.
std::string_view marking(const Lane& lane, const std::vector<BorderMark>& marks,
                         const std::optional<Neighbour>& beside) {
  if (marks.empty()) {
    if (!beside || !beside->same_direction) return "unknown";
    return beside->change_allowed() ? "dashed" : "solid";
  }
  std::size_t longest = 0;
  double longest_m = -1.0;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const double to_m = i + 1 < marks.size() ? marks[i + 1].from_s_m : lane.length_m();
    if (to_m - marks[i].from_s_m > longest_m) {
      longest_m = to_m - marks[i].from_s_m;
      longest = i;
    }
  }
  return marking_word(marks[longest]);
}

bool has_elevation(const RoadMap& road_map) {
  const auto raised = [](const LaneLine& line) {
    return std::any_of(line.z_m.begin(), line.z_m.end(), [](double z_m) { return z_m != 0.0; });
  };
  return std::any_of(road_map.lanes().begin(), road_map.lanes().end(),
                     [&](const Lane& lane) { return raised(lane.left) || raised(lane.right); });
}

class FileWriter {
 public:
  FileWriter(const RoadMap& road_map, const Plan& plan)
      : road_map_(road_map), plan_(plan), with_z_(has_elevation(road_map)) {}

  std::string write() {
    add_header();
    for (const Lane& lane : road_map_.lanes()) {
      if (is_written(lane.id)) add_lanelet(lane);
    }
    for (const PlannedSign& sign : plan_.signs) add_sign(sign);
    for (const PlannedLight& light : plan_.lights) add_light(light);
    for (const PlannedIntersection& intersection : plan_.intersections) {
      add_intersection(intersection);
    }
    text_ += "</commonRoad>\n";
    return std::move(text_);
  }

 private:
  template <typename... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
  }

  bool is_written(LaneId id) const { return plan_.lane_ids[id.index] != kNoLanelet; }

  std::string file_attribute(std::string_view key, const std::string& fallback) const {
    for (const auto& [name, value] : road_map_.attributes()) {
      if (name == key) return xml_text(value);
    }
    return fallback;
  }

  // What CommonRoad wants and the map does not know gets the value that the format has for that:
  // geoNameId -999, latitude and longitude 999; the date is that of nothing.
  void add_header() {
    text_ += "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
    add("<commonRoad timeStepSize=\"{}\" commonRoadVersion=\"2020a\" author=\"{}\" "
        "affiliation=\"{}\" source=\"{}\" benchmarkID=\"{}\" date=\"{}\">\n",
        file_attribute("timeStepSize", "0.1"), file_attribute("author", ""),
        file_attribute("affiliation", ""), file_attribute("source", "roadbed"),
        xml_text(plan_.benchmark_id), file_attribute("date", "1970-01-01"));
    add(" <location><geoNameId>{}</geoNameId><gpsLatitude>{}</gpsLatitude>"
        "<gpsLongitude>{}</gpsLongitude>",
        file_attribute("geoNameId", "-999"), file_attribute("gpsLatitude", "999"),
        file_attribute("gpsLongitude", "999"));
    if (!road_map_.crs().empty()) {
      const CrsOffset& offset = road_map_.offset_in_crs();
      add("<geoTransformation><geoReference>{}</geoReference><additionalTransformation>"
          "<xTranslation>{}</xTranslation><yTranslation>{}</yTranslation>"
          "<zRotation>{}</zRotation><scaling>{}</scaling></additionalTransformation>"
          "</geoTransformation>",
          xml_text(road_map_.crs()), decimal(offset.x_m), decimal(offset.y_m),
          decimal(offset.heading_rad), file_attribute("scaling", "1"));
    }
    text_ += "</location>\n <scenarioTags/>\n";
  }

  void add_point(const Eigen::Vector2d& in_map, std::optional<double> z_m) {
    const Eigen::Vector2d in_source = road_map_.to_source(in_map);
    add("<point><x>{}</x><y>{}</y>", decimal(in_source.x()), decimal(in_source.y()));
    if (z_m) add("<z>{}</z>", decimal(*z_m));
    text_ += "</point>";
  }

  void add_bound(const char* name, const LaneLine& line, const std::vector<double>& stations_m,
                 std::string_view marking_word) {
    add("  <{}>\n", name);
    const bool as_it_is = stations_m.empty();
    const std::size_t count = as_it_is ? line.in_map.points().size() : stations_m.size();
    for (std::size_t i = 0; i < count; ++i) {
      text_ += "   ";
      Eigen::Vector3d at;
      if (as_it_is) {
        at << line.in_map.points()[i], line.z_m[i];
      } else {
        at = point_at(line, stations_m[i]);
      }
      add_point(at.head<2>(), with_z_ ? std::optional(at.z()) : std::nullopt);
      text_ += '\n';
    }
    add("   <lineMarking>{}</lineMarking>\n  </{}>\n", marking_word, name);
  }

  void add_bounds(const Lane& lane) {
    // CommonRoad pairs the points of both borders. Where the map's do not pair, each gets a point
    // at every station of the other.
    std::vector<double> stations_m;
    if (lane.left.station_m != lane.right.station_m) {
      std::set_union(lane.left.station_m.begin(), lane.left.station_m.end(),
                     lane.right.station_m.begin(), lane.right.station_m.end(),
                     std::back_inserter(stations_m));
    }
    const LaneLinks& links = road_map_.graph().of(lane.id);
    add_bound("leftBound", lane.left, stations_m, marking(lane, lane.left_marks, links.left));
    add_bound("rightBound", lane.right, stations_m, marking(lane, lane.right_marks, links.right));
  }

  void add_references(const char* name, const std::vector<LaneId>& lanes) {
    for (const LaneId id : lanes) {
      if (is_written(id)) add("  <{} ref=\"{}\"/>\n", name, plan_.lane_ids[id.index]);
    }
  }

  void add_references(const char* name, const std::vector<std::uint64_t>& ids) {
    for (const std::uint64_t id : ids) add("  <{} ref=\"{}\"/>\n", name, id);
  }

  void add_adjacent(const char* name, const std::optional<Neighbour>& beside) {
    if (!beside || !is_written(beside->lane)) return;
    add("  <{} ref=\"{}\" drivingDir=\"{}\"/>\n", name, plan_.lane_ids[beside->lane.index],
        beside->same_direction ? "same" : "opposite");
  }

  void add_lanelet(const Lane& lane) {
    add(" <lanelet id=\"{}\">\n", plan_.lane_ids[lane.id.index]);
    add_bounds(lane);
    const LaneLinks& links = road_map_.graph().of(lane.id);
    add_references("predecessor", links.predecessors);
    add_references("successor", links.successors);
    add_adjacent("adjacentLeft", links.left);
    add_adjacent("adjacentRight", links.right);
    add_stop_line(lane);
    add_use(lane);
    add_references("trafficSignRef", plan_.sign_ids[lane.id.index]);
    add_references("trafficLightRef", plan_.light_ids[lane.id.index]);
    text_ += " </lanelet>\n";
  }

  void add_stop_line(const Lane& lane) {
    const StopLine* line = plan_.stop_lines[lane.id.index];
    if (!line) return;
    text_ += "  <stopLine>";
    for (const Eigen::Vector3d& end : {line->in_map.front(), line->in_map.back()}) {
      add_point(end.head<2>(), with_z_ ? std::optional(end.z()) : std::nullopt);
    }
    text_ += "<lineMarking>solid</lineMarking>";
    add_stop_reasons("trafficSignRef", *line, plan_.sign_by_source);
    add_stop_reasons("trafficLightRef", *line, plan_.light_by_source);
    text_ += "</stopLine>\n";
  }

  void add_stop_reasons(const char* name, const StopLine& line,
                        const std::map<std::string, std::uint64_t, std::less<>>& ids) {
    for (const std::string& signal : line.signals) {
      if (const auto found = ids.find(signal); found != ids.end()) {
        add("<{} ref=\"{}\"/>", name, found->second);
      }
    }
  }

  void add_use(const Lane& lane) {
    bool said = false;
    for (const auto& [name, word] : lane.attributes) {
      if (name != "laneletType" && name != "userOneWay" && name != "userBidirectional") continue;
      add("  <{0}>{1}</{0}>\n", name, xml_text(word));
      said = said || name == "laneletType";
    }
    if (said) return;
    add("  <laneletType>{}</laneletType>\n", type_word(lane.type));
    if (lane.junction && is_drivable(lane.type)) {
      text_ += "  <laneletType>intersection</laneletType>\n";
    }
    const char* name = lane.one_way ? "userOneWay" : "userBidirectional";
    for (const std::string_view word : user_words(lane.participants)) {
      add("  <{0}>{1}</{0}>\n", name, word);
    }
  }

  void add_sign(const PlannedSign& sign) {
    add(" <trafficSign id=\"{}\">", sign.id);
    for (const PlannedSign::Element& element : sign.elements) {
      add("<trafficSignElement><trafficSignID>{}</trafficSignID>", xml_text(element.sign_id));
      for (const std::string& value : element.values) {
        add("<additionalValue>{}</additionalValue>", xml_text(value));
      }
      text_ += "</trafficSignElement>";
    }
    text_ += "<position>";
    add_point(sign.in_map, {});
    add("</position><virtual>{}</virtual></trafficSign>\n", sign.is_virtual);
  }

  // A light whose cycle the map does not know is written as one that is off.
  void add_light(const PlannedLight& light) {
    add(" <trafficLight id=\"{}\"><cycle>", light.id);
    bool has_cycle = false;
    std::string offset, rest;
    for (const auto& [name, value] : light.signal->attributes) {
      const std::size_t blank = value.find(' ');
      if (name == "cycleElement" && blank != std::string::npos) {
        add("<cycleElement><duration>{}</duration><color>{}</color></cycleElement>",
            xml_text(value.substr(blank + 1)), xml_text(value.substr(0, blank)));
        has_cycle = true;
      }
      if (name == "timeOffset") offset = fmt::format("<{0}>{1}</{0}>", name, xml_text(value));
      if (name == "direction" || name == "active") {
        rest += fmt::format("<{0}>{1}</{0}>", name, xml_text(value));
      }
    }
    if (!has_cycle) {
      text_ += "<cycleElement><duration>1</duration><color>inactive</color></cycleElement>";
    }
    text_ += offset + "</cycle><position>";
    add_point(light.signal->in_map, {});
    text_ += "</position>" + rest + "</trafficLight>\n";
  }

  void add_intersection(const PlannedIntersection& intersection) {
    add(" <intersection id=\"{}\">\n", intersection.id);
    for (const PlannedIncoming& incoming : intersection.incomings) {
      add("  <incoming id=\"{}\">\n", incoming.id);
      add_references("incomingLanelet", incoming.lanes);
      add_references("successorsRight", incoming.right);
      add_references("successorsStraight", incoming.straight);
      add_references("successorsLeft", incoming.left);
      if (incoming.is_left_of != 0) add("  <isLeftOf ref=\"{}\"/>\n", incoming.is_left_of);
      text_ += "  </incoming>\n";
    }
    if (!intersection.crossings.empty()) {
      text_ += "  <crossing>\n";
      add_references("crossingLanelet", intersection.crossings);
      text_ += "  </crossing>\n";
    }
    text_ += " </intersection>\n";
  }

  const RoadMap& road_map_;
  const Plan& plan_;
  bool with_z_;
  std::string text_;
};

class LossCounter {
 public:
  explicit LossCounter(const RoadMap& road_map) : road_map_(road_map), plan_(make_plan(road_map)) {}

  std::vector<std::pair<std::string, std::size_t>> count() {
    count_lanes();
    lose("signs that speak to no lane, or say another limit than its own", plan_.lost_signs);
    const std::set<const StopLine*> written(plan_.stop_lines.begin(), plan_.stop_lines.end());
    lose("stop lines", std::ranges::count_if(road_map_.stop_lines(), [&](const StopLine& line) {
           return !written.contains(&line);
         }));
    lose("objects", std::ssize(road_map_.objects()));
    lose("areas", std::ssize(road_map_.areas()));
    lose("controllers", std::ssize(road_map_.controllers()));
    lose("regulations but for limits, traffic lights and intersections",
         std::ranges::count_if(road_map_.regulations(), [](const Regulation& one) {
           return one.type != "speed_limit" && one.type != "traffic_light" &&
                  one.type != "intersection";
         }));
    return std::move(lost_);
  }

 private:
  void lose(const char* what, std::integral auto count) {
    if (count > 0) lost_.emplace_back(what, static_cast<std::size_t>(count));
  }

  void count_lanes() {
    std::ptrdiff_t unsaid = 0, slowing = 0, repainted = 0;
    for (const Lane& lane : road_map_.lanes()) {
      if (plan_.lane_ids[lane.id.index] == kNoLanelet) {
        ++unsaid;
        continue;
      }
      slowing += lane.speed_limits.size() > 1 ? 1 : 0;
      for (const auto* marks : {&lane.left_marks, &lane.right_marks}) {
        repainted += std::ranges::any_of(*marks, [&](const BorderMark& mark) {
          return marking_word(mark) != marking_word(marks->front());
        });
      }
    }
    lose("lanes of type none", unsaid);
    lose("changes of the speed limit along a lane, which has the least", slowing);
    lose("changes of the marking along a border, which has the longest", repainted);
  }

  const RoadMap& road_map_;
  const Plan plan_;
  std::vector<std::pair<std::string, std::size_t>> lost_;
};

}  // namespace

std::string write_common_road(const RoadMap& road_map) {
  return FileWriter(road_map, make_plan(road_map)).write();
}

std::vector<std::pair<std::string, std::size_t>> lost_in_common_road(const RoadMap& road_map) {
  return LossCounter(road_map).count();
}

}  // namespace roadbed::map::commonroad
