#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <pugixml.hpp>
#include <string>
#include <vector>

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

/// What of lanelets a region touches. Lanelets beside each other, with rows that correspond, are a
/// group: they are cut together.
struct LadderSpans {
  std::vector<Ladder> ladders;
  std::vector<std::vector<Span>> spans;  ///< of each group, in rows
  std::vector<pugi::xml_node> unusable;  ///< lanelets without two borders
};

/// @param whole  what is touched is touched all over.
LadderSpans ladders_inside(const commonroad::Document& document, const Region& region, bool whole);

}  // namespace roadbed::map::edit::clipping
