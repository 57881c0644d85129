#include "roadbed/map/argoverse/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/argoverse/city.h"
#include "roadbed/map/argoverse/frame.h"
#include "roadbed/map/argoverse/lane_segments.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/parse_json.h"
#include "roadbed/map/files/visible_text.h"

namespace roadbed::map::argoverse {
namespace {

using Json = nlohmann::json;
using Keys = std::span<const std::string>;

/// A list of the file: what its entries are called, and which of their members are read.
struct List {
  std::string_view key, entry;
  std::array<std::string_view, 12> members;
};

constexpr std::array<List, 3> kLists = {
    {{"lane_segments",
      "lane segment",
      {"id", "is_intersection", "lane_type", "left_lane_boundary", "right_lane_boundary",
       "left_lane_mark_type", "right_lane_mark_type", "successors", "predecessors",
       "left_neighbor_id", "right_neighbor_id", ""}},
     {"pedestrian_crossings", "pedestrian crossing", {"id", "edge1", "edge2"}},
     {"drivable_areas", "drivable area", {"id", "area_boundary"}}}};

geometry::Ring ring_of(const Line3& points) {
  geometry::Ring ring;
  for (const Eigen::Vector3d& point : points) ring.emplace_back(point.head<2>());
  if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  return ring;
}

/// Counter-clockwise.
geometry::Ring turned(geometry::Ring ring) {
  if (geometry::signed_area_m2(ring) < 0.0) std::reverse(ring.begin(), ring.end());
  return ring;
}

class Reader {
 public:
  explicit Reader(const std::string& name) : name_(name), frame_(GroundHeight::beside(name)) {}

  RoadMapParts read(const std::string& bytes) {
    try {
      const auto take = [&](Keys keys, const Json& part) { add(keys, part); };
      parse_json_parts(bytes, name_, {.keys_stand_once = false, .most_levels = 32}, 2, take);
    } catch (const Json::exception& error) {
      refuse_json(error, name_);
    }
    if (lanes_.empty()) refuse("no usable lane segment", "at least one in \"lane_segments\"");
    parts_.format = "Argoverse 2";
    add_city(std::filesystem::path(name_).filename().string(), parts_);
    frame_.report(parts_);
    parts_.links = lanes_.links(parts_.remarks);
    parts_.junctions = lanes_.group_intersections();
    parts_.lanes = lanes_.take_lanes();
    for (const auto& [kind, count] : unused_) parts_.unused.push_back({kind, count});
    return std::move(parts_);
  }

 private:
  [[noreturn]] void refuse(const std::string& found, const std::string& needed) const {
    throw InputError({.file = name_,
                      .found = found,
                      .needed = needed,
                      .remedy = "give a map of Argoverse 2 (log_map_archive_*.json)"});
  }

  void add(Keys keys, const Json& part) {
    if (keys.empty()) {
      if (!part.is_object()) refuse("no JSON object", "one with lane_segments");
      return;
    }
    const auto* list = std::ranges::find(kLists, keys[0], &List::key);
    if (list == kLists.end()) {
      if (keys.size() == 1) ++unused_[one_line(keys[0])];
      return;
    }
    if (!part.is_object()) {
      refuse(fmt::format("\"{}\" is no object", one_line(keys.back())), "entries by their ids");
    }
    if (keys.size() < 2) return;
    const Entry entry{name_, fmt::format("{} {}", list->entry, one_line(keys[1])), part};
    count_unused(*list, part);
    if (list->key == "lane_segments") lanes_.add(entry, frame_, parts_.remarks);
    if (list->key == "pedestrian_crossings") add_crossing(entry);
    if (list->key == "drivable_areas") add_drivable_area(entry);
  }

  void count_unused(const List& list, const Json& part) {
    for (const auto& [key, value] : part.items()) {
      if (std::ranges::find(list.members, key) != list.members.end()) continue;
      ++unused_[fmt::format("{}/{}", list.key, one_line(key))];
    }
  }

  void leave_out(const Entry& entry, const std::string& why) {
    parts_.remarks.push_back({"import.polygon", true, entry.element, 0, why + "; it is left out"});
  }

  // Two edges that pedestrians walk along, in either direction.
  void add_crossing(const Entry& entry) {
    Line3 edge = entry.line("edge1"), other = entry.line("edge2");
    frame_.to_map(edge);
    frame_.to_map(other);
    Line3 corners = edge;
    corners.insert(corners.end(), other.rbegin(), other.rend());
    geometry::Ring ring = ring_of(corners);
    if (geometry::find_fault({ring, {}})) {
      corners = edge;
      corners.insert(corners.end(), other.begin(), other.end());
      ring = ring_of(corners);
    }
    if (const auto fault = geometry::find_fault({ring, {}})) return leave_out(entry, fault->what);
    MapObject object;
    object.source_id = std::to_string(entry.id("id"));
    object.type = "crosswalk";
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& corner : corners) middle += corner;
    middle /= static_cast<double>(corners.size());
    object.in_map = middle.head<2>();
    object.z_m = middle.z();
    object.outline_in_map = turned(std::move(ring));
    parts_.objects.push_back(std::move(object));
  }

  void add_drivable_area(const Entry& entry) {
    Line3 boundary = entry.line("area_boundary");
    frame_.to_map(boundary);
    geometry::Polygon polygon{ring_of(boundary), {}};
    if (const auto fault = geometry::find_fault(polygon)) return leave_out(entry, fault->what);
    polygon.outer = turned(std::move(polygon.outer));
    Area area;
    area.source_id = std::to_string(entry.id("id"));
    area.type = "drivable_area";
    area.is_road = true;
    area.participants = Participants::vehicles();
    area.in_map.push_back(std::move(polygon));
    parts_.areas.push_back(std::move(area));
  }

  const std::string& name_;
  Frame frame_;
  LaneSegments lanes_;
  RoadMapParts parts_;
  std::map<std::string, std::size_t> unused_;
};

}  // namespace

bool is_argoverse(std::string_view bytes) {
  constexpr std::string_view blanks = " \t\r\n\xef\xbb\xbf";
  std::string_view rest = bytes.substr(std::min(bytes.find_first_not_of(blanks), bytes.size()));
  if (!rest.starts_with('{')) return false;
  rest.remove_prefix(1);
  rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
  return std::ranges::any_of(kLists, [&](const List& list) {
    return rest.starts_with('"') && rest.substr(1).starts_with(list.key) &&
           rest.substr(1 + list.key.size()).starts_with('"');
  });
}

RoadMapParts read(const std::string& bytes, const std::string& name) {
  return Reader(name).read(bytes);
}

}  // namespace roadbed::map::argoverse
