#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/lanelet2/document.h"

namespace roadbed::map::lanelet2 {

/// The elements of a file as they stand in its text, one after the other: nodes have no place in
/// the map yet, ways and relations none of their lists.
struct ElementLists {
  /// Places in a list: the first one, and that behind the last.
  struct Range {
    std::size_t from, to;
  };

  static constexpr std::int64_t kNoId = std::numeric_limits<std::int64_t>::min();

  std::vector<Node> nodes;
  std::vector<NodePlace> places;  ///< of the nodes
  std::vector<Way> ways;
  std::vector<Range> way_refs;     ///< of `refs`, those of each way
  std::vector<std::int64_t> refs;  ///< to nodes; kNoId: the text is no number
  std::vector<Range> way_tags;     ///< of `tags`
  std::vector<Relation> relations;
  std::vector<Range> relation_tags;
  std::vector<Range> relation_members;  ///< of `members`
  std::vector<Tag> tags;
  std::vector<Member> members;

  std::string crs;        ///< that the root names
  std::string mgrs_code;  ///< the first that a node names
  std::size_t bad_elevations = 0, first_bad_elevation_at = 0;
  std::vector<ImportDiagnostic> remarks;
  std::map<std::string, std::size_t> unused;
  std::size_t left_bytes = 0;  ///< of the memory that the file may cost
};

/// What memory is spent on, besides the text [bytes]: at worst, while a list grows.
struct ElementCost {
  static constexpr std::size_t node = 3 * sizeof(Node) + 3 * sizeof(NodePlace) + 16;
  static constexpr std::size_t other = 3 * std::max(sizeof(Way), sizeof(Relation)) + 16;
  static constexpr std::size_t child = 100;
  static constexpr std::size_t fault = 400;
};

/// Takes memory from what is left of it. @throws InputError if there is not as much
void spend(std::size_t bytes, std::size_t& left_bytes, const std::string& file);

/// Reads a document's text, long ones in stretches at once; what is read is the same for any number
/// of threads. What had to be decoded stays in the document's scanners.
/// @throws InputError if the text is not well-formed, or holds more elements than a map of its size
///         does.
ElementLists read_elements(Document& document, int threads);

}  // namespace roadbed::map::lanelet2
