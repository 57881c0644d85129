#pragma once

#include <string>

#include "roadbed/map/gis/layer.h"

namespace roadbed::map::inline gis {

/// How QGIS draws a layer of that name: a QML document with a symbol for each value of the column
/// that matters most (the type of a lane, the kind of a marking, the severity of a finding), or one
/// symbol for all.
std::string qgis_style(const Layer& layer);

}  // namespace roadbed::map::gis
