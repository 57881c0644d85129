#pragma once

#include <string>

namespace roadbed::tools::inline report {

/// Colour of a share 0 … 1 of the largest speed, "#rrggbb": from dark violet over teal to yellow,
/// as bright as the share is large (stops of viridis, matplotlib, CC0), told apart by all kinds of
/// colour vision.
std::string speed_colour(double share);

}  // namespace roadbed::tools
