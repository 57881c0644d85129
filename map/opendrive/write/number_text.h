#pragma once

#include <string>

#include "roadbed/geometry/curves/piecewise_cubic.h"
#include "roadbed/map/files/short_number.h"

namespace roadbed::map::opendrive {

/// The records of a profile that hold in [from, to], as elements; stations counted from `zero_m`.
/// @param name  of the element. @param station  of its attribute: "s" or "sOffset".
void add_records(const geometry::PiecewiseCubic& cubic, double from_m, double to_m, double zero_m,
                 const char* name, const char* station, std::string& text);

}  // namespace roadbed::map::opendrive
