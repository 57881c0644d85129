#pragma once

#include "roadbed/planning/route/route_network.h"

namespace roadbed::tests {

/// A town of crossings in a grid, 100 m apart, as a network: roads of two lanes a direction in two
/// pieces, between which changes are possible, and turns between all lanes of a crossing, U-turns
/// on the left ones. Limits differ from road to road, by the seed. About 26 lanes a crossing.
planning::RouteNetwork lane_grid(int columns, int rows, unsigned seed = 20261121);

}  // namespace roadbed::tests
