#pragma once

#include "roadbed/map/gis/layer.h"
#include "roadbed/map/gis/sqlite_file.h"

namespace roadbed::map::inline gis {

/// Adds the spatial index of a layer whose features are in the file: an R-tree of their boxes, and
/// the triggers by which programs that change features keep it right (OGC 12-128r18, annex F.3).
void add_spatial_index(SqliteFile& file, const Layer& layer);

}  // namespace roadbed::map::gis
