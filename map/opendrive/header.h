#pragma once

#include "roadbed/map/opendrive/document.h"

namespace roadbed::map::opendrive {

/// <header>: revision, CRS with its offset. What is missing or broken there is remarked.
/// @throws InputError if the file is of another major revision.
void read_header(const XmlDocument& xml, Document& document);

}  // namespace roadbed::map::opendrive
