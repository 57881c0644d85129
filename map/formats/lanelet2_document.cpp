#include "roadbed/map/formats/lanelet2_document.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>

#include "roadbed/map/formats/lanelet2_frame.h"

namespace roadbed::map::lanelet2 {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

// What editors mark as deleted (JOSM) counts as gone.
bool is_deleted(pugi::xml_node element) {
  return std::string_view(element.attribute("action").value()) == "delete";
}

std::optional<std::int64_t> id_in(std::string_view text) {
  std::int64_t id = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return id;
}

// A node before its place in the map is known.
struct RawNode {
  NodePlace place{kNothing, kNothing, kNothing, kNothing};
  double elevation_m = 0.0;
};

class DocumentReader {
 public:
  explicit DocumentReader(const XmlDocument& xml) : document_(xml) {}

  Document read() {
    for (const pugi::xml_node child : document_.xml.root().children()) {
      if (child.type() == pugi::node_element && !is_deleted(child)) add(child);
    }
    place_nodes();
    document_.node_index = index_of(document_.nodes, "node");
    for (Way& way : document_.ways) add_way_nodes(way);
    document_.way_index = index_of(document_.ways, "way");
    document_.relation_index = index_of(document_.relations, "relation");
    return std::move(document_);
  }

 private:
  void add(pugi::xml_node child) {
    const std::string_view kind = child.name();
    if (kind != "node" && kind != "way" && kind != "relation") {
      if (kind != "bounds") ++document_.unused["osm/" + std::string(kind)];
      return;
    }
    const std::optional<std::int64_t> id = id_in(child.attribute("id").value());
    if (!id) {
      document_.fault(child, "import.id", "its id is not a whole number and it is left out");
    } else if (kind == "node") {
      add_node(child, *id);
    } else if (kind == "way") {
      document_.ways.push_back(
          {*id, {}, tag(child, "type"), tag(child, "subtype"), tags_of(child), child, false});
    } else {
      add_relation(child, *id);
    }
  }

  void add_node(pugi::xml_node xml, std::int64_t id) {
    RawNode raw;
    raw.place.latitude_deg = number_in(xml.attribute("lat").value());
    raw.place.longitude_deg = number_in(xml.attribute("lon").value());
    for (const pugi::xml_node child : xml.children()) {
      const std::string_view key = child.attribute("k").value();
      const char* const value = child.attribute("v").value();
      if (key == "local_x") {
        raw.place.local_x_m = number_in(value);
      } else if (key == "local_y") {
        raw.place.local_y_m = number_in(value);
      } else if (key == "ele") {
        raw.elevation_m = number_in(value);
      } else if (key == "mgrs_code" && mgrs_code_.empty()) {
        mgrs_code_ = value;
      }
    }
    if (!(std::abs(raw.elevation_m) < 1e5)) {
      if (bad_elevations_++ == 0) first_bad_elevation_ = xml;
      raw.elevation_m = 0.0;
    }
    document_.nodes.push_back({id, {0, 0, raw.elevation_m}, false, xml});
    places_.push_back(raw.place);
  }

  void add_relation(pugi::xml_node xml, std::int64_t id) {
    Relation relation{id, tag(xml, "type"), tag(xml, "subtype"), {}, xml};
    for (const pugi::xml_node child : xml.children("member")) {
      const std::string_view kind = child.attribute("type").value();
      const std::optional<std::int64_t> ref = id_in(child.attribute("ref").value());
      if (!ref || (kind != "node" && kind != "way" && kind != "relation")) {
        document_.fault(child, "import.reference", "names no node, way or relation");
        continue;
      }
      relation.members.push_back({kind == "node"  ? MemberKind::node
                                  : kind == "way" ? MemberKind::way
                                                  : MemberKind::relation,
                                  *ref, child.attribute("role").value()});
    }
    document_.relations.push_back(std::move(relation));
  }

  // Positions relative to a local origin, a whole number of kilometres in the file's coordinates.
  void place_nodes() {
    const Frame frame(places_, mgrs_code_);
    // A file that roadbed wrote says in its root what the local coordinates are.
    const std::string said = document_.xml.root().attribute("crs").value();
    document_.crs = frame.is_local() && !said.empty() ? said : frame.crs();
    if (document_.crs.empty() && !frame.doubt().empty()) {
      document_.remarks.push_back(
          {"import.crs-unknown", false, "file", 0, frame.doubt() + "; its CRS is unknown"});
    }
    bool first = true;
    std::size_t lost = 0;
    pugi::xml_node example;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const auto position = frame.place(places_[i]);
      Node& node = document_.nodes[i];
      if (!position) {
        if (lost++ == 0) example = node.xml;
        continue;
      }
      if (first) document_.origin_in_source = (*position / 1000.0).array().round() * 1000.0;
      first = false;
      node.in_map.head<2>() = *position - document_.origin_in_source;
      node.placed = true;
    }
    if (lost > 0) {
      document_.fault(example, "import.node-position",
                      fmt::format("{} nodes, this one first, have no usable coordinates", lost));
    }
    if (bad_elevations_ > 0) {
      document_.fault(first_bad_elevation_, "import.elevation",
                      fmt::format("{} nodes, this one first, have an elevation that is no height "
                                  "on earth; 0 is used",
                                  bad_elevations_));
    }
    places_ = {};
  }

  void add_way_nodes(Way& way) {
    std::size_t missing = 0;
    std::string first;
    for (const pugi::xml_node child : way.xml.children("nd")) {
      const char* const written = child.attribute("ref").value();
      const std::optional<std::int64_t> id = id_in(written);
      const auto place = id ? document_.node_index.find(*id) : std::nullopt;
      if (place && document_.nodes[*place].placed) {
        way.nodes.push_back(*place);
      } else if (missing++ == 0) {
        first = written;
      }
    }
    if (missing > 0) {
      document_.fault(
          way.xml, "import.reference",
          fmt::format("{} of its nodes, first {}, are not there or have no place", missing, first));
    }
  }

  template <typename Element>
  IdIndex index_of(const std::vector<Element>& elements, const char* kind) {
    std::vector<std::pair<std::int64_t, std::uint32_t>> ids;
    ids.reserve(elements.size());
    for (const Element& element : elements) {
      ids.emplace_back(element.id, static_cast<std::uint32_t>(ids.size()));
    }
    IdIndex index(std::move(ids));
    if (index.repeated() > 0) {
      document_.remarks.push_back(
          {"import.duplicate-id", true, "file", 0,
           fmt::format("{} {}s have an id that came before; the first of each is used",
                       index.repeated(), kind)});
    }
    return index;
  }

  Document document_;
  std::vector<NodePlace> places_;
  std::string mgrs_code_;
  std::size_t bad_elevations_ = 0;
  pugi::xml_node first_bad_elevation_;
};

}  // namespace

std::vector<Eigen::Vector3d> Document::points(const Way& way) const {
  std::vector<Eigen::Vector3d> found;
  found.reserve(way.nodes.size());
  for (const std::uint32_t node : way.nodes) found.push_back(nodes[node].in_map);
  return found;
}

void Document::fault(pugi::xml_node element, const char* rule, std::string message) {
  remarks.push_back({rule, true,
                     fmt::format("{} {}", element.name(), element.attribute("id").value()),
                     xml.line_of(element), std::move(message)});
}

Document read_document(const XmlDocument& xml) { return DocumentReader(xml).read(); }

std::string_view tag(pugi::xml_node element, std::string_view key) {
  for (const pugi::xml_node child : element.children("tag")) {
    if (child.attribute("k").value() == key) return child.attribute("v").value();
  }
  return {};
}

Attributes tags_of(pugi::xml_node element) {
  Attributes tags;
  for (const pugi::xml_node child : element.children("tag")) {
    tags.emplace_back(child.attribute("k").value(), child.attribute("v").value());
  }
  return tags;
}

double number_in(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    return kNothing;
  }
  return value;
}

}  // namespace roadbed::map::lanelet2
