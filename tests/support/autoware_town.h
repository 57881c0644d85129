#pragma once

#include "roadbed/tests/support/made_vector_map.h"

namespace roadbed::tests {

/// A map in which everything is as Autoware asks for it. Lanelets lead to the east unless they are
/// said to lead to the north; what stands apart is hundreds of metres apart.
///
///     y [m]
///       9 ┌───────── 103 pedestrian lane ┐
///       7 ├───────── 101 road ───────────┤          111 ▲
///     3.5 ├───────── 100 road ───────────┤── 110 ────────────   area 500, right of way 600
///       0 ├───────── 102 shoulder ───────┤             │
///         0                             40    48   60        x [m]
///
///     200: left turn 120 with lights, crossed by 121      400: virtual light 620 over 130, 131
///     100: road 141 with crosswalk 140 and walkway 142    600: road 150 with lights and areas
///     700: 180 turns right, 181, 182 turns left           800: roads 160 and 161, own centreline
MadeVectorMap autoware_town();

}  // namespace roadbed::tests
