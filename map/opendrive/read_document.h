#pragma once

#include "roadbed/map/opendrive/document.h"

namespace roadbed::map::opendrive {

/// As the file lists it; whether a map can be made of it its `refusal` says.
Document read_document(const XmlDocument& xml);

/// Leaves out what is broken or repeated, puts records in order of their stations, splits roads
/// where virtual junctions join them, and moves coordinates near to the map. What is split is
/// remarked.
/// @throws InputError if the document is not usable: its refusal.
void mend(Document& document);

}  // namespace roadbed::map::opendrive
