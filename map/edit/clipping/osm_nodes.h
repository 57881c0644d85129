#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "roadbed/map/files/transverse_mercator.h"
#include "roadbed/map/lanelet2/document.h"

namespace roadbed::map::inline edit::inline clipping {

/// Writes nodes as those of a file are written.
class NodeText {
 public:
  /// @param document  outlives it.
  explicit NodeText(const lanelet2::Document& document);

  /// A node on the straight line between two, in the map's coordinates: by latitude and longitude
  /// where both have them, by `local_x` and `local_y`, with an elevation between theirs.
  std::string between(std::uint32_t from, std::uint32_t to, double fraction, std::int64_t id) const;

 private:
  const lanelet2::Document& document_;
  std::optional<TransverseMercator> grid_;  // of the map's coordinates
};

}  // namespace roadbed::map::edit::clipping
