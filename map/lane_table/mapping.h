#pragma once

#include <map>
#include <optional>
#include <string>

#include "roadbed/map/elements/lane.h"

namespace roadbed::map::lane_table {

/// A number that is the same for all lanes, or stands in a column.
struct NumberColumn {
  std::optional<double> value;
  std::string column;  ///< empty if there is none
};

/// How lanes are drawn.
enum class Drawing {
  centreline,  ///< a line in driving direction, and a width
  borders,     ///< two lines for each lane, in driving direction
  polygon,     ///< its outline, and a compass direction
};

/// What the columns of a table of lanes mean: a JSON object like
/// `{"drawing": "centreline", "lane": "id", "width_m": 3.5, "type": "kind",
///   "types": {"cycle": "biking"}, "speed_kmh": "limit", "successors": "next"}`.
/// Every key may be missing; `layer` names the layer of a GeoPackage.
struct Mapping {
  Drawing drawing = Drawing::centreline;
  std::string layer;
  std::string lane;                       ///< column of the lane's id; empty: that of the feature
  std::string side;                       ///< of borders: column that says left or right
  NumberColumn width_m;                   ///< of centrelines
  NumberColumn heading_deg;               ///< of polygons: driving direction, clockwise from north
  std::string type;                       ///< column; empty: all lanes are for driving
  std::map<std::string, LaneType> types;  ///< of words of the column
  NumberColumn speed_kmh;
  std::string successors;  ///< column of ids with blanks, commas or semicolons between;
                           ///< empty: lanes whose ends coincide are linked
  double link_m = 0.1;     ///< ends that are no farther apart coincide
};

/// @throws InputError if it is no such object.
Mapping read_mapping(const std::string& bytes, const std::string& name);

}  // namespace roadbed::map::lane_table
