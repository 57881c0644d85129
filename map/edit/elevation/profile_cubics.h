#pragma once

#include <span>
#include <vector>

#include "roadbed/geometry/curves/piecewise_cubic.h"

namespace roadbed::map::inline edit::inline elevation {

/// Few cubics that pass samples within a tolerance, each from one sample to another, with the value
/// there and the slope of the parabola through it and those beside it: value and slope are
/// continuous. A stretch is halved until one cubic fits.
/// @param s_m  ascending, as many as values; one sample gives a constant.
std::vector<geometry::CubicRecord> cubics_through(std::span<const double> s_m,
                                                  std::span<const double> values, double within);

}  // namespace roadbed::map::edit::elevation
