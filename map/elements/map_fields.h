#pragma once

#include <cstdint>
#include <type_traits>

#include "roadbed/map/elements/map_content.h"

/// What each thing of a map is made of, said once for all who go through all fields: `io(value)`
/// writes, reads or compares a number, text or id, `io.list` a list, `io.optional` what may be
/// missing, `io.point` and `io.points` coordinates, `io.numbers` doubles, `io.line` a polyline;
/// `io.check` states what must hold after reading.
namespace roadbed::map::inline elements::fields {

inline constexpr auto field = [](auto& io, auto& value) { io(value); };
inline constexpr auto attribute = [](auto& io, auto& item) {
  io(item.first);
  io(item.second);
};

inline constexpr auto participants = []<typename Io, typename T>(Io& io, T& item) {
  std::uint16_t bits = item.bits();
  io(bits);
  if constexpr (!std::is_const_v<T>) item = Participants::from_bits(bits);
};

inline constexpr auto region = [](auto& io, auto& polygon) {
  io.points(polygon.outer);
  io.list(polygon.holes, [](auto& rings, auto& ring) { rings.points(ring); });
};

inline constexpr auto speed_limit = [](auto& io, auto& item) {
  io(item.from_s_m);
  io.optional(item.limit_mps, field);
};

inline constexpr auto mark = [](auto& io, auto& item) {
  io(item.from_s_m);
  io(item.type);
  io(item.color);
  io(item.width_m);
};

inline constexpr auto lane_line = [](auto& io, auto& line) {
  io.line(line.in_map);
  io.numbers(line.z_m);
  io.numbers(line.station_m);
  io.check(line.in_map.points().size() >= 2 && line.z_m.size() == line.in_map.points().size() &&
           line.station_m.size() == line.in_map.points().size());
};

inline constexpr auto lane = [](auto& io, auto& item) {
  io(item.id);
  io.optional(item.road, field);
  io.optional(item.junction, field);
  io(item.origin.section);
  io(item.origin.source_id);
  io(item.origin.road_from_s_m);
  io(item.origin.road_to_s_m);
  io(item.name);
  io(item.type);
  io(item.one_way);
  participants(io, item.participants);
  io.list(item.speed_limits, speed_limit);
  io.list(item.left_marks, mark);
  io.list(item.right_marks, mark);
  io.list(item.attributes, attribute);
  lane_line(io, item.left);
  lane_line(io, item.centre);
  lane_line(io, item.right);
  io.points(item.polygon);
};

inline constexpr auto neighbour = [](auto& io, auto& item) {
  io(item.lane);
  io(item.same_direction);
  io.list(item.change_windows, [](auto& ranges, auto& range) {
    ranges(range.from_s_m);
    ranges(range.to_s_m);
  });
};

inline constexpr auto links = [](auto& io, auto& item) {
  io.list(item.successors, field);
  io.list(item.predecessors, field);
  io.optional(item.left, neighbour);
  io.optional(item.right, neighbour);
};

inline constexpr auto road = [](auto& io, auto& item) {
  io(item.id);
  io(item.source_id);
  io(item.name);
  io.optional(item.junction, field);
  io(item.length_m);
  io.line(item.reference_in_map);
  io.numbers(item.reference_road_s_m);
  io.check(item.reference_road_s_m.size() == item.reference_in_map.points().size());
  io.list(item.lanes, field);
};

inline constexpr auto junction = [](auto& io, auto& item) {
  io(item.id);
  io(item.source_id);
  io(item.name);
  io(item.kind);
  io.list(item.connecting_roads, field);
};

inline constexpr auto signal = [](auto& io, auto& item) {
  io(item.source_id);
  io(item.name);
  io.optional(item.road, field);
  io(item.road_s_m);
  io(item.road_t_m);
  io.point(item.in_map);
  io(item.z_m);
  io.optional(item.heading_rad, field);
  io(item.country);
  io(item.type);
  io(item.subtype);
  io.optional(item.value, field);
  io(item.unit);
  io(item.text);
  io(item.dynamic);
  io.list(item.lanes, field);
  io.numbers(item.lane_s_m);
  io.check(item.lane_s_m.empty() || item.lane_s_m.size() == item.lanes.size());
  io.list(item.attributes, attribute);
};

inline constexpr auto controller = [](auto& io, auto& item) {
  io(item.source_id);
  io(item.name);
  io.list(item.signals, field);
  io.list(item.attributes, attribute);
};

inline constexpr auto stop_line = [](auto& io, auto& item) {
  io(item.source_id);
  io.points(item.in_map);
  io.list(item.lanes, field);
  io.list(item.signals, field);
};

inline constexpr auto regulation_member = [](auto& io, auto& item) {
  io(item.role);
  io(item.source_id);
  io.optional(item.lane, field);
  io.points(item.in_map);
  io.list(item.attributes, attribute);
};

inline constexpr auto regulation = [](auto& io, auto& item) {
  io(item.source_id);
  io(item.type);
  io.list(item.lanes, field);
  io.list(item.members, regulation_member);
  io.list(item.attributes, attribute);
};

inline constexpr auto map_object = [](auto& io, auto& item) {
  io(item.source_id);
  io(item.name);
  io(item.type);
  io.optional(item.road, field);
  io(item.road_s_m);
  io(item.road_t_m);
  io.point(item.in_map);
  io.points(item.outline_in_map);
  io(item.z_m);
  io(item.height_m);
  io.list(item.attributes, attribute);
};

inline constexpr auto area = [](auto& io, auto& item) {
  io(item.source_id);
  io(item.type);
  io(item.is_road);
  io.list(item.in_map, region);
  participants(io, item.participants);
  io.list(item.attributes, attribute);
};

inline constexpr auto unused = [](auto& io, auto& item) {
  io(item.name);
  io(item.count);
};

inline constexpr auto remark = [](auto& io, auto& item) {
  io(item.rule);
  io(item.is_fault);
  io(item.element);
  io(item.line);
  io(item.message);
};

/// What stands once in a map.
inline constexpr auto head = [](auto& io, auto& content) {
  io(content.format);
  io(content.crs);
  io(content.offset_in_crs.x_m);
  io(content.offset_in_crs.y_m);
  io(content.offset_in_crs.z_m);
  io(content.offset_in_crs.heading_rad);
  io(content.origin_in_source.x());
  io(content.origin_in_source.y());
  io.list(content.attributes, attribute);
};

/// Every list of a map, with its name and the fields of its elements: `io(name, fields, list...)`,
/// for one or more contents side by side.
inline constexpr auto lists = [](auto& io, auto&... content) {
  io("roads", road, content.roads...);
  io("junctions", junction, content.junctions...);
  io("signals", signal, content.signals...);
  io("controllers", controller, content.controllers...);
  io("stop_lines", stop_line, content.stop_lines...);
  io("regulations", regulation, content.regulations...);
  io("objects", map_object, content.objects...);
  io("areas", area, content.areas...);
  io("lanes", lane, content.lanes...);
  io("links", links, content.links...);
  io("remarks", remark, content.remarks...);
  io("unused", unused, content.unused...);
};

}  // namespace roadbed::map::elements::fields
