#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "roadbed/map/opendrive/write/reference_table.h"
#include "roadbed/map/opendrive/write/road_lines.h"

namespace roadbed::map::opendrive {

/// The place (s, t) of a point beside a road: its foot is searched from `s_m` on. Beyond the ends
/// the road goes straight on.
struct RoadPosition {
  double s_m = 0.0, t_m = 0.0;
  double bend = 1.0;  ///< 1 − κ t: positive as long as cross-sections do not cross
};
RoadPosition position_beside(const ReferenceTable& reference, const Eigen::Vector2d& in_map,
                             double s_m);

/// A point of a border beside the reference line.
struct BesidePoint {
  double s_m, t_m, z_m;
};
using BesideLine = std::vector<BesidePoint>;

/// The line at a station, constant beyond its ends.
/// @param hint  where to look first, no point there being behind the station; is left where it was
///              found.
BesidePoint point_at(const BesideLine& line, double s_m, std::size_t& hint);

/// The part of a line between two stations.
BesideLine clipped(const BesideLine& line, double from_m, double to_m);

/// What is wrong with borders beside a reference line: nothing where every cross-section crosses
/// each of them once, at more than 18°, and no other cross-section before that.
struct BesideFaults {
  double least_bend = 1.0;  ///< of a point of a border
  double back_m = 0.0;      ///< how far one runs back along s
  double missing_m = 0.0;   ///< how much of one there is not, or lies beyond the road's end
  double sideways_m = 0.0;  ///< how far one goes more across the road than along it
  double crossing_m = 0.0;  ///< how far one is on the wrong side of the next
};

/// How a border is placed.
struct BesideOptions {
  double chord_m = 5e-4;  ///< how far a straight chord may be from its points' line in (s, t)
  /// As soon as a bend is less than this, the line is of no use: the rest is placed coarsely.
  double hopeless_bend = -1e300;
  std::array<bool, 2> may_end{};  ///< before the road does, at its start and end
};

/// A border beside a reference line, and the stations between which the map has it.
struct PlacedBorder {
  BesideLine line;
  double from_m = 0.0, to_m = 0.0;
};

/// A border over [from, to] of the road, by growing s. Where it runs back its points are left out,
/// where it does not reach it goes straight on.
/// @param faults  grow by those of the border.
PlacedBorder line_beside(const ReferenceTable& reference, const RoadBorder& border, double from_m,
                         double to_m, BesideFaults& faults, const BesideOptions& options = {});

}  // namespace roadbed::map::opendrive
