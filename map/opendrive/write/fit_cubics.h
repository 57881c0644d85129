#pragma once

#include <span>
#include <vector>

#include "roadbed/geometry/curves/piecewise_cubic.h"

namespace roadbed::map::opendrive {

/// A value at a station.
struct Sample {
  double s_m = 0.0, value = 0.0;
};

/// Piecewise linear through samples by growing s, constant beyond the first and last one.
/// @param hint  where to look first; is left where it was found.
double value_at(std::span<const Sample> samples, double s_m, std::size_t& hint);

/// Few cubic records whose value is nowhere more than `tolerance` off the line through the samples
/// and which meet in them: each one reaches as far as it can, its slopes being those of least
/// squares. Where not even one stretch between samples can be bent so, it is straight. O(N log N).
/// @param samples   by growing s, one or more.
/// @param at_least  no value is less.
std::vector<geometry::CubicRecord> fit_cubics(std::span<const Sample> samples, double tolerance,
                                              double at_least);

}  // namespace roadbed::map::opendrive
