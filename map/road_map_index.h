#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "roadbed/map/flat_array.h"
#include "roadbed/map/lane_index.h"
#include "roadbed/map/lazy_list.h"

namespace roadbed::map {

/// What answers "which lane is here" and "which lane is called so".
struct RoadMapIndex {
  LaneIndex lanes;
  FlatArray<std::uint32_t> by_name;  ///< lanes in order of name, of equal names the first id first
  /// What a user of the map has made of it and wants to find again in its compiled form: bytes that
  /// the map does not look into. Empty: nothing.
  FlatArray<char> appendix = {};

  static RoadMapIndex of(const LazyList<Lane>& lanes);

  /// O(log lanes).
  std::optional<LaneId> find(const LazyList<Lane>& in, std::string_view name) const;

  /// @throws std::invalid_argument if it is not what of() makes of these lanes.
  void check(const LazyList<Lane>& against) const;
};

}  // namespace roadbed::map
