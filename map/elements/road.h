#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/map/elements/attributes.h"
#include "roadbed/map/elements/id.h"
#include "roadbed/map/elements/participants.h"

namespace roadbed::map::inline elements {

/// A road of the source: the lanes of all its sections and its reference line.
struct Road {
  RoadId id;
  std::string source_id;
  std::string name;
  std::optional<JunctionId> junction;  ///< of a connecting road
  double length_m = 0.0;
  geometry::Polyline reference_in_map;     ///< sampled; `t` is measured from it
  std::vector<double> reference_road_s_m;  ///< road s, one per point of the reference line
  std::vector<LaneId> lanes;
};

/// How a junction joins roads (ASAM OpenDRIVE 1.8, section 12).
enum class JunctionKind { common, direct, virtual_, crossing };
/// Where roads meet, with the roads that lead across.
struct Junction {
  JunctionId id;
  std::string source_id;
  std::string name;
  JunctionKind kind = JunctionKind::common;
  std::vector<RoadId> connecting_roads;
};

/// An area without a direction of travel: Lanelet2's area, a road surface of a GeoJSON file.
struct Area {
  std::string source_id;
  std::string type;      ///< the source's word: "parking", "walkway", …
  bool is_road = false;  ///< vehicles may be there
  std::vector<geometry::Polygon> in_map;
  Participants participants;
  Attributes attributes;
};

}  // namespace roadbed::map::elements
