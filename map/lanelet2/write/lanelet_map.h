#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/lanelet2/build_map.h"
#include "roadbed/map/lanelet2/write/osm_map.h"
#include "roadbed/map/lanelet2/write/tags.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::lanelet2 {

/// A map as elements of a Lanelet2 file, and which of them each of its things became.
struct LaneletMap {
  explicit LaneletMap(std::int64_t first_fresh_id) : osm(first_fresh_id) {}

  OsmMap osm;
  std::vector<std::optional<std::uint32_t>> lanelets;  ///< by LaneId; none: left out
  std::vector<std::array<Border, 2>> borders;          ///< left, right; by LaneId
  std::map<std::string, std::uint32_t> lines;   ///< ways of regulations and signals by source id
  std::map<std::string, std::uint32_t> points;  ///< nodes that regulations name
  std::vector<std::uint32_t> stop_lines;        ///< ways, by place in RoadMap::stop_lines()

  std::size_t left_out = 0;        ///< lanes that nobody may use
  std::size_t straightened = 0;    ///< borders that folded over themselves
  std::size_t lost_links = 0;      ///< see SharedBorders
  std::size_t unwanted_links = 0;  ///< likewise
  double largest_move_m = 0.0;     ///< likewise
  double largest_step_m = 0.0;     ///< likewise

  /// The lanes that relations are lanelets of.
  std::map<std::uint32_t, LaneId> lanes_by_relation() const;

  Attributes& tags_of(LaneId lane) { return osm.relations[*lanelets[lane.index]].tags; }
  const Attributes& tags_of(LaneId lane) const { return osm.relations[*lanelets[lane.index]].tags; }
};

struct LaneletChoices {
  std::function<bool(const Lane&)> is_wanted = is_writable;  ///< of maps of other formats
  bool areas = true;                                         ///< of maps of other formats
  bool centrelines = true;  ///< written where Lanelet2 would not come to the same by itself
};

/// Lanes as lanelets whose borders are shared by neighbours and their end nodes by successors, with
/// regulatory elements, signs, lights, stop lines, areas and objects.
/// @throws InputError if no lane can be one: nobody reads a map without.
LaneletMap lanelet_map(const RoadMap& road_map, const LaneletChoices& choices = {});

/// Regulatory elements, signs, lights, stop lines, areas and objects, to lanelets that are there.
void add_furniture(const RoadMap& road_map, const LaneletChoices& choices, LaneletMap& made);

inline constexpr auto kFlattenedLimits =
    "changes of the speed limit along a lane, which has the least";
/// How many lanelets have one limit, the least, where the map's lanes change it along the way.
std::size_t flattened_limits(const RoadMap& road_map, const LaneletMap& made);

/// What the user should know of it, a line each.
std::vector<std::string> notes_of(const LaneletMap& made);

/// Whether the map was read from a Lanelet2 file, so that its words are Lanelet2's.
inline bool is_from_lanelet2(const RoadMap& road_map) { return road_map.format() == "Lanelet2"; }

}  // namespace roadbed::map::lanelet2
