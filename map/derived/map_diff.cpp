#include "roadbed/map/derived/map_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <type_traits>
#include <utility>

#include "roadbed/geometry/index/line_distance.h"
#include "roadbed/map/elements/byte_io.h"
#include "roadbed/map/elements/map_fields.h"

namespace roadbed::map::inline derived {
namespace {

/// Numbers that differ by less than they are computed to are one.
double comparable(double value) {
  constexpr double kSteps = 1e6;  // of a metre, a radian, …
  return std::round(value * kSteps) / kSteps + 0.0;
}

/// Writes fields as two versions of a map can be compared by: ids as the names of what they stand
/// for, coordinates as the source has them, numbers to a millionth.
class NamingWriter {
 public:
  explicit NamingWriter(const RoadMap& road_map) : map_(road_map) {}
  NamingWriter(const NamingWriter&) = delete;
  NamingWriter& operator=(const NamingWriter&) = delete;

  template <typename T>
  void operator()(const T& value) {
    writer_(value);
  }
  void operator()(double value) { writer_(comparable(value)); }
  void operator()(const LaneId& id) { writer_(map_.lane(id).name); }
  void operator()(const RoadId& id) { writer_(map_.road(id).source_id); }
  void operator()(const JunctionId& id) { writer_(map_.junction(id).source_id); }
  template <typename T, typename Each>
  void list(const std::vector<T>& items, const Each& each) {
    writer_(std::uint64_t{items.size()});
    for (const T& item : items) each(*this, item);
  }
  // In which order lanes or roads are named says nothing.
  template <typename Each>
  void list(const std::vector<LaneId>& lanes, const Each&) {
    names(lanes, [&](LaneId id) { return map_.lane(id).name; });
  }
  template <typename Each>
  void list(const std::vector<RoadId>& roads, const Each&) {
    names(roads, [&](RoadId id) { return map_.road(id).source_id; });
  }
  template <typename T, typename Each>
  void optional(const std::optional<T>& value, const Each& each) {
    writer_(value.has_value());
    if (value) each(*this, *value);
  }
  void point(const Eigen::Vector2d& value) {
    writer_.point(map_.to_source(value).unaryExpr(&comparable));
  }
  void numbers(std::vector<double> values) {
    std::ranges::transform(values, values.begin(), comparable);
    writer_.numbers(values);
  }
  void points(std::vector<Eigen::Vector2d> values) {
    for (auto& point : values) point = map_.to_source(point).unaryExpr(&comparable);
    writer_.points(values);
  }
  void points(std::vector<Eigen::Vector3d> values) {
    for (auto& point : values) {
      point.head<2>() = map_.to_source(point.head<2>());
      point = point.unaryExpr(&comparable).eval();
    }
    writer_.points(values);
  }
  void line(const geometry::Polyline& polyline) { points(polyline.points()); }
  void check(bool) const {}

  std::string take() { return std::move(bytes_); }

 private:
  template <typename T, typename NameOf>
  void names(const std::vector<T>& items, const NameOf& name_of) {
    std::multiset<std::string> sorted;
    for (const T& item : items) sorted.insert(name_of(item));
    writer_(std::uint64_t{sorted.size()});
    for (const std::string& name : sorted) writer_(name);
  }

  const RoadMap& map_;
  std::string bytes_;
  ByteWriter writer_{bytes_};
};

/// What of a thing can change by itself: its name and bytes that tell it.
using Facet = std::pair<std::string, std::string>;

template <typename Fields, typename... Values>
std::string bytes_of(const RoadMap& map, const Fields& fields, const Values&... values) {
  NamingWriter writer(map);
  (fields(writer, values), ...);
  return writer.take();
}

// Of a list of values, each with these fields.
template <typename Fields, typename T>
std::string bytes_of_list(const RoadMap& map, const Fields& fields, const std::vector<T>& values) {
  NamingWriter writer(map);
  writer.list(values, fields);
  return writer.take();
}

std::string place_of(const RoadMap& map, const Eigen::Vector2d& in_map, double z_m) {
  const Eigen::Vector2d in_source = map.to_source(in_map);
  return fmt::format("{} {} {}", comparable(in_source.x()), comparable(in_source.y()),
                     comparable(z_m));
}

std::vector<Facet> facets(const RoadMap& map, const Lane& lane) {
  return {{"type", std::string(to_string(lane.type))},
          {"direction", lane.one_way ? "one way" : "both"},
          {"participants", std::to_string(lane.participants.bits())},
          {"marks", bytes_of_list(map, fields::mark, lane.left_marks) +
                        bytes_of_list(map, fields::mark, lane.right_marks)},
          {"attributes", bytes_of_list(map, fields::attribute, lane.attributes)}};
}

std::vector<Facet> facets(const RoadMap& map, const Road& road) {
  NamingWriter junction(map), lanes(map);
  junction.optional(road.junction, fields::field);
  lanes.list(road.lanes, fields::field);
  return {{"name", road.name}, {"junction", junction.take()}, {"lanes", lanes.take()}};
}

std::vector<Facet> facets(const RoadMap& map, const Signal& signal) {
  NamingWriter value(map), lanes(map);
  value.optional(signal.value, fields::field);
  lanes.list(signal.lanes, fields::field);
  return {{"place", place_of(map, signal.in_map, signal.z_m)},
          {"type", fmt::format("{}\n{}\n{}\n{}", signal.country, signal.type, signal.subtype,
                               signal.dynamic)},
          {"value", value.take() + signal.unit + "\n" + signal.text},
          {"lanes", lanes.take()},
          {"attributes", bytes_of_list(map, fields::attribute, signal.attributes)}};
}

std::vector<Facet> facets(const RoadMap& map, const Regulation& regulation) {
  return {{"type", regulation.type},
          {"lanes", bytes_of_list(map, fields::field, regulation.lanes)},
          {"members", bytes_of_list(map, fields::regulation_member, regulation.members)},
          {"attributes", bytes_of_list(map, fields::attribute, regulation.attributes)}};
}

std::vector<Facet> facets(const RoadMap& map, const Junction& junction) {
  return {{"kind", std::to_string(static_cast<int>(junction.kind))},
          {"name", junction.name},
          {"roads", bytes_of_list(map, fields::field, junction.connecting_roads)}};
}

std::vector<Facet> facets(const RoadMap& map, const Controller& controller) {
  return {{"content", bytes_of(map, fields::controller, controller)}};
}

std::vector<Facet> facets(const RoadMap& map, const StopLine& line) {
  return {{"content", bytes_of(map, fields::stop_line, line)}};
}

std::vector<Facet> facets(const RoadMap& map, const MapObject& object) {
  return {{"content", bytes_of(map, fields::map_object, object)}};
}

std::vector<Facet> facets(const RoadMap& map, const Area& area) {
  return {{"content", bytes_of(map, fields::area, area)}};
}

template <typename T>
std::string key_of(const RoadMap& map, const T& item) {
  if constexpr (std::is_same_v<T, Lane>) {
    return item.name;
  } else if constexpr (requires { item.road_s_m; }) {
    return item.road ? item.source_id + " of road " + map.road(*item.road).source_id
                     : item.source_id;
  } else {
    return item.source_id;
  }
}

std::vector<std::string> differing(const std::vector<Facet>& before,
                                   const std::vector<Facet>& after) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i].second != after[i].second) names.push_back(before[i].first);
  }
  return names;
}

class Comparison {
 public:
  Comparison(const RoadMap& before, const RoadMap& after, const MapDiffOptions& options)
      : before_(before), after_(after), options_(options) {}

  std::vector<MapChange> run() {
    compare_heads();
    compare("road", before_.roads(), after_.roads());
    compare("junction", before_.junctions(), after_.junctions());
    compare("lane", before_.lanes(), after_.lanes());
    for_lanes_of_both([this](const Lane& a, const Lane& b) { compare_geometry(a, b); });
    compare_links();
    for_lanes_of_both([this](const Lane& a, const Lane& b) { compare_limits(a, b); });
    compare("signal", before_.signals(), after_.signals());
    compare("controller", before_.controllers(), after_.controllers());
    compare("stop_line", before_.stop_lines(), after_.stop_lines());
    compare("regulation", before_.regulations(), after_.regulations());
    compare("object", before_.objects(), after_.objects());
    compare("area", before_.areas(), after_.areas());
    return std::move(changes_);
  }

 private:
  using Kind = MapChange::Kind;

  void add(Kind kind, std::string theme, std::string element,
           std::vector<std::string> changed = {}) {
    changes_.push_back({.kind = kind,
                        .theme = std::move(theme),
                        .element = std::move(element),
                        .facets = std::move(changed),
                        .moved_m = 0.0,
                        .in_source = {}});
  }

  void compare_heads() {
    const auto& a = before_.offset_in_crs();
    const auto& b = after_.offset_in_crs();
    std::vector<std::string> changed;
    if (before_.format() != after_.format()) changed.emplace_back("format");
    if (before_.crs() != after_.crs()) changed.emplace_back("crs");
    if (a != b) changed.emplace_back("offset");
    if (before_.attributes() != after_.attributes()) changed.emplace_back("attributes");
    if (!changed.empty()) add(Kind::changed, "map", "map", std::move(changed));
  }

  template <typename T>
  using ByKey = std::map<std::pair<std::string, std::size_t>, const T*>;

  // Things by key and by their number among those of the same key.
  template <typename T>
  static ByKey<T> by_key(const RoadMap& map, const LazyList<T>& items) {
    std::map<std::string, std::size_t> seen;
    ByKey<T> made;
    for (const T& item : items) {
      const std::string key = key_of(map, item);
      made.emplace(std::pair(key, seen[key]++), &item);
    }
    return made;
  }

  template <typename T>
  void compare(const char* theme, const LazyList<T>& before, const LazyList<T>& after) {
    const ByKey<T> old = by_key(before_, before), now = by_key(after_, after);
    for (const auto& [key, item] : old) {
      const auto found = now.find(key);
      if (found == now.end()) {
        add(Kind::removed, theme, key.first);
        continue;
      }
      auto changed = differing(facets(before_, *item), facets(after_, *found->second));
      if (!changed.empty()) add(Kind::changed, theme, key.first, std::move(changed));
    }
    for (const auto& [key, item] : now) {
      if (!old.contains(key)) add(Kind::added, theme, key.first);
    }
  }

  template <typename Compare>
  void for_lanes_of_both(const Compare& compare_lanes) {
    for (const Lane& lane : before_.lanes()) {
      if (const auto other = after_.find_lane(lane.name)) compare_lanes(lane, after_.lane(*other));
    }
  }

  // How far a vertex of one line is from the other line at most, and where.
  static void farthest(const RoadMap& from, const LaneLine& line, const RoadMap& to,
                       const LaneLine& other, MapChange& change) {
    const geometry::LineDistance distance_m(other.in_map);
    for (const Eigen::Vector2d& point : line.in_map.points()) {
      const Eigen::Vector2d in_source = from.to_source(point);
      const double away_m = distance_m(to.to_map(in_source));
      if (away_m <= change.moved_m) continue;
      change.moved_m = away_m;
      change.in_source = in_source;
    }
  }

  void compare_geometry(const Lane& a, const Lane& b) {
    const std::array lines{&Lane::left, &Lane::centre, &Lane::right};
    MapChange change{.kind = Kind::changed,
                     .theme = "geometry",
                     .element = a.name,
                     .facets = {},
                     .moved_m = 0.0,
                     .in_source = {}};
    bool heights = false;
    for (const auto line : lines) {
      if (bytes_of(before_, fields::lane_line, a.*line) ==
          bytes_of(after_, fields::lane_line, b.*line)) {
        continue;
      }
      farthest(before_, a.*line, after_, b.*line, change);
      farthest(after_, b.*line, before_, a.*line, change);
      heights = heights || heights_differ(a.*line, b.*line);
    }
    if (change.moved_m > options_.tolerance_m) change.facets.emplace_back("plan");
    if (heights) change.facets.emplace_back("elevation");
    if (!change.facets.empty()) changes_.push_back(std::move(change));
  }

  static double height_at(const LaneLine& line, double fraction) {
    return Lane::height_at(line, fraction * line.station_m.back());
  }

  // Heights at the same fractions of the lanes' lengths, at the vertices of both.
  bool heights_differ(const LaneLine& a, const LaneLine& b) const {
    const auto differ = [&](const LaneLine& line) {
      return std::any_of(line.station_m.begin(), line.station_m.end(), [&](double s_m) {
        const double fraction = line.station_m.back() > 0.0 ? s_m / line.station_m.back() : 0.0;
        return std::abs(height_at(a, fraction) - height_at(b, fraction)) > options_.tolerance_m;
      });
    };
    return differ(a) || differ(b);
  }

  static std::set<std::string> links_of(const RoadMap& map) {
    std::set<std::string> found;
    for (const Lane& lane : map.lanes()) {
      const LaneLinks& links = map.graph().of(lane.id);
      for (const LaneId next : links.successors) {
        found.insert(fmt::format("{} to {}", lane.name, map.lane(next).name));
      }
      const auto beside = [&](const char* side, const std::optional<Neighbour>& neighbour) {
        if (!neighbour) return;
        found.insert(fmt::format("{} {} {}{}{}", lane.name, side, map.lane(neighbour->lane).name,
                                 neighbour->same_direction ? "" : ", oncoming",
                                 neighbour->change_allowed() ? ", change allowed" : ""));
      };
      beside("left", links.left);
      beside("right", links.right);
    }
    return found;
  }

  void compare_links() {
    const auto old = links_of(before_), now = links_of(after_);
    for (const std::string& link : old) {
      if (!now.contains(link)) add(Kind::removed, "link", link);
    }
    for (const std::string& link : now) {
      if (!old.contains(link)) add(Kind::added, "link", link);
    }
  }

  void compare_limits(const Lane& a, const Lane& b) {
    if (bytes_of_list(before_, fields::speed_limit, a.speed_limits) !=
        bytes_of_list(after_, fields::speed_limit, b.speed_limits)) {
      add(Kind::changed, "speed_limit", a.name);
    }
  }

  const RoadMap& before_;
  const RoadMap& after_;
  const MapDiffOptions& options_;
  std::vector<MapChange> changes_;
};

}  // namespace

std::string_view to_string(MapChange::Kind kind) {
  switch (kind) {
    case MapChange::Kind::added:
      return "added";
    case MapChange::Kind::removed:
      return "removed";
    case MapChange::Kind::changed:
      break;
  }
  return "changed";
}

std::vector<MapChange> diff(const RoadMap& before, const RoadMap& after,
                            const MapDiffOptions& options) {
  return Comparison(before, after, options).run();
}

}  // namespace roadbed::map::derived
