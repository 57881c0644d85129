#pragma once

#include "roadbed/map/files/xml.h"
#include "roadbed/map/model/load_options.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/opendrive/document.h"

namespace roadbed::map::opendrive {

/// Everything of an OpenDRIVE file (ASAM OpenDRIVE 1.4–1.8) that a RoadMap holds.
/// @throws InputError with the place in the file if it is unusable.
/// @param xml  is taken, so that its elements are gone before the lanes are built.
RoadMapParts read(XmlDocument xml, const LoadOptions& options);

/// The same from the file's document, as read_document() gives it.
RoadMapParts read(XmlDocument xml, Document document, const LoadOptions& options);

/// As the file lists it, the same for any number of threads; whether a map can be made of it its
/// `refusal` says.
Document read_document(const XmlDocument& xml, int threads = 1);

/// Leaves out what is broken or repeated, puts records in order of their stations, splits roads
/// where virtual junctions join them, and moves coordinates near to the map. What is split is
/// remarked.
/// @throws InputError if the document is not usable: its refusal.
void mend(Document& document);

}  // namespace roadbed::map::opendrive
