#pragma once

#include <array>
#include <span>
#include <vector>

#include "roadbed/planning/lateral/batch_cost_kernel.h"
#include "roadbed/planning/lateral/candidates.h"

namespace roadbed::planning::inline lateral {

/// A batch at one station: d, and p′ = (along + i across) e^{iψ}, are linear in d_e, the first
/// number and the second times d_e; and what a stretch there adds to duration and length.
struct LinearPoint {
  double d_m[2], along[2], across[2];
  double seconds_before, metres_before;  ///< of the section that ends there, half of it
};

std::vector<LinearPoint> linear_points(const std::vector<Station>& stations,
                                       const QuinticFamily& family);

/// How long some candidates of a batch take, and how far they drive, to one of its stations.
struct PartialArcLengths {
  using Lanes = std::array<double, kSimdWidth>;
  Lanes duration_s{}, driven_m{};  ///< from the start, as drive_along() finds them
};

/// To the last of the points.
/// @param end_d_m  of the offsets, at most kSimdWidth.
PartialArcLengths partial_arc_lengths(std::span<const LinearPoint> points,
                                      std::span<const double> end_d_m);

}  // namespace roadbed::planning::lateral
