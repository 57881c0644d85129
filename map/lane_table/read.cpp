#include "roadbed/map/lane_table/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <unordered_map>
#include <utility>

#include "roadbed/map/elements/lane_lines.h"
#include "roadbed/map/elements/participants.h"
#include "roadbed/map/elements/side.h"
#include "roadbed/map/files/coordinate_limits.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/projection.h"
#include "roadbed/map/files/utm_region.h"
#include "roadbed/map/lane_table/shapes.h"
#include "roadbed/map/lane_table/table.h"

namespace roadbed::map::lane_table {
namespace {

constexpr double kBeside_m = 0.5;  // facing borders of neighbours

std::optional<double> number_in(std::string_view text) {
  double number = 0.0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool fits = fault == std::errc() && end == text.data() + text.size();
  return fits && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

std::vector<std::string> ids_in(std::string_view text) {
  std::vector<std::string> ids;
  constexpr std::string_view between = " ,;[]\"\t";
  while (!text.empty()) {
    const std::size_t from = std::min(text.find_first_not_of(between), text.size());
    text.remove_prefix(from);
    const std::size_t size = std::min(text.find_first_of(between), text.size());
    if (size > 0) ids.emplace_back(text.substr(0, size));
    text.remove_prefix(size);
  }
  return ids;
}

Participants users_of(LaneType type) {
  switch (type) {
    case LaneType::biking:
      return {Participant::bicycle};
    case LaneType::bus:
      return {Participant::bus, Participant::emergency};
    case LaneType::sidewalk:
      return {Participant::pedestrian};
    default:
      return is_surface(type) ? Participants::vehicles() : Participants();
  }
}

class Builder {
 public:
  Builder(const std::string& name, const Mapping& mapping) : name_(name), mapping_(mapping) {}

  RoadMapParts build(Table table, const char* format) {
    parts_.format = format;
    check_columns(table);
    place(table);
    if (table.unused > 0) parts_.unused.push_back({"feature of another shape", table.unused});
    if (mapping_.drawing == Drawing::borders) {
      pair_borders(table.rows);
    } else {
      for (Row& row : table.rows) add_row(row);
    }
    if (parts_.lanes.empty()) {
      refuse(parts_.remarks.empty() ? "no line or polygon" : parts_.remarks.back().message,
             "at least one lane", "check the mapping of columns");
    }
    link();
    return std::move(parts_);
  }

 private:
  [[noreturn]] void refuse(const std::string& found, const std::string& needed,
                           const std::string& remedy) const {
    throw InputError({.file = name_, .found = found, .needed = needed, .remedy = remedy});
  }

  void leave_out(const std::string& id, const std::string& why) {
    parts_.remarks.push_back({"import.row", true, "row " + id, 0, why + "; it is left out"});
  }

  void check_columns(const Table& table) const {
    if (mapping_.drawing == Drawing::centreline && !mapping_.width_m.value &&
        mapping_.width_m.column.empty()) {
      refuse("centrelines without a width", "\"width_m\": 3.5, or the name of a column",
             "add it to the mapping of columns");
    }
    if (mapping_.drawing == Drawing::borders && mapping_.side.empty()) {
      refuse("borders without a side", "\"side\": the name of a column with left and right",
             "add it to the mapping of columns");
    }
    if (mapping_.drawing == Drawing::polygon && !mapping_.heading_deg.value &&
        mapping_.heading_deg.column.empty()) {
      refuse("polygons without a direction", "\"heading_deg\": a number or the name of a column",
             "add it to the mapping of columns");
    }
    for (const std::string* column :
         {&mapping_.lane, &mapping_.side, &mapping_.width_m.column, &mapping_.heading_deg.column,
          &mapping_.type, &mapping_.speed_kmh.column, &mapping_.successors}) {
      const bool is_there = column->empty() || std::ranges::any_of(table.rows, [&](const Row& row) {
                              return !row.value(*column).empty();
                            });
      if (!is_there) refuse_column(*column, table);
    }
  }

  [[noreturn]] void refuse_column(const std::string& column, const Table& table) const {
    std::string names;
    if (!table.rows.empty()) {
      for (const auto& [key, value] : table.rows.front().values) {
        names += (names.empty() ? "" : ", ") + key;
      }
    }
    refuse(fmt::format("no row has a value in the column \"{}\"", column),
           fmt::format("one of: {}", names), "correct the mapping of columns");
  }

  /// Coordinates from the file's to the map's.
  void place(Table& table) {
    std::optional<UtmRegion> region;
    parts_.crs = table.crs;
    if (!table.in_degrees) check_metres(table.crs);
    bool is_first = true;
    for (Row& row : table.rows) {
      for (Eigen::Vector3d& point : row.points) {
        if (table.in_degrees) check_degrees(row, point);
        if (table.in_degrees && is_first) region.emplace(point.head<2>());
        if (region) point.head<2>() = region->metres_of(point.head<2>(), name_, "row " + row.id);
        const bool fits =
            point.head<2>().cwiseAbs().maxCoeff() <= kFarthestM && std::abs(point.z()) <= kHighestM;
        if (!fits)
          refuse("row " + row.id + ": a place beyond any road", "|x|, |y| ≤ 1e8 m", "correct it");
        if (is_first) parts_.origin_in_source = origin_near(point.head<2>());
        is_first = false;
        point.head<2>() -= parts_.origin_in_source;
      }
    }
    if (region) parts_.crs = region->crs();
  }

  /// Widths and speeds are of metres. What PROJ does not know is left to whoever drew it.
  static void check_metres(const std::string& crs) {
    const bool is_utm = epsg_code(crs).value_or(0) / 1000 == 32;
    if (!crs.empty() && !is_utm && projection_fault(crs).empty()) require_metres(crs);
  }

  void check_degrees(const Row& row, const Eigen::Vector3d& point) const {
    if (std::abs(point.x()) <= 180.0 && std::abs(point.y()) <= 90.0) return;
    refuse(
        fmt::format("row {}: [{}, {}] is no longitude and latitude", row.id, point.x(), point.y()),
        "degrees, or another system named by the member crs", "name the coordinate system");
  }

  std::string id_of(const Row& row) const {
    return mapping_.lane.empty() ? row.id : std::string(row.value(mapping_.lane));
  }

  static std::optional<double> number_of(const NumberColumn& number, const Row& row) {
    return number.value ? number.value : number_in(row.value(number.column));
  }

  void add_row(Row& row) {
    if (row.is_ring != (mapping_.drawing == Drawing::polygon)) {
      return leave_out(row.id, row.is_ring ? "it is a polygon, not a line" : "it is no polygon");
    }
    if (mapping_.drawing == Drawing::polygon) {
      const auto heading_deg = number_of(mapping_.heading_deg, row);
      if (!heading_deg) return leave_out(row.id, "it has no direction");
      const auto borders = borders_of_ring(row.points, *heading_deg * std::numbers::pi / 180.0);
      if (!borders) return leave_out(row.id, "its outline has no two ends");
      return add_lane(row, *borders);
    }
    const auto width_m = number_of(mapping_.width_m, row);
    if (!width_m || !(*width_m > 0.0 && *width_m < 100.0)) {
      return leave_out(row.id, "it has no width above 0, below 100 m");
    }
    const auto borders = borders_beside(row.points, *width_m);
    if (!borders) return leave_out(row.id, "its line has no length");
    add_lane(row, *borders);
  }

  void pair_borders(std::vector<Row>& rows) {
    std::unordered_map<std::string, std::pair<Row*, Row*>> sides;
    std::vector<std::string> order;
    for (Row& row : rows) {
      const std::string id = id_of(row);
      const std::string_view side = row.value(mapping_.side);
      if (side != "left" && side != "right") {
        leave_out(row.id, "its side is neither left nor right");
        continue;
      }
      auto& [left, right] = sides[id];
      if (left == nullptr && right == nullptr) order.push_back(id);
      Row*& border = side == "left" ? left : right;
      if (border != nullptr) leave_out(row.id, fmt::format("lane {} has a {} border", id, side));
      if (border == nullptr) border = &row;
    }
    for (const std::string& id : order) {
      const auto& [left, right] = sides[id];
      if (left == nullptr || right == nullptr) {
        leave_out((left != nullptr ? left : right)->id, "its lane has no border on the other side");
      } else {
        add_lane(*left, {left->points, right->points, {}});
      }
    }
  }

  // Takes what the columns of the row say with it.
  void add_lane(Row& row, const Borders& borders) {
    const auto& [left, right, centre] = borders;
    const std::string id = id_of(row);
    if (id.empty()) return leave_out(row.id, "it has no id");
    if (lane_of_id_.contains(id)) return leave_out(row.id, "another lane has its id");
    if (left.size() < 2 || right.size() < 2) return leave_out(row.id, "a border has no two points");
    Lane lane;
    lane.id = LaneId{static_cast<std::uint32_t>(parts_.lanes.size())};
    lane.name = lane.origin.source_id = id;
    if (centre.empty()) set_borders(left, right, lane);
    if (!centre.empty()) set_lines(left, centre, right, lane);
    if (!(lane.length_m() > 0.0)) return leave_out(row.id, "it has no length");
    if (has_swapped_borders(lane)) {
      parts_.remarks.push_back({"import.swapped-borders", true, "row " + row.id, 0,
                                "its left border lies to the right of its right one; swap them"});
    }
    set_use(row, lane);
    lane_of_id_.emplace(id, lane.id);
    successors_.push_back(ids_in(row.value(mapping_.successors)));
    lane.attributes = std::move(row.values);
    parts_.lanes.push_back(std::move(lane));
  }

  void set_use(const Row& row, Lane& lane) {
    lane.type = LaneType::driving;
    const std::string word(row.value(mapping_.type));
    if (const auto known = mapping_.types.find(word); known != mapping_.types.end()) {
      lane.type = known->second;
    } else if (!word.empty()) {
      lane.type = type_named(word);
      if (lane.type == LaneType::other) {
        parts_.remarks.push_back({"import.lane-type", true, "row " + row.id, 0,
                                  fmt::format("its type \"{}\" is not in the mapping", word)});
      }
    }
    lane.participants = users_of(lane.type);
    const auto kmh = number_of(mapping_.speed_kmh, row);
    if (kmh && *kmh > 0.0) lane.speed_limits = {{0.0, *kmh / 3.6}};
    const std::string_view limit = row.value(mapping_.speed_kmh.column);
    if (!kmh && !limit.empty()) {
      parts_.remarks.push_back({"import.speed-limit", true, "row " + row.id, 0,
                                fmt::format("its speed \"{}\" is no number of km/h", limit)});
    }
  }

  static LaneType type_named(const std::string& word) {
    for (int i = 0; i < static_cast<int>(LaneType::other); ++i) {
      if (to_string(static_cast<LaneType>(i)) == word) return static_cast<LaneType>(i);
    }
    return LaneType::other;
  }

  void link() {
    parts_.links.resize(parts_.lanes.size());
    if (mapping_.successors.empty()) {
      link_ends(parts_.lanes, mapping_.link_m, parts_.links);
    } else {
      link_named();
    }
    link_beside(parts_.lanes, kBeside_m, parts_.links);
  }

  void link_named() {
    for (const Lane& lane : parts_.lanes) {
      for (const std::string& id : successors_[lane.id.index]) {
        const auto to = lane_of_id_.find(id);
        if (to == lane_of_id_.end()) {
          parts_.remarks.push_back({"import.link", true, "lane " + lane.name, 0,
                                    fmt::format("its successor {} is not there", id)});
          continue;
        }
        parts_.links[lane.id.index].successors.push_back(to->second);
        parts_.links[to->second.index].predecessors.push_back(lane.id);
      }
    }
  }

  const std::string& name_;
  const Mapping& mapping_;
  RoadMapParts parts_;
  std::unordered_map<std::string, LaneId> lane_of_id_;
  std::vector<std::vector<std::string>> successors_;
};

}  // namespace

RoadMapParts read(std::string bytes, const std::string& name, const Mapping& mapping) {
  if (is_geopackage(bytes)) {
    return Builder(name, mapping)
        .build(read_geopackage(std::move(bytes), name, mapping.layer), "GeoPackage with lanes");
  }
  return Builder(name, mapping).build(read_geojson(bytes, name), "GeoJSON with lanes");
}

}  // namespace roadbed::map::lane_table
