#include "roadbed/map/lanelet2/build_map.h"

#include <fmt/format.h>

#include <algorithm>

#include "roadbed/map/lanelet2/traffic_rules.h"

namespace roadbed::map::lanelet2 {
namespace {

using NodeList = std::vector<std::uint32_t>;

// Rings made of whole ways, each begun with the first that is left and continued with the first
// that shares its end. None if one does not close.
std::optional<std::vector<NodeList>> close_rings(std::vector<NodeList> ways) {
  std::vector<NodeList> rings;
  while (!ways.empty()) {
    NodeList ring = std::move(ways.front());
    ways.erase(ways.begin());
    while (ring.front() != ring.back()) {
      const auto next = std::find_if(ways.begin(), ways.end(), [&](const NodeList& way) {
        return way.front() == ring.back() || way.back() == ring.back();
      });
      if (next == ways.end()) return {};
      if (next->front() != ring.back()) std::reverse(next->begin(), next->end());
      ring.insert(ring.end(), next->begin() + 1, next->end());
      ways.erase(next);
    }
    rings.push_back(std::move(ring));
  }
  return rings;
}

class AreaBuilder {
 public:
  AreaBuilder(Document& document, RoadMapParts& parts)
      : document_(document), parts_(parts), points_left_(1'500'000 + document.text.size()) {}

  void add(const Relation& relation) {
    const auto outer = rings_of(relation, "outer");
    const auto inner = rings_of(relation, "inner");
    if (!outer || !inner) return;
    Area area;
    area.source_id = std::to_string(relation.id);
    area.attributes = attributes_of(relation.tags);
    area.type = relation.subtype;
    area.participants = participants(relation.tags);
    area.is_road = area.participants.has(Participant::car);
    for (const geometry::Ring& ring : *outer) area.in_map.push_back({ring, {}});
    if (area.in_map.empty()) {
      document_.fault(relation.at, "import.area", "has no outer border and is left out");
      return;
    }
    for (geometry::Ring hole : *inner) {
      std::reverse(hole.begin(), hole.end());  // holes run clockwise
      holder_of(area, hole).holes.push_back(std::move(hole));
    }
    parts_.areas.push_back(std::move(area));
  }

 private:
  static geometry::Polygon& holder_of(Area& area, const geometry::Ring& hole) {
    for (geometry::Polygon& polygon : area.in_map) {
      if (geometry::contains(polygon.outer, hole.front())) return polygon;
    }
    return area.in_map.front();
  }

  std::optional<std::vector<geometry::Ring>> rings_of(const Relation& relation,
                                                      std::string_view role) {
    std::vector<NodeList> ways;
    for (const Member& member : relation.members) {
      if (member.role != role) continue;
      const auto way =
          member.kind == MemberKind::way ? document_.way_index.find(member.id) : std::nullopt;
      if (!way || document_.ways[*way].nodes.empty()) {
        return open_ring(relation, fmt::format("its {} way {} is not there", role, member.id),
                         member.kind == MemberKind::way && !way);
      }
      document_.ways[*way].used = true;
      const std::size_t points = document_.ways[*way].nodes.size();
      if (points > points_left_ || ways.size() >= kMostWays) {
        return open_ring(relation, "its borders repeat more points than the file has");
      }
      points_left_ -= points;
      const auto& nodes = document_.ways[*way].nodes;
      ways.emplace_back(nodes.begin(), nodes.end());
    }
    const auto closed = close_rings(std::move(ways));
    if (!closed) return open_ring(relation, fmt::format("its {} border does not close", role));
    return points_of(relation, *closed);
  }

  std::optional<std::vector<geometry::Ring>> points_of(const Relation& relation,
                                                       const std::vector<NodeList>& closed) {
    std::vector<geometry::Ring> rings;
    for (const NodeList& nodes : closed) {
      geometry::Ring ring;
      for (const std::uint32_t node : nodes) {
        ring.emplace_back(document_.nodes[node].in_map.head<2>());
      }
      ring = simple_ring(std::move(ring));
      if (ring.empty()) return open_ring(relation, "one of its borders encloses nothing");
      rings.push_back(std::move(ring));
    }
    return rings;
  }

  std::nullopt_t open_ring(const Relation& relation, const std::string& reason,
                           bool in_text = false) {
    document_.fault(relation.at, "import.area", reason + "; the area is left out").in_text =
        in_text;
    return std::nullopt;
  }

  static constexpr std::size_t kMostWays = 1'000;  // of one area: joining them costs the square

  Document& document_;
  RoadMapParts& parts_;
  std::size_t points_left_;
};

}  // namespace

void add_areas(Document& document, RoadMapParts& parts) {
  AreaBuilder builder(document, parts);
  for (const Relation& relation : document.relations) {
    if (relation.type == "multipolygon") builder.add(relation);
  }
}

void add_objects(Document& document, RoadMapParts& parts) {
  for (Way& way : document.ways) {
    if (!truth_of(value_of(way.tags, "area")).value_or(false) || way.nodes.empty()) continue;
    MapObject object;
    object.source_id = std::to_string(way.id);
    object.type = way.type;
    object.attributes = attributes_of(way.tags);
    object.name = value_of(way.tags, "name");
    geometry::Ring ring;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& point : document.points(way)) {
      sum += point;
      ring.emplace_back(point.head<2>());
    }
    sum /= static_cast<double>(ring.size());
    object.in_map = sum.head<2>();
    object.z_m = sum.z();
    object.outline_in_map = simple_ring(std::move(ring));
    if (object.outline_in_map.empty()) {
      document.fault(way.at, "import.area", "encloses nothing; only its place is kept");
    }
    way.used = true;
    parts.objects.push_back(std::move(object));
  }
}

}  // namespace roadbed::map::lanelet2
