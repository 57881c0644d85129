#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/map/commonroad/document.h"
#include "roadbed/map/edit/clipping/region.h"
#include "roadbed/map/edit/clipping/touching_spans.h"

namespace roadbed::map::inline edit::inline clipping {

/// A lanelet of CommonRoad: rows of a left and a right point, in its driving direction.
struct Ladder {
  pugi::xml_node node;
  std::string id;
  std::vector<Eigen::Vector2d> left, right;
  std::size_t group = 0;
  bool against = false;  ///< runs against its group's direction

  double last_row() const { return static_cast<double>(left.size() - 1); }
  /// A row of its group, counted along itself, and back.
  double own_row(double row) const { return against ? last_row() - row : row; }
  /// Whether its rows have both points.
  bool is_regular() const { return left.size() == right.size(); }
};

/// The lanelets of a map. Those beside each other, with rows that correspond, are a group: they are
/// cut together.
class LadderMap {
 public:
  /// @param document  outlives it.
  explicit LadderMap(const commonroad::Document& document);

  const std::vector<Ladder>& ladders() const { return ladders_; }
  const std::vector<pugi::xml_node>& unusable() const {
    return unusable_;
  }  ///< without two borders

  /// What of each group a region touches, in rows.
  /// @param whole  what is touched is touched all over.
  std::vector<std::vector<Span>> spans_inside(const Region& region, bool whole) const;

 private:
  using Group = std::vector<std::size_t>;  // of ladders

  void read(const XmlDocument& xml, pugi::xml_node lanelet);
  void make_groups();
  void add_neighbours(std::size_t index);
  std::vector<Span> spans_of(const Group& group, const Region& region) const;
  static geometry::Box box_of(const Ladder& ladder, double from, double to);
  geometry::Box box_of(const Group& group, double from, double to) const;
  Region::Side side_of(const Group& group, double from, double to, const RegionPart& region) const;
  double length_m(const Group& group, double from, double to) const;
  bool touches(const Group& group, double row, const RegionPart& region) const;

  std::vector<Ladder> ladders_;
  std::vector<pugi::xml_node> unusable_;
  std::map<std::string, std::size_t> by_id_;
  std::vector<Group> groups_;
  geometry::BoxTree tree_;  // of the groups
};

}  // namespace roadbed::map::edit::clipping
