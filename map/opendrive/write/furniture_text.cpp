#include "roadbed/map/opendrive/write/furniture_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <set>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/map/derived/crossings.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/map/opendrive/write/number_text.h"

namespace roadbed::map::opendrive {
namespace {

constexpr double kReach_m = 100.0;
constexpr double kStopLineWidth_m = 0.3;

/// A place beside a part of a road.
struct PartPlace {
  std::uint32_t part = 0;
  std::size_t section = 0;
  double s_m = 0.0, t_m = 0.0, z_offset_m = 0.0;  ///< s from the part's start
  double heading_rad = 0.0;                       ///< of the road there
  bool is_beside = true;                          ///< false: s is that of an end
};

/// A lane at one of its stations, in the written roads.
struct LaneSpot {
  std::uint32_t part = 0;
  double s_m = 0.0;  ///< from the part's start
  int id = 0;
  bool forward = true;
};

std::string_view object_type(std::string_view word) {
  static constexpr std::array<std::string_view, 15> words = {
      "obstacle",  "pole",         "tree",   "vegetation",   "barrier",
      "building",  "parkingSpace", "patch",  "railing",      "trafficIsland",
      "crosswalk", "streetLamp",   "gantry", "soundBarrier", "roadMark"};
  return std::find(words.begin(), words.end(), word) == words.end() ? "none" : word;
}

class FurnitureWriter {
 public:
  FurnitureWriter(const RoadMap& road_map, const RoadPlan& plan,
                  const std::vector<RoadShape>& shapes, const RoadNetwork& network, int minor)
      : road_map_(road_map), plan_(plan), shapes_(shapes), network_(network), minor_(minor) {
    made_.signals.resize(network.parts.size());
    made_.objects.resize(network.parts.size());
  }

  FurnitureText write() {
    for (const Signal& signal : road_map_.signals()) add(signal);
    for (const StopLine& line : road_map_.stop_lines()) add(line);
    for (const MapObject& object : road_map_.objects()) add(object);
    for (const Lane& lane : road_map_.lanes()) {
      if (is_crosswalk(lane) && !lane.polygon.empty()) add_crosswalk(lane);
    }
    for (const Controller& controller : road_map_.controllers()) add(controller);
    return std::move(made_);
  }

 private:
  template <typename... Values>
  static void add_to(std::string& text, fmt::format_string<Values...> words, Values&&... values) {
    fmt::format_to(std::back_inserter(text), words, std::forward<Values>(values)...);
  }

  const ReferenceTable& table(std::uint32_t road) {
    const auto found = tables_.find(road);
    if (found != tables_.end()) return found->second;
    return tables_.emplace(road, ReferenceTable(shapes_[road].plan_view)).first->second;
  }

  std::optional<LaneSpot> spot(LaneId id, std::optional<double> station_m) const {
    const auto& place = plan_.places[id.index];
    if (!place) return {};
    const PlannedSection& section = plan_.roads[place->road].sections[place->section];
    const Lane& lane = road_map_.lane(id);
    const double s_m = shapes_[place->road].sections[place->section].road_s_m(
        place->lane, station_m.value_or(lane.length_m()));
    const std::uint32_t part = part_at(place->road, s_m);
    return LaneSpot{part, std::max(0.0, s_m - network_.parts[part].from_m),
                    lane_id(section, place->lane), section.lanes[place->lane].forward};
  }

  std::uint32_t part_at(std::uint32_t road, double s_m) const {
    const auto& parts = network_.parts_of[road];
    const auto found = std::find_if(parts.begin(), parts.end(), [&](std::uint32_t part) {
      return s_m <= network_.parts[part].to_m;
    });
    return found == parts.end() ? parts.back() : *found;
  }

  PartPlace place_beside(std::uint32_t road, const Eigen::Vector2d& in_map, double z_m,
                         double near_s_m) {
    const RoadPosition at = position_beside(table(road), in_map, near_s_m);
    const RoadShape& shape = shapes_[road];
    PartPlace place;
    const double s_m = std::clamp(at.s_m, 0.0, shape.length_m);
    place.is_beside = std::abs(s_m - at.s_m) < 1e-3;
    place.part = part_at(road, s_m);
    place.section = section_before(shape, s_m);
    place.s_m = std::max(0.0, s_m - network_.parts[place.part].from_m);
    place.heading_rad = table(road).at(s_m).heading_rad();
    const double lean_rad = shape.superelevation.at(s_m).value;
    const double above_m = z_m - shape.elevation.at(s_m).value;
    place.t_m = at.t_m * std::cos(lean_rad) + above_m * std::sin(lean_rad);
    place.z_offset_m = above_m * std::cos(lean_rad) - at.t_m * std::sin(lean_rad);
    return place;
  }

  // Beside the lane that it speaks to, else beside the nearest one.
  std::optional<PartPlace> place_of(const std::vector<LaneId>& lanes,
                                    const std::vector<double>& lane_s_m,
                                    const Eigen::Vector2d& in_map, double z_m) {
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      const auto& place = plan_.places[lanes[i].index];
      if (!place) continue;
      const double station_m =
          i < lane_s_m.size() ? lane_s_m[i] : road_map_.lane(lanes[i]).length_m();
      return place_beside(place->road, in_map, z_m, road_s_m(*place, station_m));
    }
    for (const LaneMatch& match : road_map_.locate(in_map, kReach_m, false)) {
      const auto& place = plan_.places[match.place.lane.index];
      if (place) return place_beside(place->road, in_map, z_m, road_s_m(*place, match.place.s_m));
    }
    return {};
  }

  double road_s_m(const LanePlaceInPlan& place, double station_m) const {
    return shapes_[place.road].sections[place.section].road_s_m(place.lane, station_m);
  }

  static std::string validity(const std::vector<int>& ids) {
    std::string text;
    for (const int id : ids) add_to(text, "<validity fromLane=\"{0}\" toLane=\"{0}\"/>", id);
    return text;
  }

  // Lanes by the part that they are on, in the order in which they are named.
  std::map<std::uint32_t, std::vector<LaneSpot>> spots(const std::vector<LaneId>& lanes,
                                                       const std::vector<double>& lane_s_m) const {
    std::map<std::uint32_t, std::vector<LaneSpot>> by_part;
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      const auto found =
          spot(lanes[i], i < lane_s_m.size() ? std::optional(lane_s_m[i]) : std::nullopt);
      if (found) by_part[found->part].push_back(*found);
    }
    return by_part;
  }

  static std::vector<int> ids_of(const std::vector<LaneSpot>& spots) {
    std::vector<int> ids;
    for (const LaneSpot& spot : spots) ids.push_back(spot.id);
    return ids;
  }

  static char orientation_of(const std::vector<LaneSpot>& spots) {
    return spots.front().forward ? '+' : '-';
  }

  void add(const Signal& signal) {
    const auto place = place_of(signal.lanes, signal.lane_s_m, signal.in_map, signal.z_m);
    if (!place || !signal_ids_.insert(signal.source_id).second) {
      ++made_.lost_signals;
      return;
    }
    const auto by_part = spots(signal.lanes, signal.lane_s_m);
    const auto own = by_part.find(place->part);
    const char side = own != by_part.end() ? orientation_of(own->second) : '+';
    const double faces_rad = place->heading_rad + (side == '-' ? 0.0 : std::numbers::pi);
    std::string& text = made_.signals[place->part];
    add_to(text,
           "<signal s=\"{}\" t=\"{}\" id=\"{}\" name=\"{}\" dynamic=\"{}\" orientation=\"{}\"",
           short_number(place->s_m), short_number(place->t_m), xml_text(signal.source_id),
           xml_text(signal.name), signal.dynamic ? "yes" : "no", side);
    add_to(text, " zOffset=\"{}\"{} type=\"{}\" subtype=\"{}\"", short_number(place->z_offset_m),
           country(signal.country), xml_text(signal.type.empty() ? "-1" : signal.type),
           xml_text(signal.subtype.empty() ? "-1" : signal.subtype));
    if (signal.value) add_value(*signal.value, signal.unit, text);
    if (!signal.text.empty()) add_to(text, " text=\"{}\"", xml_text(signal.text));
    for (const auto& [key, size_m] : signal.attributes) {
      if (key == "height" || key == "width") add_to(text, " {}=\"{}\"", key, xml_text(size_m));
    }
    if (signal.heading_rad) {
      add_to(text, " hOffset=\"{}\"",
             short_number(geometry::wrap_angle(*signal.heading_rad - faces_rad)));
    }
    text += '>';
    text += validity(own != by_part.end() ? ids_of(own->second) : std::vector<int>{0});
    if (!place->is_beside && minor_ >= 5) {
      const Eigen::Vector2d at = road_map_.to_source(signal.in_map);
      add_to(text, "<positionInertial x=\"{}\" y=\"{}\" z=\"{}\" hdg=\"{}\"/>",
             short_number(at.x()), short_number(at.y()), short_number(signal.z_m),
             short_number(
                 geometry::wrap_angle(signal.heading_rad.value_or(faces_rad) + std::numbers::pi)));
    }
    text += "</signal>\n";
    for (const auto& [part, spots] : by_part) {
      if (part != place->part) refer(signal, part, spots);
    }
  }

  // As the schema has it: a code of ISO 3166, or what older files write.
  static std::string country(const std::string& word) {
    const bool is_code =
        (word.size() == 2 || word.size() == 3) &&
        std::all_of(word.begin(), word.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
    return is_code || word == "OpenDRIVE" ? fmt::format(" country=\"{}\"", word) : "";
  }

  static void add_value(double value, const std::string& unit, std::string& text) {
    static const std::set<std::string_view> units = {"m",   "km",   "ft", "mile", "m/s",
                                                     "mph", "km/h", "kg", "t",    "%"};
    add_to(text, " value=\"{}\"", value);
    if (units.contains(unit)) add_to(text, " unit=\"{}\"", unit);
  }

  // <signalReference>s come after the signals of their road.
  void refer(const Signal& signal, std::uint32_t part, const std::vector<LaneSpot>& spots) {
    add_to(references_[part],
           "<signalReference s=\"{}\" t=\"0\" id=\"{}\" orientation=\"{}\">{}</signalReference>\n",
           short_number(spots.front().s_m), xml_text(signal.source_id), orientation_of(spots),
           validity(ids_of(spots)));
  }

  void add(const StopLine& line) {
    const Eigen::Vector3d middle = 0.5 * (line.in_map.front() + line.in_map.back());
    const Eigen::Vector2d along = (line.in_map.back() - line.in_map.front()).head<2>();
    const auto place = place_of(line.lanes, {}, middle.head<2>(), middle.z());
    if (!place || !(along.norm() > 1e-3)) {
      ++made_.lost_stop_lines;
      return;
    }
    const auto by_part = spots(line.lanes, {});
    const auto own = by_part.find(place->part);
    const char side = own != by_part.end() ? orientation_of(own->second) : '+';
    const double across_rad =
        std::atan2(along.y(), along.x()) - 0.5 * std::numbers::pi - place->heading_rad;
    std::string& text = made_.objects[place->part];
    add_to(text,
           "<object type=\"{}\" name=\"StopLine\" id=\"{}\" s=\"{}\" t=\"{}\" zOffset=\"{}\" "
           "orientation=\"{}\" hdg=\"{}\" length=\"{}\" width=\"{}\">",
           minor_ >= 8 ? "roadMark" : "none", object_id(line.source_id), short_number(place->s_m),
           short_number(place->t_m), short_number(place->z_offset_m), side,
           short_number(geometry::wrap_angle(across_rad)),
           short_number(std::min(kStopLineWidth_m, 0.5 * along.norm())),
           short_number(along.norm()));
    if (own != by_part.end()) text += validity(ids_of(own->second));
    text += "</object>\n";
  }

  void add(const MapObject& object) {
    if (is_stop_line(object)) return;  // is one of the stop lines
    add_object(object.source_id, object.name.empty() ? object.type : object.name,
               object_type(object.type), object.in_map, object.outline_in_map, object.z_m,
               object.height_m);
  }

  static bool is_stop_line(const MapObject& object) {
    std::string letters;
    for (const char c : object.name + object.type) {
      if (std::isalpha(static_cast<unsigned char>(c)) != 0) letters += static_cast<char>(c | 0x20);
    }
    return letters.find("stopline") != std::string::npos;
  }

  void add_crosswalk(const Lane& lane) {
    const double middle_m = 0.5 * lane.length_m();
    const Eigen::Vector2d at = lane.centre.in_map.at(middle_m);
    add_object(lane.name, "crosswalk", "crosswalk", at, lane.polygon, lane.centre.z_m.front(), 0.0);
  }

  void add_object(const std::string& id, const std::string& name, std::string_view type,
                  const Eigen::Vector2d& in_map, const geometry::Ring& outline, double z_m,
                  double height_m) {
    Eigen::Vector2d middle = in_map;
    if (!outline.empty()) {
      middle = {0, 0};
      for (const Eigen::Vector2d& corner : outline) middle += corner;
      middle /= static_cast<double>(outline.size());
    }
    const auto place = place_of({}, {}, middle, z_m);
    if (!place) {
      ++made_.lost_objects;
      return;
    }
    std::string& text = made_.objects[place->part];
    const Eigen::Vector2d from = foot_of(*place);
    add_to(text,
           "<object type=\"{}\" name=\"{}\" id=\"{}\" s=\"{}\" t=\"{}\" zOffset=\"{}\" "
           "orientation=\"none\" hdg=\"{}\" height=\"{}\">",
           type, xml_text(name), object_id(id), short_number(place->s_m), short_number(place->t_m),
           short_number(place->z_offset_m), short_number(geometry::wrap_angle(-place->heading_rad)),
           short_number(height_m));
    if (!outline.empty()) {
      text += "<outline>";
      int corner_id = 0;
      for (const Eigen::Vector2d& corner : outline) {
        const Eigen::Vector2d off = corner - from;
        add_to(text, "<cornerLocal u=\"{}\" v=\"{}\" z=\"0\" height=\"{}\"", short_number(off.x()),
               short_number(off.y()), short_number(height_m));
        if (minor_ >= 5) add_to(text, " id=\"{}\"", corner_id++);
        text += "/>";
      }
      text += "</outline>";
    }
    text += "</object>\n";
  }

  // The point from which an object's corners are counted: a place before or behind a road is moved
  // to the road's end.
  Eigen::Vector2d foot_of(const PartPlace& place) {
    const RoadPart& part = network_.parts[place.part];
    const RoadShape& shape = shapes_[part.road];
    const double s_m = part.from_m + place.s_m;
    const double lean_rad = shape.superelevation.at(s_m).value;
    const double t_m = place.t_m * std::cos(lean_rad) - place.z_offset_m * std::sin(lean_rad);
    return table(part.road).at(s_m).beside(t_m);
  }

  void add(const Controller& controller) {
    std::string controls;
    std::set<std::string_view> named;
    for (const std::string& id : controller.signals) {
      if (!signal_ids_.contains(id) || !named.insert(id).second) continue;
      add_to(controls, "<control signalId=\"{}\" type=\"\"/>", xml_text(id));
    }
    if (controls.empty()) return;
    add_to(made_.controllers, "<controller id=\"{}\" name=\"{}\">{}</controller>\n",
           xml_text(controller.source_id), xml_text(controller.name), controls);
  }

  std::string object_id(const std::string& wanted) {
    if (!wanted.empty() && object_ids_.insert(wanted).second) return xml_text(wanted);
    std::string made;
    do {
      made = fmt::format("object{}", ++objects_named_);
    } while (!object_ids_.insert(made).second);
    return made;
  }

 public:
  // Signals of a part, with its references behind them.
  void finish(FurnitureText& text) const {
    for (const auto& [part, references] : references_) text.signals[part] += references;
  }

 private:
  const RoadMap& road_map_;
  const RoadPlan& plan_;
  const std::vector<RoadShape>& shapes_;
  const RoadNetwork& network_;
  int minor_;
  FurnitureText made_;
  std::map<std::uint32_t, ReferenceTable> tables_;
  std::map<std::uint32_t, std::string> references_;
  std::set<std::string> signal_ids_, object_ids_;
  std::size_t objects_named_ = 0;
};

}  // namespace

FurnitureText furniture_text(const RoadMap& road_map, const RoadPlan& plan,
                             const std::vector<RoadShape>& shapes, const RoadNetwork& network,
                             int minor) {
  FurnitureWriter writer(road_map, plan, shapes, network, minor);
  FurnitureText text = writer.write();
  writer.finish(text);
  return text;
}

}  // namespace roadbed::map::opendrive
