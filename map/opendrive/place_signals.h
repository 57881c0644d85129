#pragma once

#include <span>

#include "roadbed/map/opendrive/build_lanes.h"
#include "roadbed/map/opendrive/road_frame.h"

namespace roadbed::map::opendrive {

/// The document's signals where they stand, with the lanes they speak to — on their own road and,
/// by <signalReference>, on others. What cannot be placed is left out and remarked, a reference to
/// a signal that is not there remarked. More references than the budget holds are left out.
std::vector<Signal> place_signals(const Document& document, std::span<const RoadFrame> frames,
                                  const BuiltLanes& built, PointBudget& budget,
                                  std::vector<ImportDiagnostic>& remarks);

}  // namespace roadbed::map::opendrive
