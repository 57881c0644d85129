#pragma once

#include "roadbed/map/formats/xml.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/road_map.h"

namespace roadbed::map::open_drive {

/// Everything of an OpenDRIVE file (ASAM OpenDRIVE 1.4–1.8) that a RoadMap holds.
/// @throws InputError with the place in the file if it is unusable.
/// @param xml  is taken, so that its elements are gone before the lanes are built.
RoadMapParts read(XmlDocument xml, const LoadOptions& options);

}  // namespace roadbed::map::open_drive
