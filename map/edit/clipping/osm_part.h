#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/lanelet2/document.h"

namespace roadbed::map::inline edit::inline clipping {

/// Where the nodes, ways and relations of a file of OpenStreetMap's XML stand in it.
class OsmLayout {
 public:
  /// @param document  outlives it.
  explicit OsmLayout(const lanelet2::Document& document);

  /// The element that begins there.
  std::size_t index_of(std::size_t at) const;

  std::size_t count() const { return elements_.size(); }
  std::string_view element(std::size_t i) const {
    return between(elements_[i].at, elements_[i].end);
  }
  /// What stands before an element and behind the one before it; of count(): before the end.
  std::string_view gap(std::size_t i) const;
  /// Gaps that hold more than blanks.
  const std::vector<std::size_t>& said_gaps() const { return said_gaps_; }
  /// The last element of each kind, or of the kind before.
  std::size_t last_of(lanelet2::MemberKind kind) const {
    return last_.at(static_cast<std::size_t>(kind));
  }

 private:
  struct Place {
    std::size_t at, end;
  };

  std::string_view between(std::size_t from, std::size_t to) const {
    return text_.substr(from, to - from);
  }

  std::string_view text_;
  std::vector<Place> elements_;
  std::vector<std::size_t> said_gaps_;
  std::array<std::size_t, 3> last_{};
};

/// A file of which only some elements stay, and others are added. What is no element stays, too:
/// comments, bounds, elements without an id. Costs no more than what stays.
class OsmPart {
 public:
  /// @param layout  outlives it.
  explicit OsmPart(const OsmLayout& layout) : layout_(layout) {}

  /// The element that begins there stays, or this text stands in its place; the last word counts.
  void keep(std::size_t at, std::string text = {});

  /// Behind all others of their kind.
  void add(lanelet2::MemberKind kind, const std::string& text);

  std::string_view text_of(std::size_t at) const { return layout_.element(layout_.index_of(at)); }

  /// The whole file.
  std::string file() &&;

 private:
  const OsmLayout& layout_;
  std::vector<std::pair<std::size_t, std::string>> kept_;  // by index
  std::array<std::string, 3> added_;                       // of each kind
};

}  // namespace roadbed::map::edit::clipping
