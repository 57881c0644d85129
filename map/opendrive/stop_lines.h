#pragma once

#include <span>

#include "roadbed/map/opendrive/build_lanes.h"
#include "roadbed/map/opendrive/road_frame.h"

namespace roadbed::map::opendrive {

/// Stop lines of the file: objects whose type, subtype or name says "stop line", and signals of
/// type 294 (the German catalogue's stop line, which the standard's examples use). An object lies
/// along its longest extent, a signal across its road. Lanes are those that <validity> names, else
/// those that the line crosses. Signals are those that the line's own depend on, and the lights and
/// stop or give-way signs (205, 206) that speak to one of its lanes.
std::vector<StopLine> find_stop_lines(const Document& document, std::span<const RoadFrame> frames,
                                      const BuiltLanes& built, const std::vector<Signal>& signals,
                                      PointBudget& budget);

}  // namespace roadbed::map::opendrive
