#pragma once

#include <span>

#include "roadbed/map/opendrive/budget.h"
#include "roadbed/map/opendrive/road_frame.h"

namespace roadbed::map::opendrive {

/// The document's objects where they stand. An object with several outlines becomes one MapObject
/// for each; one that repeats, one for each copy, or one long body where copies have no distance;
/// one without an outline gets that of its length and width, or radius. A bridge or tunnel covers
/// its road from border to border. What cannot be placed is left out and remarked.
std::vector<MapObject> place_objects(const Document& document, std::span<const RoadFrame> frames,
                                     PointBudget& budget, std::vector<ImportDiagnostic>& remarks);

/// Corners of an object's outline in the map, in the file's order.
std::vector<Eigen::Vector3d> outline_in_map(const RoadFrame& frame, const ObjectRecord& object,
                                            const Outline& outline);

}  // namespace roadbed::map::opendrive
