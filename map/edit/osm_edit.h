#pragma once

#include <cstdint>
#include <forward_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/edit/row_span.h"
#include "roadbed/map/files/xml_places.h"
#include "roadbed/map/lanelet2/document.h"

namespace roadbed::map::inline edit {

/// Where a clip keeps what it took from a way or a relation: a tag of this key.
inline constexpr std::string_view kClipKey = "roadbed:clip";

/// A node, way or relation as text, taken apart so far that it can be written again with other
/// children; what is not changed stays as it stands, byte by byte.
class OsmElement {
 public:
  /// @param text  of the element, from `<` of its start tag to `>` of its end; outlives it.
  explicit OsmElement(std::string_view text);

  // Children are views of texts that it keeps.
  OsmElement(const OsmElement&) = delete;
  OsmElement& operator=(const OsmElement&) = delete;
  OsmElement(OsmElement&&) = default;
  OsmElement& operator=(OsmElement&&) = default;
  ~OsmElement() = default;

  void set_attribute(std::string_view name, std::string_view value);

  /// Leaves tags, and puts these in place of `<nd>` or `<member>`.
  void set_nodes(const std::vector<std::int64_t>& ids);
  void set_members(const std::vector<lanelet2::Member>& members);

  /// Puts a tag in place of that of its key, or behind the others.
  void set_tag(std::string_view key, std::string_view value);
  void remove_tag(std::string_view key);

  /// Its tags but for that of a clip, and where it has others than `<nd>` and `<member>`, these.
  std::string said() const;

  std::string text() const;

 private:
  struct Child {
    std::string_view name;
    std::string key;        ///< of a tag
    std::string_view text;  ///< in the source, or made
  };

  void put_first(std::vector<Child> children, std::string_view in_place_of);
  void add_attribute(std::string_view name, std::string_view value, std::string& text) const;

  std::string_view name_;
  std::string start_;  // start tag without its end, "<way id='5'"
  std::string_view before_child_ = "\n    ", before_end_ = "\n  ";
  char quote_ = '"';
  std::vector<Child> children_;
  std::forward_list<std::string> made_;  // texts of children that the source does not have
};

/// A file of OpenStreetMap's XML in which elements are taken out, changed and added; all else stays
/// byte by byte.
class OsmEdit {
 public:
  /// @param document  outlives it.
  explicit OsmEdit(const lanelet2::Document& document) : document_(document) {}

  /// What stands in place of the element that begins there, empty: nothing; the last word counts.
  void replace(std::size_t at, std::string text) { replaced_.push_back({at, std::move(text)}); }
  void drop(std::size_t at) { replace(at, {}); }

  /// Behind all others of their kind.
  void add(lanelet2::MemberKind kind, const std::string& text);

  std::string_view text_of(std::size_t at) const { return xml_element_at(document_.text, at); }

  /// The whole file.
  std::string file() &&;

 private:
  struct Replacement {
    std::size_t at;
    std::string text;
  };

  const lanelet2::Document& document_;
  std::vector<Replacement> replaced_;
  std::string nodes_, ways_, relations_;
};

/// A file whose root element has this attribute.
std::string with_root_attribute(std::string file, std::string_view name, std::string_view value);

/// The members of a relation as one text, and back; none where it is no such text.
std::string text_of(std::span<const lanelet2::Member> members);
std::optional<std::vector<lanelet2::Member>> members_in(std::string_view text);

/// The value of a tag; empty where there is none.
std::string_view tag_value(lanelet2::Tags tags, std::string_view key);

/// The whole line that a way is a part of, and which, as a clip remembers it, "205 4 8 9"; the way
/// itself where there is nothing, or something that its nodes do not fit.
struct WaySpan : RowSpan {
  std::int64_t whole = 0;
};
WaySpan span_of(const lanelet2::Way& way);

/// The number after the greatest id of a file.
std::int64_t free_id(const lanelet2::Document& document);

}  // namespace roadbed::map::edit
