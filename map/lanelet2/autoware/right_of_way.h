#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>

#include "roadbed/map/lanelet2/autoware/vector_map.h"

namespace roadbed::map::lanelet2::autoware {

/// What the lanelets that conflict with one with the right of way have to do.
struct Conflicts {
  std::set<std::int64_t> yielding;          ///< they have to yield
  std::map<std::int64_t, double> slightly;  ///< the share of the lanelet that they cover: below 1 %
                                            ///< they may or may not have to
};

/// Whether a lanelet that conflicts with one that has the right of way has to yield.
using MustYield = std::function<bool(const Lanelet& lanelet, const Lanelet& other)>;

Conflicts conflicts_of(const VectorMap& map, const Lanelet& lanelet, const MustYield& must_yield);

/// Whether two lanelets begin behind one: then who is on one of them came from the same place.
bool have_one_source(const VectorMap& map, const Lanelet& one, const Lanelet& other);

/// Whether a lanelet turns and has traffic lights: then it has to say who yields to it.
bool turns_at_lights(const Lanelet& lanelet);

/// Whether another lanelet yields to one that turns at traffic lights: it comes from elsewhere, and
/// is green at another time or turns across the road.
bool yields_at_lights(const VectorMap& map, const Lanelet& lanelet, const Lanelet& other);

}  // namespace roadbed::map::lanelet2::autoware
