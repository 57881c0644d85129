#include "roadbed/map/page/diff_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace roadbed::map::inline page {
namespace {

using Eigen::Vector2d;
using Kind = MapChange::Kind;

/// Whether the element of such a change is a lane.
bool is_about_lane(const MapChange& change) {
  return change.theme == "lane" || change.theme == "geometry" || change.theme == "speed_limit";
}

/// "1/0/-1 left 1/0/-2": the lane that a link begins at.
std::string_view start_of_link(std::string_view link) {
  std::size_t end = link.size();
  for (const std::string_view word : {" to ", " left ", " right "}) {
    end = std::min(end, link.find(word));
  }
  return link.substr(0, end);
}

/// Where the things of a map are, by theme and name as changes have them, in source coordinates.
class Places {
 public:
  explicit Places(const RoadMap& road_map) : map_(road_map) {
    for (const Road& road : map_.roads()) add_road("road", road.source_id, road);
    for (const Junction& junction : map_.junctions()) {
      if (junction.connecting_roads.empty()) continue;
      add_road("junction", junction.source_id, map_.road(junction.connecting_roads.front()));
    }
    for (const Signal& signal : map_.signals()) add("signal", on_road(signal), signal.in_map);
    for (const MapObject& object : map_.objects()) add("object", on_road(object), object.in_map);
    for (const StopLine& line : map_.stop_lines()) {
      add("stop_line", line.source_id, line.in_map.front().head<2>());
    }
    for (const Regulation& rule : map_.regulations()) {
      if (!rule.lanes.empty()) add("regulation", rule.source_id, middle(map_.lane(rule.lanes[0])));
    }
    for (const Area& area : map_.areas()) {
      if (!area.in_map.empty()) add("area", area.source_id, area.in_map[0].outer[0]);
    }
  }

  std::optional<Vector2d> of(const MapChange& change) const {
    const bool is_link = change.theme == "link";
    if (is_link || is_about_lane(change)) {
      const auto lane = map_.find_lane(is_link ? start_of_link(change.element)
                                               : std::string_view(change.element));
      if (!lane) return std::nullopt;
      return map_.to_source(middle(map_.lane(*lane)));
    }
    const auto found = in_source_.find(change.theme + " " + change.element);
    if (found == in_source_.end()) return std::nullopt;
    return found->second;
  }

 private:
  static Vector2d middle(const Lane& lane) {
    return lane.pose_at(0.5 * lane.length_m()).position();
  }

  template <typename Thing>
  std::string on_road(const Thing& thing) const {
    if (!thing.road) return thing.source_id;
    return thing.source_id + " of road " + map_.road(*thing.road).source_id;
  }

  void add(std::string_view theme, const std::string& name, const Vector2d& in_map) {
    in_source_.try_emplace(fmt::format("{} {}", theme, name), map_.to_source(in_map));
  }

  void add_road(std::string_view theme, const std::string& name, const Road& road) {
    if (!road.lanes.empty()) add(theme, name, middle(map_.lane(road.lanes.front())));
  }

  const RoadMap& map_;
  std::unordered_map<std::string, Vector2d> in_source_;
};

std::string limits_of(const Lane& lane) {
  std::string text;
  for (const SpeedLimit& limit : lane.speed_limits) {
    if (!text.empty()) text += ", ";
    if (limit.from_s_m > 0.0) text += fmt::format("from {:.1f} m ", limit.from_s_m);
    text += !limit.limit_mps                  ? "unknown"
            : std::isfinite(*limit.limit_mps) ? fmt::format("{:.4g} km/h", *limit.limit_mps * 3.6)
                                              : "no limit";
  }
  return text.empty() ? "unknown" : text;
}

class DiffPage {
 public:
  DiffPage(const RoadMap& before, const RoadMap& after)
      : before_(before), after_(after), old_places_(before), new_places_(after) {}

  void add(const MapChange& change) {
    remarks_.push_back({change.theme, std::string(to_string(change.kind)), element_of(change),
                        message_of(change), 0, place_of(change)});
    if (is_about_lane(change)) return add_lane(change);
    const auto from = old_places_.of(change), to = new_places_.of(change);
    if (from && to && *from != *to) {
      was_.lines_in_map.push_back({after_.to_map(*from), after_.to_map(*to)});
    }
  }

  void fill(MapPageOptions& options) && {
    options.remarks_title = "Changes";
    options.remarks = std::move(remarks_);
    options.overlays.clear();
    for (PageOverlay* overlay : {&changed_, &removed_, &added_, &was_}) {
      const bool is_empty = overlay->rings_in_map.empty() && overlay->lines_in_map.empty();
      if (!is_empty) options.overlays.push_back(std::move(*overlay));
    }
  }

 private:
  static PageOverlay overlay_of(std::string kind, std::string name) {
    PageOverlay overlay;
    overlay.kind = std::move(kind);
    overlay.name = std::move(name);
    return overlay;
  }

  // As the page's links and searches name things; "6 of road 12" is their signal 6.
  static std::string element_of(const MapChange& change) {
    if (is_about_lane(change)) return "lane " + change.element;
    if (change.theme == "link") return fmt::format("lane {}", start_of_link(change.element));
    return change.theme + " " + change.element.substr(0, change.element.find(" of road "));
  }

  std::optional<Vector2d> place_of(const MapChange& change) const {
    auto in_source = change.in_source;
    if (!in_source) in_source = new_places_.of(change);
    if (!in_source) in_source = old_places_.of(change);
    if (!in_source) return std::nullopt;
    return after_.to_map(*in_source);
  }

  std::string message_of(const MapChange& change) const {
    std::string text = fmt::format("{} {}", change.element, to_string(change.kind));
    if (!change.facets.empty()) text += fmt::format(": {}", fmt::join(change.facets, ", "));
    if (change.moved_m > 0.0) text += fmt::format(", moved by up to {:.3f} m", change.moved_m);
    return text + values_of(change);
  }

  // What users ask of a lane first: its value before, and now.
  std::string values_of(const MapChange& change) const {
    const auto a = before_.find_lane(change.element), b = after_.find_lane(change.element);
    if (!is_about_lane(change) || !a || !b) return {};
    const Lane &old = before_.lane(*a), &now = after_.lane(*b);
    if (change.theme == "speed_limit") {
      return fmt::format(": {} before, {} after", limits_of(old), limits_of(now));
    }
    if (old.type == now.type) return {};
    return fmt::format("; {} before, {} after", to_string(old.type), to_string(now.type));
  }

  void add_lane(const MapChange& change) {
    const auto a = before_.find_lane(change.element), b = after_.find_lane(change.element);
    if (change.kind == Kind::removed && a) return add_ring(removed_, before_, before_.lane(*a));
    if (!b) return;
    if (change.kind == Kind::added) return add_ring(added_, after_, after_.lane(*b));
    if (seen_.insert(change.element).second) add_ring(changed_, after_, after_.lane(*b));
    if (change.theme == "geometry" && a) add_borders(before_.lane(*a));
  }

  Vector2d moved(const RoadMap& road_map, const Vector2d& in_map) const {
    return after_.to_map(road_map.to_source(in_map));
  }

  void add_ring(PageOverlay& overlay, const RoadMap& road_map, const Lane& lane) const {
    geometry::Ring ring = lane.polygon;
    for (Vector2d& point : ring) point = moved(road_map, point);
    if (!ring.empty()) overlay.rings_in_map.push_back(std::move(ring));
  }

  void add_borders(const Lane& old) {
    for (const LaneLine* line : {&old.left, &old.right}) {
      std::vector<Vector2d> points = line->in_map.points();
      for (Vector2d& point : points) point = moved(before_, point);
      was_.lines_in_map.push_back(std::move(points));
    }
  }

  const RoadMap& before_;
  const RoadMap& after_;
  const Places old_places_, new_places_;
  std::set<std::string, std::less<>> seen_;
  std::vector<PageRemark> remarks_;
  PageOverlay changed_ = overlay_of("changed", "Changed lanes, after");
  PageOverlay removed_ = overlay_of("removed", "Removed lanes");
  PageOverlay added_ = overlay_of("added", "Added lanes");
  PageOverlay was_ = overlay_of("before", "Before: borders and things that moved");
};

}  // namespace

std::string write_diff_page(const RoadMap& before, const RoadMap& after,
                            std::span<const MapChange> changes, MapPageOptions options) {
  DiffPage page(before, after);
  for (const MapChange& change : changes) page.add(change);
  std::move(page).fill(options);
  return write_map_page(after, options);
}

}  // namespace roadbed::map::page
