#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/derived/components.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline derived {

struct MapAreas {
  double drivable_m2 = 0.0;   ///< under drivable lanes, what several cover once
  double junctions_m2 = 0.0;  ///< of each junction the same of its connecting roads' lanes
};

/// What a map amounts to: what `info` says of it besides the lengths of its lists. Stands in its
/// compiled form, so that a large map says it without being read.
struct MapTotals {
  struct Bounds {
    Eigen::Vector2d low_in_map, high_in_map;
  };

  std::vector<std::uint64_t> lanes_of_type;  ///< by LaneType, one number for each
  double roads_m = 0.0;                      ///< of all reference lines
  double drivable_lanes_m = 0.0;
  std::optional<MapAreas> areas;  ///< none of small maps, and where `covered_areas` has none
  std::optional<Bounds> bounds;   ///< of lane borders and areas
  std::vector<std::uint64_t> component_lanes;  ///< of `drivable_components`, the largest first
  std::vector<std::pair<std::string, std::uint64_t>> remarks;  ///< by rule, in order of rule
  bool has_road_areas = false;
};

/// Adds totals up from a map's things, which come one by one, list by list and in order; links
/// after the lanes. Areas are not among them. Keeps five bytes a lane.
class TotalsCounter {
 public:
  TotalsCounter();

  void add(const Road& road) { totals_.roads_m += road.length_m; }
  void add(const Lane& lane);
  void add(const LaneLinks& links);
  void add(const Area& area);
  void add(const ImportDiagnostic& remark);

  /// Other things count for nothing.
  template <typename Thing>
  void add(const Thing& /*thing*/) {}

  MapTotals totals() &&;

 private:
  void extend(const std::vector<Eigen::Vector2d>& points_in_map);

  MapTotals totals_;
  std::vector<bool> is_drivable_;  // of each lane
  std::optional<LaneGroups> groups_;
  std::uint32_t links_ = 0;
};

/// None where lanes lie upon each other by the thousand.
std::optional<MapAreas> covered_areas(const RoadMap& road_map, int threads = 1);

/// The totals of a map: those in its compiled form, else added up now, which touches everything.
/// @param threads  that may be used.
/// @throws InputError if the compiled map is damaged.
MapTotals totals_of(const RoadMap& road_map, int threads = 1);

/// Totals as bytes, in a compiled map.
std::string write_totals(const MapTotals& totals);

/// Whether those in a compiled map, if there are any, are what was counted, areas apart.
/// @throws InputError if they are damaged.
bool are_stored_as(const RoadMap& road_map, MapTotals counted);

}  // namespace roadbed::map::derived
