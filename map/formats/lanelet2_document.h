#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/formats/lanelet2_ids.h"
#include "roadbed/map/formats/xml.h"
#include "roadbed/map/road_map.h"

namespace roadbed::map::lanelet2 {

/// A point; its elevation is 0 where the file gives none.
struct Node {
  std::int64_t id = 0;
  Eigen::Vector3d in_map{0, 0, 0};
  bool placed = false;  ///< it has usable coordinates
  pugi::xml_node xml;
};

/// A line through nodes, those that are missing or have no place left out.
struct Way {
  std::int64_t id = 0;
  std::vector<std::uint32_t> nodes;
  std::string_view type, subtype;
  Attributes tags;
  pugi::xml_node xml;
  bool used = false;  ///< the map holds what it says
};

enum class MemberKind { node, way, relation };

struct Member {
  MemberKind kind = MemberKind::way;
  std::int64_t id = 0;
  std::string_view role;
};

/// Elements with roles: a lanelet, an area, a regulatory element.
struct Relation {
  std::int64_t id = 0;
  std::string_view type, subtype;
  std::vector<Member> members;
  pugi::xml_node xml;
};

/// A Lanelet2 file element by element, nodes in one coordinate system. Holds views of the XML.
struct Document {
  explicit Document(const XmlDocument& source) : xml(source) {}

  const XmlDocument& xml;
  std::vector<Node> nodes;
  std::vector<Way> ways;
  std::vector<Relation> relations;
  IdIndex node_index, way_index, relation_index;
  std::string crs;
  Eigen::Vector2d origin_in_source{0, 0};
  std::vector<ImportRemark> remarks;
  std::map<std::string, std::size_t> unused;

  /// Points of a way.
  std::vector<Eigen::Vector3d> points(const Way& way) const;

  /// Remarks a fault of the file at an element.
  void fault(pugi::xml_node element, const char* rule, std::string message);
};

/// @throws InputError if the file has no lanelet at all.
Document read_document(const XmlDocument& xml);

/// Value of an element's tag; empty if it has none.
std::string_view tag(pugi::xml_node element, std::string_view key);

/// All tags of an element.
Attributes tags_of(pugi::xml_node element);

/// A finite number that a text begins and ends with; NaN if it is none.
double number_in(std::string_view text);

}  // namespace roadbed::map::lanelet2
