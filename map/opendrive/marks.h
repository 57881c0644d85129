#pragma once

#include <vector>

#include "roadbed/map/opendrive/document.h"
#include "roadbed/map/opendrive/stretch.h"

namespace roadbed::map::opendrive {

/// <roadMark> with what it allows: by its laneChange, without that by its line type — of a double
/// line the one nearer to the driver.
RoadMark read_mark(const XmlDocument& xml, pugi::xml_node node, int lane_id, double s_m);

/// The same marking from the other side, or seen against the road: double lines change places.
MarkType mirrored(MarkType type);

/// Markings of a lane's outer border (lane 0: of the middle) as lines follow each other from left
/// to right, seen along the road.
std::vector<Stretch<BorderMark>> border_marks(const LaneRecord& lane, double from_s_m,
                                              double to_s_m);

/// Where a lane's outer marking (lane 0: the one in the middle) may be crossed towards larger lane
/// ids, or smaller ones.
std::vector<Stretch<bool>> crossings(const LaneRecord& lane, bool to_larger_id, double from_s_m,
                                     double to_s_m);

}  // namespace roadbed::map::opendrive
