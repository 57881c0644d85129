#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/opendrive/write/road_plan.h"
#include "roadbed/map/opendrive/write/road_shape.h"

namespace roadbed::map::opendrive {

/// What a road end leads to: another road's end, or a junction.
struct PartLink {
  bool to_junction = false;
  std::uint32_t target = 0;  ///< place among the parts, or junctions
  bool at_end = false;       ///< the end of the other road
};

/// A road as it is written: a planned one, or a piece of it.
struct RoadPart {
  std::uint32_t road = 0;  ///< in the plan
  double from_m = 0.0, to_m = 0.0;
  std::string id;
  std::optional<std::uint32_t> junction;           ///< that it is a connecting road of
  std::array<std::optional<PartLink>, 2> links{};  ///< at its start and end
  /// At its start and end: pairs of one of its lanes, by its place in the section there, and the id
  /// of a lane of the other road.
  std::array<std::vector<std::pair<std::uint32_t, int>>, 2> lane_links{};
  /// Places of lanes that another copy of this piece has: they only take their width.
  std::vector<std::uint32_t> bare_lanes;
};

struct WrittenConnection {
  std::uint32_t incoming = 0, connecting = 0;  ///< parts
  bool at_end = false;                         ///< of the connecting road
  std::vector<std::pair<int, int>> lanes;      ///< from, to
};

struct WrittenJunction {
  std::string id, name;
  std::vector<WrittenConnection> connections;
};

struct RoadNetwork {
  std::vector<RoadPart> parts;
  std::vector<std::vector<std::uint32_t>> parts_of;  ///< by planned road, by s
  std::vector<WrittenJunction> junctions;
  /// From a lane to one that begins at the same end of the same road, or at ends without width.
  std::size_t lost_links = 0;
};

/// The id of a lane of a section: left ones positive, right ones negative.
int lane_id(const PlannedSection& section, std::size_t place);

/// The plan, with roads of one direction wherever OpenDRIVE asks for it: inside junctions.
/// @param company  the most that lanes may have, by LaneId.
/// @param minor  of the revision 1.4 to 1.8.
RoadPlan plan_network_roads(const RoadMap& road_map, std::vector<Company> company, int minor);

/// How the roads join. Where two ends meet, roads are linked; where more do, those that meet all
/// others there lead into a junction, the others are its connecting roads, or their first metres
/// where their far end leads into another junction. Where no end meets all others, the roads that
/// begin there begin with a connecting road for each that ends there.
///
///        ──────●═══════●──────      ● ends meet, ═ connecting road
///               ╲═══╗
///                   ●─────
/// @param shapes  of the planned roads.
RoadNetwork join_roads(const RoadMap& road_map, const RoadPlan& plan,
                       const std::vector<RoadShape>& shapes);

}  // namespace roadbed::map::opendrive
