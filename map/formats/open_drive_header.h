#pragma once

#include "roadbed/map/formats/open_drive_document.h"

namespace roadbed::map::open_drive {

/// <header>: revision, CRS with its offset. What is missing or broken there is remarked.
/// @throws InputError if the file is of another major revision.
void read_header(const XmlDocument& xml, Document& document);

}  // namespace roadbed::map::open_drive
