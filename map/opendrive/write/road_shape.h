#pragma once

#include <array>
#include <optional>
#include <vector>

#include "roadbed/geometry/curves/piecewise_cubic.h"
#include "roadbed/geometry/curves/plan_view.h"
#include "roadbed/map/opendrive/write/beside_line.h"
#include "roadbed/map/opendrive/write/end_lines.h"
#include "roadbed/map/opendrive/write/fit_cubics.h"
#include "roadbed/map/opendrive/write/road_plan.h"

namespace roadbed::map::opendrive {

/// How near a written border is to the map's.
inline constexpr double kBorderTolerance_m = 0.006;

/// The shape of a section: of each lane, from left to right, its width, and the road's s by its
/// own stations.
struct SectionShape {
  double s_m = 0.0;
  std::vector<geometry::PiecewiseCubic> widths;
  std::vector<std::vector<Sample>> s_of_station;

  /// Whether a lane has any width at the road's s, which lies in the section or at its end.
  bool has_width(std::size_t lane, double at_m) const;

  /// The road's s at a station of a lane.
  double road_s_m(std::size_t lane, double station_m) const;
};

/// A planned road as OpenDRIVE has it.
struct RoadShape {
  std::vector<geometry::PlanPiece> plan_view;
  double length_m = 0.0;
  geometry::PiecewiseCubic elevation, superelevation, lane_offset;
  std::vector<SectionShape> sections;
  double error_m = 0.0;         ///< largest distance of a border to the map's, in plan
  double height_error_m = 0.0;  ///< the same in height
  double fault_m =
      0.0;  ///< how far its cross-sections are from crossing each border once; 0: sound
};

/// The section that a road has just before s.
std::size_t section_before(const RoadShape& shape, double s_m);

/// @param border  of the first section, which the reference line follows; of a road of the map it
///                follows that road's own.
RoadShape shape_road(const RoadMap& road_map, const PlannedRoad& road, std::size_t border,
                     const std::array<EndLine, 2>& ends);

}  // namespace roadbed::map::opendrive
