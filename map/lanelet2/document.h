#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/files/line_starts.h"
#include "roadbed/map/files/xml_scanner.h"
#include "roadbed/map/lanelet2/frame.h"
#include "roadbed/map/lanelet2/ids.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::lanelet2 {

/// Key and value as they stand in the text.
using Tag = std::pair<std::string_view, std::string_view>;
using Tags = std::span<const Tag>;

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
  std::span<const std::uint32_t> nodes;
  std::string_view type, subtype;
  Tags tags;
  std::size_t at = 0;               ///< where its start tag is in the text
  bool used = false;                ///< the map holds what it says
  std::uint32_t references = 0;     ///< to nodes, as the text has them
  std::uint32_t missing = 0;        ///< of these, to nodes that are not in the file
  std::uint32_t first_missing = 0;  ///< which one of the references
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
  std::span<const Member> members;
  Tags tags;
  std::size_t at = 0;  ///< where its start tag is in the text
};

/// A Lanelet2 file element by element, nodes in one coordinate system. Holds views of its text, and
/// elements hold views of its lists.
struct Document {
  Document(std::string bytes, std::string file);
  Document(Document&&) = default;

  std::unique_ptr<const std::string> utf8;
  std::string_view text;
  std::string name;
  std::vector<XmlScanner> scanners;  ///< hold what they decoded
  std::vector<Node> nodes;
  std::vector<NodePlace> places;  ///< of the nodes, as they say it
  std::vector<Way> ways;
  std::vector<Relation> relations;
  std::vector<std::uint32_t> way_nodes;  ///< of all ways, one after the other
  std::vector<Tag> tags;                 ///< of all ways and relations
  std::vector<Member> members;           ///< of all relations
  IdIndex node_index, way_index, relation_index;
  std::string crs;
  Eigen::Vector2d origin_in_source{0, 0};
  std::vector<ImportDiagnostic> remarks;
  std::map<std::string, std::size_t> unused;

  /// Points of a way.
  std::vector<Eigen::Vector3d> points(const Way& way) const;

  /// All tags of the element that begins at a place of the text.
  Attributes tags_of(std::size_t at) const;

  /// How the text names a node of a way.
  std::string written_reference(const Way& way, std::size_t index) const;

  /// Line of a place in the text, from 1.
  long line_of(std::size_t at) const;

  /// A fault of the file at the element that begins there.
  ImportDiagnostic fault_at(std::size_t at, const char* rule, std::string message) const;

  /// Remarks it.
  /// @returns the remark, until the next one.
  ImportDiagnostic& fault(std::size_t at, const char* rule, std::string message);

 private:
  struct Lines {
    std::once_flag once;
    std::optional<LineStarts> starts;
  };
  std::unique_ptr<Lines> lines_ = std::make_unique<Lines>();  // made for the first line
};

/// @param threads  that may be used.
/// @throws InputError if the bytes are not well-formed XML, or hold more elements than a map of
///         their size does.
Document read_document(std::string bytes, const std::string& name, int threads = 1);

/// Tags as text of its own, and views of such text.
Attributes attributes_of(Tags tags);
std::vector<Tag> views_of(const Attributes& tags);

/// The whole number that a text is; none if it is something else.
std::optional<std::int64_t> id_in(std::string_view text);

/// A finite number that a text begins and ends with; NaN if it is none.
double number_in(std::string_view text);

}  // namespace roadbed::map::lanelet2
