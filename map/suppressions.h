#pragma once

#include <vector>

#include "roadbed/map/files/xml.h"
#include "roadbed/map/lanelet2/document.h"
#include "roadbed/map/validation/rule.h"

// What a map file says of itself that `validate` need not tell: patterns of rules with commas
// between them, beside the element that they are about. CommonRoad has no place for such data.

namespace roadbed::map {

/// OpenDRIVE: `<userData code="roadbed:suppress" value="geometry.gap,curve.*"/>` in a road, a lane,
/// a signal, an object, a junction or a controller; in the header or the root it is about the whole
/// map, in any other element about the road that this is part of.
validation::Suppressions suppressions_of(const XmlDocument& xml);

/// Lanelet2: a tag `roadbed:suppress` of a relation, a way, or a node that has a finding.
validation::Suppressions suppressions_of(const lanelet2::Document& document,
                                         const std::vector<validation::Finding>& findings);

/// Takes the findings that the map suppresses out of the list, in their order.
std::vector<validation::Finding> take_suppressed(std::vector<validation::Finding>& findings,
                                                 const validation::Suppressions& suppressions);

}  // namespace roadbed::map
