#include "roadbed/map/edit/road_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "roadbed/map/edit/lane_links.h"
#include "roadbed/map/edit/plan_cut.h"
#include "roadbed/map/edit/xml_edit.h"

namespace roadbed::map::inline edit {
namespace {

constexpr double kSameRecordM = 1e-9;  // stations this near are one

using Rebase = std::function<void(pugi::xml_node record, double by_m)>;

void keep_as_it_is(pugi::xml_node, double) {}

// a + b·s + c·s² + d·s³ about another s.
void rebase_cubic(pugi::xml_node record, double by_m) {
  const double a = number(record, "a"), b = number(record, "b"), c = number(record, "c"),
               d = number(record, "d");
  set_number(record, "a", a + by_m * (b + by_m * (c + by_m * d)));
  set_number(record, "b", b + by_m * (2.0 * c + by_m * 3.0 * d));
  set_number(record, "c", c + 3.0 * d * by_m);
}

// Stations that a list of records keeps.
struct Cut {
  double from_m, to_m;
  bool at_start, at_end;  ///< whether it is cut there
};

// Records that hold from their station on until the next: those that begin inside stay, and the one
// that holds at the start begins there. A cubic before the first record is that of the first.
void cut_records(const std::vector<pugi::xml_node>& records, const char* station, const Cut& cut,
                 bool extends, const Rebase& rebase) {
  if (records.empty()) return;
  double holding_m = -HUGE_VAL, first_m = HUGE_VAL;
  for (const pugi::xml_node record : records) {
    const double s_m = number(record, station);
    first_m = std::min(first_m, s_m);
    if (s_m <= cut.from_m) holding_m = std::max(holding_m, s_m);
  }
  if (extends && holding_m < first_m) holding_m = first_m;
  for (const pugi::xml_node record : records) {
    const double s_m = number(record, station);
    if (cut.at_start && s_m == holding_m) {
      rebase(record, cut.from_m - s_m);
      set_number(record, station, std::max(0.0, extends ? 0.0 : s_m - cut.from_m));
    } else if ((cut.at_start && s_m < holding_m) ||
               (cut.at_end && s_m >= cut.to_m - kSameRecordM)) {
      record.parent().remove_child(record);
    } else if (cut.at_start) {
      set_number(record, station, s_m - cut.from_m);
    }
  }
}

void cut_cubics(const std::vector<pugi::xml_node>& records, const char* station, const Cut& cut) {
  cut_records(records, station, cut, true, rebase_cubic);
}

void cut_crossfall(pugi::xml_node lateral, const Cut& cut) {
  std::set<std::string> sides;
  for (const auto record : lateral.children("crossfall")) {
    sides.insert(record.attribute("side").value());
  }
  for (const std::string& side : sides) {
    std::vector<pugi::xml_node> records = children(lateral, "crossfall");
    std::erase_if(records, [&](auto record) { return record.attribute("side").value() != side; });
    cut_cubics(records, "s", cut);
  }
}

// A pattern goes on; dashes that begin before are gone.
void move_pattern(pugi::xml_node line, double by_m) {
  const double start_m = number(line, "sOffset") - by_m;
  const double period_m = number(line, "length") + number(line, "space");
  const double behind_m = period_m > 0.0 ? period_m * std::ceil(-start_m / period_m) : 0.0;
  set_number(line, "sOffset", start_m >= 0.0 ? start_m : std::max(0.0, start_m + behind_m));
}

// A single line: the part inside stays.
void cut_line(pugi::xml_node line, double from_m, double to_m) {
  const double start_m = number(line, "sOffset"), length_m = number(line, "length");
  const double first_m = std::max(start_m, from_m), last_m = std::min(start_m + length_m, to_m);
  if (first_m >= last_m) {
    line.parent().remove_child(line);
  } else if (first_m > start_m || last_m < start_m + length_m || from_m > 0.0) {
    set_number(line, "sOffset", first_m - from_m);
    set_number(line, "length", last_m - first_m);
  }
}

// What a marking says of places behind its own start.
void cut_marking(pugi::xml_node mark, const Cut& cut) {
  const double s_m = number(mark, "sOffset");
  const double from_m = cut.at_start ? std::max(0.0, cut.from_m - s_m) : 0.0;
  const double to_m = cut.at_end ? cut.to_m - s_m : HUGE_VAL;
  for (const auto line : children(mark.child("explicit"), "line")) cut_line(line, from_m, to_m);
  if (from_m == 0.0) return;
  for (const auto line : children(mark.child("type"), "line")) move_pattern(line, from_m);
  cut_cubics(children(mark, "sway"), "ds", {from_m, to_m, true, false});
}

// Whatever in a lane begins at an offset from its section's start.
void cut_lane(pugi::xml_node lane, const Cut& cut) {
  std::set<std::string> names;
  for (const auto child : lane.children()) {
    if (child.attribute("sOffset")) names.insert(child.name());
  }
  for (const auto mark : children(lane, "roadMark")) cut_marking(mark, cut);
  for (const std::string& name : names) {
    const auto records = children(lane, name.c_str());
    if (name == "width" || name == "border") {
      cut_cubics(records, "sOffset", cut);
    } else {
      cut_records(records, "sOffset", cut, false, keep_as_it_is);
    }
  }
}

// Returns how many sections before the first one that stays are gone.
int cut_sections(pugi::xml_node lanes, double length_m, const Cut& cut) {
  std::vector<pugi::xml_node> sections = children(lanes, "laneSection");
  std::stable_sort(sections.begin(), sections.end(),
                   [](auto a, auto b) { return number(a, "s") < number(b, "s"); });
  std::vector<pugi::xml_node> kept;
  bool starts_between = false, ends_between = false;
  int gone = 0;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const double begin_m = number(sections[i], "s");
    const double end_m = i + 1 < sections.size() ? number(sections[i + 1], "s") : length_m;
    const bool before =
        cut.at_start && end_m <= cut.from_m + kSameRecordM && i + 1 < sections.size();
    const bool behind = cut.at_end && begin_m >= cut.to_m - kSameRecordM && !kept.empty();
    if (before || behind) {
      gone += before ? 1 : 0;
      lanes.remove_child(sections[i]);
      continue;
    }
    kept.push_back(sections[i]);
    if (kept.size() == 1) starts_between = begin_m >= cut.from_m;
    ends_between = end_m <= cut.to_m;
    const Cut of_section{cut.from_m - begin_m, cut.to_m - begin_m,
                         cut.at_start && begin_m < cut.from_m, cut.at_end && end_m > cut.to_m};
    for_each_lane(sections[i], [&](pugi::xml_node lane) { cut_lane(lane, of_section); });
    if (cut.at_start) set_number(sections[i], "s", std::max(0.0, begin_m - cut.from_m));
  }
  if (kept.empty()) return gone;
  // Of links between sections nothing else knows.
  if (cut.at_start) take_lane_links(kept.front(), "predecessor", starts_between);
  if (cut.at_end) take_lane_links(kept.back(), "successor", ends_between);
  return gone;
}

void cut_profiles(pugi::xml_node road, const Cut& cut) {
  cut_records(children(road, "type"), "s", cut, false, keep_as_it_is);
  cut_cubics(children(road.child("elevationProfile"), "elevation"), "s", cut);
  const pugi::xml_node lateral = road.child("lateralProfile");
  cut_cubics(children(lateral, "superelevation"), "s", cut);
  cut_crossfall(lateral, cut);
  cut_cubics(children(road.child("lanes"), "laneOffset"), "s", cut);
}

// Heights over t at a station: a + b·Δt + c·Δt² + d·Δt³ by the t where they begin.
using Shape = std::map<double, std::array<double, 4>>;

std::array<double, 4> cubic_at(const Shape& shape, double t_m) {
  auto holding = shape.upper_bound(t_m);
  if (holding != shape.begin()) --holding;  // the first holds before itself, too
  const auto& [a, b, c, d] = holding->second;
  const double by_m = t_m - holding->first;
  return {a + by_m * (b + by_m * (c + by_m * d)), b + by_m * (2.0 * c + by_m * 3.0 * d),
          c + 3.0 * d * by_m, d};
}

Shape between(const Shape& first, const Shape& second, double share) {
  Shape shape;
  for (const Shape* one : {&first, &second}) {
    for (const auto& [t_m, cubic] : *one) {
      const auto here = cubic_at(first, t_m), there = cubic_at(second, t_m);
      for (std::size_t i = 0; i < 4; ++i) shape[t_m][i] = std::lerp(here[i], there[i], share);
    }
  }
  return shape;
}

// Linear between stations, constant before the first and after the last.
Shape shape_at(const std::map<double, Shape>& shapes, double s_m) {
  const auto after = shapes.upper_bound(s_m);
  if (after == shapes.begin()) return after->second;
  const auto before = std::prev(after);
  if (after == shapes.end()) return before->second;
  return between(before->second, after->second,
                 (s_m - before->first) / (after->first - before->first));
}

void cut_shapes(pugi::xml_node lateral, const Cut& cut) {
  constexpr std::array<const char*, 4> names = {"a", "b", "c", "d"};
  std::map<double, Shape> shapes, kept;
  for (const auto record : children(lateral, "shape")) {
    std::array<double, 4>& cubic = shapes[number(record, "s")][number(record, "t")];
    for (std::size_t i = 0; i < 4; ++i) cubic[i] = number(record, names[i]);
    lateral.remove_child(record);
  }
  if (shapes.empty()) return;
  for (const auto& [s_m, shape] : shapes) {
    if (s_m > cut.from_m && s_m < cut.to_m) kept.emplace(s_m, shape);
  }
  for (const double s_m : {cut.from_m, cut.to_m}) kept.emplace(s_m, shape_at(shapes, s_m));
  for (const auto& [s_m, shape] : kept) {
    for (const auto& [t_m, cubic] : shape) {
      pugi::xml_node record = lateral.append_child("shape");
      set_number(record, "s", s_m - cut.from_m);
      set_number(record, "t", t_m);
      for (std::size_t i = 0; i < 4; ++i) set_number(record, names[i], cubic[i]);
    }
  }
}

bool is_inside(double s_m, const Cut& cut) {
  return !(cut.at_start && s_m < cut.from_m) && !(cut.at_end && s_m > cut.to_m);
}

// What stands at a station.
void cut_places(pugi::xml_node parent, const char* name, const Cut& cut) {
  for (const auto place : children(parent, name)) {
    const double s_m = number(place, "s");
    if (!is_inside(s_m, cut)) {
      parent.remove_child(place);
    } else if (cut.at_start) {
      set_number(place, "s", s_m - cut.from_m);
    }
  }
}

// Values that run from Start to End over a length, as of a repeated object.
void shorten_between(pugi::xml_node node, double from_share, double to_share) {
  for (const auto start : node.attributes()) {
    const std::string_view name = start.name();
    if (!name.ends_with("Start")) continue;
    const std::string end_name = std::string(name.substr(0, name.size() - 5)) + "End";
    if (!node.attribute(end_name.c_str())) continue;
    const double at_start = start.as_double(), at_end = number(node, end_name.c_str());
    set_number(node, start.name(), std::lerp(at_start, at_end, from_share));
    set_number(node, end_name.c_str(), std::lerp(at_start, at_end, to_share));
  }
}

// What runs over a length: the part inside stays. Copies at a distance stay where they are.
// Returns whether anything does.
bool cut_length(pugi::xml_node node, const Cut& cut) {
  const double s_m = number(node, "s"), length_m = number(node, "length"),
               step_m = number(node, "distance");
  double from_m = cut.at_start ? std::max(s_m, cut.from_m) : s_m;
  const double to_m = cut.at_end ? std::min(s_m + length_m, cut.to_m) : s_m + length_m;
  if (step_m > 0.0) from_m = s_m + step_m * std::ceil((from_m - s_m) / step_m - 1e-9);
  if (from_m > to_m || (from_m == to_m && length_m > 0.0 && step_m == 0.0)) return false;
  if (length_m > 0.0 && (from_m > s_m || to_m < s_m + length_m)) {
    shorten_between(node, (from_m - s_m) / length_m, (to_m - s_m) / length_m);
    set_number(node, "length", to_m - from_m);
  }
  if (cut.at_start) set_number(node, "s", from_m - cut.from_m);
  return true;
}

void cut_lengths(pugi::xml_node parent, const char* name, const Cut& cut) {
  for (const auto node : children(parent, name)) {
    if (!cut_length(node, cut)) parent.remove_child(node);
  }
}

// What of an object has stations of the road: it has to lie inside whole.
std::vector<pugi::xml_node> corners_of(pugi::xml_node object) {
  std::vector<pugi::xml_node> corners;
  for (const auto& found : object.select_nodes(".//cornerRoad | .//vertexRoad")) {
    corners.push_back(found.node());
  }
  return corners;
}

bool has_corner_outside(pugi::xml_node object, const Cut& cut) {
  return std::ranges::any_of(corners_of(object), [&](pugi::xml_node corner) {
    return !is_inside(number(corner, "s"), cut);
  });
}

void shift_object(pugi::xml_node object, double by_m) {
  set_number(object, "s", std::max(0.0, number(object, "s") + by_m));
  for (const auto corner : corners_of(object)) set_number(corner, "s", number(corner, "s") + by_m);
}

/// @param whole_from_m  station of the whole road at which this one begins.
void cut_object(pugi::xml_node road, pugi::xml_node object, const Cut& cut, double whole_from_m) {
  const bool repeated = object.child("repeat");
  if (repeated) cut_lengths(object, "repeat", cut);
  const bool stays = repeated ? bool(object.child("repeat")) : is_inside(number(object, "s"), cut);
  if (stays && has_corner_outside(object, cut)) {
    shift_object(child_of(clip_memory(road), "objects").append_copy(object), whole_from_m);
  } else if (stays) {
    if (cut.at_start) shift_object(object, -cut.from_m);
    return;
  }
  object.parent().remove_child(object);
}

void cut_furniture(pugi::xml_node road, const Cut& cut, double whole_from_m) {
  const pugi::xml_node signals = road.child("signals"), objects = road.child("objects");
  cut_places(signals, "signal", cut);
  cut_places(signals, "signalReference", cut);
  for (const auto object : children(objects, "object")) {
    cut_object(road, object, cut, whole_from_m);
  }
  cut_places(objects, "objectReference", cut);
  cut_lengths(objects, "bridge", cut);
  cut_lengths(objects, "tunnel", cut);
}

// The geometry that is cut, as it is in the whole road: under `<from>` or `<to>`.
void remember_geometry(pugi::xml_node road, const RoadCut& whole, const char* end, double s_m) {
  pugi::xml_node memory = clip_memory(road);
  const pugi::xml_node plan_view = road.child("planView"), across = geometry_across(plan_view, s_m);
  // One that was cut before is remembered already, by its end that was cut then.
  pugi::xml_node known;
  if (across && across == plan_view.child("geometry")) known = memory.child("from");
  if (across && !known && across == plan_view.last_child()) known = memory.child("to");
  pugi::xml_node kept = memory.append_child("kept");
  if (across) {
    pugi::xml_node copy = kept.append_copy(known ? known.child("geometry") : across);
    if (!known && whole.from_m > 0.0) set_number(copy, "s", number(copy, "s") + whole.from_m);
  }
  remove_children(memory, end);
  if (across) {
    kept.set_name(end);
  } else {
    memory.remove_child(kept);
  }
}

// What of a lateral profile is kept whole, and cut anew from there.
constexpr std::array<const char*, 2> kAcross = {"shape", "crossSectionSurface"};

void remember_lateral(pugi::xml_node road) {
  const pugi::xml_node lateral = road.child("lateralProfile");
  pugi::xml_node memory = clip_memory(road);
  if (memory.child("lateralProfile")) return;
  for (const char* name : kAcross) {
    for (const auto one : lateral.children(name)) {
      child_of(memory, "lateralProfile").append_copy(one);
    }
  }
}

}  // namespace

RoadCut road_cut(pugi::xml_node road) {
  const double length_m = number(road, "length");
  const RoadCut whole{road.attribute("id").value(), 0.0, length_m, length_m, 0};
  const pugi::xml_node cut = find_clip_memory(road).child("cut");
  if (!cut) return whole;
  const RoadCut part{cut.attribute("road").value(), number(cut, "from"), number(cut, "to"),
                     number(cut, "length"), cut.attribute("section").as_int()};
  // Whoever wrote it, it has to fit the road.
  const bool fits = part.from_m >= 0.0 && part.from_m < part.to_m && part.to_m <= part.length_m &&
                    std::abs(part.to_m - part.from_m - length_m) < 1e-3;
  return fits ? part : whole;
}

void remember_cut(pugi::xml_node road, const RoadCut& whole) {
  pugi::xml_node memory = clip_memory(road);
  pugi::xml_node cut = memory.child("cut");
  if (!cut) cut = memory.prepend_child("cut");
  set_text(cut, "road", whole.road);
  set_number(cut, "from", whole.from_m);
  set_number(cut, "to", whole.to_m);
  set_number(cut, "length", whole.length_m);
  set_number(cut, "section", whole.section);
}

bool can_be_cut(pugi::xml_node road) {
  for (const auto section : road.child("lanes").children("laneSection")) {
    const std::string_view single = section.attribute("singleSide").value();
    if (single == "true" || single == "1") return false;
  }
  return true;
}

void cut_road(pugi::xml_node road, double from_m, double to_m) {
  const double length_m = number(road, "length");
  const Cut cut{from_m, to_m, from_m > 0.0, to_m < length_m};
  if (!cut.at_start && !cut.at_end) return;
  RoadCut whole = road_cut(road);
  if (cut.at_start) remember_geometry(road, whole, "from", from_m);
  if (cut.at_end) remember_geometry(road, whole, "to", to_m);
  remember_lateral(road);
  cut_plan_view(road.child("planView"), from_m, cut.at_end ? to_m : HUGE_VAL);
  cut_profiles(road, cut);
  whole.section += cut_sections(road.child("lanes"), length_m, cut);
  cut_furniture(road, cut, whole.from_m);
  set_number(road, "length", to_m - from_m);
  if (cut.at_end) whole.to_m = whole.from_m + to_m;
  if (cut.at_start) whole.from_m += from_m;
  remember_cut(road, whole);
  restore_lateral(road);
}

void restore_objects(pugi::xml_node road) {
  pugi::xml_node memory = find_clip_memory(road);
  const RoadCut part = road_cut(road);
  const Cut ends{part.from_m, part.to_m, !part.has_start(), !part.has_end()};
  for (const auto kept : children(memory.child("objects"), "object")) {
    if (has_corner_outside(kept, ends)) continue;
    pugi::xml_node list = ordered_child(road, "objects", kRoadOrder);
    if (!list.find_child_by_attribute("object", "id", kept.attribute("id").value())) {
      shift_object(list.append_copy(kept), -part.from_m);
    }
    memory.child("objects").remove_child(kept);
  }
  if (!memory.child("objects").first_child()) memory.remove_child("objects");
}

void restore_lateral(pugi::xml_node road) {
  pugi::xml_node memory = find_clip_memory(road), lateral = road.child("lateralProfile");
  const pugi::xml_node kept = memory.child("lateralProfile");
  if (!kept) return;
  for (const char* name : kAcross) {
    for (const auto own : children(lateral, name)) lateral.remove_child(own);
    for (const auto whole : kept.children(name)) lateral.append_copy(whole);
  }
  const RoadCut part = road_cut(road);
  if (part.is_whole()) {
    memory.remove_child(kept);
    return;
  }
  const Cut cut{part.from_m, part.to_m, !part.has_start(), !part.has_end()};
  cut_shapes(lateral, cut);
  for (const auto& function : lateral.select_nodes("crossSectionSurface//*[coefficients]")) {
    cut_cubics(children(function.node(), "coefficients"), "s", cut);
  }
}

void forget_empty_memory(pugi::xml_node parent) {
  pugi::xml_node memory = find_clip_memory(parent);
  if (!memory) return;
  const auto cut = memory.child("cut");
  const bool is_whole =
      parent.name() == std::string_view("road") && cut && road_cut(parent).is_whole();
  if (is_whole && text(parent, "id") == text(cut, "road")) memory.remove_child(cut);
  remove_empty_memory(parent);
}

}  // namespace roadbed::map::edit
