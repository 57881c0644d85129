#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "roadbed/map/opendrive/write/road_lines.h"
#include "roadbed/map/opendrive/write/road_plan.h"

namespace roadbed::map::opendrive {

/// The line across a road where it begins or ends: through a point, and the heading of the road
/// there, along s.
struct EndLine {
  Eigen::Vector2d in_map{0, 0};
  double heading_rad = 0.0;
  /// Nothing goes on there: borders may end inside the road, each where the map has it end.
  bool is_rim = false;
  double off_m = 0.0;  ///< how far from amid the ends of the borders
};

/// Lines across the ends of roads, some to choose from, the likeliest first. Roads that join each
/// other have the same, whatever is cut off one being the beginning of the next.
struct EndLines {
  std::vector<std::vector<EndLine>> choices;  ///< by group of ends
  std::vector<std::uint32_t> group_of_end;    ///< ends are 2 · road, + 1 at its end
  std::vector<Eigen::Vector2d> along_of_end;  ///< which way the road goes there

  /// Places among the choices of a group, by how far they are from the ends of the borders.
  std::vector<std::size_t> nearest_first(std::size_t group) const;

  /// A line, its heading along the road of this end.
  EndLine at(std::uint32_t end, std::size_t choice) const;
};

/// Where a border crosses the line across a road's end.
struct Crossing {
  Eigen::Vector2d in_map;
  std::size_t inside = 0;  ///< the next point of the border in the road
};

/// From the border's end inwards to the line; a border that ends before it goes straight on.
Crossing crossing(const RoadBorder& border, const EndLine& line, bool last);

/// Through all ends of the lanes' borders, if these are in line and not too askew; square to the
/// lanes, of roads that lead into a junction where all their borders still go on; and between.
EndLines end_lines(const RoadMap& road_map, const RoadPlan& plan);

}  // namespace roadbed::map::opendrive
