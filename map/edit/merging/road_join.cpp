#include "roadbed/map/edit/merging/road_join.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/edit/lane_links.h"
#include "roadbed/map/edit/plan_cut.h"
#include "roadbed/map/edit/road_cut.h"
#include "roadbed/map/edit/xml_edit.h"

namespace roadbed::map::inline edit::inline merging {
namespace {

constexpr double kSameStationM = 1e-9, kSameSpotM = 1e-6;

// Whether a cubic is what another one is, about its own start.
bool is_one_cubic(pugi::xml_node first, pugi::xml_node second, double apart_m) {
  const double a = number(first, "a"), b = number(first, "b"), c = number(first, "c"),
               d = number(first, "d");
  const std::array<double, 4> there = {a + apart_m * (b + apart_m * (c + apart_m * d)),
                                       b + apart_m * (2.0 * c + apart_m * 3.0 * d),
                                       c + 3.0 * d * apart_m, d};
  const std::array<double, 4> here = {number(second, "a"), number(second, "b"), number(second, "c"),
                                      number(second, "d")};
  return std::equal(there.begin(), there.end(), here.begin(), [](double x, double y) {
    return std::abs(x - y) <= 1e-9 * std::max(1.0, std::abs(x));
  });
}

bool says_the_same_but(pugi::xml_node a, pugi::xml_node b, const char* station) {
  const std::string of_a = text(a, station), of_b = text(b, station);
  set_text(a, station, "");
  set_text(b, station, "");
  const bool same = say_the_same(a, b, [](pugi::xml_node) { return false; });
  set_text(a, station, of_a);
  set_text(b, station, of_b);
  return same;
}

// Whether a record at the start of the second part is the one that holds at the first part's end.
bool is_same_record(pugi::xml_node last, pugi::xml_node record, const char* station,
                    double apart_m) {
  if (!last) return false;
  const bool is_cubic = record.attribute("d") && record.attribute("a");
  return is_cubic ? is_one_cubic(last, record, apart_m) : says_the_same_but(last, record, station);
}

// Whether no record of its side begins behind it.
bool is_last_of(pugi::xml_node record, const std::vector<pugi::xml_node>& list,
                const char* station) {
  return std::none_of(list.begin(), list.end(), [&](pugi::xml_node other) {
    return text(other, "side") == text(record, "side") &&
           number(other, station) > number(record, station);
  });
}

// Records that hold until the next one, those with a `side` apart for each. What holds at the start
// of the second part and is what holds at the end of the first one is not said again.
void append_records(pugi::xml_node to, pugi::xml_node from, const char* name, const char* station,
                    double offset_m, std::span<const std::string_view> order) {
  const std::vector<pugi::xml_node> own = children(to, name);
  pugi::xml_node behind = own.empty() ? pugi::xml_node() : own.back();
  for (const auto record : from.children(name)) {
    const double s_m = number(record, station);
    const bool is_said =
        s_m <= kSameStationM && std::any_of(own.begin(), own.end(), [&](auto one) {
          const bool holds =
              text(one, "side") == text(record, "side") && is_last_of(one, own, station);
          return holds && is_same_record(one, record, station, offset_m - number(one, station));
        });
    if (is_said) continue;
    behind = behind ? to.insert_copy_after(record, behind) : insert_ordered(to, record, order);
    set_number(behind, station, s_m + offset_m);
  }
}

// The geometry that both parts have some of is made anew of what it was in the whole road.
// @param first_m, last_m  stations of the whole road where the first part begins and where the
//                         second one ends.
bool put_together(pugi::xml_node to, pugi::xml_node whole, double first_m, double last_m) {
  if (!whole || !to.child("geometry")) return false;
  const double begin_m = number(whole, "s"), length_m = number(whole, "length");
  const pugi::xml_node old = children(to, "geometry").back();
  const pugi::xml_node made = to.insert_copy_after(whole, old);
  const double from_m = std::max(0.0, first_m - begin_m);
  const double to_m = std::min(length_m, last_m - begin_m);
  if (from_m > 0.0 || to_m < length_m) cut_geometry(made, from_m, to_m);
  if (first_m > 0.0) set_number(made, "s", std::max(0.0, begin_m - first_m));
  to.remove_child(old);
  return true;
}

void join_plan_views(pugi::xml_node first, pugi::xml_node second, double offset_m) {
  pugi::xml_node to = first.child("planView"), memory = clip_memory(first);
  const pugi::xml_node of_first = memory.child("to").child("geometry"),
                       of_second = find_clip_memory(second).child("from").child("geometry");
  const RoadCut end = road_cut(second);
  const bool is_one =
      of_first && of_second && says_the_same_but(of_first, of_second, "s") &&
      std::abs(number(of_first, "s") - number(of_second, "s")) < kSameSpotM &&
      put_together(to, of_first, road_cut(first).from_m, end.has_end() ? HUGE_VAL : end.to_m);
  bool skip = is_one;
  for (const auto geometry : second.child("planView").children("geometry")) {
    if (!skip) set_number(to.append_copy(geometry), "s", number(geometry, "s") + offset_m);
    skip = false;
  }
  memory.remove_child("to");
  if (const auto kept = find_clip_memory(second).child("to")) memory.append_copy(kept);
}

pugi::xml_node lane_of(pugi::xml_node section, std::string_view side, pugi::xml_node like) {
  return section.child(std::string(side).c_str())
      .find_child_by_attribute("lane", "id", like.attribute("id").value());
}

constexpr std::array<const char*, 3> kSides = {"left", "center", "right"};

// Two parts of one section.
void join_sections(pugi::xml_node first, pugi::xml_node second, double offset_m) {
  for (const char* side : kSides) {
    for (const auto lane : second.child(side).children("lane")) {
      pugi::xml_node own = lane_of(first, side, lane);
      if (!own) continue;
      std::set<std::string> names;
      for (const auto child : lane.children()) {
        if (child.attribute("sOffset")) names.insert(child.name());
      }
      for (const std::string& name : names) {
        append_records(own, lane, name.c_str(), "sOffset", offset_m, kLaneOrder);
      }
      pugi::xml_node link = ordered_child(own, "link", kLaneOrder);
      for (const auto successor : lane.child("link").children("successor")) {
        link.append_copy(successor);
      }
      if (!link.first_child() && !lane.child("link")) own.remove_child(link);
      for (const auto kept : find_clip_memory(lane).children("successor")) {
        clip_memory(own).append_copy(kept);
      }
    }
  }
}

void join_lanes(pugi::xml_node to, pugi::xml_node from, double offset_m, bool in_one_section) {
  append_records(to, from, "laneOffset", "s", offset_m,
                 std::array<std::string_view, 2>{"laneOffset", "laneSection"});
  bool first = true;
  for (const auto section : from.children("laneSection")) {
    const std::vector<pugi::xml_node> own = children(to, "laneSection");
    if (first && in_one_section && !own.empty()) {
      join_sections(own.back(), section, offset_m - number(own.back(), "s"));
    } else {
      if (first && !own.empty()) restore_lane_links(own.back(), "successor");
      pugi::xml_node copy = to.append_copy(section);
      set_number(copy, "s", number(section, "s") + offset_m);
      if (first) restore_lane_links(copy, "predecessor");
    }
    first = false;
  }
}

// Bridges and tunnels that were shortened at the cut.
bool lengthen(pugi::xml_node list, pugi::xml_node structure, double offset_m) {
  auto own =
      list.find_child_by_attribute(structure.name(), "id", structure.attribute("id").value());
  if (!own) return false;
  const double end_m = number(structure, "s") + offset_m + number(structure, "length");
  set_number(own, "length", std::max(number(own, "length"), end_m - number(own, "s")));
  return true;
}

// Names, without "Start", of what runs from Start to End over a repetition.
std::vector<std::string> running(pugi::xml_node repeat) {
  std::vector<std::string> names;
  for (const auto start : repeat.attributes()) {
    const std::string_view name = start.name();
    if (!name.ends_with("Start")) continue;
    names.emplace_back(name.substr(0, name.size() - 5));
    if (!repeat.attribute((names.back() + "End").c_str())) names.pop_back();
  }
  return names;
}

// Makes one of two parts of a repetition: the second begins where the first ends, or a step behind,
// and all that runs over them runs on.
bool repeat_on(pugi::xml_node first, pugi::xml_node second, double offset_m) {
  const double s_m = number(first, "s"), length_m = number(first, "length"),
               step_m = number(first, "distance"), apart_m = number(second, "s") + offset_m - s_m,
               both_m = apart_m + number(second, "length");
  const double steps = step_m > 0.0 ? apart_m / step_m : 0.0;
  const bool meets = step_m > 0.0 ? std::abs(steps - std::round(steps)) * step_m < kSameSpotM &&
                                        apart_m > length_m - kSameSpotM &&
                                        apart_m < length_m + step_m + kSameSpotM
                                  : std::abs(apart_m - length_m) < kSameSpotM;
  if (!meets || step_m != number(second, "distance") || !(both_m > 0.0)) return false;
  const auto names = running(first);
  const auto runs_on = [&](const std::string& name) {
    const double from = number(first, (name + "Start").c_str());
    const double to = number(second, (name + "End").c_str());
    const auto is_on_line = [&](pugi::xml_node repeat, const char* end, double at_m) {
      const double there = number(repeat, (name + end).c_str());
      return std::abs(std::lerp(from, to, at_m / both_m) - there) < kSameSpotM;
    };
    return is_on_line(first, "End", length_m) && is_on_line(second, "Start", apart_m);
  };
  if (!std::all_of(names.begin(), names.end(), runs_on)) return false;
  for (const std::string& name : names) {
    const std::string end = name + "End";
    set_text(first, end.c_str(), text(second, end.c_str()));
  }
  set_number(first, "length", both_m);
  return true;
}

// A repeated object of which each part has some.
bool repeat_further(pugi::xml_node list, pugi::xml_node object, double offset_m) {
  auto own = list.find_child_by_attribute("object", "id", object.attribute("id").value());
  if (!own) return false;
  const std::vector<pugi::xml_node> repeats = children(own, "repeat");
  pugi::xml_node behind = repeats.empty() ? pugi::xml_node() : repeats.back();
  for (const auto repeat : object.children("repeat")) {
    if (!behind) break;
    if (std::any_of(repeats.begin(), repeats.end(),
                    [&](auto one) { return repeat_on(one, repeat, offset_m); })) {
      continue;
    }
    behind = own.insert_copy_after(repeat, behind);
    set_number(behind, "s", number(repeat, "s") + offset_m);
  }
  return true;
}

// Whether a signal at the seam is there already.
bool stands_there(pugi::xml_node list, pugi::xml_node signal, double offset_m) {
  const double s_m = number(signal, "s") + offset_m;
  const auto signals = list.children("signal");
  return std::any_of(signals.begin(), signals.end(), [&](pugi::xml_node own) {
    return text(own, "id") == text(signal, "id") && std::abs(number(own, "s") - s_m) < kSameSpotM;
  });
}

void join_furniture(pugi::xml_node road, pugi::xml_node other, const char* list, double offset_m) {
  for (const auto item : other.child(list).children()) {
    if (item.type() != pugi::node_element) continue;
    pugi::xml_node own = ordered_child(road, list, kRoadOrder);
    const std::string_view name = item.name();
    if ((name == "bridge" || name == "tunnel") && lengthen(own, item, offset_m)) continue;
    if (name == "object" && repeat_further(own, item, offset_m)) continue;
    if (name == "signal" && stands_there(own, item, offset_m)) continue;
    pugi::xml_node copy = own.append_copy(item);
    if (!copy.attribute("s")) continue;
    set_number(copy, "s", number(item, "s") + offset_m);
    for (const auto& inside : copy.select_nodes(".//cornerRoad | .//vertexRoad | repeat")) {
      set_number(inside.node(), "s", number(inside.node(), "s") + offset_m);
    }
  }
}

// Objects across the seam stand in the memory of either part, by stations of the whole road.
void join_memories(pugi::xml_node first, pugi::xml_node second) {
  for (const auto object : find_clip_memory(second).child("objects").children("object")) {
    child_of(clip_memory(first), "objects").append_copy(object);
  }
}

int sections(pugi::xml_node road) {
  return static_cast<int>(children(road.child("lanes"), "laneSection").size());
}

}  // namespace

bool goes_on(pugi::xml_node first, pugi::xml_node second) {
  const RoadCut a = road_cut(first), b = road_cut(second);
  if (a.road != b.road || std::abs(a.length_m - b.length_m) > 1e-6) return false;
  if (b.from_m < a.from_m || b.from_m > a.to_m + kSameStationM) return false;
  const auto there = reference_pose(first, std::min(b.from_m, a.to_m) - a.from_m);
  const auto here = reference_pose(second, 0.0);
  return (there.position() - here.position()).norm() < 1e-3;
}

void join_roads(pugi::xml_node first, pugi::xml_node second) {
  RoadCut whole = road_cut(first);
  if (road_cut(second).to_m <= whole.to_m) return;
  const double both_m = whole.to_m - road_cut(second).from_m;
  if (both_m > kSameStationM) cut_road(second, both_m, number(second, "length"));
  const RoadCut rest = road_cut(second);
  const double offset_m = number(first, "length");
  const bool in_one_section = whole.section + sections(first) - 1 == rest.section;

  join_plan_views(first, second, offset_m);
  append_records(first, second, "type", "s", offset_m, kRoadOrder);
  const auto profile = [&](const char* list, const char* name) {
    if (second.child(list)) {
      append_records(ordered_child(first, list, kRoadOrder), second.child(list), name, "s",
                     offset_m, {});
    }
  };
  profile("elevationProfile", "elevation");
  profile("lateralProfile", "superelevation");
  profile("lateralProfile", "crossfall");
  join_lanes(first.child("lanes"), second.child("lanes"), offset_m, in_one_section);
  join_furniture(first, second, "objects", offset_m);
  join_furniture(first, second, "signals", offset_m);
  join_memories(first, second);
  set_number(
      first, "length",
      rest.has_end() && whole.has_start() ? rest.length_m : offset_m + number(second, "length"));
  whole.to_m = rest.to_m;
  remember_cut(first, whole);
  restore_lateral(first);
  restore_objects(first);
}

}  // namespace roadbed::map::edit::merging
