#pragma once

#include <array>
#include <optional>
#include <vector>

#include "roadbed/geometry/curves/piecewise_cubic.h"
#include "roadbed/geometry/curves/plan_view.h"
#include "roadbed/map/opendrive/document.h"
#include "roadbed/map/opendrive/write/fit_cubics.h"
#include "roadbed/map/opendrive/write/placed_road.h"
#include "roadbed/map/opendrive/write/road_plan.h"

namespace roadbed::map::opendrive {

/// How near a written border is to the map's.
inline constexpr double kBorderTolerance_m = 0.006;

/// The shape of a section: of each lane, from left to right, its width, its heights above the
/// road's plane (none in rims), and the road's s by its own stations.
struct SectionShape {
  double s_m = 0.0;
  std::size_t left_lanes = 0;
  std::vector<geometry::PiecewiseCubic> widths;
  std::vector<std::vector<LaneHeight>> heights;
  std::vector<std::vector<Sample>> s_of_station;
  /// In a rim, whether a lane is still there between two borders; of other sections all are.
  std::vector<bool> has_lane;

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
  std::vector<SectionShape> sections;  ///< as planned
  /// Before the first and behind the last section, by s: stretches in which some borders have
  /// ended, and lie on the next one that has not.
  std::array<std::vector<SectionShape>, 2> rims;
  double height_error_m = 0.0;  ///< largest of a border's elevation
};

/// A section of a file: one of the plan, or a rim of it.
struct WrittenSection {
  const SectionShape* shape = nullptr;
  std::size_t planned = 0;
  double from_m = 0.0, to_m = 0.0;

  bool is_rim() const { return !shape->has_lane.empty(); }
  bool has_lane(std::size_t lane) const { return !is_rim() || shape->has_lane[lane]; }
};

/// All sections of a road, by s.
std::vector<WrittenSection> written_sections(const RoadShape& shape);

/// The section that a road has just before s.
std::size_t section_before(const RoadShape& shape, double s_m);

/// Offsets, widths and heights of a road whose borders are placed.
RoadShape shape_road(const RoadMap& road_map, const PlannedRoad& road, const PlacedRoad& placed);

}  // namespace roadbed::map::opendrive
