#include "roadbed/map/lanelet2/write/autoware/written_map.h"

namespace roadbed::map::lanelet2 {

// Elements of a written file have ids of their own, so that all are read, in the same order.
WrittenMap::WrittenMap(const OsmMap& osm, const AutowareFrame& frame)
    : document_(read_document(osm_text(osm, frame), "Lanelet2")),
      built_(build_lanes(document_)),
      source_(document_, built_),
      map_(source_, built_) {}

const autoware::Lanelet* WrittenMap::lanelet(std::uint32_t relation) const {
  return map_.lanelet(document_.relations[relation].id);
}

std::uint32_t WrittenMap::relation(const autoware::Lanelet& lanelet) const {
  return static_cast<std::uint32_t>(&lanelet.relation() - document_.relations.data());
}

}  // namespace roadbed::map::lanelet2
