#pragma once

#include "roadbed/map/formats/open_drive_document.h"

namespace roadbed::map::open_drive {

/// All <junction> elements into `document.junctions`, all <controller> ones into
/// `document.controllers`.
void read_junctions(const XmlDocument& xml, Document& document);
void read_controllers(const XmlDocument& xml, Document& document);

}  // namespace roadbed::map::open_drive
