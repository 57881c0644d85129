#pragma once

#include "roadbed/map/opendrive/document.h"

namespace roadbed::map::opendrive {

/// All <junction> elements into `document.junctions`, all <controller> ones into
/// `document.controllers`.
void read_junctions(const XmlDocument& xml, Document& document);
void read_controllers(const XmlDocument& xml, Document& document);

}  // namespace roadbed::map::opendrive
