#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/formats/lanelet2_ids.h"
#include "roadbed/map/formats/line_starts.h"
#include "roadbed/map/formats/xml_scanner.h"
#include "roadbed/map/road_map.h"

namespace roadbed::map::lanelet2 {

/// A point; its elevation is 0 where the file gives none.
struct Node {
  std::int64_t id = 0;
  Eigen::Vector3d in_map{0, 0, 0};
  bool placed = false;  ///< it has usable coordinates
  std::size_t at = 0;   ///< where its start tag is in the text
};

/// A line through nodes, those that are missing or have no place left out.
struct Way {
  std::int64_t id = 0;
  std::vector<std::uint32_t> nodes;
  std::string_view type, subtype;
  Attributes tags;
  std::size_t at = 0;  ///< where its start tag is in the text
  bool used = false;   ///< the map holds what it says
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
  std::size_t at = 0;  ///< where its start tag is in the text
};

/// A Lanelet2 file element by element, nodes in one coordinate system. Holds views of the text.
struct Document {
  Document(const std::string& bytes, std::string file)
      : text(bytes), name(std::move(file)), scanner(text, name) {}

  std::string_view text;
  std::string name;
  XmlScanner scanner;  ///< holds what it decoded
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

  /// All tags of the element that begins at a place of the text.
  Attributes tags_of(std::size_t at) const;

  /// Remarks a fault of the file at the element that begins there.
  void fault(std::size_t at, const char* rule, std::string message);

 private:
  std::optional<LineStarts> line_starts_;  // made for the first fault
};

/// @param bytes  UTF-8; must outlive the document.
/// @throws InputError if they are not well-formed XML, or hold more elements than a map of their
///         size does.
Document read_document(const std::string& bytes, const std::string& name);

/// A finite number that a text begins and ends with; NaN if it is none.
double number_in(std::string_view text);

}  // namespace roadbed::map::lanelet2
