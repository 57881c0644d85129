#pragma once

#include <cstdint>

#include "roadbed/map/lanelet2/autoware/vector_map.h"
#include "roadbed/map/lanelet2/write/autoware/frame.h"

namespace roadbed::map::lanelet2 {

/// A file as it would be written, looked at as Autoware's requirements look at it: so the writer
/// and the rules agree on who meets whom. Later changes to the elements are not seen.
class WrittenMap {
 public:
  WrittenMap(const OsmMap& osm, const AutowareFrame& frame);

  const autoware::VectorMap& map() const { return map_; }

  /// The lanelet that a relation of the OsmMap is; null if it is none.
  const autoware::Lanelet* lanelet(std::uint32_t relation) const;
  /// The place of a lanelet in OsmMap::relations.
  std::uint32_t relation(const autoware::Lanelet& lanelet) const;

 private:
  Document document_;
  BuiltLanes built_;
  rules::Source source_;
  autoware::VectorMap map_;
};

}  // namespace roadbed::map::lanelet2
