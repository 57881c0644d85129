#pragma once

#include <string_view>

#include "roadbed/map/lanelet2/autoware/rules.h"

namespace roadbed::map::lanelet2::autoware {

/// Adds an issue about a regulatory element whose members lie so far apart that some of them belong
/// to another place: the diagonal of the box around them is longer than 100 m. (Autoware's
/// validator has 40 m as its default, which lights across a wide crossing exceed: 57 m on real
/// maps.)
void check_extent(const VectorMap& map, validation::Report& report, int number,
                  const Relation& regulation, validation::Severity severity);

/// Adds an issue about each line that a regulatory element names by a role and that is not of the
/// type that the role asks for.
void check_line_types(const VectorMap& map, validation::Report& report, int number,
                      const Relation& regulation, std::string_view role, std::string_view type);

}  // namespace roadbed::map::lanelet2::autoware
