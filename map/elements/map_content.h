#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "roadbed/map/elements/attributes.h"
#include "roadbed/map/elements/furniture.h"
#include "roadbed/map/elements/lane.h"
#include "roadbed/map/elements/lane_graph.h"
#include "roadbed/map/elements/road.h"

namespace roadbed::map::inline elements {

/// What the loader saw and did not keep, or had to mend: for `info` and `validate`.
struct ImportDiagnostic {
  std::string rule;       ///< "import.unused-element", …
  bool is_fault = false;  ///< a fault of the file (a warning of `validate`), else a note
  std::string element;    ///< "road 12"
  long line = 0;          ///< in the source file, 0 if unknown
  std::string message;
  bool in_text = false;  ///< a rule about the file's text finds the same; compiled maps forget it
};

/// Elements that the file holds and roadbed does not use.
struct UnusedContent {
  std::string name;  ///< of the element, as the file spells it, with its parent: "road/railroad"
  std::size_t count = 0;
};

/// How source coordinates lie in the CRS: turned about the origin, then moved (OpenDRIVE's header
/// offset). Used on the way to the CRS only.
struct CrsOffset {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, heading_rad = 0.0;
  bool operator==(const CrsOffset&) const = default;
};

/// What a map says of itself as a whole. A new field is named in map_fields.h as well.
struct MapHead {
  std::string format;  ///< "OpenDRIVE 1.4", …
  std::string crs;     ///< as the file says, may be empty
  CrsOffset offset_in_crs;
  Eigen::Vector2d origin_in_source{0, 0};
  Attributes attributes;  ///< of the file as a whole: where the map is, who made it
};

/// Everything a map is made of, in lists of one kind. A new list is named in map_fields.h as well.
template <template <typename> typename List>
struct MapContent : MapHead {
  List<Road> roads;
  List<Junction> junctions;
  List<Signal> signals;
  List<Controller> controllers;
  List<StopLine> stop_lines;
  List<Regulation> regulations;
  List<MapObject> objects;
  List<Area> areas;
  List<Lane> lanes;
  List<LaneLinks> links;  ///< one per lane
  List<ImportDiagnostic> remarks;
  List<UnusedContent> unused;  ///< in order of name
};

template <typename T>
using Vector = std::vector<T>;

/// What a reader of a format fills.
struct RoadMapParts : MapContent<Vector> {};

}  // namespace roadbed::map::elements
