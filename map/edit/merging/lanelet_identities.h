#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/edit/merging/merge.h"
#include "roadbed/map/edit/osm_edit.h"
#include "roadbed/map/lanelet2/document.h"

namespace roadbed::map::inline edit::inline merging {

using OsmId = std::int64_t;
using OsmNames = std::map<OsmId, OsmId>;

/// What an element is called now.
OsmId renamed(const OsmNames& names, OsmId id);

/// A part of a whole line, which all that is not cut is, too.
struct WayPart : WaySpan {
  std::size_t file = 0, way = 0;  ///< which of its file
  std::vector<OsmId> nodes;

  std::size_t first_whole() const { return static_cast<std::size_t>(std::ceil(from)); }
  bool starts_at_cut() const { return static_cast<double>(first_whole()) > from; }
  bool ends_at_cut() const { return std::floor(to) < to; }

  // The node of a point of the whole line; none if it is not in this part.
  const OsmId* at(std::size_t index) const {
    const std::size_t first = first_whole();
    if (index < first || static_cast<double>(index) > to) return nullptr;
    const std::size_t place = index - first + (starts_at_cut() ? 1 : 0);
    return place < nodes.size() ? &nodes[place] : nullptr;
  }
};

/// What of several Lanelet2 files is one, and what it is called in the map that is made of them: of
/// different elements with one id those of later files get others.
class LaneletIdentities {
 public:
  using Place = std::pair<std::size_t, std::size_t>;  ///< file, index

  /// New names of a file's elements.
  struct Names {
    OsmNames nodes, ways, relations;
    std::set<OsmId> cut_nodes;  ///< made by a clip
  };

  /// @param files  outlive it. @param renamings  gets those that are no clip's doing.
  LaneletIdentities(const std::vector<lanelet2::Document>& files, std::vector<Renamed>& renamings);

  const Names& names(std::size_t file) const { return names_[file]; }
  /// Nodes of the merged map, and where they are said.
  const std::map<OsmId, Place>& nodes() const { return nodes_; }
  /// Parts of each whole line, nodes by their new names; they are gone then.
  std::map<OsmId, std::vector<WayPart>> take_ways() { return std::move(ways_); }
  /// From here on no element has the number.
  OsmId free_id() const { return next_id_; }

  /// The lanelet that one is a part of; else its own id.
  static OsmId whole_of(const lanelet2::Relation& relation);

  /// A relation's members in the whole map, as all files call them but for relations.
  std::vector<lanelet2::Member> whole_members(std::size_t file,
                                              const lanelet2::Relation& relation) const;

 private:
  bool is_first(std::size_t f, const lanelet2::Way& way, std::size_t i) const;
  void read_parts(std::size_t f);
  void name_nodes(std::size_t f);
  void name_ways(std::size_t f);
  void name_relations(std::size_t f);
  bool is_same_node(const Place& a, const Place& b) const;
  bool is_one_line(const WayPart& a, const WayPart& b) const;
  std::string said(std::size_t f, std::size_t at) const;
  Renamed named(std::size_t f, const char* kind, OsmId from, OsmId to) const;
  OsmId whole_way(std::size_t f, OsmId way) const;

  const std::vector<lanelet2::Document>& files_;
  OsmId next_id_ = 1;
  std::vector<Names> names_;                    // of each file
  std::vector<WayPart> parts_;                  // of the file that is being read
  std::map<OsmId, Place> nodes_;                // of the merged map
  std::map<OsmId, std::vector<WayPart>> ways_;  // of each whole line
  std::map<OsmId, std::string> relations_;      // what each whole relation says
  std::vector<Renamed>& renamings_;
};

}  // namespace roadbed::map::edit::merging
