#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "roadbed/map/elements/lane.h"

namespace roadbed::map::validation {

/// Borders are sampled to within 1 mm each [m].
constexpr double kWidthTolerance = 2e-3;
/// Less is a step at a joint of geometry records [m].
constexpr double kFold = 0.01;

/// Direction of travel over a metre: where geometry records step back at their joints, as many
/// files have them do by up to some centimetres, a single segment may point anywhere.
Eigen::Vector2d direction_at(const Lane& lane, double s_m);

/// Distance from the right border to the left one across the lane, negative if they are swapped.
double signed_width_m(const Lane& lane, double s_m);

/// Stations of all vertices of both borders.
std::vector<double> border_stations_m(const Lane& lane);

struct Fold {
  Eigen::Vector2d in_map;
  double length_m = 0.0;
};

/// The part of a border that runs against the lane's direction, of the border that does so longer.
Fold longer_fold(const Lane& lane);

struct Swap {
  double s_m, width_m;
};

/// Where the borders of a lane are swapped most, if they are by more than the tolerance.
std::optional<Swap> most_swapped(const Lane& lane);

/// Whether a border runs backwards or the borders are swapped, as in a bend about a centre that
/// lies within the lane or before it: what follows from its direction then says nothing of links.
bool is_folded(const Lane& lane);

}  // namespace roadbed::map::validation
